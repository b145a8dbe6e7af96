#include "evolve/spines/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/heed_stop.h"

namespace meniscus::spines {

namespace {

using Node = std::array<int, 3>;  // of the lattice

constexpr std::size_t kMostCells = 3'000'000;
/// Crossings stay off a lattice edge's ends, so that no facet is without area.
constexpr double kLeastShare = 0.05;

struct NodeHash {
  std::size_t operator()(const Node& n) const {
    std::uint64_t h = 1469598103934665603ULL;
    for (const int k : n) {
      h = (h ^ static_cast<std::uint32_t>(k)) * 1099511628211ULL;
    }
    return h;
  }
};

class Lattice {
 public:
  Lattice(const std::function<double(const Vec3&)>& value, double cell,
          const std::function<bool(const Vec3&)>& leave_out)
      : value_(value), cell_(cell), leave_out_(leave_out) {
    mesh_.labels = {"surface"};
  }

  /// Whether the surface runs through the cell with its lowest corner there.
  bool crosses(const Node& low) {
    const std::optional<std::array<int, 8>> corner = corners(low);
    return corner && std::any_of(corner->begin(), corner->end(), [&](int v) {
             return inside(v) != inside(corner->front());
           });
  }

  void add_cell(const Node& low) {
    const std::optional<std::array<int, 8>> corner = corners(low);
    if (!corner) {
      return;
    }
    // Kuhn's six tetrahedra about the diagonal from corner 0 to 7: the same
    // diagonals on the faces of neighbours.
    static constexpr std::array<std::array<int, 2>, 6> kBetween = {
        {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}};
    for (const auto& [a, b] : kBetween) {
      add_tet({(*corner)[0], (*corner)[a], (*corner)[b], (*corner)[7]});
    }
  }

  SurfaceMesh take() {
    mesh_.facet_label.assign(mesh_.facets.size(), 0);
    return std::move(mesh_);
  }

 private:
  /// Nothing where one of them is left out.
  std::optional<std::array<int, 8>> corners(const Node& low) {
    std::array<int, 8> corner;
    for (int k = 0; k < 8; ++k) {
      corner[k] = node(
          {low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2 & 1)});
      if (left_out_[corner[k]] != 0) {
        return std::nullopt;
      }
    }
    return corner;
  }

  int node(const Node& at) {
    const auto [found, is_new] =
        ids_.try_emplace(at, static_cast<int>(places_.size()));
    if (is_new) {
      const Vec3 place = cell_ * Vec3(at[0], at[1], at[2]);
      places_.push_back(place);
      left_out_.push_back(leave_out_(place) ? 1 : 0);
      values_.push_back(left_out_.back() != 0 ? 0.0 : value_(place));
      if (places_.size() % 4096 == 0) {
        heed_stop("film");
      }
    }
    return found->second;
  }

  bool inside(int node) const { return values_[node] > 0.0; }

  /// Where the level crosses a lattice edge.
  int crossing(int a, int b) {
    const Edge key = {std::min(a, b), std::max(a, b)};
    const auto [found, is_new] =
        crossings_.try_emplace(key, static_cast<int>(mesh_.points.size()));
    if (is_new) {
      const double of_a = values_[key[0]];
      const double share = std::clamp(of_a / (of_a - values_[key[1]]),
                                      kLeastShare, 1.0 - kLeastShare);
      mesh_.points.push_back(places_[key[0]] +
                             share * (places_[key[1]] - places_[key[0]]));
    }
    return found->second;
  }

  /// `in` and `out`: nodes inside and outside, the facet's normal to run out.
  void add_facet(const Triangle& t, int in, int out) {
    const Points& p = mesh_.points;
    const Vec3 normal = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
    if (normal.dot(places_[out] - places_[in]) > 0.0) {
      mesh_.facets.push_back(t);
    } else {
      mesh_.facets.push_back({t[0], t[2], t[1]});
    }
  }

  void add_tet(const std::array<int, 4>& tet) {
    std::vector<int> in;
    std::vector<int> out;
    for (const int v : tet) {
      (inside(v) ? in : out).push_back(v);
    }
    if (in.size() == 1) {
      add_facet({crossing(in[0], out[0]), crossing(in[0], out[1]),
                 crossing(in[0], out[2])},
                in[0], out[0]);
    } else if (in.size() == 3) {
      add_facet({crossing(in[0], out[0]), crossing(in[1], out[0]),
                 crossing(in[2], out[0])},
                in[0], out[0]);
    } else if (in.size() == 2) {
      const std::array<int, 4> ring = {
          crossing(in[0], out[0]), crossing(in[0], out[1]),
          crossing(in[1], out[1]), crossing(in[1], out[0])};
      add_facet({ring[0], ring[1], ring[2]}, in[0], out[0]);
      add_facet({ring[0], ring[2], ring[3]}, in[0], out[0]);
    }
  }

  const std::function<double(const Vec3&)>& value_;
  double cell_;
  const std::function<bool(const Vec3&)>& leave_out_;
  std::unordered_map<Node, int, NodeHash> ids_;
  Points places_;
  std::vector<double> values_;
  std::vector<char> left_out_;
  std::map<Edge, int> crossings_;  // vertex of the surface
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh isosurface(const std::function<double(const Vec3&)>& value,
                       const std::vector<Ball>& balls, double cell,
                       const std::function<bool(const Vec3&)>& leave_out) {
  std::set<Node> cells;  // in order: the same mesh for the same input
  for (const Ball& ball : balls) {
    const Vec3 low = (ball.at.array() - ball.radius) / cell;
    const Vec3 high = (ball.at.array() + ball.radius) / cell;
    if (!((high - low).prod() < kMostCells) ||
        !(low.cwiseAbs().maxCoeff() < 1e9)) {
      throw InvalidInput("a lattice of so small a step has too many cells");
    }
    for (int i = static_cast<int>(std::floor(low.x())); i < high.x(); ++i) {
      for (int j = static_cast<int>(std::floor(low.y())); j < high.y(); ++j) {
        for (int k = static_cast<int>(std::floor(low.z())); k < high.z(); ++k) {
          const Vec3 middle = cell * Vec3(i + 0.5, j + 0.5, k + 0.5);
          if ((middle - ball.at).norm() < ball.radius + cell) {
            cells.insert({i, j, k});
          }
        }
      }
    }
    if (cells.size() > kMostCells) {
      throw InvalidInput("a lattice of so small a step has too many cells");
    }
    heed_stop("film");
  }
  // On along the surface, where it leaves the balls.
  Lattice lattice(value, cell, leave_out);
  std::vector<Node> border(cells.begin(), cells.end());
  while (!border.empty()) {
    std::vector<Node> next;
    for (const Node& at : border) {
      if (!lattice.crosses(at)) {
        continue;
      }
      for (int side = 0; side < 6; ++side) {
        Node beside = at;
        beside[side / 2] += side % 2 == 0 ? 1 : -1;
        if (cells.insert(beside).second) {
          next.push_back(beside);
        }
      }
    }
    if (cells.size() > kMostCells) {
      throw InvalidInput("a lattice of so small a step has too many cells");
    }
    border = std::move(next);
  }
  for (const Node& at : cells) {
    lattice.add_cell(at);
  }
  return lattice.take();
}

}  // namespace meniscus::spines
