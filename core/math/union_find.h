/// Sets that grow together: which of many things hang together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace meniscus {

/// Things 0 .. size() - 1, each in a set of its own at first. The root of a set
/// is its smallest member, so that it depends on what was joined and not on the
/// order (join_to() excepted). Ids are not checked.
class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : up_(size) {
    std::iota(up_.begin(), up_.end(), 0);
  }

  std::size_t size() const { return up_.size(); }

  /// One more thing; its id.
  int add() {
    up_.push_back(static_cast<int>(up_.size()));
    return up_.back();
  }

  /// The one that stands for the set of `i`. Shortens the way there.
  int root(int i) {
    while (up_[i] != i) {
      up_[i] = up_[up_[i]];
      i = up_[i];
    }
    return i;
  }

  bool same(int i, int j) { return root(i) == root(j); }

  /// Makes the sets of both one; false when they were.
  bool join(int i, int j) {
    const int a = root(i);
    const int b = root(j);
    up_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

  /// As join(), but the root of `kept` stays, whichever is smaller.
  bool join_to(int kept, int gone) {
    const int a = root(kept);
    const int b = root(gone);
    up_[b] = a;
    return a != b;
  }

  /// Of each thing its root.
  std::vector<int> roots() {
    std::vector<int> result(up_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = root(static_cast<int>(i));
    }
    return result;
  }

  /// Of each thing the number of its set, in order of their smallest members;
  /// `count`: how many there are. Not after join_to().
  std::vector<int> numbers(int& count) {
    std::vector<int> result(up_.size());
    count = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const int first = root(static_cast<int>(i));
      result[i] = first == static_cast<int>(i) ? count++ : result[first];
    }
    return result;
  }

 private:
  std::vector<int> up_;
};

}  // namespace meniscus
