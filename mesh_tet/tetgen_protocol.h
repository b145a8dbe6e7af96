/// What the program and its helper `meniscus-tetgen` say to each other, over
/// stdin and stdout, on one machine and from one build: a header, then arrays
/// without gaps, then the end mark. Both sides check every number they read.
#pragma once

#include <cstdint>

namespace meniscus::mesh_tet::tetgen {

inline constexpr std::uint64_t kMagic = 0x4d45'4e54'4554'0002;  // last: version
inline constexpr std::uint64_t kEndMark = 0x454e'444d'4152'4b21;
inline constexpr int kSwitchesSize = 120;

/// Followed by points (3 doubles each), facets (3 int32 each), holes (3 doubles
/// each), elements to refine (4 int32 each), the largest volume of each (a
/// double), and the end mark.
struct Request {
  std::uint64_t magic = kMagic;
  std::int64_t points = 0;
  std::int64_t facets = 0;
  std::int64_t holes = 0;
  std::int64_t elements = 0;
  char switches[kSwitchesSize] = {};  // ends with a zero byte
};

/// Followed by nodes (3 doubles each), elements (4 int32 each) and the end
/// mark. The first nodes are the request's points.
struct Reply {
  std::uint64_t magic = kMagic;
  std::int64_t nodes = 0;
  std::int64_t elements = 0;
};

/// Exit codes of the helper. TetGen's own codes are added to kTetgenCode: 1
/// memory, 2 internal, 3 self-intersection, 4 feature too small, 5 facets too
/// close, 10 input.
inline constexpr int kDone = 0;
inline constexpr int kBadRequest = 3;
inline constexpr int kOutOfMemory = 4;
inline constexpr int kNotDelivered = 5;
inline constexpr int kTetgenCode = 20;

}  // namespace meniscus::mesh_tet::tetgen
