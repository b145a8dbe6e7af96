#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/edge_key.h"
#include "tests/support/evolver.h"

namespace meniscus {

namespace {

bool is_boundary(const films::FilmComplex& complex, int curve) {
  return curve >= 0 &&
         std::holds_alternative<curves::Circle>(complex.curves[curve].shape);
}

// Circles about the z direction, as the starts have them; t = 0 is at +x.
std::string boundaries(const films::FilmComplex& complex) {
  std::string text;
  for (std::size_t c = 0; c < complex.curves.size(); ++c) {
    if (!is_boundary(complex, static_cast<int>(c))) {
      continue;
    }
    const curves::Circle& circle =
        std::get<curves::Circle>(complex.curves[c].shape);
    if (circle.normal.cross(Vec3::UnitZ()).norm() != 0.0) {
      throw std::runtime_error("evolver datafile: a circle is not level");
    }
    text += fmt::format(
        "boundary {} parameters 1\nx1: {:.17g} + {:.17g}*cos(p1)\n"
        "x2: {:.17g} + {:.17g}*sin(p1)\nx3: {:.17g}\n\n",
        c + 1, circle.center.x(), circle.radius, circle.center.y(),
        circle.radius, circle.center.z());
  }
  return text;
}

// One numbered constraint per constraint set; its energy integral is that of
// the edges that carry the set.
std::string constraints(const films::FilmComplex& complex) {
  std::string text;
  for (std::size_t s = 0; s < complex.constraint_sets.size(); ++s) {
    if (complex.constraint_sets[s].size() != 1) {
      throw std::runtime_error("evolver datafile: one level set per vertex");
    }
    const films::LevelSet& set =
        complex.level_sets[complex.constraint_sets[s][0]];
    text += fmt::format("constraint {}\nformula: {} = 0\n", s + 1,
                        set.formula.text());
    for (const films::ComplexEdge& edge : complex.edges) {
      if (edge.constraints == static_cast<int>(s) && edge.integrals >= 0) {
        const films::VectorField& field =
            complex.integrals[complex.integral_sets[edge.integrals].at(0)]
                .field;
        text += fmt::format("energy:\ne1: {}\ne2: {}\ne3: {}\n",
                            field[0].text(), field[1].text(), field[2].text());
        break;
      }
    }
    text += "\n";
  }
  return text;
}

struct Numbering {
  std::vector<Edge> edges;            // of the films
  std::vector<Triangle> facet_edges;  // per film facet
  std::vector<int> films;             // facets of films
  std::vector<int> vertex;            // from 1; 0: not in a film
};

Numbering number(const films::FilmComplex& complex) {
  Numbering numbers;
  std::vector<Triangle> facets;
  numbers.vertex.assign(complex.vertices.size(), 0);
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.surfaces[complex.mesh.facet_label[f]].liquid) {
      numbers.films.push_back(static_cast<int>(f));
      facets.push_back(complex.mesh.facets[f]);
    }
  }
  list_edges(facets, numbers.edges, numbers.facet_edges);
  std::set<Edge> marked;  // integrals run as these do
  for (const films::ComplexEdge& edge : complex.edges) {
    marked.insert({edge.a, edge.b});
  }
  for (Edge& edge : numbers.edges) {
    if (marked.contains({edge[1], edge[0]})) {
      std::swap(edge[0], edge[1]);
    }
  }
  for (const Triangle& facet : facets) {
    for (const int v : facet) {
      numbers.vertex[v] = 1;
    }
  }
  int next = 0;
  for (int& v : numbers.vertex) {
    v = v == 0 ? 0 : ++next;
  }
  return numbers;
}

std::string vertices(const films::FilmComplex& complex,
                     const Numbering& numbers) {
  std::string text = "vertices\n";
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (numbers.vertex[v] == 0) {
      continue;
    }
    const films::ComplexVertex& vertex = complex.vertices[v];
    const Vec3& p = complex.mesh.points[v];
    text += fmt::format("{} ", numbers.vertex[v]);
    if (is_boundary(complex, vertex.curve)) {
      text += fmt::format("{:.17g} boundary {} fixed\n",
                          2.0 * std::numbers::pi * vertex.t, vertex.curve + 1);
      continue;
    }
    text += fmt::format("{:.17g} {:.17g} {:.17g}", p.x(), p.y(), p.z());
    if (vertex.kind != films::VertexKind::Free) {
      text += " fixed";
    }
    if (vertex.constraints >= 0) {
      text += fmt::format(" constraint {}", vertex.constraints + 1);
    }
    text += "\n";
  }
  return text;
}

std::string edges(const films::FilmComplex& complex, const Numbering& numbers) {
  std::map<Edge, const films::ComplexEdge*> marked;
  for (const films::ComplexEdge& edge : complex.edges) {
    marked[edge_key(edge.a, edge.b)] = &edge;
  }
  std::string text = "\nedges\n";
  for (std::size_t e = 0; e < numbers.edges.size(); ++e) {
    auto [a, b] = numbers.edges[e];
    const auto found = marked.find(edge_key(a, b));
    text +=
        fmt::format("{} {} {}", e + 1, numbers.vertex[a], numbers.vertex[b]);
    if (found != marked.end()) {
      const films::ComplexEdge& edge = *found->second;
      if (is_boundary(complex, edge.curve)) {
        text += fmt::format(" boundary {} fixed", edge.curve + 1);
      } else if (edge.kind != films::VertexKind::Free) {
        text += " fixed";
      }
      if (edge.constraints >= 0) {
        text += fmt::format(" constraint {}", edge.constraints + 1);
      }
    }
    text += "\n";
  }
  return text;
}

std::string faces(const films::FilmComplex& complex, const Numbering& numbers) {
  std::string text = "\nfaces\n";
  for (std::size_t i = 0; i < numbers.films.size(); ++i) {
    const int f = numbers.films[i];
    const Triangle& facet = complex.mesh.facets[f];
    text += fmt::format("{}", i + 1);
    for (int k = 0; k < 3; ++k) {
      const int e = numbers.facet_edges[i][k];
      const bool along = numbers.edges[e][0] == facet[k];
      text += fmt::format(" {}", along ? e + 1 : -(e + 1));
    }
    const double tension =
        complex.surfaces[complex.mesh.facet_label[f]].tension;
    text += fmt::format(" tension {:.17g}\n", tension);
  }
  return text;
}

std::string bodies(const films::FilmComplex& complex,
                   const Numbering& numbers) {
  std::string text = complex.bodies.empty() ? "" : "\nbodies\n";
  for (std::size_t b = 0; b < complex.bodies.size(); ++b) {
    const films::ComplexBody& body = complex.bodies[b];
    text += fmt::format("{}", b + 1);
    for (std::size_t i = 0; i < numbers.films.size(); ++i) {
      for (const films::BodySide& side : body.sides) {
        if (side.surface == complex.mesh.facet_label[numbers.films[i]]) {
          text += fmt::format(" {}{}", side.sign < 0 ? "-" : "", i + 1);
        }
      }
      if (i % 16 == 15) {
        text += " \\\n";
      }
    }
    if (body.volume) {
      text += fmt::format(" volume {:.17g}", *body.volume);
    }
    if (body.pressure) {
      text += fmt::format(" pressure {:.17g}", *body.pressure);
    }
    text += fmt::format(" volconst {:.17g}\n",
                        evolver_cap_volume(complex, body, 0));
  }
  return text;
}

}  // namespace

double evolver_cap_volume(const films::FilmComplex& complex,
                          const films::ComplexBody& body, int refinements) {
  double volume = 0.0;
  for (const films::BodySide& side : body.sides) {
    if (complex.surfaces[side.surface].liquid) {
      continue;
    }
    int curve = -1;
    int pieces = 0;
    double column = 0.0;  // under the cap as it is
    for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
      if (complex.mesh.facet_label[f] != side.surface) {
        continue;
      }
      const Triangle& facet = complex.mesh.facets[f];
      const Points& p = complex.mesh.points;
      if (p[facet[0]].z() != p[facet[1]].z() ||
          p[facet[0]].z() != p[facet[2]].z()) {
        throw std::runtime_error("evolver datafile: a cap is not level");
      }
      column += side.sign * 0.5 * p[facet[0]].z() *
                area_vector2(complex.mesh, static_cast<int>(f)).z();
      for (const int v : facet) {
        curve = std::max(curve, complex.vertices[v].curve);
      }
      ++pieces;
    }
    // A fan has as many facets as its rim has edges; refined, the polygon in
    // a circle grows.
    const auto share = [](double n) {
      return n * std::sin(2.0 * std::numbers::pi / n);
    };
    const double finer = std::ldexp(pieces, refinements);
    volume += is_boundary(complex, curve)
                  ? column * share(finer) / share(pieces)
                  : column;
  }
  return volume;
}

std::string evolver_datafile(const films::FilmComplex& complex) {
  const Numbering numbers = number(complex);
  return "gravity_constant 0\n\n" + boundaries(complex) + constraints(complex) +
         vertices(complex, numbers) + edges(complex, numbers) +
         faces(complex, numbers) + bodies(complex, numbers) + "\nread\n";
}

}  // namespace meniscus
