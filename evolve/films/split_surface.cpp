#include "evolve/films/split_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/nearest_name.h"

namespace meniscus::films {

namespace {

int checked_surface(const FilmComplex& complex, const std::string& surface,
                    const Region& region) {
  std::vector<std::string> names;
  int found = -1;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    names.push_back(complex.surfaces[s].name);
    if (names.back() == surface) {
      found = static_cast<int>(s);
    }
    if (names.back() == region.name) {
      throw InvalidInput(fmt::format(
          "region '{}': a surface has that name already", region.name));
    }
  }
  if (found < 0) {
    const std::string near = nearest_name(surface, names);
    throw InvalidInput(fmt::format(
        "region '{}': surface '{}' does not exist{}", region.name, surface,
        near.empty() ? std::string() : fmt::format("; nearest: '{}'", near)));
  }
  if (!complex.surfaces[found].liquid) {
    throw InvalidInput(fmt::format("region '{}': surface '{}' is solid already",
                                   region.name, surface));
  }
  if (region.liquid && !region.tension_field &&
      !(std::isfinite(region.tension) && region.tension > 0.0)) {
    throw InvalidInput(
        fmt::format("region '{}': its tension {} must be above "
                    "0; make it solid to hold it",
                    region.name, region.tension));
  }
  return found;
}

bool holds_at(const FilmComplex& complex, int facet, const Expression& where,
              const Region& region) {
  const Triangle& t = complex.mesh.facets[facet];
  const Points& p = complex.mesh.points;
  const Vec3 at = (p[t[0]] + p[t[1]] + p[t[2]]) / 3.0;
  try {
    return where.evaluate(std::span<const double>(at.data(), 3)) > 0.0;
  } catch (const ExpressionError& error) {
    throw InvalidInput(fmt::format("region '{}': '{}' at ({}, {}, {}): {}",
                                   region.name, where.text(), at.x(), at.y(),
                                   at.z(), error.what()));
  }
}

void fix_vertices(FilmComplex& complex, int label) {
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.mesh.facet_label[f] != label) {
      continue;
    }
    for (const int v : complex.mesh.facets[f]) {
      ComplexVertex& vertex = complex.vertices[v];
      if (vertex.kind == VertexKind::Free ||
          vertex.kind == VertexKind::Slides) {
        vertex = ComplexVertex{};
        vertex.kind = VertexKind::Fixed;
      }
    }
  }
}

/// Edges with facets of both labels.
std::set<Edge> border_edges(const SurfaceMesh& mesh, int old_label, int label) {
  std::map<Edge, int> sides;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int side = mesh.facet_label[f] == label       ? 1
                     : mesh.facet_label[f] == old_label ? 2
                                                        : 0;
    for (int k = 0; k < 3 && side != 0; ++k) {
      const int a = mesh.facets[f][k];
      const int b = mesh.facets[f][(k + 1) % 3];
      sides[edge_key(a, b)] |= side;
    }
  }
  std::set<Edge> result;
  for (const auto& [edge, side] : sides) {
    if (side == 3) {
      result.insert(edge);
    }
  }
  return result;
}

void mark_border(FilmComplex& complex, std::set<Edge> border, bool solid) {
  for (ComplexEdge& edge : complex.edges) {
    if (border.erase(edge_key(edge.a, edge.b)) > 0 && solid &&
        edge.kind != VertexKind::OnCurve) {
      edge.kind = VertexKind::Fixed;
      edge.curve = -1;
      edge.constraints = -1;
    }
  }
  for (const Edge& ends : border) {
    ComplexEdge edge;
    edge.a = ends[0];
    edge.b = ends[1];
    edge.kind = solid ? VertexKind::Fixed : VertexKind::Free;
    complex.edges.push_back(edge);
  }
}

}  // namespace

int split_surface(FilmComplex& complex, const std::string& surface,
                  const Expression& where, const Region& region) {
  const int old_label = checked_surface(complex, surface, region);
  const auto label = static_cast<int>(complex.surfaces.size());
  // The region is the facets where the expression is above 0. It must leave
  // some of both, or there is no border.
  std::vector<int> chosen;
  int others = 0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.mesh.facet_label[f] == old_label) {
      if (holds_at(complex, static_cast<int>(f), where, region)) {
        chosen.push_back(static_cast<int>(f));
      } else {
        ++others;
      }
    }
  }
  if (chosen.empty() || others == 0) {
    throw InvalidInput(fmt::format(
        "region '{}': '{}' > 0 holds at {} of the {} facets of '{}'; refine "
        "the film or change the region",
        region.name, where.text(), chosen.size(), chosen.size() + others,
        surface));
  }
  for (const int f : chosen) {
    complex.mesh.facet_label[f] = label;
  }
  complex.mesh.labels.push_back(region.name);
  // The new surface inherits the rest, its tension apart: bodies see it on the
  // same side, quantities count it too.
  ComplexSurface made = complex.surfaces[old_label];
  made.name = region.name;
  made.liquid = region.liquid;
  made.tension = region.liquid ? region.tension : 0.0;
  made.tension_field = region.liquid ? region.tension_field : std::nullopt;
  complex.surfaces.push_back(made);
  for (ComplexBody& body : complex.bodies) {
    const std::vector<BodySide> before = body.sides;
    for (const BodySide& side : before) {
      if (side.surface == old_label) {
        body.sides.push_back({label, side.sign});
      }
    }
  }
  for (FilmQuantity& quantity : complex.quantities) {
    auto& on = quantity.surfaces;
    if (std::find(on.begin(), on.end(), old_label) != on.end()) {
      on.push_back(label);
    }
  }
  // A solid region does not move, and the border becomes a line of its own.
  if (!region.liquid) {
    fix_vertices(complex, label);
  }
  mark_border(complex, border_edges(complex.mesh, old_label, label),
              !region.liquid);
  return label;
}

}  // namespace meniscus::films
