#include "fea/supports/held_check.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/union_find.h"

namespace meniscus::supports {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Eigenvalues of the normalised Gram matrix below this are free motions: a
/// pad of a thousandth of the part's size still resists with 1e-6.
constexpr double kFreeMotion = 1e-13;
/// Part of a normal's uncertainty that it is off by on a curved surface.
constexpr double kNormalNoise = 0.5;
constexpr double kExactWeight = 1e6;

/// Part number of every node; parts are numbered by their lowest node.
std::vector<int> connected_parts(const TetMesh& mesh,
                                 const std::vector<PinFrame>& pins) {
  UnionFind parts(mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (const int node : ids) {
      parts.join(ids[0], node);
    }
  }
  for (const PinFrame& pin : pins) {
    for (const int node : pin.nodes) {
      parts.join(pin.nodes[0], node);
    }
  }
  return parts.roots();
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

  /// Rotation about the unit axis, times the size, per unit of the motions.
  static Vec6 turn_row(const Vec3& axis) {
    Vec6 r = Vec6::Zero();
    r.tail<3>() = axis;
    return r;
  }
};

std::string direction_name(const Vec3& d) {
  constexpr double kAligned = 1.0 - 1e-7;  // components of others below kNone
  for (int k = 0; k < 3; ++k) {
    if (std::abs(d[k]) > kAligned) {
      return std::string(1, static_cast<char>('x' + k));
    }
  }
  constexpr double kNone = 5e-4;  // below the digits shown
  const auto shown = [&](int k) { return std::abs(d[k]) < kNone ? 0.0 : d[k]; };
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", shown(0), shown(1), shown(2));
}

/// Describes the rigid motions that span the columns of `free`.
std::string describe(const Eigen::MatrixXd& free, const RigidFrame& frame) {
  if (free.cols() == 6) {
    return "move and rotate freely: nothing holds it";
  }
  constexpr double kNoTurn = 1e-6;
  std::vector<std::string> motions;
  const auto turns = symmetric_eigen(
      Eigen::MatrixXd(free.bottomRows<3>().transpose() * free.bottomRows<3>()));
  for (Eigen::Index k = 0; k < free.cols(); ++k) {
    const Vec6 motion = free * turns.vectors.col(k);
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

std::string list_held(const std::vector<HeldDirection>& held) {
  std::array<int, 4> count{};
  for (const HeldDirection& h : held) {
    int axis = 3;
    for (int k = 0; k < 3; ++k) {
      axis = std::abs(h.direction[k]) == 1.0 ? k : axis;
    }
    ++count[axis];
  }
  std::string text = fmt::format("held are x at {}, y at {}, z at {} nodes",
                                 count[0], count[1], count[2]);
  if (count[3] > 0) {
    text += fmt::format(", other directions at {}", count[3]);
  }
  return text;
}

/// The connected parts of the mesh, each with its rigid motions.
struct Parts {
  std::vector<int> of_node;  // the part's number; -1: in no element
  std::vector<RigidFrame> frames;
};

Parts find_parts(const TetMesh& mesh, const std::vector<PinFrame>& pins = {}) {
  const std::vector<int> head = connected_parts(mesh, pins);
  Parts parts;
  parts.of_node.assign(mesh.nodes.size(), -1);
  for (const int node : mesh.elements) {
    parts.of_node[node] = 0;
  }
  std::vector<int> number(mesh.nodes.size(), -1);
  std::vector<int> count;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (parts.of_node[i] < 0) {
      continue;
    }
    int& part = number[head[i]];
    if (part < 0) {
      part = static_cast<int>(count.size());
      count.push_back(0);
      parts.frames.push_back({Vec3::Zero(), 0.0});
    }
    parts.of_node[i] = part;
    parts.frames[part].centre += mesh.nodes[i];
    ++count[part];
  }
  for (std::size_t p = 0; p < count.size(); ++p) {
    parts.frames[p].centre /= count[p];
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (parts.of_node[i] >= 0) {
      RigidFrame& frame = parts.frames[parts.of_node[i]];
      frame.size = std::max(frame.size, (mesh.nodes[i] - frame.centre).norm());
    }
  }
  return parts;
}

/// How one part's rigid motions are resisted.
struct Resistance {
  Mat6 exact = Mat6::Zero();
  Mat6 normals = Mat6::Zero();  // less what their uncertainty would resist with

  /// Weighted so that the least exact hold outdoes an uncertain normal.
  Mat6 total() const { return kExactWeight * exact + normals; }
};

void add_direction(const HeldDirection& held, const Vec3& x,
                   const RigidFrame& frame, Resistance& resistance) {
  Vec6 row = Vec6::Zero();
  Mat6 all = Mat6::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec6 component = frame.row(x, k);
    row += held.direction[k] * component;
    all += component * component.transpose();
  }
  if (held.uncertainty <= kExactDirection) {
    resistance.exact += row * row.transpose();
  } else {
    const double noise = kNormalNoise * held.uncertainty;
    resistance.normals += row * row.transpose() - noise * noise * all;
  }
}

/// What a pin's fixed motions resist.
void add_fixed_motions(const PinFrame& pin, const RigidFrame& frame,
                       Resistance& resistance) {
  for (int k = 0; k < 6; ++k) {
    if (!pin.fixed[k]) {
      continue;
    }
    Vec6 row = RigidFrame::turn_row(pin.axes.col(k % 3));
    if (k < 3) {
      row.setZero();
      for (int c = 0; c < 3; ++c) {
        row += pin.axes(c, k) * frame.row(pin.point, c);
      }
    }
    resistance.exact += row * row.transpose();
  }
}

/// Per part, the rigid motions that `held` leaves, as columns.
std::vector<Eigen::MatrixXd> free_per_part(
    const TetMesh& mesh, const std::vector<HeldDirection>& held,
    const std::vector<PinFrame>& pins, const Parts& parts) {
  std::vector<Resistance> resistances(parts.frames.size());
  for (const HeldDirection& h : held) {
    const int part = parts.of_node[h.node];
    if (part >= 0) {
      add_direction(h, mesh.nodes[h.node], parts.frames[part],
                    resistances[part]);
    }
  }
  for (const PinFrame& pin : pins) {
    const int part = parts.of_node[pin.nodes[0]];
    add_fixed_motions(pin, parts.frames[part], resistances[part]);
  }
  std::vector<Eigen::MatrixXd> motions;
  for (const Resistance& resistance : resistances) {
    const auto eigen = symmetric_eigen(resistance.total());
    const double bound = kFreeMotion * std::max(eigen.values[5], 1e-300);
    int free = 0;
    while (free < 6 && !(eigen.values[free] > bound)) {
      ++free;
    }
    motions.emplace_back(eigen.vectors.leftCols(free));
  }
  return motions;
}

}  // namespace

void check_held(const TetMesh& mesh, const std::vector<HeldDirection>& held,
                const std::vector<PinFrame>& pins,
                const std::string& load_case) {
  const Parts parts = find_parts(mesh, pins);
  const auto motions = free_per_part(mesh, held, pins, parts);
  for (std::size_t p = 0; p < motions.size(); ++p) {
    if (motions[p].cols() > 0) {
      const RigidFrame& frame = parts.frames[p];
      throw SolverError(fmt::format(
          "load case '{}': the supports are too weak: the part around ({:.4g}, "
          "{:.4g}, {:.4g}) can {} ({}); fix more components or surfaces",
          load_case, frame.centre.x(), frame.centre.y(), frame.centre.z(),
          describe(motions[p], frame), list_held(held)));
    }
  }
}

Eigen::MatrixXd free_motions(const TetMesh& mesh,
                             const std::vector<HeldDirection>& held) {
  const Parts parts = find_parts(mesh);
  const auto motions = free_per_part(mesh, held, {}, parts);
  std::vector<Eigen::Index> first = {0};
  for (const Eigen::MatrixXd& motion : motions) {
    first.push_back(first.back() + motion.cols());
  }
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(
      static_cast<Eigen::Index>(3 * mesh.nodes.size()), first.back());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const int part = parts.of_node[i];
    if (part < 0) {
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      u.block(static_cast<Eigen::Index>(3 * i) + k, first[part], 1,
              motions[part].cols()) =
          parts.frames[part].row(mesh.nodes[i], k).transpose() * motions[part];
    }
  }
  return u;
}

}  // namespace meniscus::supports
