#include "pipeline/part_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fea/parts.h"

namespace meniscus {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A bar of two materials pulled to a stress of 100; region 1 is its far half.
EvaluationFields pulled_bar(double near_yield, double far_yield,
                            double modulus) {
  EvaluationFields fields;
  fields.mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 1.0, 1.0}, 4, 2, 2));
  for (int e = 0; e < fields.mesh.element_count(); ++e) {
    double x = 0.0;
    for (const int node : fields.mesh.element(e).first<4>()) {
      x += 0.25 * fields.mesh.nodes[node].x();
    }
    fields.mesh.element_region[e] = x < 2.0 ? 0 : 1;
  }
  fields.inputs.materials = {{"near", modulus, 0.3, 1.0, near_yield},
                             {"far", modulus, 0.3, 1.0, far_yield}};
  LoadCase pull;
  pull.name = "pull";
  pull.supports = {{"x0", true, false, false},
                   {"y0", false, true, false},
                   {"z0", false, false, true}};
  pull.forces = {{"x1", {100.0, 0.0, 0.0}}};
  fields.inputs.load_cases = {pull};
  fields.solution = ElasticModel(fields.mesh, fields.inputs.materials, {pull})
                        .base_solution();
  return fields;
}

Case in_newtons() {
  Case input;
  input.units.pressure = "MPa";
  input.units.length = "mm";
  return input;
}

TEST(PartWarnings, AreNoneForASoundPart) {
  EXPECT_THAT(part_warnings(in_newtons(), pulled_bar(101.0, 200.0, 2e5)),
              IsEmpty());
}

TEST(PartWarnings, HoldEachBodyAgainstItsOwnYieldStrength) {
  EXPECT_THAT(
      part_warnings(in_newtons(), pulled_bar(200.0, 80.0, 2e5)),
      ElementsAre(AllOf(HasSubstr("stress above yield: load case 'pull'"),
                        HasSubstr("reaches 100 MPa"),
                        HasSubstr("'far' yields at 80 MPa"),
                        HasSubstr("safety factor 0.8"))));
}

TEST(PartWarnings, TellOfDeflectionsThatAreNotSmall) {
  EXPECT_THAT(part_warnings(in_newtons(), pulled_bar(200.0, 200.0, 1e3)),
              ElementsAre(HasSubstr("deflection not small")));
}

}  // namespace
}  // namespace meniscus
