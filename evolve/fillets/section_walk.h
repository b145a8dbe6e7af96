/// Sections of a triangle surface by planes across a curve where it ends.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/edge_key.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::fillets {

/// A fixed mean of a surface's points: numbers and weights that sum to one.
using Mean = std::vector<std::pair<int, double>>;

Vec3 at_mean(const Mean& mean, const Points& points);

/// Facets of one label about each point and edge.
class LabelledFacets {
 public:
  LabelledFacets(const SurfaceMesh& mesh, int label);

  const SurfaceMesh& mesh() const { return mesh_; }
  /// Those about a point.
  const std::vector<int>& about(int point) const;
  /// The facet across an edge, or -1 where the label ends.
  int across(const Edge& edge, int facet) const;
  /// Points within, off the label's ends.
  std::vector<int> inner_points() const;

 private:
  const SurfaceMesh& mesh_;
  std::vector<std::vector<int>> about_;
  std::vector<int> points_;
};

/// A section from a point of the label's end into it.
struct Walk {
  std::vector<Mean> points;     // from the first on
  std::vector<double> lengths;  // along, from 0 [length]
  Edge end = {-1, -1};          // of the label, where it was reached

  double length() const { return lengths.back(); }
  bool ended() const { return end[0] >= 0; }
  /// The place so far along, on the facet between two of the points.
  Mean at(double length) const;
};

/// By the plane through `point` with normal `along`, until `most` or the
/// label's end. Empty where the label has no facet there.
std::optional<Walk> walk_section(const LabelledFacets& facets, int point,
                                 const Vec3& along, double most);

}  // namespace meniscus::fillets
