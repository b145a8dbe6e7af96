/// Internal to film_faces: which sides of a film's patches share their knots.
#pragma once

#include <algorithm>
#include <vector>

namespace meniscus::solid {

/// Directions a and b of patches in classes, each direction along its class or
/// against it.
class DirectionClasses {
 public:
  struct Member {
    int root = 0;
    bool flipped = false;
  };
  explicit DirectionClasses(int patches) {
    for (int k = 0; k < 2 * patches; ++k) {
      parents_.push_back({k, false});
    }
  }
  Member of(int patch, int side) const {
    Member at = parents_[2 * patch + side % 2];
    while (parents_[at.root].root != at.root) {
      const Member& next = parents_[at.root];
      at = {next.root, at.flipped != next.flipped};
    }
    return at;
  }
  void join(int patch, int side, int other_patch, int other_side,
            bool against) {
    const Member p = of(patch, side);
    const Member q = of(other_patch, other_side);
    if (p.root != q.root) {
      const bool flipped = (p.flipped != q.flipped) != against;
      parents_[std::max(p.root, q.root)] = {std::min(p.root, q.root), flipped};
    }
  }

 private:
  std::vector<Member> parents_;
};

}  // namespace meniscus::solid
