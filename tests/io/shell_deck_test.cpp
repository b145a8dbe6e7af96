#include "io/shell_deck/shell_deck.h"

#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/shell_deck/calculix_shells.h"
#include "io/shell_deck/nastran_shells.h"

namespace meniscus::shell_deck {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Two facets that share the side from 1 to 2, held along x = 0.
ShellDeck square() {
  ShellDeck deck;
  deck.nodes = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {1, 0, 0},
                {1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {1, 2, 0}};
  deck.facets = {{0, 1, 2, 4, 5, 6}, {1, 3, 2, 7, 8, 5}};
  deck.section = {0, 1};
  deck.thickness = {{1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}};
  const io::DeckMaterial steel{"steel", 210e3, 0.3, 7.85e-9};
  deck.sections = {{"one", {{steel}}, 0.0}, {"two", {{steel}}, 0.5}};
  deck.sets = {{"plate/rim:root", {0, 2, 6}}};
  deck.steps = {{"pull", {{{0, 2, 6}, {true, true, true}}}}};
  deck.steps[0].nodal_forces = VectorX::Zero(54);
  deck.steps[0].nodal_forces[18] = 3.0;  // node 4 along x
  return deck;
}

std::string error_of(const ShellDeck& deck) {
  try {
    calculix_shell_deck(deck);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

// The wall lies over node 4 by half: a force along x has a moment about y.
TEST(ShellDeckTest, ForcesBesideTheWallHaveMoments) {
  const std::string text = calculix_shell_deck(square());
  EXPECT_THAT(text, HasSubstr("OFFSET=-0.5"));
  EXPECT_THAT(text, HasSubstr("*NSET, NSET=AXES_0\n4\n*TRANSFORM"));
  // Frame: z, then x and y turned about it; the moment is 3 x 0.5 in size.
  const std::size_t at = text.find("*CLOAD, OP=NEW\n") + 15;
  double force = 0.0;
  double moment = 0.0;
  std::istringstream lines(text.substr(at, text.find("*DLOAD") - at));
  int node = 0;
  int component = 0;
  double value = 0.0;
  char comma = 0;
  while (lines >> node >> comma >> component >> comma >> value) {
    EXPECT_EQ(node, 4);
    (component <= 3 ? force : moment) += value * value;
  }
  EXPECT_NEAR(force, 9.0, 1e-11);
  EXPECT_NEAR(moment, 2.25, 1e-11);
}

TEST(ShellDeckTest, MomentsActAtNodes) {
  ShellDeck deck = square();
  deck.steps[0].nodal_forces.setZero();
  deck.steps[0].nodal_forces[18 + 4] = 7.0;  // node 4 about y
  EXPECT_THAT(nastran_shell_bdf(deck), HasSubstr("MOMENT*"));
  EXPECT_THAT(nastran_shell_bdf(deck), Not(HasSubstr("FORCE*")));
  const std::string text = calculix_shell_deck(deck);
  const std::size_t at = text.find("*CLOAD, OP=NEW\n") + 15;
  EXPECT_THAT(text.substr(at, text.find("*DLOAD") - at), HasSubstr("7.0"));
}

TEST(ShellDeckTest, ZoffsIsALength) {
  ShellDeck deck = square();
  deck.thickness[1].fill(4.0);
  EXPECT_THAT(
      nastran_shell_bdf(deck),
      HasSubstr("CTRIA6*                2               2               2"
                "               4\n"
                "*                      3               8               9"
                "               6\n"
                "*                                     2.\n"));
}

TEST(ShellDeckTest, OneFrameANode) {
  ShellDeck deck = square();
  DeckShellSupport slide{{2}, {true}};
  Mat3 turned;
  turned << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1;
  slide.axes = turned;
  deck.steps[0].supports.push_back(slide);
  deck.steps.push_back({"other", {{{2}, {true}}}});
  EXPECT_EQ(error_of(deck), "");  // held altogether besides
  deck.steps[0].supports[0].nodes = {0, 6};
  EXPECT_THAT(error_of(deck), HasSubstr("load case 'other' holds node 3"));
}

// CalculiX has no rotation about the normal z: what is held beside it.
TEST(ShellDeckTest, RotationsInPartAreHeldAboutTangents) {
  const auto held = [](std::array<bool, 6> fixed) {
    ShellDeck deck = square();
    deck.sections[1].offset = 0.0;
    deck.steps[0].supports = {{{2}, fixed}};
    const std::string text = calculix_shell_deck(deck);
    const std::size_t at = text.find("*BOUNDARY, OP=NEW\n") + 18;
    return text.substr(at, text.find("*CLOAD") - at);
  };
  EXPECT_EQ(held({true, false, false, false, true, true}),
            "3, 2, 2\n3, 4, 4\n");  // about y, the first axis of its frame
  EXPECT_EQ(held({false, false, false, true, true, false}),
            "3, 4, 4\n3, 5, 5\n");
  EXPECT_EQ(held({true, true, true, false, false, true}),
            "3, 1, 1\n3, 2, 2\n3, 3, 3\n");
  EXPECT_EQ(held({false, false, false, true, true, true}),
            "3, 4, 4\n3, 5, 5\n3, 6, 6\n");
}

TEST(ShellDeckTest, OneThicknessANode) {
  ShellDeck deck = square();
  deck.thickness[0] = {1, 2, 3, 1.5, 2.5, 2};
  EXPECT_EQ(error_of(deck), "");  // the other has one for all
  deck.thickness[1] = {2, 2, 4, 2, 3, 3};
  EXPECT_THAT(error_of(deck), HasSubstr("thicknesses 3 and 4 meet at (0, 2,"));
}

TEST(ShellDeckTest, WhatDoesNotFitIsNamed) {
  ShellDeck deck = square();
  deck.facets[1][3] = 9;
  EXPECT_THAT(error_of(deck), HasSubstr("facet 1 of the deck has node 9 of 9"));
  deck = square();
  deck.section[0] = 2;
  EXPECT_THAT(error_of(deck), HasSubstr("facet 0 of the deck has section 2"));
  deck = square();
  deck.steps[0].supports.clear();
  EXPECT_THAT(error_of(deck), HasSubstr("'pull' of the deck has no support"));
}

/// By the quick reference: PCOMP has PID, Z0 and a MID, T, THETA, SOUT each
/// ply; MAT8 E1, E2, NU12, G12, G1Z, G2Z.
TEST(ShellDeck, LayersAreThoseOfNastran) {
  ShellDeck deck = square();
  io::DeckMaterial carbon{"carbon"};
  carbon.orthotropic = io::DeckOrthotropic{
      {135e3, 10e3, 9e3}, {0.3, 0.31, 0.45}, {5e3, 4e3, 3e3}};
  deck.sections[1].plies = {{carbon, 0.25, 0.5},
                            {deck.sections[0].plies[0].material, 0.75}};
  deck.sections[1].direction = Vec3(0.0, 2.0, 0.0);
  const std::string text = nastran_shell_bdf(deck);
  EXPECT_THAT(text, HasSubstr("PCOMP"));
  EXPECT_THAT(text, HasSubstr("MAT8"));
  EXPECT_THAT(text, HasSubstr("28.6478"));  // 0.5 rad
  EXPECT_THAT(error_of(deck), HasSubstr("'two' is orthotropic or of layers"));
  deck.thickness[1] = {1, 2, 1, 1, 1, 1};
  EXPECT_THROW(nastran_shell_bdf(deck), InvalidInput);
  deck = square();
  deck.sections[1].plies[0].material = carbon;
  EXPECT_THAT(error_of(deck), HasSubstr("no direction"));
  deck.sections[1].plies.clear();
  EXPECT_THAT(error_of(deck), HasSubstr("has no ply"));
}

}  // namespace
}  // namespace meniscus::shell_deck
