/// One element's part of a sweep (element_sweep.h).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/LU>

#include "core/geometry/tet_mesh.h"
#include "fea/element/tet_rules.h"

namespace meniscus::element {

template <std::size_t Fields>
struct SweepPoint {
  int element;
  int point;
  double volume;                      // weight x det J [length^3]
  std::array<Mat3, Fields> gradient;  // dv_i/dx_j of each field
  std::span<const double> shape;      // of the element's nodes
  std::span<const int> nodes;
};

/// What a point adds to node a of output k: by_gradient[k] g_a +
/// by_shape[k] N_a, g_a and N_a being the node's shape function and its
/// gradient there; and to the nodal scalar by_scalar N_a.
template <std::size_t Outputs>
struct SweepFlux {
  std::array<Mat3, Outputs> by_gradient;
  std::array<Vec3, Outputs> by_shape;
  double by_scalar = 0.0;

  SweepFlux() {
    by_gradient.fill(Mat3::Zero());
    by_shape.fill(Vec3::Zero());
  }
};

/// 3 numbers per node each; `scalar`, one per node, may be null, and must be
/// without outputs.
template <std::size_t Fields, std::size_t Outputs>
struct SweepTargets {
  std::array<const VectorX*, Fields> fields;
  std::array<VectorX*, Outputs> outputs;
  VectorX* scalar = nullptr;
};

namespace element_sweep {

/// Columns of four numbers, the fourth 0 or a nodal scalar's: a register each.
template <int Count>
using Padded = Eigen::Matrix<double, 4, Count>;

template <int Nodes, std::size_t Outputs>
using Local = std::array<Padded<Nodes>, Outputs>;

template <int Nodes>
Padded<3> by_reference(const Padded<Nodes>& v,
                       const Eigen::Matrix<double, Nodes, 3>& slopes) {
  Padded<3> result;
  for (int j = 0; j < 3; ++j) {
    Padded<1> sum = slopes(0, j) * v.col(0);
    for (int a = 1; a < Nodes; ++a) {
      sum += slopes(a, j) * v.col(a);
    }
    result.col(j) = sum;
  }
  return result;
}

template <int Nodes>
void add_flux(const typename TetRule<Nodes>::Point& point, const Mat3& inverse,
              const Mat3& by_gradient, const Vec3& by_shape, double by_scalar,
              Padded<Nodes>& output) {
  Padded<3> pulled;
  pulled.template topRows<3>().noalias() = by_gradient * inverse.transpose();
  pulled.row(3).setZero();
  const Padded<1> shaped(by_shape.x(), by_shape.y(), by_shape.z(), by_scalar);
  for (int a = 0; a < Nodes; ++a) {
    output.col(a) += point.slopes(a, 0) * pulled.col(0) +
                     point.slopes(a, 1) * pulled.col(1) +
                     point.slopes(a, 2) * pulled.col(2) +
                     point.shape[a] * shaped;
  }
}

template <int Nodes, std::size_t Fields, std::size_t Outputs, class Work>
void add_element(const TetMesh& mesh, const TetRule<Nodes>& rule,
                 const SweepTargets<Fields, Outputs>& targets, int e,
                 const Work& work, Local<Nodes, Outputs>& local) {
  const auto ids = mesh.element(e);
  Padded<Nodes> x;
  std::array<Padded<Nodes>, Fields> v;  // relative to one node: no rigid shift
  for (int a = 0; a < Nodes; ++a) {
    x.col(a) << mesh.nodes[ids[a]], 0.0;
    for (std::size_t k = 0; k < Fields; ++k) {
      const VectorX& field = *targets.fields[k];
      v[k].col(a) << field.segment<3>(3L * ids[a]) -
                         field.segment<3>(3L * ids[0]),
          0.0;
    }
  }
  for (Padded<Nodes>& output : local) {
    output.setZero();
  }
  SweepPoint<Fields> at{.element = e, .nodes = ids};
  for (std::size_t q = 0; q < rule.points.size(); ++q) {
    const auto& point = rule.points[q];
    const Mat3 F = by_reference(x, point.slopes).template topRows<3>();
    const Mat3 inverse = F.inverse();
    at.point = static_cast<int>(q);
    at.volume = point.weight * F.determinant();
    at.shape = point.shape;
    for (std::size_t k = 0; k < Fields; ++k) {
      at.gradient[k].noalias() =
          by_reference(v[k], point.slopes).template topRows<3>() * inverse;
    }
    SweepFlux<Outputs> flux;
    work(at, flux);
    for (std::size_t k = 0; k < Outputs; ++k) {
      add_flux<Nodes>(point, inverse, flux.by_gradient[k], flux.by_shape[k],
                      k == 0 ? flux.by_scalar : 0.0, local[k]);
    }
  }
}

}  // namespace element_sweep

}  // namespace meniscus::element
