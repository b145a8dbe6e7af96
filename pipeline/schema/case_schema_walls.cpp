#include "pipeline/schema/case_schema.h"

namespace meniscus {

namespace {

using D = Dimension;
using K = KeyType;
using N = TableNeed;

}  // namespace

TableSpec walls_table() {
  return {
      "walls",
      true,
      N::Optional,
      "Films made solid by thickness. `meniscus evolve` reports the largest "
      "safe one and writes the closed surface",
      {{"films", K::Names, D::None, true,
        "the film, or several; where they share a curve they are joined"},
       {"thickness", K::Place, D::Length, true,
        "above 0; a number may follow the design, an expression of x, y, z "
        "may not"},
       {"material", K::Name, D::None, false,
        "of the wall; a run needs it, and walls that meet have one"},
       {"fillet", K::Constant, D::Length, false,
        "radius where three or more films meet, 0: sharp; half the thickness "
        "when left out"},
       {"side", K::Choice, D::None, false,
        "where the material lies: both sides of the film, all of it inside "
        "(towards the middle of the film's curves) or outside; both when left "
        "out",
        "both|inside|outside"}}};
}

}  // namespace meniscus
