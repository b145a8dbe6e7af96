/// Internal to film_solid: the lines of a mesh along which faces of a solid
/// meet.
#pragma once

#include <map>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::solid {

struct FaceLine {
  std::vector<int> vertices;  // of a closed line the first is not repeated
  bool closed = false;
};

/// A line on the way along a loop.
struct LineRun {
  int line = 0;
  bool forward = true;
};

/// Lines end where three faces and more meet, and where a face touches itself;
/// those that nowhere do are closed.
class FaceLines {
 public:
  /// `faces`: the facets of each, all of the mesh's.
  FaceLines(const SurfaceMesh& mesh,
            const std::vector<std::vector<int>>& faces);

  const std::vector<FaceLine>& lines() const { return lines_; }
  /// The lines along a face's boundary loop from its first vertex on, which is
  /// the end of a line if any of its vertices is; as begins_at_end() has it.
  std::vector<LineRun> runs(const std::vector<int>& loop) const;
  std::vector<int> begins_at_end(std::vector<int> loop) const;

 private:
  using Neighbours = std::map<int, std::vector<int>>;
  bool is_end(int v) const { return next_.at(v).size() != 2; }
  void add_line(int from, int to);

  Neighbours next_;  // along lines
  std::vector<FaceLine> lines_;
  std::map<Edge, int> line_at_;
};

}  // namespace meniscus::solid
