#include "cad/solid/rim_edges.h"

#include <algorithm>
#include <cmath>

namespace meniscus::solid {

namespace {

constexpr double kSameRimPlace = 1e-9;  // of the rim's length

double apart(double s, double t, double length) {
  const double d = s - t;
  return std::abs(d - length * std::round(d / length));
}

}  // namespace

void RimEdges::build(double tolerance, Brep& brep) {
  // Vertices stand where pieces of the curve meet; a whole circle has none.
  const double length = curve_->length();
  const bool one_arc =
      curve_->piece_count() == 1 &&
      std::holds_alternative<EllipseCurve>(curve_->piece(0).curve);
  for (int k = 0; k < curve_->piece_count() && !one_arc; ++k) {
    places_.push_back(curve_->start_of(k));
  }
  // Wishes near a vertex that is there are served by it (places are periodic);
  // exact ones come first, so that others move to them.
  const auto put = [&](std::vector<double>& wishes, double near) {
    std::sort(wishes.begin(), wishes.end());
    for (const double s : wishes) {
      const bool there = std::any_of(
          places_.begin(), places_.end(),
          [&](double place) { return apart(s, place, length) < near; });
      if (!there) {
        places_.push_back(curve_->wrapped(s));
      }
    }
  };
  put(exact_, kSameRimPlace * length);
  put(wanted_, tolerance);
  if (places_.empty()) {
    places_.push_back(0.0);
  }
  // Each interval of the sorted places is an edge within one piece, the last
  // one across the beginning.
  std::sort(places_.begin(), places_.end());
  for (const double s : places_) {
    vertices_.push_back(static_cast<int>(brep.vertices.size()));
    brep.vertices.push_back(curve_->point(s));
  }
  const std::size_t count = places_.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double end = k + 1 < count ? places_[k + 1] : places_[0] + length;
    const int piece = curve_->piece_at(0.5 * (places_[k] + end));
    edges_.push_back(static_cast<int>(brep.edges.size()));
    brep.edges.push_back({vertices_[k], vertices_[(k + 1) % count],
                          curve_->piece(piece).curve,
                          curve_->parameter_at(piece, places_[k]),
                          curve_->parameter_at(piece, end)});
  }
}

int RimEdges::index_of(double s) const {
  const auto nearest =
      std::min_element(places_.begin(), places_.end(), [&](double p, double q) {
        return apart(s, p, curve_->length()) < apart(s, q, curve_->length());
      });
  return static_cast<int>(nearest - places_.begin());
}

double RimEdges::way(double from, double to, bool growing) const {
  const double d = growing ? place(to) - place(from) : place(from) - place(to);
  return d > 0.0 ? d : d + curve_->length();
}

std::vector<RimEdges::Step> RimEdges::between(double from, double to,
                                              bool growing) const {
  const int count = static_cast<int>(places_.size());
  const double whole = way(from, to, growing);
  const int end = index_of(to);
  std::vector<Step> steps;
  double done = 0.0;
  int at = index_of(from);
  do {
    const int next = growing ? (at + 1) % count : (at + count - 1) % count;
    const int edge = growing ? at : next;
    const double length = edge + 1 < count
                              ? places_[edge + 1] - places_[edge]
                              : places_[0] + curve_->length() - places_[edge];
    const double begin_share = done / whole;
    done += length;
    const double end_share = next == end ? 1.0 : done / whole;
    steps.push_back(growing
                        ? Step{edges_[edge], true, begin_share, end_share}
                        : Step{edges_[edge], false, end_share, begin_share});
    at = next;
  } while (at != end);
  return steps;
}

}  // namespace meniscus::solid
