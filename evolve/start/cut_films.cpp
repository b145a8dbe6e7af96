#include "evolve/start/cut_films.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/curve_cut.h"
#include "evolve/films/edge_marks.h"

namespace meniscus::start {

namespace {

constexpr double kNear = 0.3;       // x the shortest edge: is put onto it
constexpr double kSameLine = 1e-7;  // of a band's coordinates

/// From a to b the shorter way around, in (-1/2, 1/2].
double turn_from(double a, double b) {
  const double turn = b - a;
  return turn - std::ceil(turn - 0.5);
}

/// A straight line of a ruled band in the plane: at one t, or at one share.
struct BandLine {
  bool at_t = true;
  double value = 0.0;

  /// How far it is from a place of the band.
  double from(const films::BandPlace& place) const {
    return at_t ? turn_from(place.t, value) : value - place.share;
  }
};

class FilmCut {
 public:
  FilmCut(const FacePlane& plane, films::FilmComplex& complex)
      : plane_(plane),
        complex_(complex),
        off_(complex.mesh.points.size()),
        star_(complex.mesh.points.size()) {}

  void run() {
    measure();
    find_band_lines();
    put_onto_plane();
    cut_marks();
    cut_facets();
    bind_vertices();
    mark_edges();
  }

 private:
  double off(const Vec3& p) const { return plane_.normal.dot(p - plane_.at); }

  void measure() {
    const Points& points = complex_.mesh.points;
    const double reach = reach_of_planes(points);
    for (std::size_t v = 0; v < points.size(); ++v) {
      const double here = off(points[v]);
      off_[v] = std::abs(here) <= reach ? 0.0 : here;
    }
    for (std::size_t f = 0; f < complex_.mesh.facets.size(); ++f) {
      for (const int v : complex_.mesh.facets[f]) {
        star_[v].push_back(static_cast<int>(f));
      }
    }
  }

  void find_band_lines() {
    lines_.resize(complex_.bands.size());
    for (std::size_t b = 0; b < lines_.size(); ++b) {
      const films::RuledBand& band = complex_.bands[b];
      const std::vector<double> at = curves::crossings(
          complex_.curves[band.outer].shape, plane_.at, plane_.normal);
      if (!band.is_patch()) {
        for (const double t : at) {
          lines_[b].push_back({true, t});
        }
      } else if (at.size() == 2) {
        const films::BandPlace one = films::place_on_patch(band, at[0]);
        const films::BandPlace two = films::place_on_patch(band, at[1]);
        const bool at_t = std::abs(one.t - two.t) < kSameLine;
        if (at_t || std::abs(one.share - two.share) < kSameLine) {
          lines_[b].push_back({at_t, at_t ? one.t : one.share});
        }
      }
    }
  }

  films::BandPlace on_band(int band, int v) const {
    return films::place_on_band(
        complex_, band, {complex_.vertices[v], complex_.mesh.points[v]});
  }

  /// The band's place on one of its lines that is nearest to a vertex.
  std::optional<films::BandPlace> on_line(int band, int v) const {
    const films::BandPlace place = on_band(band, v);
    const BandLine* nearest = nullptr;
    for (const BandLine& line : lines_[band]) {
      if (nearest == nullptr ||
          std::abs(line.from(place)) < std::abs(nearest->from(place))) {
        nearest = &line;
      }
    }
    if (nearest == nullptr) {
      return std::nullopt;
    }
    return nearest->at_t ? films::BandPlace{nearest->value, place.share}
                         : films::BandPlace{place.t, nearest->value};
  }

  /// No facet may come to lie in the plane.
  bool leaves_facets(int v) const {
    return std::none_of(star_[v].begin(), star_[v].end(), [&](int f) {
      const Triangle& t = complex_.mesh.facets[f];
      return std::all_of(t.begin(), t.end(),
                         [&](int u) { return u == v || off_[u] == 0.0; });
    });
  }

  double shortest_edge_at(int v) const {
    double least = std::numeric_limits<double>::infinity();
    for (const int f : star_[v]) {
      for (const int u : complex_.mesh.facets[f]) {
        if (u != v) {
          least = std::min(
              least,
              (complex_.mesh.points[u] - complex_.mesh.points[v]).norm());
        }
      }
    }
    return least;
  }

  /// Thin facets beside the plane would stay in rings, and be many in films.
  void put_onto_plane() {
    for (std::size_t i = 0; i < off_.size(); ++i) {
      const auto v = static_cast<int>(i);
      films::ComplexVertex& vertex = complex_.vertices[v];
      if (off_[v] == 0.0 || star_[v].empty()) {
        continue;
      }
      const double near = kNear * shortest_edge_at(v);
      if (std::abs(off_[v]) > near || !leaves_facets(v)) {
        continue;
      }
      Vec3& at = complex_.mesh.points[v];
      if (vertex.kind == films::VertexKind::Free) {
        at -= off_[v] * plane_.normal;
        off_[v] = 0.0;
      } else if (vertex.kind == films::VertexKind::OnBand) {
        const auto place = on_line(vertex.curve, v);
        const Vec3 there = place ? films::point_on_band(
                                       complex_.bands[vertex.curve],
                                       complex_.curves, place->t, place->share)
                                 : at;
        if (place && (there - at).norm() <= near) {
          at = there;
          vertex.t = place->t;
          vertex.share = place->share;
          off_[v] = 0.0;
        }
      }
    }
  }

  /// The vertex where the edge from a to b of a surface crosses the plane.
  int crossing(int a, int b, int label, int constraints) {
    const auto [known, is_new] = made_.try_emplace(edge_key(a, b), -1);
    if (!is_new) {
      return known->second;
    }
    const films::ComplexSurface& surface = complex_.surfaces[label];
    films::PlacedVertex made =
        surface.band < 0 ? on_film(a, b, constraints)
                         : on_band_edge(surface.band, a, b, surface.name);
    known->second = static_cast<int>(complex_.mesh.points.size());
    complex_.mesh.points.push_back(made.place);
    complex_.vertices.push_back(made.vertex);
    off_.push_back(0.0);
    return known->second;
  }

  films::PlacedVertex on_film(int a, int b, int constraints) const {
    const Points& points = complex_.mesh.points;
    const double share = off_[a] / (off_[a] - off_[b]);
    Vec3 place = points[a] + share * (points[b] - points[a]);
    place -= off(place) * plane_.normal;
    return {{.kind = films::VertexKind::Free, .constraints = constraints},
            place};
  }

  films::PlacedVertex on_band_edge(int band, int a, int b,
                                   const std::string& name) const {
    const films::BandPlace one = on_band(band, a);
    const films::BandPlace two = on_band(band, b);
    for (const BandLine& line : lines_[band]) {
      const double from = line.from(one);
      const double to = line.from(two);
      if (!(from * to < 0.0) || std::abs(from - to) > 0.5) {
        continue;
      }
      const double s = from / (from - to);
      double t = line.at_t ? line.value : one.t + s * turn_from(one.t, two.t);
      t -= std::floor(t);
      const double share =
          line.at_t ? one.share + s * (two.share - one.share) : line.value;
      return {{.kind = films::VertexKind::OnBand,
               .curve = band,
               .t = t,
               .share = share},
              films::point_on_band(complex_.bands[band], complex_.curves, t,
                                   share)};
    }
    const Vec3& p = complex_.mesh.points[a];
    throw InvalidInput(fmt::format(
        "a plane of symmetry cuts '{}' aslant at ({:.6g}, {:.6g}, {:.6g}), not "
        "along one of its straight lines; draw the whole",
        name, p.x(), p.y(), p.z()));
  }

  void cut_marks() {
    std::vector<films::ComplexEdge> kept;
    for (films::ComplexEdge mark : complex_.edges) {
      const double a = off_[mark.a];
      const double b = off_[mark.b];
      if (a > 0.0 && b > 0.0) {
        continue;
      }
      if (a * b < 0.0) {
        const int label = label_along(mark.a, mark.b);
        if (label < 0) {
          continue;  // no surface's any more
        }
        const int v = crossing(mark.a, mark.b, label, mark.constraints);
        (a > 0.0 ? mark.a : mark.b) = v;
      } else if (a + b > 0.0) {
        continue;
      }
      kept.push_back(mark);
    }
    complex_.edges = std::move(kept);
  }

  int label_along(int a, int b) const {
    for (const int f : star_[a]) {
      const Triangle& t = complex_.mesh.facets[f];
      if (std::find(t.begin(), t.end(), b) != t.end()) {
        return complex_.mesh.facet_label[f];
      }
    }
    return -1;
  }

  void cut_facets() {
    SurfaceMesh& mesh = complex_.mesh;
    const std::vector<Triangle> facets = std::move(mesh.facets);
    const std::vector<int> labels = std::move(mesh.facet_label);
    mesh.facets.clear();
    mesh.facet_label.clear();
    for (std::size_t f = 0; f < facets.size(); ++f) {
      std::vector<int> part;  // what is left, around
      // What lies in the plane is a solid's own face, which stays.
      bool behind =
          lies_in_plane(facets[f]) && !complex_.surfaces[labels[f]].liquid;
      for (int k = 0; k < 3; ++k) {
        const int a = facets[f][k];
        const int b = facets[f][(k + 1) % 3];
        behind = behind || off_[a] < 0.0;
        if (off_[a] <= 0.0) {
          part.push_back(a);
        }
        if (off_[a] * off_[b] < 0.0) {
          part.push_back(crossing(a, b, labels[f], -1));
        }
      }
      if (behind) {
        add_part(part, labels[f]);
      }
    }
  }

  bool lies_in_plane(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(),
                       [&](int v) { return off_[v] == 0.0; });
  }

  /// Of a curve in the plane, which holds what ends there.
  bool is_on_curve(int a, int b) const {
    const films::ComplexVertex& from = complex_.vertices[a];
    const films::ComplexVertex& to = complex_.vertices[b];
    return from.kind == films::VertexKind::OnCurve &&
           to.kind == films::VertexKind::OnCurve && from.curve == to.curve;
  }

  void add_part(const std::vector<int>& part, int label) {
    SurfaceMesh& mesh = complex_.mesh;
    const auto add = [&](int a, int b, int c) {
      mesh.facets.push_back({a, b, c});
      mesh.facet_label.push_back(label);
    };
    if (part.size() == 3) {
      add(part[0], part[1], part[2]);
      return;
    }
    const auto length = [&](int i, int j) {
      return (mesh.points[part[i]] - mesh.points[part[j]]).norm();
    };
    if (length(0, 2) <= length(1, 3)) {
      add(part[0], part[1], part[2]);
      add(part[0], part[2], part[3]);
    } else {
      add(part[1], part[2], part[3]);
      add(part[1], part[3], part[0]);
    }
  }

  void bind_vertices() {
    for (std::size_t v = 0; v < off_.size(); ++v) {
      films::ComplexVertex& vertex = complex_.vertices[v];
      if (off_[v] == 0.0 && vertex.kind == films::VertexKind::Free) {
        vertex.constraints =
            joined_set(complex_, vertex.constraints, plane_.set);
      }
    }
  }

  void mark_edges() {
    std::map<Edge, films::ComplexEdge> marked;
    for (const films::ComplexEdge& mark : complex_.edges) {
      marked[edge_key(mark.a, mark.b)] = mark;
    }
    const SurfaceMesh& mesh = complex_.mesh;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (lies_in_plane(mesh.facets[f])) {
        continue;
      }
      const films::ComplexSurface& surface =
          complex_.surfaces[mesh.facet_label[f]];
      for (int k = 0; k < 3; ++k) {
        const int a = mesh.facets[f][k];
        const int b = mesh.facets[f][(k + 1) % 3];
        if (off_[a] != 0.0 || off_[b] != 0.0 || is_on_curve(a, b)) {
          continue;
        }
        const auto [known, is_new] = marked.try_emplace(edge_key(a, b));
        films::ComplexEdge& mark = known->second;
        if (is_new) {
          mark = mark_of(a, b, surface);
          complex_.edges.push_back(mark);
        } else if (mark.constraints != plane_.set &&
                   mark.kind != films::VertexKind::OnCurve) {
          refuse_along(surface.name, mesh.points[a]);
        }
      }
    }
  }

  films::ComplexEdge mark_of(int a, int b,
                             const films::ComplexSurface& surface) const {
    films::ComplexEdge mark;
    mark.a = a;
    mark.b = b;
    mark.constraints = plane_.set;
    if (surface.band >= 0) {
      mark.kind = films::VertexKind::OnBand;
      mark.curve = surface.band;
    }
    return mark;
  }

  [[noreturn]] static void refuse_along(const std::string& name,
                                        const Vec3& p) {
    throw InvalidInput(fmt::format(
        "'{}' runs along the line where two planes of symmetry meet at "
        "({:.6g}, {:.6g}, {:.6g}); draw the whole",
        name, p.x(), p.y(), p.z()));
  }

  const FacePlane& plane_;
  films::FilmComplex& complex_;
  std::vector<double> off_;             // per point, above 0 beyond the plane
  std::vector<std::vector<int>> star_;  // per old point: its facets
  std::vector<std::vector<BandLine>> lines_;  // per band
  std::map<Edge, int> made_;
};

}  // namespace

void cut_films(const FacePlane& plane, films::FilmComplex& complex) {
  FilmCut(plane, complex).run();
}

}  // namespace meniscus::start
