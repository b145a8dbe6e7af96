#include "fea/supports/springs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "fea/element/face_points.h"
#include "fea/element/node_elements.h"
#include "fea/element/surface_faces.h"
#include "fea/element/surface_normals.h"
#include "fea/loads/loads.h"

namespace meniscus::supports {

namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

void check(const loads::SpringBed& bed, const loads::LoadCase& load_case) {
  const auto refuse = [&](const std::string& what) {
    throw InvalidInput(fmt::format("load case '{}': springs on '{}' {}",
                                   load_case.name, bed.surface, what));
  };
  const Vec3& k = bed.components;
  if (!k.allFinite() || !std::isfinite(bed.normal) || k.minCoeff() < 0.0 ||
      bed.normal < 0.0) {
    refuse(
        fmt::format("have stiffnesses {}, {}, {} and {} along the normal; "
                    "all must be 0 or above",
                    k.x(), k.y(), k.z(), bed.normal));
  }
  if (k.isZero(0.0) && bed.normal == 0.0) {
    refuse("have no stiffness; give one along a component or the normal");
  }
  if (bed.axes && !element::span_a_plane(*bed.axes)) {
    refuse(
        "have axes without length or parallel ones; give two that span a "
        "plane");
  }
}

struct Entry {
  std::array<int, 2> at;
  Mat3 block;
};

void add_bed_stiffness(const TetMesh& mesh, const loads::SpringBed& bed,
                       int order, std::vector<Entry>& entries) {
  const BedStiffness stiffness = bed_stiffness_of(mesh, bed);
  const int label = element::surface_label(mesh, bed.surface);
  const element::FaceQuadrature quadrature(order, element::FaceRule::Seven);
  const int count = order == 1 ? 3 : 6;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] != label) {
      continue;
    }
    const auto ids = mesh.face(f);
    std::array<std::array<Mat3, 6>, 6> sum;
    for (auto& row : sum) {
      row.fill(Mat3::Zero());
    }
    for (int q = 0; q < quadrature.size(); ++q) {
      const element::FacePoint point = quadrature.at(mesh, f, q);
      const double area = point.normal.norm();
      const Vec3 n = point.normal / area;
      const Mat3 k =
          area * (stiffness.tensor + stiffness.normal * n * n.transpose());
      for (int a = 0; a < count; ++a) {
        for (int b = 0; b < count; ++b) {
          sum[a][b] += point.shape[a] * point.shape[b] * k;
        }
      }
    }
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        if (ids[a] >= ids[b]) {
          entries.push_back({{ids[a], ids[b]}, sum[a][b]});
        }
      }
    }
  }
}

/// The local numbers of the spring's nodes in an element that has them all.
struct SpringElement {
  int element = -1;
  std::vector<int> local;
};

SpringElement find_element(const TetMesh& mesh,
                           const element::NodeElements& around,
                           const std::vector<int>& nodes) {
  SpringElement found;
  for (const int e : around.of(nodes.front())) {
    const auto ids = mesh.element(e);
    found.local.clear();
    for (const int node : nodes) {
      const auto at = std::find(ids.begin(), ids.end(), node);
      if (at != ids.end()) {
        found.local.push_back(static_cast<int>(at - ids.begin()));
      }
    }
    if (found.local.size() == nodes.size()) {
      found.element = e;
      break;
    }
  }
  return found;
}

/// Half of what mid-sides have goes to each of their ends.
Points on_corners(const Points& of_local) {
  Points corners(of_local.begin(), of_local.begin() + 4);
  for (std::size_t m = 4; m < of_local.size(); ++m) {
    for (const int end : kTetEdges[m - 4]) {
      corners[static_cast<std::size_t>(end)] += 0.5 * of_local[m];
    }
  }
  return corners;
}

void check(const TetMesh& mesh, const loads::NodeSpring& spring,
           const loads::LoadCase& load_case) {
  const auto is_node = [&](int node) {
    return node >= 0 && node < static_cast<int>(mesh.nodes.size());
  };
  const bool fits =
      !spring.nodes.empty() &&
      spring.nodes.size() == spring.coefficients.size() &&
      std::all_of(spring.nodes.begin(), spring.nodes.end(), is_node) &&
      std::all_of(spring.coefficients.begin(), spring.coefficients.end(),
                  [](const Vec3& c) { return c.allFinite(); });
  if (!fits || !(spring.stiffness > 0.0) || !std::isfinite(spring.stiffness)) {
    throw InvalidInput(fmt::format(
        "load case '{}': a spring of stiffness {} has {} nodes and {} "
        "coefficients; give a stiffness above 0 and a finite coefficient for "
        "each node of the mesh",
        load_case.name, spring.stiffness, spring.nodes.size(),
        spring.coefficients.size()));
  }
}

void add_node_springs(const TetMesh& mesh, const loads::LoadCase& load_case,
                      int order, std::vector<Entry>& entries) {
  const element::NodeElements around = element::node_elements(
      mesh.elements, mesh.nodes_per_element(), mesh.nodes_per_element(),
      static_cast<int>(mesh.nodes.size()));
  for (const loads::NodeSpring& spring : load_case.node_springs) {
    check(mesh, spring, load_case);
    const SpringElement at = find_element(mesh, around, spring.nodes);
    if (at.element < 0) {
      throw InvalidInput(fmt::format(
          "load case '{}': the nodes {} of a spring belong to no element that "
          "has them all; a spring can act between nodes of one",
          load_case.name, fmt::join(spring.nodes, ", ")));
    }
    const auto ids = mesh.element(at.element);
    Points c(ids.size(), Vec3::Zero());
    for (std::size_t k = 0; k < at.local.size(); ++k) {
      c[static_cast<std::size_t>(at.local[k])] += spring.coefficients[k];
    }
    if (order == 1) {
      c = on_corners(c);
    }
    for (std::size_t a = 0; a < c.size(); ++a) {
      for (std::size_t b = 0; b < c.size(); ++b) {
        if (ids[a] >= ids[b] && !c[a].isZero(0.0) && !c[b].isZero(0.0)) {
          entries.push_back(
              {{ids[a], ids[b]}, spring.stiffness * c[a] * c[b].transpose()});
        }
      }
    }
  }
}

/// Sorted, with the entries of one place added in their order.
SpringBlocks merged(std::vector<Entry> entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.at < b.at; });
  SpringBlocks result;
  for (const Entry& entry : entries) {
    if (result.at.empty() || result.at.back() != entry.at) {
      result.at.push_back(entry.at);
      result.block.push_back(entry.block);
    } else {
      result.block.back() += entry.block;
    }
  }
  return result;
}

/// Along a fixed direction, or the normal where there is none.
SpringSet spring_set(const TetMesh& mesh, const loads::SpringBed& bed,
                     double stiffness, const std::optional<Vec3>& direction) {
  const double whole =
      bed.measure == loads::SpringMeasure::Total
          ? loads::surface_weights(mesh, bed.surface).weights.sum()
          : 1.0;
  SpringSet set{.stiffness = stiffness};
  element::over_face_points(
      mesh, element::surface_label(mesh, bed.surface), element::FaceRule::Seven,
      [&](int f, const element::FacePoint& point) {
        const double area = point.normal.norm();
        const Vec3 along =
            std::sqrt(area / whole) * direction.value_or(point.normal / area);
        const auto ids = mesh.face(f);
        SpringSet::Spring& spring = set.springs.emplace_back();
        spring.nodes.assign(ids.begin(), ids.end());
        for (std::size_t a = 0; a < ids.size(); ++a) {
          spring.coefficients.push_back(point.shape[a] * along);
        }
      });
  return set;
}

}  // namespace

BedStiffness bed_stiffness_of(const TetMesh& mesh,
                              const loads::SpringBed& bed) {
  const Mat3 axes = bed.axes ? element::unit_axes(*bed.axes) : Mat3::Identity();
  const double area = loads::surface_weights(mesh, bed.surface).weights.sum();
  const double scale =
      bed.measure == loads::SpringMeasure::Total ? 1.0 / area : 1.0;
  return {scale * axes * bed.components.asDiagonal() * axes.transpose(),
          scale * bed.normal};
}

VectorX reactions_of_supports(const VectorX& reactions,
                              const SpringBlocks& springs, const VectorX& u) {
  return springs.at.empty() ? reactions
                            : VectorX(reactions + spring_forces(springs, u));
}

std::vector<SpringSet> spring_sets(const TetMesh& mesh,
                                   const loads::LoadCase& load_case) {
  std::vector<SpringSet> sets;
  for (const loads::SpringBed& bed : load_case.springs) {
    check(bed, load_case);
    const Mat3 axes =
        bed.axes ? element::unit_axes(*bed.axes) : Mat3::Identity();
    for (int c = 0; c < 3; ++c) {
      if (bed.components[c] > 0.0) {
        sets.push_back(
            spring_set(mesh, bed, bed.components[c], Vec3(axes.col(c))));
      }
    }
    if (bed.normal > 0.0) {
      sets.push_back(spring_set(mesh, bed, bed.normal, std::nullopt));
    }
  }
  for (const loads::NodeSpring& spring : load_case.node_springs) {
    check(mesh, spring, load_case);
    const bool alike = !sets.empty() && sets.back().nodal &&
                       sets.back().stiffness == spring.stiffness;
    if (!alike) {
      sets.push_back({.stiffness = spring.stiffness, .nodal = true});
    }
    sets.back().springs.push_back({spring.nodes, spring.coefficients});
  }
  return sets;
}

SpringBlocks spring_blocks(const TetMesh& mesh,
                           const loads::LoadCase& load_case, int order) {
  std::vector<Entry> entries;
  for (const loads::SpringBed& bed : load_case.springs) {
    check(bed, load_case);
    add_bed_stiffness(mesh, bed, order, entries);
  }
  if (!load_case.node_springs.empty()) {
    add_node_springs(mesh, load_case, order, entries);
  }
  return merged(std::move(entries));
}

SpringBlocks renumbered(const SpringBlocks& springs,
                        const std::vector<int>& number) {
  std::vector<Entry> entries;
  for (std::size_t k = 0; k < springs.at.size(); ++k) {
    const int a = number[springs.at[k][0]];
    const int b = number[springs.at[k][1]];
    entries.push_back({{std::max(a, b), std::min(a, b)}, springs.block[k]});
  }
  return merged(std::move(entries));
}

void add_springs(const solver::BlockPattern& pattern,
                 const SpringBlocks& springs,
                 solver::BlockMatrix<double>& matrix) {
  for (std::size_t k = 0; k < springs.at.size(); ++k) {
    const auto [row, column] = springs.at[k];
    double* block = matrix.diagonal.data() + 9L * row;
    if (row != column) {
      const auto first = pattern.column.begin() + pattern.start[row];
      const auto last = pattern.column.begin() + pattern.start[row + 1];
      const auto place = std::lower_bound(first, last, column);
      block = matrix.lower.data() + 9L * (place - pattern.column.begin());
    }
    Eigen::Map<RowMat3>(block) += springs.block[k];
  }
}

VectorX spring_forces(const SpringBlocks& springs, const VectorX& u) {
  VectorX f = VectorX::Zero(u.size());
  for (std::size_t k = 0; k < springs.at.size(); ++k) {
    const auto [a, b] = springs.at[k];
    f.segment<3>(3L * a) += springs.block[k] * u.segment<3>(3L * b);
    if (a != b) {
      f.segment<3>(3L * b) += springs.block[k] * u.segment<3>(3L * a);
    }
  }
  return f;
}

std::vector<HeldDirection> sprung_directions(const TetMesh& mesh,
                                             const loads::LoadCase& load_case) {
  std::vector<HeldDirection> held;
  for (const loads::SpringBed& bed : load_case.springs) {
    check(bed, load_case);
    const Mat3 axes =
        bed.axes ? element::unit_axes(*bed.axes) : Mat3::Identity();
    const element::SurfaceNormals normals =
        element::surface_normals(mesh, bed.surface);
    for (std::size_t k = 0; k < normals.nodes.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        if (bed.components[c] > 0.0) {
          held.push_back({normals.nodes[k], axes.col(c), kExactDirection});
        }
      }
      if (bed.normal > 0.0) {
        held.push_back({normals.nodes[k], normals.normal[k],
                        std::max(kExactDirection, 2.0 * normals.spread[k])});
      }
    }
  }
  for (const loads::NodeSpring& spring : load_case.node_springs) {
    check(mesh, spring, load_case);
    for (std::size_t a = 0; a < spring.nodes.size(); ++a) {
      if (!spring.coefficients[a].isZero(0.0)) {
        held.push_back({spring.nodes[a], spring.coefficients[a].normalized(),
                        kExactDirection});
      }
    }
  }
  return held;
}

}  // namespace meniscus::supports
