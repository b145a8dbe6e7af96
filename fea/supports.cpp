#include "fea/supports.h"

#include <numeric>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "fea/surface_faces.h"

namespace meniscus {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Eigenvalues of the normalised Gram matrix below this are free motions: a
/// pad of a thousandth of the part's size still resists with 1e-6.
constexpr double kFreeMotion = 1e-13;

/// Part number of every node; parts are numbered by their lowest node.
std::vector<int> connected_parts(const TetMesh& mesh) {
  std::vector<int> parent(mesh.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) {
      parent[i] = parent[parent[i]];
      i = parent[i];
    }
    return i;
  };
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (const int node : ids) {
      const int a = root(ids[0]);
      const int b = root(node);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<int> part(mesh.nodes.size());
  for (std::size_t i = 0; i < part.size(); ++i) {
    part[i] = root(static_cast<int>(i));
  }
  return part;
}

/// Rigid motions about `centre`, lengths in units of `size`.
struct RigidFrame {
  Vec3 centre = Vec3::Zero();
  double size = 1.0;

  /// Displacement component k at x per unit of the six motions.
  Vec6 row(const Vec3& x, int k) const {
    const Vec3 d = (x - centre) / size;
    Vec6 r = Vec6::Zero();
    r[k] = 1.0;
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    r[3 + i] = d[j];
    r[3 + j] = -d[i];
    return r;
  }
};

std::string direction_name(const Vec3& d) {
  constexpr double kAligned = 1.0 - 1e-9;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(d[k]) > kAligned) {
      return std::string(1, static_cast<char>('x' + k));
    }
  }
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", d.x(), d.y(), d.z());
}

/// Describes the rigid motions that span the columns of `free`.
std::string describe(const Eigen::MatrixXd& free, const RigidFrame& frame) {
  if (free.cols() == 6) {
    return "move and rotate freely: nothing holds it";
  }
  constexpr double kNoTurn = 1e-6;
  std::vector<std::string> motions;
  const Eigen::SelfAdjointEigenSolver<Mat3> shifts(
      Mat3(free.topRows<3>() * free.topRows<3>().transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> turns(
      Eigen::MatrixXd(free.bottomRows<3>().transpose() * free.bottomRows<3>()));
  for (Eigen::Index k = 0; k < free.cols(); ++k) {
    const Vec6 motion = free * turns.eigenvectors().col(k);
    const Vec3 t = motion.head<3>();
    const Vec3 w = motion.tail<3>();
    if (w.norm() < kNoTurn) {
      motions.push_back("move along " + direction_name(t.normalized()));
      continue;
    }
    // The axis of a screw: u = t + w x d vanishes at d = w x t / w^2.
    const Vec3 at = frame.centre + frame.size * w.cross(t) / w.squaredNorm();
    motions.push_back(
        fmt::format("rotate about {} through ({:.4g}, {:.4g}, "
                    "{:.4g})",
                    direction_name(w.normalized()), at.x(), at.y(), at.z()));
  }
  return fmt::format("{}", fmt::join(motions, " and "));
}

std::string list_supports(const std::vector<char>& fixed) {
  std::array<int, 3> count{};
  for (std::size_t d = 0; d < fixed.size(); ++d) {
    count[d % 3] += fixed[d];
  }
  return fmt::format("fixed are x at {}, y at {}, z at {} nodes", count[0],
                     count[1], count[2]);
}

}  // namespace

std::vector<char> fixed_dofs(const TetMesh& mesh, const LoadCase& load_case) {
  std::vector<char> fixed(3 * mesh.nodes.size(), 0);
  bool any = false;
  for (const Support& support : load_case.supports) {
    const int label = surface_label(mesh, support.surface);
    const std::array<bool, 3> fix = {support.fix_x, support.fix_y,
                                     support.fix_z};
    for (const int node : surface_nodes(mesh, label)) {
      for (int k = 0; k < 3; ++k) {
        if (fix[k]) {
          fixed[3 * static_cast<std::size_t>(node) + k] = 1;
          any = true;
        }
      }
    }
  }
  if (!any) {
    throw InvalidInput(
        fmt::format("load case '{}' has no support: fix x, y or z on a surface",
                    load_case.name));
  }
  return fixed;
}

void check_held(const TetMesh& mesh, const std::vector<char>& fixed,
                const std::string& load_case) {
  const std::vector<int> part = connected_parts(mesh);
  const std::size_t n = mesh.nodes.size();
  std::vector<char> in_element(n, 0);
  for (const int node : mesh.elements) {
    in_element[node] = 1;
  }
  std::vector<int> heads;
  std::vector<int> count(n, 0);
  std::vector<RigidFrame> frames(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (in_element[i] != 0) {
      if (count[part[i]]++ == 0) {
        heads.push_back(part[i]);
      }
      frames[part[i]].centre += mesh.nodes[i];
    }
  }
  for (const int head : heads) {
    frames[head].centre /= count[head];
    frames[head].size = 0.0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (in_element[i] != 0) {
      RigidFrame& frame = frames[part[i]];
      frame.size = std::max(frame.size, (mesh.nodes[i] - frame.centre).norm());
    }
  }
  std::vector<Mat6> gram(n, Mat6::Zero());
  for (std::size_t d = 0; d < fixed.size(); ++d) {
    const std::size_t i = d / 3;
    if (fixed[d] != 0 && in_element[i] != 0) {
      const Vec6 row =
          frames[part[i]].row(mesh.nodes[i], static_cast<int>(d % 3));
      gram[part[i]] += row * row.transpose();
    }
  }
  for (const int head : heads) {
    const Eigen::SelfAdjointEigenSolver<Mat6> eigen(gram[head]);
    const double bound = kFreeMotion * std::max(eigen.eigenvalues()[5], 1e-300);
    int free = 0;
    while (free < 6 && !(eigen.eigenvalues()[free] > bound)) {
      ++free;
    }
    if (free > 0) {
      const RigidFrame& frame = frames[head];
      throw SolverError(fmt::format(
          "load case '{}': the supports are too weak: the part around ({:.4g}, "
          "{:.4g}, {:.4g}) can {} ({}); fix more components or surfaces",
          load_case, frame.centre.x(), frame.centre.y(), frame.centre.z(),
          describe(eigen.eigenvectors().leftCols(free), frame),
          list_supports(fixed)));
    }
  }
}

}  // namespace meniscus
