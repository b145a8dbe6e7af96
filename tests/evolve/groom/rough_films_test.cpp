#include "evolve/groom/rough_films.h"

#include <gtest/gtest.h>

#include "tests/support/film_complexes.h"
#include "tests/support/film_shapes.h"

namespace meniscus::rough_films_test {
namespace {

constexpr int kAround = 24;
constexpr int kMoved = 5 * kAround + 7;  // a vertex amid the tube

films::FilmComplex even_tube() {
  return shapes::tube(1.0, 2.0, kAround, 8, [](double) { return 1.0; });
}

TEST(RoughFilms, ASmoothFilmIsLeftAlone) {
  films::FilmComplex tube = even_tube();
  const Points before = tube.mesh.points;
  EXPECT_TRUE(groom::rough_vertices(tube).empty());
  for (const groom::EvenOut how :
       {groom::EvenOut::Flips, groom::EvenOut::KeepEdges}) {
    EXPECT_FALSE(groom::even_out(tube, how));
    EXPECT_EQ(tube.mesh.points, before);
  }
}

// Where three films meet they turn by 60 degrees and more, as they should.
TEST(RoughFilms, LinesAreNoFolds) {
  EXPECT_TRUE(groom::rough_vertices(test_films::triple_disk_start()).empty());
}

TEST(RoughFilms, AFoldIsFound) {
  films::FilmComplex tube = even_tube();
  tube.mesh.points[kMoved] *= 0.5;
  const std::vector<char> rough = groom::rough_vertices(tube);
  ASSERT_EQ(rough.size(), tube.mesh.points.size());
  EXPECT_EQ(rough[kMoved], 1);
  EXPECT_EQ(rough[kMoved + kAround / 2], 0);
}

TEST(RoughFilms, ThinFacetsAreEvenedOutOnTheEdgesTheyHave) {
  films::FilmComplex tube = even_tube();
  Points& points = tube.mesh.points;
  points[kMoved] += 0.95 * (points[kMoved + 1] - points[kMoved]);
  ASSERT_FALSE(groom::rough_vertices(tube).empty());
  const films::FilmComplex before = tube;
  EXPECT_TRUE(groom::even_out(tube, groom::EvenOut::KeepEdges));
  EXPECT_TRUE(groom::rough_vertices(tube).empty());
  EXPECT_EQ(tube.mesh.facets, before.mesh.facets);
  // far from there nothing moves
  const int far = kMoved + kAround / 2;
  EXPECT_EQ(points[far], before.mesh.points[far]);
}

}  // namespace
}  // namespace meniscus::rough_films_test
