/// Loads from any direction through the whole forward model.
#include "pipeline/responses/worst_loads.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "pipeline/forward/stress_figures.h"
#include "pipeline/forward/worst_cases.h"
#include "tests/support/case_text.h"

namespace meniscus::worst_loads_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two solutions of the same equations.
constexpr double kSolved = 1e-7;

/// A leaning strut whose head is loaded through a point above it.
std::string text_of(const std::string& load) {
  std::string text = leaning_strut();
  text = changed(text, "density = 2.8e-9",
                 "density = 2.8e-9\nyield_strength = 20");
  text = changed(text, "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
                 "[{ on = \"head_pad\", " + load +
                     ", at = [\"lean\", 4, \"length + 10\"] }]");
  return changed(text, "[study]", R"toml([responses.tilt]
kind = "mean_displacement"
on = "head_pad"
direction = [1, 0.5, "lean / 10"]
weight = "x + lean / 5"

[responses.turn]
kind = "rotation"
on = "head_pad"
axis = [0.2, 1, 0]

[responses.work]
kind = "compliance"

[responses.energy]
kind = "strain_energy"

[responses.stress]
kind = "stress_ratio"

[study])toml");
}

const char* const kSize = "size = \"load * (1 + lean / 20)\"";

std::string in_cone(double degrees, const Vec3& about) {
  return text_of(fmt::format("{}, within = \"{} deg\", about = [{}, {}, {}]",
                             kSize, degrees, about.x(), about.y(), about.z()));
}

std::string along(const Vec3& d) {
  return text_of(
      fmt::format("force = [\"load * (1 + lean / 20) * {0:.17g}\", "
                  "\"load * (1 + lean / 20) * {1:.17g}\", "
                  "\"load * (1 + lean / 20) * {2:.17g}\"]",
                  d.x(), d.y(), d.z()));
}

struct Found {
  VectorX responses;
  std::vector<responses::WorstLoad> worst;
};

Found found(const std::string& text) {
  const case_data::Case input = case_of(text);
  const forward::ForwardModel model(input);
  forward::EvaluationFields fields;
  const forward::Evaluation there =
      model.evaluate(case_data::initial_design(input), &fields);
  EXPECT_FALSE(there.failure);
  return {
      there.responses,
      responses::worst_loads(input, {fields.inputs, fields.mesh,
                                     fields.solution, fields.exclusion.what})};
}

TEST(WorstLoads, AreThoseOfTheirOwnDirections) {
  for (const std::string& text :
       {text_of(kSize), in_cone(40.0, Vec3(0.5, -0.4, -1.0))}) {
    const Found worst = found(text);
    ASSERT_EQ(worst.worst.size(), 6U);
    for (const responses::WorstLoad& load : worst.worst) {
      EXPECT_EQ(load.load_case, "service");
      const double own = found(along(load.direction)).responses[load.response];
      const double value = worst.responses[load.response];
      if (load.response == 6) {
        // At other nodes other directions are worse: the bound is of all.
        EXPECT_GE(value, own * (1.0 - kSolved));
        EXPECT_LE(value, own * 1.05);
      } else {
        EXPECT_NEAR(value, own, kSolved * std::abs(own)) << load.response;
      }
    }
  }
}

TEST(WorstLoads, NoOtherDirectionIsWorse) {
  const VectorX worst = found(text_of(kSize)).responses;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 4; ++k) {
    const Vec3 d(normal(random), normal(random), normal(random));
    const VectorX own = found(along(d.normalized())).responses;
    for (const int r : {0, 2, 3, 4, 5, 6}) {
      EXPECT_LE(own[r], worst[r] * (1.0 + kSolved)) << r;
    }
  }
}

TEST(WorstLoads, OfConesWithoutWidthAndOfAllDirections) {
  const Vec3 about(0.48, -0.64, 0.6);
  const VectorX narrow = found(in_cone(0.0, about)).responses;
  const VectorX own = found(along(about)).responses;
  const VectorX wide = found(in_cone(180.0, about)).responses;
  const VectorX all = found(text_of(kSize)).responses;
  for (Eigen::Index r = 0; r < own.size(); ++r) {
    EXPECT_NEAR(narrow[r], own[r], kSolved * std::abs(own[r])) << r;
    EXPECT_NEAR(wide[r], all[r], kSolved * std::abs(all[r])) << r;
  }
}

forward::EvaluationFields stressed(const case_data::Case& input) {
  const forward::ForwardModel model(input);
  forward::EvaluationFields fields;
  EXPECT_FALSE(
      model.evaluate(case_data::initial_design(input), &fields).failure);
  forward::find_stresses(input, fields);
  return fields;
}

TEST(WorstLoads, AreShownByALoadCaseOfTheirName) {
  const Vec3 about = Vec3(0.5, -0.4, -1.0).normalized();
  const case_data::Case input = case_of(in_cone(40.0, about));
  const forward::EvaluationFields fields = stressed(input);
  const std::vector<forward::StressFigures> figures =
      forward::stress_figures(fields);
  ASSERT_EQ(figures.size(), 4U);
  EXPECT_EQ(figures[3].load_case, "service");
  ASSERT_TRUE(figures[3].direction);
  const Vec3 d = *figures[3].direction;
  EXPECT_GE(d.dot(about), std::cos(40.0 * EIGEN_PI / 180.0) - 1e-12);
  const auto peak_along = [](const Vec3& direction) {
    const std::vector<forward::StressFigures> own =
        forward::stress_figures(stressed(case_of(along(direction))));
    return own[0].readings.largest().von_mises;
  };
  const double peak = figures[3].readings.largest().von_mises;
  EXPECT_NEAR(peak_along(d), peak, kSolved * peak);
  const Vec3 aside = about.unitOrthogonal();
  for (const double turn : {0.0, 0.35, -0.35}) {
    const Vec3 other = std::cos(turn) * about + std::sin(turn) * aside;
    EXPECT_LE(peak_along(other), peak * (1.0 + kSolved)) << turn;
  }
  // Its unit loads are nobody's, wherever their stress is higher.
  EXPECT_EQ(forward::worst_load_case(figures), 3U);
  const nlohmann::ordered_json json = {
      {"stress", forward::stress_json(figures)}};
  EXPECT_TRUE(json["stress"]["service"].contains("safety_factor"));
  EXPECT_FALSE(json["stress"]["service_x"].contains("safety_factor"));
  // A run's folder knows the load again.
  case_data::EvaluatedCase again =
      case_data::evaluate(input, case_data::initial_design(input));
  forward::add_worst_cases(input, json, again);
  ASSERT_EQ(again.load_cases.size(), 4U);
  EXPECT_EQ(again.load_cases[3].name, "service");
  EXPECT_LT((again.load_cases[3].remote_loads[0].force -
             fields.inputs.load_cases[3].remote_loads[0].force)
                .norm(),
            1e-12);
}

TEST(WorstLoads, GradientsAreExactThroughTheModel) {
  for (const std::string& text :
       {text_of(kSize), in_cone(35.0, Vec3(0.5, -0.4, -1.0)),
        text_of(std::string(kSize) + ", by = \"rigid\"")}) {
    const case_data::Case input = case_of(text);
    const forward::CaseGradientCheck check = forward::check_case_gradient(
        input, case_data::initial_design(input) + Eigen::Vector2d(0.8, -2.0));
    EXPECT_TRUE(check.report.passed)
        << forward::gradient_check_text(input, check);
    EXPECT_THAT(check.left_out, IsEmpty());
  }
}

TEST(WorstLoads, UnitLoadsHaveNames) {
  const case_data::Case input =
      case_of(changed(text_of(kSize), "[study]",
                      "[responses.any]\nkind = \"envelope\"\nof = \"sway\"\n\n"
                      "[responses.one]\nkind = \"von_mises_norm\"\n"
                      "load_case = \"service_y\"\n\n[study]"));
  ASSERT_EQ(input.load_cases.size(), 3U);
  EXPECT_EQ(input.load_cases[2].name, "service_z");
  ASSERT_EQ(input.directions.size(), 1U);
  const auto at = [&](const char* name) {
    return input.responses[case_data::response_index(input, name)];
  };
  EXPECT_THAT(at("any").parts, ElementsAre(0));
  EXPECT_EQ(at("one").load_case, 1);
  EXPECT_FALSE(at("one").worst_in);
}

TEST(WorstLoads, MistakesAreToldByLine) {
  const auto told = [](const std::string& load) {
    return problems_of(text_of(load));
  };
  EXPECT_THAT(told("size = 5, within = \"20 deg\""),
              Contains(HasSubstr("one of 'within' and 'about'")));
  EXPECT_THAT(told("size = 5, within = \"200 deg\", about = [0, 0, 1]"),
              Contains(HasSubstr("within is 200 degrees")));
  EXPECT_THAT(told("size = 5, within = \"20 deg\", about = [0, 0, 0]"),
              Contains(HasSubstr("about has no length")));
  EXPECT_THAT(told("size = -5"), Contains(HasSubstr("above 0")));
  EXPECT_THAT(told("size = 5, by = \"bearing\""),
              Contains(HasSubstr("unit loads do not add up")));
  EXPECT_THAT(told("size = 5, moment = [1, 0, 0]"),
              Contains(HasSubstr("moment and size")));
  EXPECT_THAT(told("force = [1, 0, 0], within = \"20 deg\""),
              Contains(HasSubstr("within does not belong to a force")));
  EXPECT_THAT(told("size = 5 }, { gravity = [0, 0, 1]"),
              Contains(HasSubstr("such a load acts alone")));
  for (const char* kind :
       {"buckling_factor", "von_mises_norm", "max_von_mises", "uniformity"}) {
    EXPECT_THAT(problems_of(changed(text_of(kSize), "kind = \"compliance\"",
                                    fmt::format("kind = \"{}\"", kind))),
                Contains(HasSubstr("its kind knows no worst one")))
        << kind;
  }
  EXPECT_THAT(
      problems_of(changed(text_of(kSize), "kind = \"stress_ratio\"",
                          "kind = \"stress_ratio\"\nmeasure = \"tension\"")),
      Contains(HasSubstr("its kind knows no worst one")));
  EXPECT_THAT(
      problems_of(changed(text_of(kSize), "[load_cases.service]",
                          "[load_cases.service_x]\n"
                          "supports = [{ on = \"foot_pad\", fix = \"xyz\" }]\n"
                          "loads = [{ on = \"head_pad\", force = [1, 0, 0] }]\n"
                          "\n[load_cases.service]")),
      Contains(HasSubstr("has the name of a unit load")));
}

}  // namespace
}  // namespace meniscus::worst_loads_test
