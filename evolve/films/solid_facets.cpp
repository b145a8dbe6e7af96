#include "evolve/films/solid_facets.h"

#include <algorithm>
#include <utility>

namespace meniscus::films {

std::vector<int> regions_of(const std::vector<BodySpec>& bodies) {
  std::vector<int> regions;
  regions.reserve(bodies.size());
  int count = 0;
  for (const BodySpec& body : bodies) {
    regions.push_back(body.is_void ? -1 : count++);
  }
  return regions;
}

void keep_solids(const FilmComplex& complex, const std::vector<int>& regions,
                 SurfaceMesh& mesh) {
  std::vector<FacetBodies> of_surface(complex.surfaces.size(), {-1, -1});
  for (std::size_t b = 0; b < complex.bodies.size(); ++b) {
    for (const BodySide& side : complex.bodies[b].sides) {
      FacetBodies& bodies = of_surface[side.surface];
      (side.sign > 0 ? bodies.behind : bodies.front) = regions[b];
    }
  }
  // One body has all surfaces, but for films beside it.
  const auto is_bare = [](const FacetBodies& bodies) {
    return bodies.behind < 0 && bodies.front < 0;
  };
  if (complex.bodies.empty() ||
      (complex.bodies.size() == 1 &&
       (regions.front() < 0 ||
        std::none_of(of_surface.begin(), of_surface.end(), is_bare)))) {
    return;
  }
  SurfaceMesh kept{.points = std::move(mesh.points),
                   .labels = std::move(mesh.labels)};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Triangle facet = mesh.facets[f];
    FacetBodies bodies = of_surface[mesh.facet_label[f]];
    if (bodies.behind < 0) {
      std::swap(bodies.behind, bodies.front);
      std::swap(facet[1], facet[2]);
    }
    if (bodies.behind >= 0) {
      kept.facets.push_back(facet);
      kept.facet_label.push_back(mesh.facet_label[f]);
      kept.facet_bodies.push_back(bodies);
    }
  }
  mesh = std::move(kept);
}

void drop_interfaces(SurfaceMesh& mesh) {
  if (mesh.facet_bodies.empty()) {
    return;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_bodies[f].front < 0) {
      mesh.facets[kept] = mesh.facets[f];
      mesh.facet_label[kept] = mesh.facet_label[f];
      ++kept;
    }
  }
  mesh.facets.resize(kept);
  mesh.facet_label.resize(kept);
  mesh.facet_bodies.clear();
}

void drop_unused(SurfaceMesh& mesh, std::vector<int>& corner) {
  std::vector<int> number(corner.size(), -1);
  for (const Triangle& facet : mesh.facets) {
    for (const int c : facet) {
      number[c] = 0;
    }
  }
  int count = 0;
  for (std::size_t c = 0; c < corner.size(); ++c) {
    if (number[c] == 0) {
      corner[count] = corner[c];
      number[c] = count++;
    }
  }
  corner.resize(count);
  for (Triangle& facet : mesh.facets) {
    for (int& c : facet) {
      c = number[c];
    }
  }
}

}  // namespace meniscus::films
