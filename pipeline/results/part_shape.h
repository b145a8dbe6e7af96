/// The curved faces that a part's facets stand for.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/geometry/facet_tree.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::results {

/// Known by finer facets of the same faces, under the same labels.
class PartShape {
 public:
  explicit PartShape(SurfaceMesh fine);
  PartShape(const PartShape&) = delete;
  PartShape& operator=(const PartShape&) = delete;

  /// Where the middle of a coarse edge `a` `b` belongs: on the face beside it,
  /// on the line where the two faces beside it meet. The middle itself where
  /// that is further away than a quarter of the edge: there the faces are not
  /// those that were meant.
  Vec3 middle(const Vec3& a, const Vec3& b, const Edge& labels) const;

  /// The nearest place on the face, or on the line where the two faces meet;
  /// `at` itself where they do not.
  Vec3 nearest(const Vec3& at, const Edge& labels) const;

 private:
  using Line = std::vector<std::array<Vec3, 2>>;

  SurfaceMesh fine_;
  std::vector<std::unique_ptr<FacetTree>> faces_;  // by label
  std::map<Edge, Line> lines_;                     // by the two labels
};

}  // namespace meniscus::results
