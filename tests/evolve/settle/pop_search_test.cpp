#include "evolve/settle/pop_search.h"

#include <gtest/gtest.h>

#include "core/operation_count.h"
#include "tests/support/film_shapes.h"

namespace meniscus::pop_search_test {
namespace {

double work_of(const settle::PopSearchOptions& options) {
  const films::FilmComplex film =
      shapes::tube(1.0, 0.8, 12, 4, [](double) { return 1.1; });
  const double before = operations_done();
  const std::vector<settle::PoppedFilm> found =
      settle::search_pops({film}, options);
  EXPECT_FALSE(found.empty());
  return operations_done() - before;
}

// The round that finds the first film is none without a lower one: with a
// patience of 1 another follows.
TEST(PopSearch, TheFirstFilmFoundIsNoIdleRound) {
  const double one = work_of({.most_rounds = 1, .patience = 1});
  EXPECT_GT(work_of({.most_rounds = 12, .patience = 1}), 1.2 * one);
}

}  // namespace
}  // namespace meniscus::pop_search_test
