/// The same equations solved by CalculiX: the two-arm bracket's own deck, and
/// its pads under CalculiX's own pressure.
#include <gtest/gtest.h>

#include "pipeline/reader/case_reader.h"
#include "pipeline/results/calculix_export.h"
#include "tests/support/calculix.h"

namespace meniscus::two_arm_calculix_test {
namespace {

// CalculiX prints seven digits; the bound is 1e-6 of the largest.
constexpr double kAgreement = 1e-6;
constexpr double kPressure = 5.0;  // MPa

class TwoArmInCalculix : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    input_ = reader::read_case(MENISCUS_SOURCE_DIR "/cases/two_arm/case.toml",
                               {"resolution.fea=18", "resolution.film=9"});
    const forward::ForwardModel model(input_);
    ASSERT_FALSE(model.failure()) << model.failure()->message;
    // Away from the frozen design, so that moved meshes are compared.
    const forward::Evaluation evaluation =
        model.evaluate(VectorX::Constant(1, 13.0), &fields_);
    ASSERT_FALSE(evaluation.failure) << evaluation.failure->message;
  }

  static loads::LoadCase case_with(
      std::vector<loads::SurfaceForce> forces,
      std::vector<loads::SurfacePressure> pressures) {
    loads::LoadCase load_case = fields_.inputs.load_cases.front();
    load_case.forces = std::move(forces);
    load_case.pressures = std::move(pressures);
    return load_case;
  }

  static VectorX ours(const loads::LoadCase& load_case) {
    const elastic::ElasticModel model(fields_.mesh, fields_.inputs.materials,
                                      {load_case});
    return model.base_solution().displacements.front();
  }

  static CalculixStep calculix(const loads::LoadCase& load_case) {
    case_data::EvaluatedCase numbers = fields_.inputs;
    numbers.load_cases = {load_case};
    io::CalculixDeck deck =
        results::calculix_deck_of(input_, numbers, fields_.mesh);
    deck.output = io::DeckOutput::Print;
    return run_calculix(io::calculix_deck(fields_.mesh, deck),
                        static_cast<int>(fields_.mesh.nodes.size()))
        .front();
  }

  static void expect_same(const VectorX& a, const VectorX& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(a.cwiseAbs().maxCoeff(), 0.0);
    const double difference =
        (a - b).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff();
    RecordProperty("difference", std::to_string(1e9 * difference) + "e-9");
    EXPECT_LT(difference, kAgreement);
  }

  static inline case_data::Case input_;
  static inline forward::EvaluationFields fields_;
};

TEST_F(TwoArmInCalculix, GivesTheSameDisplacements) {
  ASSERT_TRUE(have_calculix());
  const CalculixStep step = calculix(fields_.inputs.load_cases.front());
  expect_same(fields_.solution.displacements.front(), step.displacement);
  Vec3 loads = Vec3::Zero();
  for (const loads::SurfaceForce& f :
       fields_.inputs.load_cases.front().forces) {
    loads += f.total;
  }
  EXPECT_LT((step.reaction + loads).norm(), 1e-5 * loads.norm());
}

/// CalculiX integrates *DLOAD itself, so a wrong weight of a pad's node cannot
/// agree with itself: first our pressure, then the same load as a force.
TEST_F(TwoArmInCalculix, LoadsAPadAsCalculixDoes) {
  ASSERT_TRUE(have_calculix());
  for (const char* pad : {"left_pad", "right_pad"}) {
    const loads::LoadCase pressed = case_with({}, {{pad, kPressure}});
    const VectorX theirs = calculix(pressed).displacement;
    expect_same(ours(pressed), theirs);

    const loads::SurfaceWeights weights =
        loads::surface_weights(fields_.mesh, pad);
    const double side = pad[0] == 'l' ? -1.0 : 1.0;
    const double angle = 60.0 * EIGEN_PI / 180.0;
    const Vec3 normal(side * std::sin(angle), 0.0, std::cos(angle));
    const Vec3 total = -kPressure * weights.weights.sum() * normal;
    expect_same(ours(case_with({{pad, total}}, {})), theirs);
  }
}

}  // namespace
}  // namespace meniscus::two_arm_calculix_test
