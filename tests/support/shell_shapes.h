/// Shells made by maps of the unit square, for tests.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell_shapes {

/// Along which diagonal squares are cut in two.
enum class Cut { Slash, Backslash, Mixed };  // Mixed: at random

struct GridOptions {
  int m = 4;  // squares along s
  int n = 4;  // squares along t
  Cut cut = Cut::Slash;
  double shake = 0.0;  // inner corners moved, in parts of a square's side
  unsigned seed = 1;
  bool straight = false;  // middles half way between corners, not on the map
};

/// A mesh with the place (s, t) of each node on the unit square.
struct MappedShell {
  shell::ShellMesh mesh;
  std::vector<std::array<double, 2>> place;

  /// Nodes where `where(s, t)` holds.
  std::vector<int> nodes(
      const std::function<bool(double s, double t)>& where) const;
  /// The one nearest to (s, t).
  int node(double s, double t) const;
  /// Edges (from, to, middle) whose three nodes hold.
  std::vector<std::array<int, 3>> edges(
      const std::function<bool(double s, double t)>& where) const;
};

using Map = std::function<Vec3(double s, double t)>;

MappedShell mapped_shell(const Map& map, double thickness,
                         const GridOptions& options);

/// On the triangle s, t, s + t <= 1, options.m cells along a side.
MappedShell triangle_shell(const Map& map, double thickness,
                           const GridOptions& options);

/// Both, with nodes nearer than `tolerance` made one; places of `first` stay.
MappedShell joined(const MappedShell& first, const MappedShell& second,
                   double tolerance = 1e-9);

/// The same components held at many nodes; `held` such as "xyz", "xyzabc" (a b
/// c: rotations).
void hold(std::vector<shell::NodeSupport>& supports,
          const std::vector<int>& nodes, const char* held);

shell::Section isotropic(double youngs_modulus, double poisson_ratio,
                         double density = 0.0);

}  // namespace meniscus::shell_shapes
