/// Internal to the start from facets: films by facets, their points as one.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"
#include "evolve/films/film_system.h"

namespace meniscus::films {

struct FacetPart {
  std::string what;  // "film 'skin'", for messages
  std::string name;
  std::vector<int> curves;       // that it names
  double within = 0.0;           // rims may be so far off them [length]
  std::vector<Triangle> facets;  // of FacetParts::points
};

/// An edge with one facet of its part, in that facet's direction.
struct FacetRim {
  int part = 0;
  int facet = 0;
  int a = 0;
  int b = 0;
  bool shared = false;  // other parts have facets there too
  int curve = -1;       // that it is found to lie on
};

struct FacetParts {
  Points points;  // those at one place are one
  std::vector<FacetPart> parts;
  std::vector<FacetRim> rims;

  Vec3 middle(const FacetRim& rim) const {
    return 0.5 * (points[rim.a] + points[rim.b]);
  }
};

/// Films, then solids. Throws InvalidInput as start_from_facets() says.
FacetParts facet_parts(const FilmSystem& system);

std::string text_of_place(const Vec3& p);

}  // namespace meniscus::films
