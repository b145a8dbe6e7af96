/// The exact gradient through film, mesh and elasticity against central
/// differences of the same map.
#include <omp.h>
#include <set>

#include <gmock/gmock.h>

#include "core/operation_count.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "pipeline/reader/case_reader.h"
#include "tests/support/case_text.h"
#include "tests/support/rim_case.h"

namespace meniscus::design_gradient_test {
namespace {

/// A strut whose curves, volume and load follow three design variables, with
/// every kind of response that has derivatives.
std::string every_response() {
  std::string text = changed(leaning_strut(), "[curves.base]",
                             "[design.fill]\ninitial = 1.0\n"
                             "bounds = [0.8, 1.3]\n\n"
                             "[curves.base]");
  text = changed(text, "normal = [0, 0, 1]", "normal = [\"lean / 50\", 0, 1]");
  text = changed(text, "volume = 9e4", "volume = \"9e4 * fill\"");
  text = changed(text, "density = 2.8e-9",
                 "density = 2.8e-9\nyield_strength = 200");
  text = changed(text, "length = 60.0", "length = 60.0\nfoot_at = 30.0");
  text = changed(text, "[responses.sway]", R"toml([responses.tilt]
kind = "mean_displacement"
on = "head_pad"
direction = [0, "lean / 10", 1]
weight = "(x - 3) / 20 + y^2 / 400"

[responses.far]
kind = "displacement_norm"
on = "skin"
direction = [1, 0, 0.2]
power = 6

[responses.turn]
kind = "rotation"
on = "head_pad"
axis = [0, 1, 0]

[responses.work]
kind = "compliance"

[responses.strain]
kind = "strain_energy"

[responses.size]
kind = "volume"

[responses.middle]
kind = "centre_of_mass"
direction = ["fill", 0, "lean / 3"]

[responses.norm]
kind = "von_mises_norm"
power = 10

[responses.ks]
kind = "von_mises_ks"
sharpness = 20

[responses.evenness]
kind = "uniformity"

[responses.energy_evenness]
kind = "energy_uniformity"

[responses.area]
kind = "film_area"
film = "skin"

[responses.energy]
kind = "film_energy"

[responses.gas]
kind = "pressure"
body = "part"

[responses.margin]
kind = "collapse_margin"

[responses.tightest]
kind = "radius"

[responses.thinnest]
kind = "thickness"

[responses.deepest]
kind = "groove"

[responses.clearance]
kind = "distance"
keep_out = "12 - sqrt((x - foot_at)^2 + y^2 + (z - 30)^2)"
smoothing = 2

[responses.overhang]
kind = "distance"
keep_in = "28 - sqrt(x^2 + y^2 + z / 8)"

[responses.sway])toml");
  return changed(text, "[study]",
                 R"([responses.price]
kind = "expression"
value = "mass * 1e6 + sqrt(norm) * load / (1000 + lean) + area / fill"

[study])");
}

/// A strut that is pushed, with eigenvalues of every kind: bounds of clusters,
/// and modes that are followed.
std::string eigenvalues() {
  std::string text = changed(strut(), "[curves.base]",
                             "[design.thrust]\ninitial = 2000.0\n"
                             "bounds = [1000.0, 3000.0]\n\n"
                             "[curves.base]");
  text = changed(text, "force = [\"load\", 0, 0]",
                 "force = [\"load / 10\", 0, \"-thrust\"]");
  text = changed(text, "fea = 6.0\nfilm = 3.0", "fea = 10.0\nfilm = 5.0");
  text = changed(text, "youngs_modulus = 71700.0",
                 "youngs_modulus = \"71700 + thrust\"");
  text = changed(text, "density = 2.8e-9", "density = \"2.8e-9 * foot / 25\"");
  return changed(text, "[responses.mass]", R"([responses.stable]
kind = "buckling_factor"

[responses.second]
kind = "buckling_factor"
number = 2

[responses.hum]
kind = "frequency"

[responses.ring]
kind = "frequency"
load_case = "free"
number = 2

[responses.mass])");
}

/// Evaluated a little beside the initial design, and the derivatives there.
struct Differentiated {
  VectorX responses;
  forward::DesignGradient by;
};

Differentiated differentiated(const std::vector<std::string>& responses) {
  const case_data::Case input = case_of(eigenvalues());
  const forward::ForwardModel model(input);
  EXPECT_FALSE(model.failure());
  forward::EvaluationFields fields;
  forward::AdjointState adjoint;
  const forward::Evaluation here = model.evaluate(
      case_data::initial_design(input) + Eigen::Vector2d(0.3, 50.0), &fields,
      &adjoint);
  EXPECT_FALSE(here.failure);
  std::vector<int> wanted;
  for (const std::string& name : responses) {
    wanted.push_back(case_data::response_index(input, name));
  }
  return {here.responses, model.gradient(here, fields, adjoint, wanted)};
}

void expect_exact(const std::string& text, const VectorX& move) {
  const case_data::Case input = case_of(text);
  const VectorX design = case_data::initial_design(input) + move;
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, design);
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
}

TEST(DesignGradient, IsExactForEveryResponseAtTheFrozenDesign) {
  expect_exact(every_response(), VectorX::Zero(3));
}

// On a bound a direction leads inwards, and differences are one-sided.
TEST(DesignGradient, IsExactAlongDirectionsOfAllVariablesToo) {
  const reader::CaseReading reading = reader::read_case_file(
      MENISCUS_SOURCE_DIR "/cases/two_arm_sized/case.toml",
      {"resolution.fea=20", "resolution.film=10"});
  ASSERT_THAT(reading.problems, testing::IsEmpty());
  case_data::Case input = *reading.input;
  const VectorX design = case_data::initial_design(input);
  for (const bool on_a_bound : {false, true}) {
    if (on_a_bound) {
      input.design[1].upper = design[1];
    }
    const forward::CaseGradientCheck check =
        forward::check_case_gradient(input, design, {}, on_a_bound ? 1 : 2);
    EXPECT_TRUE(check.report.passed)
        << forward::gradient_check_text(input, check);
    EXPECT_EQ(check.report.rows.size(),
              (on_a_bound ? 1 : 2) * input.responses.size());
    EXPECT_EQ(check.report.rows[0].variable, "direction 1");
    EXPECT_NE(check.report.rows[0].given, check.report.rows[1].given);
  }
}

// By each element of a small vector, by eight and a direction of a large one.
TEST(DesignGradient, OfVectorsIsExact) {
  const std::string coarse =
      changed(petal_strut(), "fea = 6.0\nfilm = 3.0", "fea = 12.0\nfilm = 6.0");
  expect_exact(coarse, VectorX::LinSpaced(6, -1.0, 1.5));
  // In a tension, and in a pressure that is an expression of the place.
  expect_exact(changed(changed(coarse, "curves = [\"base\", \"head\"]",
                               "curves = [\"base\", \"head\"]\n"
                               "tension = \"t[1, 1] / 25\""),
                       "force = [\"load\", 0, 0]",
                       "pressure = \"t[1, 2] / 10 + t[2, 1 + 1] * x / 300\""),
               VectorX::LinSpaced(6, -1.0, 1.5));
  const std::string text =
      changed(changed(changed(coarse, "shape = [2, 3]", "shape = [4, 3]"),
                      "t[i, j] * cos((j + 3 * i) * pi / 3)",
                      "t[i, j] * cos((j + 3 * i) * pi / 6)"),
              "t[i, j] * sin((j + 3 * i) * pi / 3)\", 0], repeat = [2, 3]",
              "t[i, j] * sin((j + 3 * i) * pi / 6)\", 0], repeat = [4, 3]");
  const case_data::Case input = case_of(text);
  const VectorX design =
      case_data::initial_design(input) + VectorX::LinSpaced(12, -1.0, 1.0);
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, design);
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
  EXPECT_THAT(check.sampled,
              testing::ElementsAre("t [4 x 3]: 8 of its 12 elements at random "
                                   "and a direction of them all"));
  std::set<std::string> looked;
  for (const optimize::GradientCheckRow& row : check.report.rows) {
    looked.insert(row.variable);
  }
  EXPECT_EQ(looked.size(), 9U);
  EXPECT_TRUE(looked.count("t, direction"));
  EXPECT_THAT(forward::gradient_check_text(input, check),
              testing::HasSubstr("8 of its 12 elements at random"));
}

TEST(DesignGradient, OfEigenvaluesIsExact) {
  expect_exact(eigenvalues(), VectorX::Zero(2));
  expect_exact(eigenvalues(), Eigen::Vector2d(0.3, 50.0));
}

// Of a strut that swings about a bolt under it, its head kept from going
// sideways.
TEST(DesignGradient, OfEigenvaluesOnRigidPinsIsExact) {
  std::string text = changed(
      eigenvalues(),
      "[{ on = \"head_pad\", force = [\"load / 10\", 0, \"-thrust\"] }]",
      "[{ on = \"head_pad\", by = \"rigid\", at = [0, 2, 70], "
      "force = [\"load / 10\", 0, \"-thrust\"] }]");
  text = changed(text, "[{ on = \"foot_pad\", fix = \"xyz\" }]",
                 "[{ on = \"foot_pad\", by = \"rigid\", at = [\"thrust / "
                 "500\", 0, \"-foot / 2\"], fix = \"xyz\", fix_rotation = "
                 "\"xz\" },\n"
                 "  { on = \"head_pad\", by = \"rigid\", at = [0, 2, 70], fix "
                 "= \"x\" }]");
  expect_exact(text, VectorX::Zero(2));
  expect_exact(text, Eigen::Vector2d(0.3, 50.0));
}

TEST(DesignGradient, OfFactorsOfTheSecondLoadCaseIsExact) {
  std::string text =
      changed(eigenvalues(), "[load_cases.service]",
              "[load_cases.first]\n"
              "supports = [{ on = \"foot_pad\", fix = \"xyz\" }]\n"
              "loads = [{ on = \"head_pad\", force = [0, \"thrust\", 0] }]\n\n"
              "[load_cases.service]");
  text = changed(text, "kind = \"buckling_factor\"\n\n",
                 "kind = \"buckling_factor\"\nload_case = \"service\"\n\n");
  expect_exact(text, VectorX::Zero(2));
}

// One for the stress's dependence on displacements, whatever the cluster.
TEST(DesignGradient, OfABucklingFactorCostsOneSolve) {
  EXPECT_EQ(differentiated({"stable"}).by.solves, 1);
  EXPECT_EQ(differentiated({"second"}).by.solves, 1);
  EXPECT_EQ(differentiated({"hum", "ring"}).by.solves, 0);
}

TEST(DesignGradient, OfEigenvaluesHasTheSameBitsOnOneAndTwoThreads) {
  const auto run = [](int threads) {
    omp_set_num_threads(threads);
    return differentiated({"stable", "second", "hum", "ring"});
  };
  const int before = omp_get_max_threads();
  const Differentiated one = run(1);
  const Differentiated two = run(2);
  omp_set_num_threads(before);
  EXPECT_TRUE(one.responses == two.responses);
  EXPECT_TRUE(one.by.jacobian == two.by.jacobian);
}

TEST(DesignGradient, IsExactAwayFromTheFrozenDesign) {
  expect_exact(every_response(), Vec3(1.5, -4.0, 0.07));
}

TEST(DesignGradient, IsExactUnderEveryKindOfLoad) {
  std::string text = changed(
      every_response(), "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
      "[{ on = \"head_pad\", force = [\"load\", \"30 * lean\", 0], "
      "at = [\"lean\", 5, 80], moment = [0, 1e4, \"1e3 * fill\"] },\n"
      "  { on = \"skin\", pressure = \"fill + x * lean / 400 + z^2 / 3e3\" },\n"
      "  { on = \"skin\", traction = [\"lean * y / 900\", 0.1, \"x / foot\"] "
      "},\n"
      "  { gravity = [0, \"1e5 * lean\", -9.8e6] },\n"
      "  { spin = \"20 * fill\", at = [\"lean\", 0, 0], axis = [0, 0.1, 1] }]");
  expect_exact(text, VectorX::Zero(3));
}

TEST(DesignGradient, IsExactUnderLoadsOfSeveralSurfaces) {
  expect_exact(
      changed(every_response(),
              "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
              "[{ on = [\"head_pad\", \"skin\"], force = [\"load\", \"30 * "
              "lean\", 0], at = [\"lean\", 5, 80], moment = [0, 1e4, 0] },\n"
              "  { on = [\"head_pad\", \"skin\"], force = [0, \"load * fill\", "
              "0] }]"),
      Vec3(1.5, -4.0, 0.07));
}

TEST(DesignGradient, IsExactUnderRigidPins) {
  std::string text = changed(
      every_response(), "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
      "[{ on = \"head_pad\", by = \"rigid\", force = [\"load\", \"30 * lean\", "
      "0], at = [\"lean\", 5, 80], moment = [0, 1e4, \"1e3 * fill\"] },\n"
      "  { gravity = [0, \"1e5 * lean\", -9.8e6] }]");
  text =
      changed(text, "[{ on = \"foot_pad\", fix = \"xyz\" }]",
              "[{ on = \"foot_pad\", by = \"rigid\", at = [\"lean\", 0, "
              "\"-foot\"], fix = \"xyz\", fix_rotation = \"xyz\", rotation = "
              "[\"lean / 1e4\", \"2e-4 * fill\", 0], displacement = [0, "
              "\"lean / 100\", 0] }]");
  expect_exact(text, Vec3(1.5, -4.0, 0.07));
}

TEST(DesignGradient, IsExactWhereAFilmSlidesAtAnAngleThatFollowsTheDesign) {
  std::string text =
      changed(every_response(), "radius = \"foot\"", "radius = 22");
  text = changed(text, "kind = \"cap\"\ncurve = \"base\"",
                 "kind = \"wetted\"\ncurve = \"base\"\nat = [9, 0, 0]\n"
                 "normal = [0, 0, 2]\n"
                 "contact_angle = \"(72 + foot / 2) * deg\"");
  expect_exact(text, VectorX::Zero(3));
  expect_exact(text, Vec3(1.5, -4.0, 0.07));
}

TEST(DesignGradient, IsExactUnderBearingForces) {
  const std::string text = changed(
      every_response(), "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
      "[{ on = \"skin\", by = \"bearing\", force = [\"load\", \"30 * lean\", "
      "\"-10 * lean\"] },\n"
      "  { on = \"skin\", by = \"bearing\", force = [\"-load * fill\", 0, "
      "0], at = [\"lean / 2\", 0, \"28 + lean\"], axis = [\"lean / 100\", 0, "
      "1] }]");
  expect_exact(text, VectorX::Zero(3));
}

TEST(DesignGradient, IsExactUnderEnforcedDisplacements) {
  const std::string text =
      changed(every_response(), "[{ on = \"foot_pad\", fix = \"xyz\" }]",
              "[{ on = \"foot_pad\", fix = \"xyz\", displacement = "
              "[\"lean / 300\", \"fill / 100\", 0], axes = [[1, 0.2, 0], [0, "
              "1, 0.3]] },\n"
              "  { on = \"head_pad\", fix = \"z\", displacement = [0, 0, "
              "\"(lean - 3) / 50\"] }]");
  expect_exact(text, VectorX::Zero(3));  // where one is 0, but moves
  expect_exact(text, Vec3(1.5, -4.0, 0.07));
}

TEST(DesignGradient, IsExactWhereMaterialsFollowTheDesign) {
  std::string text = changed(
      every_response(), "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
      "[{ on = \"head_pad\", force = [\"load\", \"30 * lean\", 0] },\n"
      "  { gravity = [0, 1e6, -9.8e6] },\n"
      "  { spin = 20, at = [0, 0, 0], axis = [0, 0.1, 1] },\n"
      "  { temperature = \"20 + z * fill / 4\", reference = 15 }]");
  text = changed(text, "youngs_modulus = 71700.0",
                 "youngs_modulus = \"7e4 + 400 * lean * fill\"\n"
                 "thermal_expansion = 2.3e-6");
  text = changed(text, "density = 2.8e-9", "density = \"2.8e-9 * fill^2\"");
  expect_exact(text, Vec3(0.5, 1.0, 0.03));
}

TEST(DesignGradient, IsExactWhereWeightsAndRegionsFollowTheDesign) {
  std::string text = changed(every_response(), "(x - 3) / 20 + y^2 / 400",
                             "(x - lean) / 20 + fill * y^2 / 400");
  text = changed(text, "foot_at = 30.0", "foot_at = \"30.0 + lean / 3\"");
  text = changed(text, "28 - sqrt(x^2", "28 * fill - sqrt(x^2");
  expect_exact(text, Vec3(0.5, 1.0, 0.03));
}

TEST(DesignGradient, HasTheSameBitsInAnotherOrderOfDesigns) {
  const case_data::Case input = case_of(every_response());
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const VectorX a = case_data::initial_design(input);
  const VectorX b = a + Vec3(1.0, 2.0, 0.05);
  const std::vector<int> wanted = {0, 3, 8};
  const auto gradient_at = [&](const VectorX& design) {
    forward::EvaluationFields fields;
    forward::AdjointState adjoint;
    const forward::Evaluation there = model.evaluate(design, &fields, &adjoint);
    EXPECT_FALSE(there.failure);
    return model.gradient(there, fields, adjoint, wanted).jacobian;
  };
  const Eigen::MatrixXd first = gradient_at(a);
  gradient_at(b);
  EXPECT_EQ(first, gradient_at(a));
}

/// What the gradient of an expression asks for.
struct ExpressionCost {
  long long weights = 0;  // evaluations of a response's weight, at a place each
  double operations = 0.0;
  int solves = 0;
};

/// Of a part of 200 points whose radii are so many design variables: 2 % away
/// from the frozen design, the same part for any number.
ExpressionCost expression_cost(int variables) {
  std::string text = rim_case(200, variables, 30.0);
  text = changed(text, "direction = [1, 0, 0]",
                 "direction = [1, 0, 0]\nweight = \"1 + x / 100\"");
  text = changed(text, "[study]",
                 "[responses.price]\nkind = \"expression\"\n"
                 "value = \"1e6 * mass + sqr(sway) / (1 + r0 / 100)\"\n\n"
                 "[responses.dear]\nkind = \"expression\"\n"
                 "value = \"price * mass\"\n\n[study]");
  const case_data::Case input = case_of(text);
  const forward::ForwardModel model(input);
  forward::EvaluationFields fields;
  forward::AdjointState adjoint;
  const forward::Evaluation there = model.evaluate(
      1.02 * case_data::initial_design(input), &fields, &adjoint);
  EXPECT_FALSE(there.failure);
  ExpressionCost cost;
  loads::NumberOfPlace& weight = fields.inputs.responses[0].weight;
  weight = [&cost, plain = weight](const Vec3& x) {
    ++cost.weights;
    return plain(x);
  };
  const double before = operations_done();
  const forward::DesignGradient found =
      model.gradient(there, fields, adjoint, {2, 3});
  EXPECT_FALSE(found.failure);
  EXPECT_EQ(found.jacobian.cols(), variables);
  cost.operations = operations_done() - before;
  cost.solves = found.solves;
  return cost;
}

TEST(DesignGradient, OfExpressionsCostsTheSameForOneAnd200Variables) {
  const ExpressionCost one = expression_cost(1);
  EXPECT_GT(one.weights, 0);
  EXPECT_EQ(one.solves, 1);
  for (const int variables : {20, 200}) {
    const ExpressionCost many = expression_cost(variables);
    EXPECT_EQ(many.weights, one.weights) << variables;
    EXPECT_EQ(many.solves, one.solves) << variables;
    EXPECT_NEAR(many.operations, one.operations, 1e-3 * one.operations)
        << variables;
  }
}

TEST(DesignGradient, PeaksAreLeftOutByName) {
  const case_data::Case input =
      case_of(changed(strut(), "[responses.mass]",
                      "[responses.peak]\nkind = "
                      "\"max_von_mises\"\n\n[responses.mass]"));
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, case_data::initial_design(input));
  EXPECT_TRUE(check.report.passed);
  EXPECT_THAT(check.left_out, testing::ElementsAre("peak"));
}

}  // namespace
}  // namespace meniscus::design_gradient_test
