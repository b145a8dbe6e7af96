/// Two bodies of their own materials that share a plate.
#include <algorithm>

#include <gtest/gtest.h>

#include "pipeline/forward/adaptation.h"
#include "pipeline/forward/forward_model.h"
#include "tests/support/case_text.h"

namespace meniscus::bodies_model_test {
namespace {

/// The strut cut at half its height.
std::string cut_strut() {
  std::string text = changed(strut(), "fea = 6.0\nfilm = 3.0", "fea = 10.0");
  text = changed(text, "[curves.head]",
                 "[curves.waist]\nkind = \"circle\"\ncenter = [0, 0, 30]\n"
                 "normal = [0, 0, 1]\nradius = 19\n\n[curves.head]");
  text = changed(text,
                 "[films.skin]\nkind = \"branch\"\n"
                 "curves = [\"base\", \"head\"]",
                 "[films.lower]\nkind = \"loft\"\ncurves = [\"base\", "
                 "\"waist\"]\n\n[films.upper]\nkind = \"loft\"\n"
                 "curves = [\"waist\", \"head\"]\n\n[solids.plate]\n"
                 "kind = \"cap\"\ncurve = \"waist\"");
  text = changed(text,
                 "[bodies.part]\nenclosed_by = [\"skin\", \"foot_pad\", "
                 "\"head_pad\"]\nvolume = 9e4\nmaterial = \"aluminium\"",
                 "[bodies.foot]\nenclosed_by = [\"lower\", \"foot_pad\", "
                 "\"plate\"]\nvolume = 4.2e4\nmaterial = \"alloy\"\n\n"
                 "[bodies.neck]\nenclosed_by = [\"upper\", \"plate\", "
                 "\"head_pad\"]\nvolume = 3.6e4\nmaterial = \"aluminium\"");
  text = changed(text, "[\"load\", 0, 0]", "[0, 0, \"-load\"]");
  text = changed(text, "direction = [1, 0, 0]", "direction = [0, 0, -1]");
  text =
      changed(text, "targets = { sway = 0.01 }", "targets = { sway = 0.001 }");
  return text + R"(
[materials.alloy]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 8e-9

[responses.plate_sinks]
kind = "mean_displacement"
on = "plate"
direction = [0, 0, -1]
)";
}

struct Cut {
  forward::Evaluation evaluation;
  forward::EvaluationFields fields;
};

Cut evaluated(const std::string& text) {
  const reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_TRUE(reading.problems.empty()) << reading.problems.front();
  const forward::ForwardModel model(*reading.input);
  EXPECT_FALSE(model.failure()) << model.failure()->message;
  Cut cut;
  cut.evaluation =
      model.evaluate(case_data::initial_design(*reading.input), &cut.fields);
  EXPECT_FALSE(cut.evaluation.failure);
  return cut;
}

TEST(Bodies, FillTheirOwnRegionsWithTheirOwnMaterials) {
  const Cut cut = evaluated(cut_strut());
  std::array<double, 2> volume{};
  for (int e = 0; e < cut.fields.mesh.element_count(); ++e) {
    volume.at(cut.fields.mesh.element_region[e]) +=
        corner_volume(cut.fields.mesh, e);
  }
  const auto& bodies = cut.evaluation.film.bodies;
  constexpr double kFlatFacets = 0.03;  // of the meshed level, films are finer
  EXPECT_NEAR(volume[0] / bodies[0].volume, 1.0, kFlatFacets);
  EXPECT_NEAR(volume[1] / bodies[1].volume, 1.0, kFlatFacets);
  EXPECT_NEAR(bodies[0].volume, 4.2e4, 1e-3);
  EXPECT_NEAR(cut.evaluation.responses[1],
              8e-9 * bodies[0].volume + 2.8e-9 * bodies[1].volume,
              kFlatFacets * cut.evaluation.responses[1]);
}

TEST(Bodies, ASofterFootSinksMoreAndTheNeckOnItDoesNot) {
  const Cut stiff = evaluated(cut_strut());
  const Cut soft = evaluated(
      changed(cut_strut(), "[materials.alloy]\nyoungs_modulus = 71700.0",
              "[materials.alloy]\nyoungs_modulus = 35850.0"));
  const auto& a = stiff.evaluation.responses;
  const auto& b = soft.evaluation.responses;
  constexpr double kAcross = 0.05;  // the plate bends the two a little
  EXPECT_NEAR(b[2] / a[2], 2.0, 2.0 * kAcross);
  EXPECT_NEAR((b[0] - b[2]) / (a[0] - a[2]), 1.0, kAcross);
}

TEST(Bodies, FollowTheDesignOnOneMesh) {
  const reader::CaseReading reading =
      reader::read_case_text(cut_strut(), "case.toml");
  const forward::ForwardModel model(*reading.input);
  const forward::Evaluation moved = model.evaluate(VectorX::Constant(1, 23.0));
  ASSERT_FALSE(moved.failure) << moved.failure->message;
  EXPECT_EQ(moved.tet.elements, model.frozen().tet.elements);
  EXPECT_EQ(model.evaluate(VectorX::Constant(1, 23.0)).responses,
            moved.responses);
}

/// The neck is a chamber of gas; its plate carries the load.
std::string half_void() {
  std::string text =
      changed(cut_strut(), "volume = 3.6e4\nmaterial = \"aluminium\"",
              "volume = 3.6e4\nmaterial = \"void\"");
  text = changed(text, "on = \"head_pad\", force", "on = \"plate\", force");
  text = changed(text, "on = \"head_pad\"\ndirection",
                 "on = \"plate\"\ndirection");
  return text;
}

TEST(Voids, ShapeTheirFilmsAndAreNotMeshed) {
  const Cut cut = evaluated(half_void());
  const Cut both = evaluated(cut_strut());
  const auto& film = cut.evaluation.film;
  ASSERT_EQ(film.bodies.size(), 2U);
  EXPECT_NEAR(film.bodies[1].volume, 3.6e4, 1e-3);
  EXPECT_EQ(film.area, both.evaluation.film.area);
  const auto& region = cut.fields.mesh.element_region;
  EXPECT_EQ(*std::max_element(region.begin(), region.end()), 0);
  EXPECT_LT(cut.evaluation.responses[1], 4.2e4 * 8e-9 * 1.02);
  // The foot is what it was, and so is the load that it bears.
  EXPECT_NEAR(cut.evaluation.responses[2] / both.evaluation.responses[2], 1.0,
              0.05);
  for (const Vec3& x : cut.fields.surface.base.points) {
    EXPECT_LE(x.z(), 30.0 + 1e-9);
  }
  // What is written for printers is closed, and without the void.
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(cut.fields.boundary.facets, edges, facet_edges);
  EXPECT_EQ(2 * edges.size(), 3 * cut.fields.boundary.facets.size());
  EXPECT_NEAR(enclosed_volume(cut.fields.boundary), 4.2e4, 1.0);
}

TEST(Voids, NamedFirstLeaveTheSamePart) {
  // The plate's facets now run out of the void and are turned.
  const std::string text = half_void();
  const std::size_t foot = text.find("[bodies.foot]");
  const std::size_t neck = text.find("[bodies.neck]");
  const std::size_t after = text.find("[resolution]");
  const std::string turned =
      text.substr(0, foot) + text.substr(neck, after - neck) +
      text.substr(foot, neck - foot) + text.substr(after);
  const Cut one = evaluated(text);
  const Cut other = evaluated(turned);
  EXPECT_EQ(other.evaluation.film.bodies[0].name, "neck");
  EXPECT_NEAR(enclosed_volume(other.fields.boundary), 4.2e4, 1.0);
  constexpr double kOtherElements = 0.01;  // the start differs
  EXPECT_NEAR(enclosed_volume(other.fields.surface.base) /
                  enclosed_volume(one.fields.surface.base),
              1.0, kOtherElements);
  EXPECT_NEAR(other.evaluation.responses[2] / one.evaluation.responses[2], 1.0,
              kOtherElements);
}

TEST(Voids, AreLeftOutOfAnAdaptedModelToo) {
  const reader::CaseReading reading = reader::read_case_text(
      half_void() + "[analysis]\nadapt = true\n", "case.toml");
  ASSERT_TRUE(reading.input);
  const forward::ForwardModel model(*reading.input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const forward::Adaptation& round = *model.adaptation();
  EXPECT_LT(round.after.errors.energy, round.before.errors.energy);
}

TEST(Voids, WithBothSolidTheBoundaryHasNoPlate) {
  const Cut cut = evaluated(cut_strut());
  const SurfaceMesh& boundary = cut.fields.boundary;
  EXPECT_EQ(std::count(boundary.facet_label.begin(), boundary.facet_label.end(),
                       boundary.label_of("plate")),
            0);
  EXPECT_NEAR(enclosed_volume(boundary), 7.8e4, 1.0);
}

TEST(Voids, AreRefusedWhereNothingIsLeft) {
  const auto problem = [](const std::string& text) {
    std::string all;
    for (const std::string& one : problems_of(text)) {
      all += one + "\n";
    }
    return all;
  };
  EXPECT_NE(problem(changed(half_void(), "volume = 4.2e4\nmaterial = \"alloy\"",
                            "volume = 4.2e4\nmaterial = \"void\""))
                .find("all bodies are void"),
            std::string::npos);
  EXPECT_NE(problem(changed(half_void(), "on = \"plate\", force",
                            "on = \"head_pad\", force"))
                .find("'head_pad' encloses no material, only voids"),
            std::string::npos);
  EXPECT_NE(
      problem(changed(strut(), "[materials.aluminium]", "[materials.void]"))
          .find("bodies that are void have this name"),
      std::string::npos);
}

}  // namespace
}  // namespace meniscus::bodies_model_test
