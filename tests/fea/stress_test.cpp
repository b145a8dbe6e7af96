#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/fea/parts.h"

namespace meniscus {
namespace {

TEST(Stress, VonMisesOfPullAndShear) {
  EXPECT_DOUBLE_EQ(von_mises({3.0, 0.0, 0.0, 0.0, 0.0, 0.0}), 3.0);
  EXPECT_DOUBLE_EQ(von_mises({0.0, 0.0, 0.0, 2.0, 0.0, 0.0}),
                   2.0 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(von_mises({5.0, 5.0, 5.0, 0.0, 0.0, 0.0}), 0.0);
}

TEST(Stress, PeakIsTheLargestNodalValue) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({3.0, 1.0, 1.0}, 6, 2, 2));
  const ElasticModel model(mesh, {parts::steel()},
                           {parts::pulled({0.0, 0.0, -10.0})});
  const StressField field = recover_stress(
      mesh, {parts::steel()}, model.base_solution().displacements[0]);
  double top = 0.0;
  for (const double s : field.von_mises) {
    top = std::max(top, s);
  }
  EXPECT_EQ(field.max_von_mises, top);
  EXPECT_EQ(field.von_mises[field.max_node], top);
}

TEST(Stress, WrongSizesAreRefused) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THROW(recover_stress(mesh, {parts::steel()}, VectorX::Zero(3)),
               InvalidInput);
  EXPECT_THROW(recover_stress(mesh, {}, VectorX::Zero(24)), InvalidInput);
}

}  // namespace
}  // namespace meniscus
