#include "io/deck/deck_reader.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/calculix_inp.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::deck_reader_test {
namespace {

using deck::DeckProcedure;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// Two tetrahedra on one face.
constexpr const char* kModel = R"(*HEADING
two tetrahedra
*NODE, NSET=Nall
1, 0., 0., 0.
2, 10., 0., 0.
3, 0., 10., 0.
4, 0., 0., 1.D+1
7, 10., 10., 10.
*ELEMENT, TYPE=C3D4, ELSET=Eall
1, 1, 2, 3, 4
5, 2, 3, 4, 7
*NSET, NSET=foot
1, 2
*nset, nset = FOOT
3
*NSET, NSET=odd, GENERATE
1, 9, 2
*NSET, NSET=both
odd, foot
*ELSET, ELSET=some
Eall
*SURFACE, NAME=side, TYPE=ELEMENT
1, S1
5, S4
*MATERIAL, NAME=steel
*ELASTIC
210000., 0.3
*DENSITY
7.85e-9
*SOLID SECTION, ELSET=some, MATERIAL=STEEL
)";
constexpr int kModelLines = 30;

/// A step of these lines.
std::string step(const std::string& cards,
                 const std::string& procedure = "*STATIC\n") {
  return "*STEP\n" + procedure + cards + "*END STEP\n";
}

deck::ReadDeck read(const std::string& steps) {
  return deck::read_deck_text(kModel + steps, "deck.inp");
}

std::string refusal(const std::string& text) {
  try {
    deck::read_deck_text(text, "deck.inp");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing refused";
}

double force(const deck::ReadStep& s, int node, int component) {
  return s.nodal_forces.size() == 0 ? 0.0
                                    : s.nodal_forces[3L * node + component];
}

TEST(DeckReader, ReadsTheModel) {
  const deck::ReadDeck d = read(step("*CLOAD\n7, 1, 1.\n"));
  EXPECT_EQ(d.heading, "two tetrahedra");
  EXPECT_EQ(d.mesh.order, 1);
  EXPECT_THAT(d.node_numbers, ElementsAre(1, 2, 3, 4, 7));
  EXPECT_THAT(d.element_numbers, ElementsAre(1, 5));
  EXPECT_EQ(d.mesh.nodes[3], Vec3(0, 0, 10));
  EXPECT_THAT(d.mesh.elements, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
  EXPECT_EQ(d.mesh.face_count(), 6);
  ASSERT_EQ(d.materials.size(), 1U);
  EXPECT_EQ(d.materials[0].youngs_modulus, 210000.0);
  EXPECT_EQ(d.materials[0].density, 7.85e-9);
  EXPECT_EQ(d.place_of_element(1), "deck.inp:11");
}

TEST(DeckReader, FacesAreOutwardAndLabelled) {
  const TetMesh mesh = read(step("*CLOAD\n7, 1, 1.\n")).mesh;
  Vec3 sum = Vec3::Zero();
  double flux = 0.0;  // three times the volume
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto ids = mesh.face(f);
    const Vec3 a = mesh.nodes[ids[0]];
    const Vec3 normal =
        0.5 * (mesh.nodes[ids[1]] - a).cross(mesh.nodes[ids[2]] - a);
    sum += normal;
    flux += normal.dot(a);
  }
  EXPECT_LT(sum.norm(), 1e-12 * 100.0);
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    volume += corner_volume(mesh, e);
  }
  EXPECT_NEAR(flux, 3.0 * volume, 1e-12 * flux);
  std::vector<int> labelled(mesh.labels.size(), 0);
  for (const int label : mesh.face_label) {
    ++labelled[label];
  }
  EXPECT_EQ(labelled[mesh.label_of("SIDE")], 2);
  // The set of all nodes names no face; that of 1, 2 and 3 has none left; 2, 3
  // and 7 are in BOTH.
  EXPECT_EQ(mesh.label_of("NALL"), -1);
  EXPECT_EQ(mesh.label_of("FOOT"), -1);
  EXPECT_EQ(labelled[mesh.label_of("BOTH")], 1);
  EXPECT_EQ(labelled[mesh.label_of("outside")], 3);
}

TEST(DeckReader, SetsGrowAndHoldSets) {
  const deck::ReadDeck d =
      read(step("*BOUNDARY\nFoot, 1\nboth, 3, 3, 0.\n*CLOAD\n7, 1, 1.\n"));
  std::vector<int> along_x;
  std::vector<int> along_z;
  for (const deck::ReadHold& hold : d.steps[0].holds) {
    (hold.direction == Vec3::UnitX() ? along_x : along_z).push_back(hold.node);
  }
  EXPECT_THAT(along_x, ElementsAre(0, 1, 2));
  EXPECT_THAT(along_z, ElementsAre(0, 1, 2, 4));  // 1, 2, 3 and 7
}

TEST(DeckReader, LoadsAddUpInAStepAndAreReplacedByTheNext) {
  const deck::ReadDeck d =
      read("*BOUNDARY\nFOOT, 1, 3\n" +
           step("*CLOAD\n7, 1, 1.\n7, 1, 2.\n4, 2, 5.\n"
                "*DLOAD\n1, P1, 2.\nEALL, GRAV, 9., 0, 0, -2.\n") +
           step("*CLOAD\n7, 1, 10.\n*DSLOAD\nside, P, 4.\nSide, p, 1.\n"
                "*DLOAD\nEALL, GRAV, 3., 0, 0, -1.\n") +
           step("*CLOAD, OP=NEW\n7, 2, 1.\n*DLOAD, OP=NEW\n"
                "*BOUNDARY, OP=NEW\n1, 1, 3\n"));
  ASSERT_EQ(d.steps.size(), 3U);
  EXPECT_EQ(force(d.steps[0], 4, 0), 3.0);
  EXPECT_EQ(force(d.steps[1], 4, 0), 10.0);
  EXPECT_EQ(force(d.steps[1], 3, 1), 5.0);
  EXPECT_EQ(force(d.steps[2], 4, 0), 0.0);
  EXPECT_EQ(force(d.steps[2], 4, 1), 1.0);
  ASSERT_EQ(d.steps[0].pressures.size(), 1U);
  EXPECT_EQ(d.steps[0].pressures[0].opposite_corner, 3);
  ASSERT_EQ(d.steps[1].pressures.size(), 2U);  // P1 is a face of the surface
  EXPECT_EQ(d.steps[1].pressures[0].pressure, 5.0);
  EXPECT_EQ(d.steps[1].pressures[1].opposite_corner, 1);
  EXPECT_EQ(d.steps[0].body_loads[0].gravity, Vec3(0, 0, -9));
  EXPECT_EQ(d.steps[1].body_loads[0].gravity, Vec3(0, 0, -3));
  EXPECT_TRUE(d.steps[2].pressures.empty());
  EXPECT_TRUE(d.steps[2].body_loads.empty());
  EXPECT_EQ(d.steps[1].holds.size(), 9U);
  EXPECT_EQ(d.steps[2].holds.size(), 3U);
}

// CalculiX counts *DLOAD and *DSLOAD as one; the first card's OP holds.
TEST(DeckReader, OnlyTheFirstCardOfAStepClears) {
  const deck::ReadDeck d =
      read(step("*DLOAD, OP=NEW\n1, P1, 2.\n*DSLOAD, OP=NEW\nside, P, 1.\n"
                "*CLOAD\n7, 1, 1.\n*CLOAD, OP=NEW\n7, 2, 1.\n"));
  EXPECT_EQ(d.steps[0].pressures[0].pressure, 3.0);
  EXPECT_EQ(force(d.steps[0], 4, 0), 1.0);
}

TEST(DeckReader, ModesClearTheLoadsOfEarlierSteps) {
  const deck::ReadDeck d = read(
      step("*CLOAD\n7, 1, 1.\n") + step("*CLOAD\n4, 1, 8.\n", "*BUCKLE\n3\n") +
      step("") + step("", "*FREQUENCY\n5\n") + step("*CLOAD\n7, 3, 1.\n"));
  EXPECT_EQ(d.steps[1].procedure, DeckProcedure::Buckling);
  EXPECT_EQ(d.steps[1].modes, 3);
  EXPECT_EQ(force(d.steps[1], 4, 0), 0.0);
  EXPECT_EQ(force(d.steps[1], 3, 0), 8.0);
  EXPECT_EQ(force(d.steps[2], 3, 0), 8.0);
  EXPECT_EQ(d.steps[3].procedure, DeckProcedure::Frequency);
  EXPECT_EQ(force(d.steps[4], 3, 0), 0.0);
}

TEST(DeckReader, StepsHaveNames) {
  const deck::ReadDeck d = read(
      "*STEP, NAME=Pull it\n*STATIC\n*CLOAD\n7, 1, 1.\n*END STEP\n"
      "** load case 'push'\n*STEP\n*STATIC\n*END STEP\n" +
      step(""));
  EXPECT_EQ(d.steps[0].name, "Pull it");
  EXPECT_EQ(d.steps[1].name, "push");
  EXPECT_EQ(d.steps[2].name, "step_3");
  EXPECT_EQ(d.steps[0].place, fmt::format("deck.inp:{}", kModelLines + 1));
}

TEST(DeckReader, OutputIsNotNeeded) {
  const deck::ReadDeck d =
      read(step("*CLOAD\n7, 1, 1.\n*NODE FILE\nU\n*EL PRINT, ELSET=EALL\nS\n"));
  EXPECT_THAT(d.not_needed, ElementsAre("*NODE FILE (deck.inp:35)",
                                        "*EL PRINT "
                                        "(deck.inp:37)"));
}

TEST(DeckReader, KeywordLinesAndElementsGoOn) {
  std::string text = kModel;
  text.replace(text.find("TYPE=C3D4, "), 11, "TYPE=C3D4,\n ");
  text.replace(text.find("1, 1, 2, 3, 4"), 13, "1, 1,\n2, 3, 4");
  const deck::ReadDeck d =
      deck::read_deck_text(text + step("*CLOAD\n7, 1, 1.\n"), "deck.inp");
  EXPECT_EQ(d.mesh.element_count(), 2);
}

TEST(DeckReader, FilesAreIncludedWhereTheyStand) {
  const TempFolder folder;
  const std::string text = kModel;
  const std::size_t first = text.find("2, 10.");
  const std::size_t last = text.find("*ELEMENT");
  write_file(folder / "nodes.txt", text.substr(first, last - first));
  write_file(folder / "deck.inp",
             text.substr(0, first) + "*INCLUDE, INPUT=nodes.txt\n" +
                 text.substr(last) + step("*CLOAD\n7, 1, 1.\n"));
  EXPECT_EQ(deck::read_deck(folder / "deck.inp").mesh.nodes.size(), 5U);
  write_file(folder / "deck.inp", "*INCLUDE, INPUT=deck.inp\n");
  EXPECT_THROW(deck::read_deck(folder / "deck.inp"), InvalidInput);
  write_file(folder / "deck.inp", "*INCLUDE, INPUT=nowhere.txt\n");
  EXPECT_THROW(deck::read_deck(folder / "deck.inp"), InvalidInput);
}

TEST(DeckReader, TemperaturesAreChanges) {
  const deck::ReadDeck d =
      read("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 20.\n" +
           step("*TEMPERATURE\nNALL, 20.\n7, 50.\n") +
           step("*TEMPERATURE\n7, 20.\n*CLOAD\n7, 1, 1.\n"));
  EXPECT_EQ(d.steps[0].temperature_change[4], 30.0);
  EXPECT_EQ(d.steps[0].temperature_change[0], 0.0);
  EXPECT_EQ(d.steps[1].temperature_change.size(), 0);
}

/// A grounded spring as our own decks have it: node 90 feels -d + g + u = 0.
std::string with_spring(const std::string& ground) {
  return "*NODE, NSET=LOOSE\n90, 0, 0, 0\n"
         "*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS\n9, 90\n"
         "*SPRING, ELSET=SPRINGS\n1\n50.\n"
         "*EQUATION\n4\n90, 1, -1., 90, 2, 1., 7, 3, 0.5\n4, 3, 0.25\n"
         "*EQUATION\n2\n1, 1, 0.6, 1, 2, 0.8\n" +
         step("*BOUNDARY\nFOOT, 3, 3\n" + ground + "*CLOAD\n7, 1, 1.\n");
}

TEST(DeckReader, SpringsAndObliqueHoldsAsOurOwnDecksHaveThem) {
  const deck::ReadStep s = read(with_spring("LOOSE, 2, 3\n")).steps[0];
  ASSERT_EQ(s.springs.size(), 1U);
  EXPECT_EQ(s.springs[0].stiffness, 50.0);
  EXPECT_THAT(s.springs[0].nodes, ElementsAre(3, 4));
  EXPECT_EQ(s.springs[0].coefficients[0], Vec3(0, 0, 0.25));
  EXPECT_EQ(s.springs[0].coefficients[1], Vec3(0, 0, 0.5));
  ASSERT_EQ(s.holds.size(), 4U);
  EXPECT_LT((s.holds[3].direction - Vec3(0.6, 0.8, 0)).norm(), 1e-15);
  // A ground that is free follows.
  EXPECT_TRUE(read(with_spring("LOOSE, 3, 3\n")).steps[0].springs.empty());
}

struct Refused {
  const char* what;
  std::string text;
  int line;
  const char* says;
};

std::vector<Refused> refused_steps() {
  const int at = kModelLines + 3;  // the first line of a step's cards
  return {{"NodeThatIsNot", "*CLOAD\n8, 1, 1.\n", at + 1, "no node 8"},
          {"SetThatIsNot", "*CLOAD\nfooot, 1, 1.\n", at + 1, "'FOOT'"},
          {"Component", "*CLOAD\n7, 4, 1.\n", at + 1, "component '4'"},
          {"NotANumber", "*CLOAD\n7, 1, nan\n", at + 1, "no finite number"},
          {"Amplitude", "*CLOAD, AMPLITUDE=A\n7, 1, 1.\n", at, "AMPLITUDE"},
          {"Enforced", "*BOUNDARY\n7, 1, 1, x\n", at + 1, "displacement"},
          {"FaceFive", "*DLOAD\n1, P5, 1.\n", at + 1, "P1 to P4"},
          {"NoElement", "*DLOAD\n2, P1, 1.\n", at + 1, "no element 2"},
          {"NoSurface", "*DSLOAD\nlid, P, 1.\n", at + 1, "no surface 'lid'"},
          {"GravityNowhere", "*DLOAD\nEALL, GRAV, 1., 0, 0, 0\n", at + 1,
           "no length"},
          {"Contact", "*CONTACT PAIR\n", at, "common nodes"},
          {"Model", "*NODE\n9, 0, 0, 0\n", at, "before the first *STEP"},
          {"Temperature", "*TEMPERATURE\n7, 50.\n", at - 2, "INITIAL"}};
}

TEST(DeckReader, RefusesByLineWhatAStepCannotHave) {
  for (const Refused& refused : refused_steps()) {
    SCOPED_TRACE(refused.what);
    EXPECT_THAT(refusal(kModel + step(refused.text)),
                AllOf(HasSubstr(fmt::format("deck.inp:{}:", refused.line)),
                      HasSubstr(refused.says)));
  }
}

/// The model with one text for another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = kModel;
  text.replace(text.find(from), from.size(), to);
  return text + step("*CLOAD\n7, 1, 1.\n");
}

TEST(DeckReader, RefusesByLineWhatAModelCannotHave) {
  const std::vector<Refused> all = {
      {"Twice", changed("7, 10., 10., 10.", "4, 1., 1., 1."), 8,
       "node 4 is there already"},
      {"NoSuchNode", changed("4, 7", "4, 8"), 11, "names node 8"},
      {"NodeTwice", changed("3, 4, 7", "3, 3, 7"), 11, "node 3 twice"},
      {"InsideOut", changed("1, 1, 2, 3, 4", "1, 2, 1, 3, 4"), 10, "volume"},
      {"Coordinate", changed("10., 10., 10.", "10., inf, 10."), 8, "no node"},
      {"Hexahedra", changed("C3D4", "C3D8"), 9, "C3D4 or C3D10"},
      {"TooFew", changed("5, 2, 3, 4, 7", "5, 2, 3, 4"), 11, "has 3 nodes"},
      {"NoSection", changed("ELSET=some, MATERIAL", "ELSET=foot, MATERIAL"), 30,
       "no element set"},
      {"NoMaterial", changed("MATERIAL=STEEL", "MATERIAL=IRON"), 30,
       "no material 'IRON'"},
      {"TwoTemperatures",
       changed("210000., 0.3\n",
               "210000., 0.3, 20.\n"
               "200000., 0.3, 90.\n"),
       26, "temperature"},
      {"Plastic", changed("*DENSITY", "*PLASTIC"), 28, "elastic"},
      {"Parts", changed("*NODE, NSET=Nall", "*PART, NAME=p"), 3,
       "without parts"},
      {"Text", "hello\n", 1, "before the first keyword"},
      {"Nothing", "", 1, "no keyword"},
      {"Bytes", std::string("*NODE\n\0\n", 8), 2, "byte 0"},
      {"NoEnd", std::string(kModel) + "*STEP\n*STATIC\n", kModelLines + 1,
       "*END STEP"},
      {"NoStep", kModel, 1, "no *STEP"},
      {"NonLinear", std::string(kModel) + "*STEP, NLGEOM\n*STATIC\n*END STEP\n",
       kModelLines + 1, "NLGEOM"},
      {"Preload",
       kModel + step("*CLOAD\n7, 1, 1.\n") +
           "*STEP, PERTURBATION\n*FREQUENCY\n3\n*END STEP\n",
       kModelLines + 7, "preload"}};
  for (const Refused& refused : all) {
    SCOPED_TRACE(refused.what);
    EXPECT_THAT(refusal(refused.text),
                AllOf(HasSubstr(fmt::format("deck.inp:{}:", refused.line)),
                      HasSubstr(refused.says)));
  }
}

// Every cut of a deck is read or refused; nothing else.
TEST(DeckReader, CutDecksAreReadOrRefused) {
  const std::string whole =
      kModel + with_spring("LOOSE, 2, 3\n") +
      step("*DLOAD\nEALL, CENTRIF, 2., 0, 0, 0, 0, 0, 1.\n") +
      step("", "*FREQUENCY\n2\n");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      deck::read_deck_text(whole.substr(0, size), "cut.inp");
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("cut.inp:"));
    }
  }
}

// Sets that hold each other twice over would double without end.
TEST(DeckReader, SetsOfSetsDoNotGrowWithoutBound) {
  std::string sets = "*NSET, NSET=S0\n";
  for (int k = 1; k < 4000; k += 2) {
    sets += fmt::format("{}\n", k);
  }
  for (int k = 1; k <= 20000; ++k) {
    sets += fmt::format("*NSET, NSET=S{0}\nS{1}, S{1}\n", k, k - 1);
  }
  EXPECT_THAT(refusal(kModel + sets), HasSubstr("sets of sets"));
}

// What our own writer writes: the mesh node by node.
TEST(DeckReader, OurOwnDeckComesBack) {
  for (const int order : {1, 2}) {
    TetMesh mesh = shapes::brick(Vec3(20, 30, 40), 2, 3, 4);
    if (order == 2) {
      mesh = shapes::straight_quadratic(mesh);
    }
    io::CalculixDeck written;
    written.materials = {{"aluminium", 71700.0, 0.33, 2.8e-9}};
    io::DeckStep press{"press", {{"z0", {}, true, true, true}}, {}, {}};
    press.pressures = {{"z1", 3.0}};
    press.spin = io::DeckSpin{Vec3(1, 2, 3), Vec3(0, 3, 0), 2.5};
    written.steps = {press};
    const deck::ReadDeck d =
        deck::read_deck_text(io::calculix_deck(mesh, written), "own.inp");
    EXPECT_EQ(d.mesh.elements, mesh.elements);
    EXPECT_EQ(d.mesh.nodes, mesh.nodes);
    EXPECT_EQ(d.mesh.face_count(), mesh.face_count());
    EXPECT_EQ(d.steps[0].name, "press");
    std::size_t pressed = 0;
    for (const int label : mesh.face_label) {
      pressed += label == mesh.label_of("z1") ? 1U : 0U;
    }
    EXPECT_EQ(d.steps[0].pressures.size(), pressed);
    const std::optional<io::DeckSpin>& spin = d.steps[0].body_loads[0].spin;
    ASSERT_TRUE(spin);
    EXPECT_NEAR(spin->rate, 2.5, 1e-11);
    EXPECT_EQ(spin->axis, Vec3::UnitY());
    // The sides' node sets name the faces.
    for (int f = 0; f < d.mesh.face_count(); ++f) {
      const std::string& name = d.mesh.labels[d.mesh.face_label[f]];
      EXPECT_THAT(name, testing::AnyOf("X0", "X1", "Y0", "Y1", "Z0", "Z1"));
    }
  }
}

}  // namespace
}  // namespace meniscus::deck_reader_test
