#include "core/geometry/harmonic.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/math/linear_solve.h"

namespace meniscus {

namespace {

constexpr double kLeastWeight = 1e-3;
constexpr double kMostWeight = 1e3;

/// Half the cotangent of the facet's angle opposite to its edge k.
double edge_weight(const HarmonicProblem& problem, const Triangle& t, int k) {
  const Points& points = problem.points;
  const Vec3& c = points[t[(k + 2) % 3]];
  const Vec3 a = points[t[k]] - c;
  const Vec3 b = points[t[(k + 1) % 3]] - c;
  const double area2 = a.cross(b).norm();
  const double cotangent = area2 > 0.0 ? a.dot(b) / area2 : kMostWeight;
  const double least = problem.weights == HarmonicWeights::Positive
                           ? kLeastWeight
                           : -kMostWeight;
  return std::clamp(0.5 * cotangent, least, kMostWeight);
}

/// Numbers of the free vertices, -1 for others. Throws where none is fixed.
std::vector<int> number_free(const HarmonicProblem& problem, int& count) {
  std::vector<int> unknown(problem.points.size(), -1);
  count = 0;
  int fixed = 0;
  for (const int f : problem.facets) {
    for (const int v : problem.mesh[f]) {
      if (problem.fixed[v] != 0) {
        ++fixed;
      } else if (unknown[v] < 0) {
        unknown[v] = count++;
      }
    }
  }
  if (fixed == 0) {
    throw MeshError("no vertex of the film is held on a rim");
  }
  return unknown;
}

}  // namespace

Eigen::MatrixXd harmonic(const HarmonicProblem& problem) {
  int count = 0;
  const std::vector<int> unknown = number_free(problem, count);
  const Eigen::Index columns = problem.values.cols();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, columns);
  std::vector<Eigen::Triplet<double>> entries;
  // Row v of the weighted graph Laplacian; what is held goes to the right.
  const auto half = [&](int v, int w, double weight, double jump) {
    // weight (x_v + o_v - x_w - o_w) by x_v, jump = o_v - o_w
    const int row = unknown[v];
    if (row < 0) {
      return;
    }
    entries.emplace_back(row, row, weight);
    right.row(row).array() -= weight * jump;
    if (unknown[w] < 0) {
      right.row(row) += weight * problem.values.row(w);
    } else if (unknown[w] < row) {
      entries.emplace_back(row, unknown[w], -weight);
    }
  };
  // Offsets make a function that jumps across a cut.
  for (std::size_t i = 0; i < problem.facets.size(); ++i) {
    const int f = problem.facets[i];
    const Triangle& t = problem.mesh[f];
    const double stiffness =
        problem.stiffness.empty() ? 1.0 : problem.stiffness[f];
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const double weight = stiffness * edge_weight(problem, t, k);
      const double jump =
          problem.offsets.empty()
              ? 0.0
              : problem.offsets[i][k] - problem.offsets[i][next];
      half(t[k], t[next], weight, jump);
      half(t[next], t[k], weight, -jump);
    }
  }
  Eigen::MatrixXd result = problem.values;
  if (count == 0) {
    return result;
  }
  // Positive definite if each component has a vertex that is held.
  SparseMatrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  SymmetricFactor factor(matrix, FactorKind::Cholesky);
  if (!factor.factorize(matrix)) {
    throw MeshError("a film is in pieces: it has no harmonic functions");
  }
  const Eigen::MatrixXd solution = factor.solve(right);
  for (std::size_t v = 0; v < unknown.size(); ++v) {
    if (unknown[v] >= 0) {
      result.row(static_cast<Eigen::Index>(v)) = solution.row(unknown[v]);
    }
  }
  return result;
}

namespace {

/// The shortest way in edges from one loop to the other, over vertices of
/// neither but its ends.
std::vector<int> path_between(const std::vector<Triangle>& mesh,
                              std::size_t points,
                              const std::vector<int>& facets,
                              const std::vector<int>& first,
                              const std::vector<int>& second) {
  std::vector<std::vector<int>> near(points);
  for (const int f : facets) {
    const Triangle& t = mesh[f];
    for (int k = 0; k < 3; ++k) {
      near[t[k]].push_back(t[(k + 1) % 3]);
      near[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  const std::set<int> goal(second.begin(), second.end());
  std::vector<int> before(points, -1);
  std::deque<int> queue(first.begin(), first.end());
  for (const int v : first) {
    before[v] = v;
  }
  while (!queue.empty()) {
    const int v = queue.front();
    queue.pop_front();
    if (goal.count(v) > 0) {
      std::vector<int> path{v};
      while (before[path.back()] != path.back()) {
        path.push_back(before[path.back()]);
      }
      std::reverse(path.begin(), path.end());
      return path;
    }
    std::sort(near[v].begin(), near[v].end());
    for (const int w : near[v]) {
      if (before[w] < 0) {
        before[w] = v;
        queue.push_back(w);
      }
    }
  }
  throw MeshError("a film's rims are not connected by it");
}

}  // namespace

TubeCut cut_tube(const std::vector<Triangle>& mesh, std::size_t points,
                 const std::vector<int>& facets, const std::vector<int>& first,
                 const std::vector<int>& second) {
  TubeCut cut;
  cut.path = path_between(mesh, points, facets, first, second);
  std::vector<int> place(points, -1);
  for (std::size_t i = 0; i < cut.path.size(); ++i) {
    place[cut.path[i]] = static_cast<int>(i);
  }
  const auto on_path = [&](int a, int b) {
    return place[a] >= 0 && place[b] >= 0 && std::abs(place[a] - place[b]) == 1;
  };
  // Sides of corners at the path: seeded by facets along it, spread over the
  // facets about each vertex without crossing it.
  cut.offsets.assign(facets.size(), {0, 0, 0});
  std::map<Edge, int> owner;  // directed edge: place in `facets`
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Triangle& t = mesh[facets[i]];
    for (int k = 0; k < 3; ++k) {
      owner[{t[k], t[(k + 1) % 3]}] = static_cast<int>(i);
    }
  }
  const auto corner_of = [&](int i, int v) {
    const Triangle& t = mesh[facets[i]];
    return t[0] == v ? 0 : t[1] == v ? 1 : 2;
  };
  // Left of the path, turning about v from the facet on path edge (a, b).
  const auto spread = [&](int v, int a, int b) {
    auto at = owner.find({a, b});
    int guard = 0;
    while (at != owner.end() && guard++ < 1000) {
      const int i = at->second;
      const int k = corner_of(i, v);
      cut.offsets[i][k] = 1;
      const Triangle& t = mesh[facets[i]];
      const int next = t[(k + 1) % 3];
      const int last = t[(k + 2) % 3];
      if (v == a) {  // came in over v -> next; leave over last -> v
        if (on_path(last, v)) {
          return;
        }
        at = owner.find({v, last});
      } else {  // came in over last -> v; leave over v -> next
        if (on_path(v, next)) {
          return;
        }
        at = owner.find({next, v});
      }
    }
  };
  for (std::size_t i = 0; i + 1 < cut.path.size(); ++i) {
    spread(cut.path[i], cut.path[i], cut.path[i + 1]);
    spread(cut.path[i + 1], cut.path[i], cut.path[i + 1]);
  }
  return cut;
}

}  // namespace meniscus
