// Curves, films and solids: what the liquid starts from.
#include "pipeline/schema/case_schema.h"

namespace meniscus {

namespace {

using D = Dimension;
using K = KeyType;
using N = TableNeed;

}  // namespace

std::vector<TableSpec> shape_tables() {
  return {
      {"curves",
       true,
       N::Optional,
       "A closed boundary curve, counter-clockwise seen from its normal's tip",
       {{"kind", K::Choice, D::None, true,
         "its shape: circle, ellipse, rectangle; polygon: straight sides; "
         "spline: smooth through points; polyline: straight sides and circular "
         "arcs; file: points from a file; copy: another curve offset, scaled, "
         "mirrored, turned, moved",
         "circle|ellipse|rectangle|polygon|spline|polyline|file|copy", "arc"},
        {"center", K::Vector, D::Length, false,
         "of circle, ellipse, rectangle"},
        {"normal", K::Vector, D::None, false,
         "of circle, ellipse, rectangle; any length but 0"},
        {"axis", K::Vector, D::None, false,
         "of ellipse, rectangle: direction of radius_1 or width; of copy: what "
         "it is turned about"},
        {"radius", K::Quantity, D::Length, false, "of circle"},
        {"radius_1", K::Quantity, D::Length, false, "of ellipse, along axis"},
        {"radius_2", K::Quantity, D::Length, false, "of ellipse, across axis"},
        {"width", K::Quantity, D::Length, false, "of rectangle: along axis"},
        {"height", K::Quantity, D::Length, false, "of rectangle: across it"},
        {"corner_radius", K::Quantity, D::Length, false,
         "of rectangle; 0 when left out"},
        {"points", K::Path, D::Length, false,
         "of polygon, spline, polyline, in order; they close by themselves. In "
         "a polyline { through = [x, y, z] } makes the side between its "
         "neighbours an arc"},
        {"file", K::Text, D::None, false,
         "of file: a csv file with a head row x,y,z, units if it likes (x "
         "[in]), or a STEP file; relative to the case file"},
        {"as", K::Choice, D::None, false,
         "of a csv file: what the points make; spline when left out",
         "spline|polygon"},
        {"edge", K::NamesOrNumbers, D::None, false,
         "of a STEP file: a closed edge, or several that close, by name or "
         "number: 7, \"rim\", [3, 4]; or"},
        {"face", K::NamesOrNumbers, D::None, false,
         "of a STEP file: the face whose outer rim it is, by name or number"},
        {"of", K::Name, D::None, false, "of copy: a curve that stands above"},
        {"offset", K::Quantity, D::Length, false,
         "of copy: outwards in the curve's plane, below 0 inwards; corners "
         "stay sharp, arcs concentric. Not of a copy"},
        {"scale", K::Quantity, D::None, false, "of copy: a factor above 0, or"},
        {"scales", K::Vector, D::None, false,
         "of copy: factors along x, y, z, above 0"},
        {"mirror", K::Vector, D::None, false,
         "of copy: normal of the mirror plane; any length but 0"},
        {"rotate", K::Quantity, D::None, false,
         "of copy: angle in radians, right-handed about axis"},
        {"about", K::Vector, D::Length, false,
         "of copy: the point that scaling, mirror plane and axis go through; "
         "the origin when left out"},
        {"move", K::Vector, D::Length, false, "of copy: added at the end"}}},
      {"films",
       true,
       N::Optional,
       "A liquid film between curves",
       {{"kind", K::Choice, D::None, true,
         "how the liquid starts: branch (convex hull of any number of curves "
         "less their caps), loft (band between two), disk (across one), facets "
         "(given here), file (facets of an STL, OBJ or Surface Evolver file)",
         "branch|loft|disk|facets|file"},
        {"curves", K::Names, D::None, false,
         "the curves that hold it; of facets and file those that its rims lie "
         "on, none where it is closed"},
        {"tension", K::Place, D::Tension, false,
         "energy per area of the film, above 0; 1 when left out. An expression "
         "of x, y, z cannot depend on design variables"},
        {"vertices", K::Vectors, D::Length, false,
         "of facets: where its corners are at first"},
        {"facets", K::Facets, D::None, false,
         "of facets: three or more numbers of vertices each, from 0, all the "
         "same way around"},
        {"file", K::Text, D::None, false,
         "of file: .stl, .obj or .fe, relative to the case file"},
        {"surface", K::Name, D::None, false,
         "of file: one of its surfaces (STL solid, OBJ group; film_1, film_2, "
         "... of a datafile); all when left out"},
        {"scale", K::Constant, D::None, false,
         "of file: what its lengths are multiplied by; 1 when left out"},
        {"within", K::Constant, D::Length, false,
         "of facets and file: how far rims may lie off their curves; a quarter "
         "of resolution.fea when left out"}}},
      {"solids",
       true,
       N::Optional,
       "A solid surface, named so that loads find it",
       {{"kind", K::Choice, D::None, true,
         "cap: flat disk across a planar curve; ring: band between two curves, "
         "flat where they lie in one plane; sides: the plane faces between the "
         "sides of two polygons; file: facets of an STL, OBJ or Surface "
         "Evolver file, which stay as they are",
         "cap|ring|sides|file", "plate|pad|faces"},
        {"curve", K::Name, D::None, false, "of cap, ring: its rim"},
        {"inner", K::Name, D::None, false, "of ring: the rim of its hole"},
        {"holes", K::Names, D::None, false,
         "of cap: curves in its plane that it leaves open"},
        {"curves", K::Names, D::None, false,
         "of sides: two polygons of as many corners; of file: those that its "
         "rims lie on"},
        {"file", K::Text, D::None, false, "of file: as of films"},
        {"surface", K::Name, D::None, false, "of file: as of films"},
        {"scale", K::Constant, D::None, false, "of file: as of films"},
        {"within", K::Constant, D::Length, false, "of file: as of films"}}},
  };
}

}  // namespace meniscus
