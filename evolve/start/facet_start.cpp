#include "evolve/start/facet_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "evolve/curves/curve_place.h"
#include "evolve/films/facet_parts.h"

namespace meniscus::start {

namespace {

constexpr double kSameCut = 0.2;    // cuts nearer than this are one [spacing]
constexpr double kAtCorner = 0.25;  // so near a cut moves to a corner
constexpr double kLongPiece = 1.5;  // is cut [edge]

struct Held {  // a point on a curve
  int curve = -1;
  double t = 0.0;
  double distance = std::numeric_limits<double>::infinity();
  double spacing = 1.0;  // to the next one along the rim, in t
  bool used = false;
  int cut = -1;
};

/// From a to b the shorter way around, in (-0.5, 0.5].
double way(double a, double b) {
  const double d = b - a - std::floor(b - a);
  return d > 0.5 ? d - 1.0 : d;
}

class Builder {
 public:
  Builder(const films::FilmSystem& system, double edge, bool keep)
      : system_(system),
        edge_(edge),
        keep_(keep),
        all_(films::facet_parts(system)) {}

  FacetStart build() {
    result_.points = all_.points;
    find_places();
    put_on_curves();
    cut_curves();
    for (std::size_t p = 0; p < all_.parts.size(); ++p) {
      add_sheet(static_cast<int>(p));
    }
    return std::move(result_);
  }

 private:
  void find_places();
  void put_on_curves();
  void cut_curves();
  void add_cuts(int curve, std::vector<double>& cuts) const;
  void add_sheet(int part);

  [[noreturn]] void refuse_rim(const films::FacetRim& rim) const;

  const films::FilmSystem& system_;
  double edge_;
  bool keep_;
  films::FacetParts all_;
  FacetStart result_;
  std::vector<Held> held_;  // per point
};

/// The nearest place on the curves of its films for each point of a rim.
void Builder::find_places() {
  held_.resize(result_.points.size());
  for (std::size_t c = 0; c < system_.curves.size(); ++c) {
    std::set<int> points;
    for (const films::FacetRim& rim : all_.rims) {
      const std::vector<int>& curves = all_.parts[rim.part].curves;
      if (std::find(curves.begin(), curves.end(), static_cast<int>(c)) !=
          curves.end()) {
        points.insert({rim.a, rim.b});
      }
    }
    if (points.empty()) {
      continue;
    }
    Points at;
    for (const int v : points) {
      at.push_back(all_.points[v]);
    }
    const std::vector<curves::CurvePlace> places =
        curves::nearest_places(system_.curves[c].shape, at);
    std::size_t k = 0;
    for (const int v : points) {
      if (places[k].distance < held_[v].distance) {
        held_[v].curve = static_cast<int>(c);
        held_[v].t = places[k].t;
        held_[v].distance = places[k].distance;
      }
      ++k;
    }
  }
}

void Builder::refuse_rim(const films::FacetRim& rim) const {
  const films::FacetPart& part = all_.parts[rim.part];
  const std::string at = films::text_of_place(all_.middle(rim));
  if (part.curves.empty()) {
    throw InvalidInput(fmt::format(
        "{} is open at {} and names no curve; name the curves that hold "
        "its rims, or close it",
        part.what, at));
  }
  const Held& far = held_[rim.a].distance > held_[rim.b].distance
                        ? held_[rim.a]
                        : held_[rim.b];
  throw InvalidInput(fmt::format(
      "{}: its rim at {} lies on none of its curves; the nearest, '{}', "
      "is {:.4g} away, and {:.4g} is allowed (within): name the curve there, "
      "or "
      "move the one or the other",
      part.what, at, system_.curves[far.curve].name, far.distance,
      part.within));
}

void Builder::put_on_curves() {
  std::map<std::pair<int, int>, double> covered;  // part, curve: share
  for (films::FacetRim& rim : all_.rims) {
    const films::FacetPart& part = all_.parts[rim.part];
    Held& a = held_[rim.a];
    Held& b = held_[rim.b];
    // A rim lies on a curve when both ends are near the same one. An edge that
    // other films share may also cut across it: then its middle is far off.
    const bool near = a.curve >= 0 && a.curve == b.curve &&
                      a.distance <= part.within && b.distance <= part.within &&
                      std::find(part.curves.begin(), part.curves.end(),
                                a.curve) != part.curves.end();
    const bool across = near && rim.shared &&
                        curves::nearest_places(system_.curves[a.curve].shape,
                                               {all_.middle(rim)})[0]
                                .distance > std::abs(part.within);
    if (!near || across) {
      if (!rim.shared) {
        refuse_rim(rim);
      }
      continue;
    }
    // The share of the curve that each part covers, by parameter: above 1 it
    // runs back over itself.
    rim.curve = a.curve;
    const double gap = std::abs(way(a.t, b.t));
    for (Held* end : {&a, &b}) {
      end->used = true;
      end->spacing = std::min(end->spacing, gap);
    }
    double& share = covered[{rim.part, rim.curve}];
    share += gap;
    if (share > 1.0 + 1e-6) {
      throw InvalidInput(
          fmt::format("{}: its rim folds back on the curve '{}' near {}; a rim "
                      "follows its curve once around",
                      part.what, system_.curves[rim.curve].name,
                      films::text_of_place(all_.middle(rim))));
    }
  }
  // Every curve that a part names must have been met.
  for (std::size_t p = 0; p < all_.parts.size(); ++p) {
    for (const int curve : all_.parts[p].curves) {
      if (!covered.contains({static_cast<int>(p), curve})) {
        throw InvalidInput(fmt::format(
            "{} names the curve '{}', and no rim of its facets lies on "
            "it (within {:.4g}); take it out, or move it",
            all_.parts[p].what, system_.curves[curve].name,
            all_.parts[p].within));
      }
    }
  }
}

/// Corners, and the middles of long pieces.
void Builder::add_cuts(int curve, std::vector<double>& cuts) const {
  const curves::CurveShape& shape = system_.curves[curve].shape;
  for (const double corner : curves::corner_parameters(shape)) {
    if (std::find(cuts.begin(), cuts.end(), corner) == cuts.end()) {
      cuts.push_back(corner);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  if (keep_) {
    return;
  }
  constexpr int kChords = 8;
  const std::vector<double> before = cuts;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double next = k + 1 < before.size() ? before[k + 1] : before[0] + 1.0;
    const double gap = next - before[k];
    double length = 0.0;
    Vec3 last = curves::point_at(shape, before[k]);
    for (int i = 1; i <= kChords; ++i) {
      const Vec3 at = curves::point_at(shape, before[k] + gap * i / kChords);
      length += (at - last).norm();
      last = at;
    }
    const double pieces =
        length > kLongPiece * edge_ ? std::ceil(length / edge_) : 1.0;
    for (int i = 1; i < static_cast<int>(pieces); ++i) {
      const double t = before[k] + gap * i / pieces;
      cuts.push_back(t - std::floor(t));
    }
  }
  std::sort(cuts.begin(), cuts.end());
}

void Builder::cut_curves() {
  for (std::size_t c = 0; c < system_.curves.size(); ++c) {
    std::vector<int> on;
    for (std::size_t v = 0; v < held_.size(); ++v) {
      if (held_[v].used && held_[v].curve == static_cast<int>(c)) {
        on.push_back(static_cast<int>(v));
      }
    }
    if (on.empty()) {
      continue;
    }
    const curves::CurveShape& shape = system_.curves[c].shape;
    // Corners of the curve take the vertex nearest to them, so that a rim turns
    // exactly there.
    for (const double corner : curves::corner_parameters(shape)) {
      const int near =
          *std::min_element(on.begin(), on.end(), [&](int a, int b) {
            return std::abs(way(held_[a].t, corner)) <
                   std::abs(way(held_[b].t, corner));
          });
      if (std::abs(way(held_[near].t, corner)) <=
          kAtCorner * held_[near].spacing) {
        held_[near].t = corner;
      }
    }
    // Around the curve, vertices of several films that nearly coincide share
    // one parameter: their films then meet in one cut.
    std::stable_sort(on.begin(), on.end(),
                     [&](int a, int b) { return held_[a].t < held_[b].t; });
    std::vector<double> cuts;
    int last = on.back();
    for (const int v : on) {
      const double same =
          kSameCut * std::min(held_[v].spacing, held_[last].spacing);
      if (v != last && std::abs(way(held_[last].t, held_[v].t)) < same) {
        held_[v].t = held_[last].t;  // of another film, and the same
      } else {
        last = v;
      }
      cuts.push_back(held_[v].t);
    }
    // Distinct cuts in order, with those that corners and long pieces add; each
    // vertex then finds its own by its parameter.
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    add_cuts(static_cast<int>(c), cuts);
    for (const int v : on) {
      held_[v].cut = static_cast<int>(
          std::lower_bound(cuts.begin(), cuts.end(), held_[v].t) -
          cuts.begin());
    }
    result_.cuts.emplace(static_cast<int>(c), std::move(cuts));
  }
}

/// Facets of corners by one number: points, then the cuts of all curves.
class Cutter {
 public:
  explicit Cutter(std::vector<Triangle> facets) : facets_(std::move(facets)) {}

  void note(int facet, int a, int b) { at_[{a, b}] = facet; }

  /// Puts corners between a and b, in this order.
  void cut(int a, int b, const std::vector<int>& between) {
    for (const int m : between) {
      const int f = at_.at({a, b});
      Triangle& t = facets_[f];
      const auto k = std::find(t.begin(), t.end(), a) - t.begin();
      const int c = t[(k + 2) % 3];
      t = {a, m, c};
      const int made = static_cast<int>(facets_.size());
      facets_.push_back({m, b, c});
      at_.erase({a, b});
      at_[{a, m}] = f;
      at_[{m, b}] = made;
      if (const auto other = at_.find({b, c}); other != at_.end()) {
        other->second = made;
      }
      a = m;
    }
  }
  const std::vector<Triangle>& facets() const { return facets_; }

 private:
  std::vector<Triangle> facets_;
  std::map<Edge, int> at_;  // directed rim edges: their facet
};

void Builder::add_sheet(int part) {
  // One numbering for free points and the cuts of all curves.
  std::map<int, int> first;  // of a curve's cuts
  std::vector<FacetCorner> corner(result_.points.size());
  for (std::size_t v = 0; v < corner.size(); ++v) {
    corner[v].point = static_cast<int>(v);
  }
  for (const auto& [curve, cuts] : result_.cuts) {
    first[curve] = static_cast<int>(corner.size());
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      corner.push_back({-1, curve, static_cast<int>(k)});
    }
  }
  // Facets by these numbers; two corners at one cut leave no facet.
  const auto id_of = [&](int v) {
    return held_[v].used ? first.at(held_[v].curve) + held_[v].cut : v;
  };
  std::vector<Triangle> facets;
  for (const Triangle& t : all_.parts[part].facets) {
    facets.push_back({id_of(t[0]), id_of(t[1]), id_of(t[2])});
    const Triangle& f = facets.back();
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) {
      throw InvalidInput(fmt::format(
          "{}: its facet at {} shrinks to nothing on its curve; other "
          "films' rims there have other vertices, give them the same",
          all_.parts[part].what, films::text_of_place(all_.points[t[0]])));
    }
  }
  Cutter cutter(std::move(facets));
  for (const films::FacetRim& rim : all_.rims) {
    if (rim.part == part && rim.curve >= 0) {
      cutter.note(rim.facet, id_of(rim.a), id_of(rim.b));
    }
  }
  for (const films::FacetRim& rim : all_.rims) {
    if (rim.part != part || rim.curve < 0) {
      continue;
    }
    // Cuts between a rim edge's ends, the short way around the curve, fan the
    // facet beside it.
    const int n = static_cast<int>(result_.cuts.at(rim.curve).size());
    const int step = way(held_[rim.a].t, held_[rim.b].t) > 0.0 ? 1 : -1;
    std::vector<int> between;
    for (int k = (held_[rim.a].cut + step + n) % n; k != held_[rim.b].cut;
         k = (k + step + n) % n) {
      between.push_back(first.at(rim.curve) + k);
    }
    cutter.cut(id_of(rim.a), id_of(rim.b), between);
  }
  FacetSheet sheet{all_.parts[part].name, {}};
  for (const Triangle& t : cutter.facets()) {
    sheet.facets.push_back({corner[t[0]], corner[t[1]], corner[t[2]]});
  }
  result_.sheets.push_back(std::move(sheet));
}

}  // namespace

FacetStart start_from_facets(const films::FilmSystem& system, double edge,
                             bool keep) {
  return Builder(system, edge, keep).build();
}

double mean_facet_edge(const films::FilmSystem& system) {
  double sum = 0.0;
  double count = 0.0;
  for (const films::FilmSpec& film : system.films) {
    if (!film.start) {
      continue;
    }
    const Points& p = film.start->points;
    for (const Triangle& t : film.start->facets) {
      for (int k = 0; k < 3; ++k) {
        sum += (p[t[(k + 1) % 3]] - p[t[k]]).norm();
        count += 1.0;
      }
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace meniscus::start
