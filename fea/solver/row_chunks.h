/// Rows of a matrix in pieces that threads may work on side by side.
#pragma once

#include <omp.h>
#include <vector>

#include "fea/solver/team_barrier.h"

namespace meniscus::solver {

/// Chunk c holds rows first[c] .. first[c + 1] - 1; colour k holds chunks
/// colour[k] .. colour[k + 1] - 1. No row couples to two chunks of one colour,
/// so threads that work on chunks of one colour, colour after colour, never
/// write the same number and add in the same order, however many they are.
struct RowChunks {
  std::vector<int> first = {0};
  std::vector<int> colour = {0};

  int count() const { return static_cast<int>(first.size()) - 1; }
  int colours() const { return static_cast<int>(colour.size()) - 1; }
};

/// Loops over fewer rows than this stay on one thread: on a busy machine the
/// threads' waiting for each other would cost more than the work.
inline constexpr int kParallelRows = 10000;

/// All rows in one chunk.
inline RowChunks one_chunk(int rows) { return {{0, rows}, {0, 1}}; }

enum class RowOrder { Forward, Backward };

/// work(chunk) for each chunk, colours in the order of rows or against it.
template <class Work>
void over_chunks(const RowChunks& chunks, RowOrder order, const Work& work) {
  TeamBarrier barrier;
#pragma omp parallel if (chunks.count() > chunks.colours() && \
                         chunks.first.back() >= kParallelRows)
  for (int k = 0; k < chunks.colours(); ++k) {
    const int colour =
        order == RowOrder::Forward ? k : chunks.colours() - 1 - k;
#pragma omp for schedule(dynamic, 1) nowait
    for (int c = chunks.colour[colour]; c < chunks.colour[colour + 1]; ++c) {
      work(c);
    }
    barrier.wait(omp_get_num_threads());
  }
}

}  // namespace meniscus::solver
