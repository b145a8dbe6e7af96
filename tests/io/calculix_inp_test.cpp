#include "io/calculix_inp.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/shapes.h"

namespace meniscus::calculix_inp_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TetMesh brick() {
  return shapes::straight_quadratic(
      shapes::sheared(shapes::brick(Vec3(1e-3, 2e7, 3), 2, 1, 1), 0.1));
}

io::CalculixDeck deck() {
  io::CalculixDeck deck;
  deck.materials = {{"steel", 210000.0, 0.3, 7.85e-9}};
  deck.steps = {{"service", {{"z0", {}, true, true, true}}, {}, {{"z1", 2}}}};
  return deck;
}

io::CalculixDeck on_a_pin() {
  io::CalculixDeck result = deck();
  result.pins = {{.nodes = {0, 1, 2}, .point = Vec3(1.0 / 3.0, -2e-9, 3e7)}};
  result.pins[0].axes << 2.0, -1.0, 2.0, 2.0, 2.0, -1.0, -1.0, 2.0, 2.0;
  result.pins[0].axes /= 3.0;
  result.steps[0].pins = {
      {.fixed = {true, true, true, true, true, true},
       .value = {1e-7 / 3.0, -1e7 / 3.0, 0.0, 1.0, 2.0, 3.0}}};
  return result;
}

io::CalculixDeck on_springs() {
  io::CalculixDeck result = deck();
  result.steps.push_back({"sprung"});
  result.springs = {
      {1e-7 / 3.0, {{{0, 1, 2}, Points(3, Vec3(-1.0, 2e-9, 3e7) / 3.0)}}, {1}}};
  return result;
}

// CalculiX reads 20 characters of every number and 132 of a line.
TEST(CalculixInp, KeepsFieldsAndLinesShort) {
  std::istringstream lines(io::calculix_deck(brick(), on_springs()) +
                           io::calculix_deck(brick(), on_a_pin()));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("*")) {
      continue;
    }
    EXPECT_LE(line.size(), 132u);
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      field.erase(0, field.find_first_not_of(' '));
      EXPECT_LE(field.size(), 20u) << line;
    }
  }
}

TEST(CalculixInp, MakesNamesThatCalculixTakesAndKeepsThemApart) {
  TetMesh mesh = brick();
  mesh.labels = {"left pad", "Left_Pad", "größe", "1st", "z0", "z1"};
  io::CalculixDeck input = deck();
  input.comments = {"title\n*NODE, in a title"};
  const std::string text = io::calculix_deck(mesh, input);
  EXPECT_THAT(text, HasSubstr("*NSET, NSET=LEFT_PAD\n"));
  EXPECT_THAT(text, HasSubstr("*NSET, NSET=LEFT_PAD_2\n"));
  EXPECT_THAT(text, HasSubstr("*NSET, NSET=GR____E\n"));
  EXPECT_THAT(text, HasSubstr("*NSET, NSET=S_1ST\n"));
  EXPECT_THAT(text, HasSubstr("surface 'größe' is NSET GR____E"));
  EXPECT_THAT(text, Not(HasSubstr("\n*NODE, in")));
}

TEST(CalculixInp, IsTheSameEveryTime) {
  EXPECT_EQ(io::calculix_deck(brick(), deck()),
            io::calculix_deck(brick(), deck()));
}

template <class Change>
std::string refusal(const Change& change) {
  io::CalculixDeck input = deck();
  change(input);
  try {
    io::calculix_deck(brick(), input);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(CalculixInp, NamesWhatDoesNotFit) {
  EXPECT_THAT(refusal([](auto& d) { d.steps[0].pressures[0].surface = "lid"; }),
              testing::AllOf(HasSubstr("'lid'"), HasSubstr("x0, x1")));
  EXPECT_THAT(refusal([](auto& d) { d.steps[0].supports[0].surface = "lid"; }),
              HasSubstr("'lid'"));
  EXPECT_THAT(refusal([](auto& d) { d.steps[0].supports.clear(); }),
              HasSubstr("no support"));
  EXPECT_THAT(refusal([](auto& d) {
                d.steps[0].supports[0] = {"", {7777}, true, true, true};
              }),
              HasSubstr("7777"));
  EXPECT_THAT(refusal([](auto& d) {
                d = on_springs();
                d.springs[0].springs[0].nodes[1] = 7777;
              }),
              HasSubstr("spring of set 1"));
  EXPECT_THAT(refusal([](auto& d) {
                d = on_springs();
                d.springs[0].stiffness = 0.0;
              }),
              HasSubstr("stiffness 0"));
  EXPECT_THAT(refusal([](auto& d) { d.materials.clear(); }),
              HasSubstr("0 materials for 1 regions"));
  EXPECT_THAT(refusal([](auto& d) { d.steps[0].nodal_forces.resize(5); }),
              HasSubstr("5 nodal forces"));
}

}  // namespace
}  // namespace meniscus::calculix_inp_test
