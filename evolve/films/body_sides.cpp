#include "evolve/films/body_sides.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::films {

namespace {

// A use of an edge by a surface; forward: in the edge's own direction.
struct SurfaceUse {
  int surface;
  bool forward;
};

std::vector<std::vector<SurfaceUse>> uses_of(
    const SurfaceMesh& mesh, const std::vector<Edge>& edges,
    const std::vector<Triangle>& facet_edges,
    const std::vector<char>& enclosing) {
  std::vector<std::vector<SurfaceUse>> uses(edges.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int surface = mesh.facet_label[f];
    if (enclosing[surface] == 0) {
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const int e = facet_edges[f][k];
      uses[e].push_back({surface, mesh.facets[f][k] == edges[e][0]});
    }
  }
  return uses;
}

[[noreturn]] void refuse_open(
    const FilmComplex& complex, const ComplexBody& body,
    const std::vector<Edge>& edges,
    const std::vector<std::vector<SurfaceUse>>& uses) {
  std::set<int> surfaces;
  int open = 0;
  int crowded = 0;
  Vec3 place = Vec3::Zero();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (uses[e].empty() || uses[e].size() == 2) {
      continue;
    }
    if (open + crowded == 0) {
      place = 0.5 * (complex.mesh.points[edges[e][0]] +
                     complex.mesh.points[edges[e][1]]);
    }
    ++(uses[e].size() == 1 ? open : crowded);
    for (const SurfaceUse& use : uses[e]) {
      surfaces.insert(use.surface);
    }
  }
  std::string names;
  for (const int s : surfaces) {
    names += (names.empty() ? "'" : ", '") + complex.surfaces[s].name + "'";
  }
  throw InvalidInput(fmt::format(
      "body '{}' is not closed by its surfaces: {} edges of {} have one facet "
      "and {} have more than two, the first at ({:.6g}, {:.6g}, {:.6g}); list "
      "in enclosed_by every film and cap around the body and no other",
      body.name, open, names, crowded, place.x(), place.y(), place.z()));
}

// Signs of the surfaces (0: not enclosing) that make neighbours agree, and
// the connected part of the boundary each belongs to.
struct Sides {
  std::vector<int> sign;
  std::vector<int> part;
  int parts = 0;
};

Sides agree(const FilmComplex& complex, const ComplexBody& body,
            const std::vector<Edge>& edges,
            const std::vector<std::vector<SurfaceUse>>& uses) {
  struct Link {
    int to;
    int factor;
  };
  // Surfaces as a graph with an edge of sign +1 or -1: facets that run opposite
  // ways along a common edge are on the same side.
  std::vector<std::vector<Link>> links(complex.surfaces.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (uses[e].empty()) {
      continue;
    }
    if (uses[e].size() != 2) {
      refuse_open(complex, body, edges, uses);
    }
    const SurfaceUse& a = uses[e][0];
    const SurfaceUse& b = uses[e][1];
    const int factor = a.forward == b.forward ? -1 : 1;
    links[a.surface].push_back({b.surface, factor});
    links[b.surface].push_back({a.surface, factor});
  }
  // Signs spread depth first over each connected part. A loop of links whose
  // signs multiply to -1 has one side only and encloses nothing.
  Sides sides;
  sides.sign.assign(complex.surfaces.size(), 0);
  sides.part.assign(complex.surfaces.size(), -1);
  for (const BodySide& side : body.sides) {
    if (sides.sign[side.surface] != 0) {
      continue;
    }
    std::vector<int> stack = {side.surface};
    sides.sign[side.surface] = 1;
    sides.part[side.surface] = sides.parts;
    while (!stack.empty()) {
      const int s = stack.back();
      stack.pop_back();
      for (const Link& link : links[s]) {
        const int wanted = sides.sign[s] * link.factor;
        if (sides.sign[link.to] == 0) {
          sides.sign[link.to] = wanted;
          sides.part[link.to] = sides.parts;
          stack.push_back(link.to);
        } else if (sides.sign[link.to] != wanted) {
          throw InvalidInput(fmt::format(
              "body '{}' has no inside: its surface '{}' closes on itself with "
              "one side (as a Moebius band does)",
              body.name, complex.surfaces[link.to].name));
        }
      }
    }
    ++sides.parts;
  }
  return sides;
}

// Signed volume of one connected part of a body's boundary.
double part_volume(const FilmComplex& complex, const Sides& sides, int part) {
  const SurfaceMesh& mesh = complex.mesh;
  const Vec3 origin = mesh.points.front();
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int surface = mesh.facet_label[f];
    if (sides.part[surface] == part) {
      const Triangle& t = mesh.facets[f];
      const Vec3 a = mesh.points[t[0]] - origin;
      const Vec3 b = mesh.points[t[1]] - origin;
      const Vec3 c = mesh.points[t[2]] - origin;
      sum += sides.sign[surface] * a.dot(b.cross(c)) / 6.0;
    }
  }
  return sum;
}

// Is `point` inside the closed surface of a part? By its solid angle.
bool inside_part(const FilmComplex& complex, const Sides& sides, int part,
                 const Vec3& point) {
  const SurfaceMesh& mesh = complex.mesh;
  double angle = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int surface = mesh.facet_label[f];
    if (sides.part[surface] != part) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    const Vec3 a = mesh.points[t[0]] - point;
    const Vec3 b = mesh.points[t[1]] - point;
    const Vec3 c = mesh.points[t[2]] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2.0 * sides.sign[surface] *
             std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc +
                                               b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 6.0;  // 4 pi inside, 0 outside
}

// Makes the outermost parts run outward and the hollows inward.
void turn_parts(const FilmComplex& complex, const ComplexBody& body,
                Sides& sides) {
  const double size = bounding_diagonal(complex.mesh.points);
  std::vector<int> factor(sides.parts, 1);
  for (int part = 0; part < sides.parts; ++part) {
    const double volume = part_volume(complex, sides, part);
    const auto first = std::find_if(
        complex.mesh.facet_label.begin(), complex.mesh.facet_label.end(),
        [&](int s) { return sides.part[s] == part; });
    if (first == complex.mesh.facet_label.end() ||
        !(std::abs(volume) > 1e-12 * size * size * size)) {
      throw InvalidInput(fmt::format(
          "body '{}' encloses no volume: its surfaces lie on each other, or "
          "are closer than an edge is long; move them apart, or shorten "
          "resolution.fea",
          body.name));
    }
    const Triangle& t =
        complex.mesh.facets[first - complex.mesh.facet_label.begin()];
    int around = 0;
    for (int other = 0; other < sides.parts; ++other) {
      if (other != part &&
          inside_part(complex, sides, other, complex.mesh.points[t[0]])) {
        ++around;
      }
    }
    factor[part] = (volume > 0.0) == (around % 2 == 0) ? 1 : -1;
  }
  for (std::size_t s = 0; s < sides.sign.size(); ++s) {
    if (sides.part[s] >= 0) {
      sides.sign[s] *= factor[sides.part[s]];
    }
  }
}

}  // namespace

ComplexBody make_body(const BodySpec& body, const SurfaceMesh& mesh) {
  ComplexBody made{body.name, {}, body.volume, body.pressure};
  if (body.volume && body.pressure) {
    throw InvalidInput(fmt::format(
        "body '{}' has both volume and pressure; give one of them", body.name));
  }
  if (body.volume && !(std::isfinite(*body.volume) && *body.volume > 0.0)) {
    throw InvalidInput(fmt::format("body '{}': volume is {}, must be above 0",
                                   body.name, *body.volume));
  }
  if (body.enclosed_by.empty()) {
    throw InvalidInput(
        fmt::format("body '{}' is enclosed by nothing; list its films and caps",
                    body.name));
  }
  for (const std::string& name : body.enclosed_by) {
    const int surface = mesh.label_of(name);
    if (surface < 0) {
      throw InvalidInput(fmt::format(
          "body '{}' is enclosed by '{}', which is neither a film nor a cap",
          body.name, name));
    }
    const bool twice =
        std::any_of(made.sides.begin(), made.sides.end(),
                    [&](const BodySide& s) { return s.surface == surface; });
    if (twice) {
      throw InvalidInput(
          fmt::format("body '{}' lists '{}' twice", body.name, name));
    }
    made.sides.push_back({surface, 1});
  }
  return made;
}

void require_body(const FilmSystem& system, const std::string& cap) {
  for (const BodySpec& body : system.bodies) {
    if (std::find(body.enclosed_by.begin(), body.enclosed_by.end(), cap) !=
        body.enclosed_by.end()) {
      return;
    }
  }
  throw InvalidInput(fmt::format(
      "cap '{}' encloses nothing; add it to a body's enclosed_by or remove it",
      cap));
}

void orient_bodies(FilmComplex& complex) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, edges, facet_edges);
  std::vector<int> turn(complex.surfaces.size(), 0);
  std::vector<Sides> found;
  for (const ComplexBody& body : complex.bodies) {
    std::vector<char> enclosing(complex.surfaces.size(), 0);
    for (const BodySide& side : body.sides) {
      enclosing[side.surface] = 1;
    }
    const auto uses = uses_of(complex.mesh, edges, facet_edges, enclosing);
    Sides sides = agree(complex, body, edges, uses);
    turn_parts(complex, body, sides);
    for (std::size_t s = 0; s < turn.size(); ++s) {
      turn[s] = turn[s] == 0 ? sides.sign[s] : turn[s];
    }
    found.push_back(std::move(sides));
  }
  for (std::size_t b = 0; b < found.size(); ++b) {
    for (BodySide& side : complex.bodies[b].sides) {
      side.sign = found[b].sign[side.surface] * turn[side.surface];
    }
  }
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (turn[complex.mesh.facet_label[f]] < 0) {
      std::swap(complex.mesh.facets[f][1], complex.mesh.facets[f][2]);
    }
  }
}

SurfaceMesh body_surface(const FilmComplex& complex, const ComplexBody& body) {
  std::vector<int> sign(complex.surfaces.size(), 0);
  for (const BodySide& side : body.sides) {
    sign[side.surface] = side.sign;
  }
  SurfaceMesh result;
  result.points = complex.mesh.points;
  result.labels = complex.mesh.labels;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    Triangle t = complex.mesh.facets[f];
    const int side = sign[complex.mesh.facet_label[f]];
    if (side == 0) {
      continue;
    }
    if (side < 0) {
      std::swap(t[1], t[2]);
    }
    result.facets.push_back(t);
    result.facet_label.push_back(complex.mesh.facet_label[f]);
  }
  return result;
}

}  // namespace meniscus::films
