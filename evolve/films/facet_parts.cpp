#include "evolve/films/facet_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::films {

namespace {

constexpr double kWeld = 1e-9;  // points alike [size of all]

/// Points by cells, to find one within `near`.
class Welder {
 public:
  Welder(Points& points, double near) : points_(points), near_(near) {}

  int id_of(const Vec3& p) {
    for (int k = 0; k < 8; ++k) {
      const Vec3 off((k & 1) - 0.5, ((k >> 1) & 1) - 0.5, ((k >> 2) & 1) - 0.5);
      const auto found = cells_.find(cell_of(p + 2.0 * near_ * off));
      if (found != cells_.end() &&
          (points_[found->second] - p).norm() <= near_) {
        return found->second;
      }
    }
    points_.push_back(p);
    const int id = static_cast<int>(points_.size()) - 1;
    cells_.emplace(cell_of(p), id);
    return id;
  }

 private:
  std::array<long, 3> cell_of(const Vec3& p) const {
    const double width = 8.0 * near_;
    return {std::lround(p.x() / width), std::lround(p.y() / width),
            std::lround(p.z() / width)};
  }

  Points& points_;
  double near_;
  std::map<std::array<long, 3>, int> cells_;
};

int curve_named(const FilmSystem& system, const std::string& curve,
                const std::string& user) {
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    if (system.curves[c].name == curve) {
      return static_cast<int>(c);
    }
  }
  throw InvalidInput(fmt::format(
      "{} names the curve '{}', which does not exist", user, curve));
}

/// The facet with its corners' numbers among all points.
Triangle welded(const FacetPart& part, const StartFacets& start,
                const Triangle& t, const std::vector<int>& id) {
  const Points& points = start.points;
  for (const int v : t) {
    if (v < 0 || v >= std::ssize(points)) {
      throw InvalidInput(fmt::format(
          "{}: a facet has the corner {}, and there are {} vertices, numbered "
          "from 0",
          part.what, v, points.size()));
    }
  }
  const Triangle result{id[t[0]], id[t[1]], id[t[2]]};
  const Vec3 u = points[t[1]] - points[t[0]];
  const Vec3 v = points[t[2]] - points[t[0]];
  if (result[0] == result[1] || result[1] == result[2] ||
      result[2] == result[0] ||
      !(u.cross(v).norm() > kWeld * (u.squaredNorm() + v.squaredNorm()))) {
    throw InvalidInput(
        fmt::format("{}: the facet [{}, {}, {}] at {} has no area", part.what,
                    t[0], t[1], t[2], text_of_place(points[t[0]])));
  }
  return result;
}

template <class Spec>
void add_part(const FilmSystem& system, const Spec& spec, const char* what,
              const std::vector<std::string>& curves, Welder& welder,
              FacetParts& result) {
  if (!spec.start) {
    return;
  }
  FacetPart part{.what = fmt::format("{} '{}'", what, spec.name),
                 .name = spec.name,
                 .curves = {},
                 .within = spec.within,
                 .facets = {}};
  for (const std::string& curve : curves) {
    part.curves.push_back(curve_named(system, curve, part.what));
  }
  std::vector<int> id;
  for (const Vec3& p : spec.start->points) {
    id.push_back(welder.id_of(p));
  }
  for (const Triangle& t : spec.start->facets) {
    part.facets.push_back(welded(part, *spec.start, t, id));
  }
  if (part.facets.empty()) {
    throw InvalidInput(part.what + " has no facets");
  }
  result.parts.push_back(std::move(part));
}

struct PartUse {
  int part;
  int facet;  // of the part
  int side;
};

/// The rims among the uses of one edge.
void add_rims(const std::vector<PartUse>& uses, FacetParts& result) {
  for (const PartUse& use : uses) {
    const FacetPart& part = result.parts[use.part];
    const auto own =
        std::count_if(uses.begin(), uses.end(),
                      [&](const PartUse& u) { return u.part == use.part; });
    const Triangle& t = part.facets[use.facet];
    const FacetRim rim{use.part, use.facet, t[use.side], t[(use.side + 1) % 3],
                       uses.size() > 1};
    if (own > 2) {
      throw InvalidInput(fmt::format(
          "{}: {} of its facets meet at the edge at {}; of one film two may, "
          "make several films of it",
          part.what, own, text_of_place(result.middle(rim))));
    }
    if (own == 1) {
      result.rims.push_back(rim);
    }
  }
}

}  // namespace

std::string text_of_place(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

FacetParts facet_parts(const FilmSystem& system) {
  Points all;
  for (const FilmSpec& film : system.films) {
    if (film.start) {
      all.insert(all.end(), film.start->points.begin(),
                 film.start->points.end());
    }
  }
  for (const CapSpec& cap : system.caps) {
    if (cap.start) {
      all.insert(all.end(), cap.start->points.begin(), cap.start->points.end());
    }
  }
  // Points nearer than a share of the system's size become one, so that parts
  // join where they touch.
  FacetParts result;
  Welder welder(result.points, kWeld * bounding_diagonal(all));
  for (const FilmSpec& film : system.films) {
    add_part(system, film, "film", film.curves, welder, result);
  }
  for (const CapSpec& cap : system.caps) {
    add_part(system, cap, "solid", cap.rims, welder, result);
  }
  // All parts as one set of facets, each with its owner, to list what uses each
  // edge.
  std::vector<Triangle> facets;
  std::vector<PartUse> owner;
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    for (std::size_t f = 0; f < result.parts[p].facets.size(); ++f) {
      facets.push_back(result.parts[p].facets[f]);
      owner.push_back({static_cast<int>(p), static_cast<int>(f), 0});
    }
  }
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(facets, edges, facet_edges);
  std::vector<std::vector<PartUse>> uses(edges.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      uses[facet_edges[f][k]].push_back({owner[f].part, owner[f].facet, k});
    }
  }
  // An edge that a part uses once is its rim, shared where other parts have it
  // too.
  for (const std::vector<PartUse>& at : uses) {
    add_rims(at, result);
  }
  return result;
}

}  // namespace meniscus::films
