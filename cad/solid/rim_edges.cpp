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

/// The place on piece j of `to` that place s of piece k of `from` is: both
/// pieces are one, and places run in proportion to its parameter.
double moved(const RimCurve& from, int k, double s, const RimCurve& to, int j,
             bool reversed) {
  const double share =
      (s - from.start_of(k)) / (from.start_of(k + 1) - from.start_of(k));
  return to.start_of(j) + (reversed ? 1.0 - share : share) *
                              (to.start_of(j + 1) - to.start_of(j));
}

}  // namespace

void RimEdges::share(int k, RimEdges& owner, int piece, bool reversed) {
  owners_[k] = {&owner, piece, reversed};
  shares_ = true;
  owner.shares_ = true;
}

void RimEdges::want(double s) {
  const int k = curve_->piece_at(s);
  if (owners_[k].rim != nullptr) {
    owners_[k].rim->want(at_owner(k, curve_->wrapped(s)));
  } else {
    wanted_.push_back(s);
  }
}

void RimEdges::want_exactly(double s) {
  const int k = curve_->piece_at(s);
  if (owners_[k].rim != nullptr) {
    owners_[k].rim->want_exactly(at_owner(k, curve_->wrapped(s)));
  } else {
    exact_.push_back(s);
  }
}

/// The owner's place that place s of piece k is.
double RimEdges::at_owner(int k, double s) const {
  const Owner& owner = owners_[k];
  return moved(*curve_, k, s, owner.rim->curve(), owner.piece, owner.reversed);
}

/// Those within the piece, where it is shared.
void RimEdges::add_owners_places(int k) {
  const Owner& owner = owners_[k];
  if (owner.rim == nullptr) {
    return;
  }
  const RimCurve& there = owner.rim->curve();
  for (const double place : owner.rim->places_) {
    if (place > there.start_of(owner.piece) &&
        place < there.start_of(owner.piece + 1)) {
      places_.push_back(
          moved(there, owner.piece, place, *curve_, k, owner.reversed));
    }
  }
}

/// The end of the edge from place k, the last one's beyond the beginning.
double RimEdges::end_of(std::size_t k) const {
  return k + 1 < places_.size() ? places_[k + 1]
                                : places_[0] + curve_->length();
}

void RimEdges::set_places(double tolerance) {
  // Vertices stand where pieces of the curve meet; a whole circle has none.
  const double length = curve_->length();
  const bool one_arc =
      curve_->piece_count() == 1 &&
      std::holds_alternative<EllipseCurve>(curve_->piece(0).curve);
  for (int k = 0; k < curve_->piece_count() && !one_arc; ++k) {
    places_.push_back(curve_->start_of(k));
    add_owners_places(k);
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
  std::sort(places_.begin(), places_.end());
}

/// Where pieces are shared, the owners' edges and their vertices.
void RimEdges::take_parts(const Brep& brep) {
  const std::size_t count = places_.size();
  parts_.assign(count, {});
  vertices_.assign(count, -1);
  for (std::size_t k = 0; k < count; ++k) {
    const double middle = curve_->wrapped(0.5 * (places_[k] + end_of(k)));
    const int piece = curve_->piece_at(middle);
    const Owner& owner = owners_[piece];
    if (owner.rim == nullptr) {
      continue;
    }
    const std::vector<double>& places = owner.rim->places_;
    const auto after =
        std::upper_bound(places.begin(), places.end(), at_owner(piece, middle));
    // Those before the first place are of the last edge, across the beginning.
    const std::size_t at =
        (after - places.begin() + places.size() - 1) % places.size();
    parts_[k] = {owner.rim->parts_[at].edge, !owner.reversed};
    const BrepEdge& edge = brep.edges[parts_[k].edge];
    vertices_[k] = owner.reversed ? edge.to : edge.from;
    vertices_[(k + 1) % count] = owner.reversed ? edge.from : edge.to;
  }
}

/// The vertex that another rim has at this corner, or -1.
int RimEdges::corner(double s, const Brep& brep, double same) const {
  const Vec3 place = curve_->point(s);
  for (std::size_t v = 0; v < brep.vertices.size() && shares_; ++v) {
    if ((brep.vertices[v] - place).norm() <= same) {
      return static_cast<int>(v);
    }
  }
  return -1;
}

void RimEdges::build(double tolerance, Brep& brep, double same) {
  set_places(tolerance);
  take_parts(brep);
  const std::size_t count = places_.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (vertices_[k] < 0) {
      vertices_[k] = corner(places_[k], brep, same);
    }
    if (vertices_[k] < 0) {
      vertices_[k] = static_cast<int>(brep.vertices.size());
      brep.vertices.push_back(curve_->point(places_[k]));
    }
  }
  // Each interval of the sorted places is an edge within one piece, the last
  // one across the beginning.
  for (std::size_t k = 0; k < count; ++k) {
    if (parts_[k].edge >= 0) {
      continue;
    }
    const double end = end_of(k);
    const int piece = curve_->piece_at(0.5 * (places_[k] + end));
    parts_[k].edge = static_cast<int>(brep.edges.size());
    brep.edges.push_back({vertices_[k], vertices_[(k + 1) % count],
                          curve_->piece(piece).curve,
                          curve_->parameter_at(piece, places_[k]),
                          curve_->parameter_at(piece, end)});
  }
  // Shared corners may lie beside this rim's own by as much as rims may.
  for (std::size_t k = 0; k < count && shares_; ++k) {
    const double off =
        (curve_->point(places_[k]) - brep.vertices[vertices_[k]]).norm();
    for (const std::size_t at : {k, (k + count - 1) % count}) {
      double& gap = brep.edges[parts_[at].edge].gap;
      gap = std::max(gap, off);
    }
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
    const double begin = done / whole;
    done += end_of(edge) - places_[edge];
    const double end_share = next == end ? 1.0 : done / whole;
    const Part& part = parts_[edge];
    steps.push_back(growing == part.along
                        ? Step{part.edge, true, begin, end_share}
                        : Step{part.edge, false, end_share, begin});
    at = next;
  } while (at != end);
  return steps;
}

}  // namespace meniscus::solid
