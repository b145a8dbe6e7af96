/// Which modes responses take, in designs near the base and where modes cross.
#include "pipeline/responses/response_modes.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/case_text.h"
#include "tests/support/parts.h"

namespace meniscus::response_modes_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

case_data::ResponseEntry factor(int number, double cluster) {
  case_data::ResponseEntry response;
  response.name = "factor";
  response.kind = case_data::ResponseKind::BucklingFactor;
  response.number = number;
  response.cluster = cluster;
  return response;
}

/// A bar of section 1 x 1, its y and z stretched by design.
class Bar {
 public:
  Bar(std::vector<case_data::ResponseEntry> responses, double push,
      double poisson_ratio = 0.3) {
    input_.responses = std::move(responses);
    base_.mesh =
        shapes::straight_quadratic(shapes::brick({10.0, 1.0, 0.8}, 8, 2, 2));
    base_.inputs.materials = {parts::steel()};
    base_.inputs.materials[0].poisson_ratio = poisson_ratio;
    base_.inputs.load_cases = {parts::pulled({-push, 0.0, 0.0})};
    model_.emplace(base_.mesh, base_.inputs.materials, base_.inputs.load_cases);
    base_.solution = model_->base_solution();
    modes_ = find(base_, nullptr);
  }

  const responses::ResponseModes& base() const { return modes_; }

  responses::ResponseModes at(double y, double z) const {
    State state = base_;
    for (Vec3& x : state.mesh.nodes) {
      x.y() *= y;
      x.z() *= z;
    }
    state.solution = model_->solve(state.mesh);
    return find(state, &modes_);
  }

 private:
  struct State {
    case_data::EvaluatedCase inputs;
    TetMesh mesh;
    equations::ElasticSolution solution;
  };

  responses::ResponseModes find(const State& state,
                                const responses::ResponseModes* base) const {
    return responses::find_response_modes({.input = input_,
                                           .inputs = state.inputs,
                                           .mesh = state.mesh,
                                           .solution = state.solution,
                                           .model = &*model_,
                                           .base = base});
  }

  case_data::Case input_;
  State base_;
  std::optional<elastic::ElasticModel> model_;
  responses::ResponseModes modes_;
};

TEST(ResponseModes, AreThoseOfABeam) {
  const Bar bar({factor(1, 0.1)}, 1.0);
  ASSERT_FALSE(bar.base().failure) << bar.base().failure->message;
  const double pi = std::acos(-1.0);
  const double euler = pi * pi * parts::steel().youngs_modulus *
                       std::pow(0.8, 3) / 12.0 / (4.0 * 10.0 * 10.0);
  EXPECT_NEAR(bar.base().sums[0].value / euler, 1.0, 0.02);
}

// Its two bendings cross where y and z stretch apart.
TEST(ResponseModes, AreFollowedThroughACrossing) {
  case_data::ResponseEntry second = factor(2, 0.0);
  second.name = "second";
  const Bar bar({factor(1, 0.0), second}, 1.0);
  const responses::ResponseModes& base = bar.base();
  ASSERT_FALSE(base.failure) << base.failure->message;
  const double weak = modal_sum(base, "factor").value;
  const double strong = modal_sum(base, "second").value;
  EXPECT_LT(weak, strong);
  const responses::ResponseModes there = bar.at(0.7, 1.4);
  ASSERT_FALSE(there.failure) << there.failure->message;
  // Bending of the weak side goes with y z^3, of the strong with z y^3.
  EXPECT_NEAR(modal_sum(there, "factor").value / weak, 0.7 * std::pow(1.4, 3),
              0.05);
  EXPECT_NEAR(modal_sum(there, "second").value / strong, 1.4 * std::pow(0.7, 3),
              0.02);
  EXPECT_GT(modal_sum(there, "factor").value, modal_sum(there, "second").value);
}

TEST(ResponseModes, OfAClusterAreSmoothThroughACrossing) {
  const Bar bar({factor(1, 0.1)}, 1.0);
  // Square at y = 0.8^0.5, z = 1 / 0.8^0.5: two equal factors.
  std::vector<double> value;
  std::vector<double> least;
  for (int k = -2; k <= 2; ++k) {
    const double y = std::sqrt(0.8) * (1.0 + 1e-3 * k);
    const responses::ResponseModes there = bar.at(y, 0.8 / (y * 0.8));
    ASSERT_FALSE(there.failure);
    value.push_back(there.sums[0].value);
    least.push_back(there.problems[0].values[0]);
  }
  const auto kink = [](const std::vector<double>& v) {
    return std::abs(v[1] - 2.0 * v[2] + v[3]) / std::abs(v[3] - v[1]);
  };
  EXPECT_GT(kink(least), 0.5);
  const double bend = value[1] - 2.0 * value[2] + value[3];
  EXPECT_LT(std::abs(bend), 1e-4 * value[2]);
  EXPECT_GT(std::abs(least[1] - 2.0 * least[2] + least[3]),
            10.0 * std::abs(bend));
  EXPECT_NEAR(value[2] / least[2], 1.0 / (1.1 - 0.1 / std::cbrt(2.0)), 1e-3);
}

TEST(ResponseModes, OfAWideClusterTakeAsManyAsThereAre) {
  const Bar bar({factor(1, 0.99)}, 1.0);
  ASSERT_FALSE(bar.base().failure);
  EXPECT_GE(bar.base().problems[0].values.back(),
            1.99 * bar.base().sums[0].value);
}

TEST(ResponseModes, ThatAreNotThereAreAFailure) {
  // Pulled, and no wider at the clamp: nothing is compressed.
  const Bar none({factor(1, 0.1)}, -1.0, 0.0);
  ASSERT_TRUE(none.base().failure);
  EXPECT_THAT(none.base().failure->message,
              AllOf(HasSubstr("load case 'main'"),
                    HasSubstr("no buckling factor below 1e+06")));
}

case_data::Case strut_with(const std::string& response) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(strut(), "[responses.mass]", response + "\n[responses.mass]"),
      "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  return *reading.input;
}

TEST(ModeResponses, AreRead) {
  const auto first = [](const std::string& response) {
    return strut_with("[responses.first]\n" + response).responses[1];
  };
  const case_data::ResponseEntry plain = first("kind = \"buckling_factor\"\n");
  EXPECT_EQ(plain.number, 1);
  EXPECT_EQ(plain.cluster, 0.1);
  EXPECT_EQ(first("kind = \"buckling_factor\"\ncluster = 0\n").cluster, 0.0);
  const case_data::ResponseEntry third =
      first("kind = \"frequency\"\nnumber = 3\nload_case = \"free\"\n");
  EXPECT_EQ(third.number, 3);
  EXPECT_EQ(third.cluster, 0.0);
  EXPECT_EQ(third.load_case, case_data::AnalysisEntry::kFree);
}

TEST(ModeResponses, OfFrequencyAreHeldAsTheAnalysisSays) {
  const std::string plain = "[responses.hum]\nkind = \"frequency\"\n";
  const std::string free = "[analysis]\nsupports_of = \"free\"\n";
  const case_data::Case held = strut_with(plain);
  const case_data::Case loose = strut_with(free + plain);
  EXPECT_EQ(held.responses[1].load_case, 0);
  EXPECT_EQ(loose.responses[1].load_case, case_data::AnalysisEntry::kFree);
  EXPECT_NE(held.hash, loose.hash) << "evaluations depend on it";
  const std::string own = plain + "load_case = \"service\"\n";
  EXPECT_EQ(strut_with(own).hash, strut_with(free + own).hash);
}

TEST(ModeResponses, WrongKeysAreRefused) {
  const auto problems = [](const std::string& keys) {
    return problems_of(
        changed(strut(), "[responses.mass]",
                "[responses.first]\n" + keys + "\n[responses.mass]"));
  };
  const std::string factor = "kind = \"buckling_factor\"\n";
  EXPECT_THAT(problems(factor + "number = 0"),
              ElementsAre(HasSubstr("a whole number from 1 to 50")));
  EXPECT_THAT(problems(factor + "cluster = 1"),
              ElementsAre(HasSubstr("must be from 0 to below 1; 0.1 when")));
  EXPECT_THAT(problems(factor + "number = 2\ncluster = 0.1"),
              ElementsAre(HasSubstr("number is 2; take one of the two out")));
  EXPECT_THAT(problems(factor + "load_case = \"free\""),
              ElementsAre(HasSubstr("load case")));
  EXPECT_THAT(problems_of(changed(strut(), "[responses.mass]",
                                  "[analysis]\nsolver = \"petsc\"\n"
                                  "[responses.first]\n" +
                                      factor + "\n[responses.mass]")),
              ElementsAre(HasSubstr("needs the matrix in one process")));
  EXPECT_THAT(problems_of(changed(
                  changed(strut(), "2.8e-9", "0"), "[responses.mass]",
                  "[responses.first]\nkind = \"frequency\"\n[responses.mass]")),
              ElementsAre(HasSubstr("density is 0, but natural frequencies")));
}

}  // namespace
}  // namespace meniscus::response_modes_test
