#include "cad/solid/face_lines.h"

#include <algorithm>

#include "core/geometry/edge_key.h"

namespace meniscus::solid {

FaceLines::FaceLines(const SurfaceMesh& mesh,
                     const std::vector<std::vector<int>>& faces) {
  std::map<Edge, std::vector<int>> faces_at;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    for (const int f : faces[face]) {
      const Triangle& t = mesh.facets[f];
      for (int k = 0; k < 3; ++k) {
        faces_at[edge_key(t[k], t[(k + 1) % 3])].push_back(
            static_cast<int>(face));
      }
    }
  }
  for (const auto& [edge, both] : faces_at) {
    if (both.size() != 2 || both[0] != both[1]) {
      next_[edge[0]].push_back(edge[1]);
      next_[edge[1]].push_back(edge[0]);
    }
  }
  // Those between ends first; what is left is closed.
  for (const bool from_ends : {true, false}) {
    for (const auto& [v, others] : next_) {
      for (const int w : others) {
        if (is_end(v) == from_ends && line_at_.count(edge_key(v, w)) == 0) {
          add_line(v, w);
        }
      }
    }
  }
}

void FaceLines::add_line(int from, int to) {
  const int number = static_cast<int>(lines_.size());
  FaceLine line{{from, to}, false};
  line_at_[edge_key(from, to)] = number;
  while (!is_end(to) && to != from) {
    const std::vector<int>& both = next_.at(to);
    const int before = line.vertices.end()[-2];
    to = both[0] == before ? both[1] : both[0];
    line_at_[edge_key(line.vertices.back(), to)] = number;
    line.vertices.push_back(to);
  }
  if (!is_end(from)) {
    line.closed = true;
    line.vertices.pop_back();
  }
  lines_.push_back(std::move(line));
}

std::vector<int> FaceLines::begins_at_end(std::vector<int> loop) const {
  const auto end = std::find_if(loop.begin(), loop.end(),
                                [this](int v) { return is_end(v); });
  if (end != loop.end()) {
    std::rotate(loop.begin(), end, loop.end());
  }
  return loop;
}

std::vector<LineRun> FaceLines::runs(const std::vector<int>& loop) const {
  std::vector<LineRun> result;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (k > 0 && !is_end(loop[k])) {
      continue;
    }
    const int next = loop[(k + 1) % loop.size()];
    const int number = line_at_.at(edge_key(loop[k], next));
    const FaceLine& line = lines_[number];
    const auto here =
        std::find(line.vertices.begin(), line.vertices.end(), loop[k]) + 1;
    const bool forward = here != line.vertices.end()
                             ? *here == next
                             : line.closed && line.vertices.front() == next;
    result.push_back({number, forward});
  }
  return result;
}

}  // namespace meniscus::solid
