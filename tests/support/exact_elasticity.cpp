#include "tests/support/exact_elasticity.h"

#include <cmath>

#include <Eigen/Dense>

#include "fea/element/surface_faces.h"
#include "fea/element/tet_shape.h"

namespace meniscus::exact {

namespace {

struct FacePoint {
  std::array<double, 3> L;
  double weight;  // of the area
};

/// Radon's seven points, exact to degree five.
std::vector<FacePoint> face_rule() {
  const double root = std::sqrt(15.0);
  std::vector<FacePoint> rule = {{{1.0 / 3, 1.0 / 3, 1.0 / 3}, 9.0 / 40.0}};
  for (const double sign : {-1.0, 1.0}) {
    const double a = (6.0 + sign * root) / 21.0;
    const double weight = (155.0 + sign * root) / 1200.0;
    for (int c = 0; c < 3; ++c) {
      rule.push_back({{a, a, a}, weight});
      rule.back().L[c] = 1.0 - 2.0 * a;
    }
  }
  return rule;
}

/// Calls visit(nodes, shapes, place, outward normal times weight) at the points
/// of a surface.
template <class Visit>
void for_surface_points(const TetMesh& mesh, const std::string& surface,
                        const Visit& visit) {
  static const std::vector<FacePoint> kRule = face_rule();
  constexpr double kSlope[3][2] = {{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
  const int label = element::surface_label(mesh, surface);
  const int count = mesh.nodes_per_face();
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] != label) {
      continue;
    }
    const auto ids = mesh.face(f);
    for (const auto& [L, weight] : kRule) {
      std::array<double, 6> N{};
      Vec3 x = Vec3::Zero();
      std::array<Vec3, 2> tangent = {Vec3::Zero(), Vec3::Zero()};
      for (int a = 0; a < count; ++a) {
        const int i = a % 3;
        const int j = (a + 1) % 3;
        const bool corner = a < 3;
        N[a] = corner ? (mesh.order == 1 ? L[i] : L[i] * (2.0 * L[i] - 1.0))
                      : 4.0 * L[i] * L[j];
        x += N[a] * mesh.nodes[ids[a]];
        for (int k = 0; k < 2; ++k) {
          const double d =
              corner ? kSlope[i][k] * (mesh.order == 1 ? 1.0 : 4.0 * L[i] - 1.0)
                     : 4.0 * (kSlope[i][k] * L[j] + kSlope[j][k] * L[i]);
          tangent[k] += d * mesh.nodes[ids[a]];
        }
      }
      const Vec3 normal = 0.5 * weight * tangent[0].cross(tangent[1]);
      visit(ids, N, x, normal);
    }
  }
}

Mat3 tensor(const element::Stress& s) {
  return element::stress_tensor(Eigen::Map<const element::Vec6>(s.data()));
}

/// Calls visit(element, nodal shapes, L, place, volume) at the points of the
/// fine rule.
template <int Nodes, class Visit>
void for_volume_points(const TetMesh& mesh, const Visit& visit) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    std::array<Vec3, Nodes> x;
    for (int a = 0; a < Nodes; ++a) {
      x[a] = mesh.nodes[ids[a]];
    }
    for (const auto& [L, weight] : element::fine_tet_rule()) {
      const auto N = element::tet_shapes<Nodes>(L);
      Vec3 place = Vec3::Zero();
      for (int a = 0; a < Nodes; ++a) {
        place += N[a] * x[a];
      }
      const double det = element::gradient_at<Nodes>(x, x, L).determinant;
      visit(e, x, N, L, place, weight * det / 6.0);
    }
  }
}

template <int Nodes>
void add_body_force(const TetMesh& mesh, const Field& field, VectorX& f) {
  for_volume_points<Nodes>(
      mesh, [&](int e, const auto&, const auto& N, const element::Barycentric&,
                const Vec3& place, double volume) {
        const Vec3 b = field.at(place).body_force;
        for (int a = 0; a < Nodes; ++a) {
          f.segment<3>(3L * mesh.element(e)[a]) += volume * N[a] * b;
        }
      });
}

template <int Nodes>
Norms norms(const TetMesh& mesh, const Field& field, const VectorX& u) {
  Norms sum;
  const element::ElasticLaw law = element::elastic_law(field.material());
  for_volume_points<Nodes>(mesh, [&](int e, const auto& x, const auto& N,
                                     const element::Barycentric& L,
                                     const Vec3& place, double volume) {
    std::array<Vec3, Nodes> nodal;
    Vec3 here = Vec3::Zero();
    for (int a = 0; a < Nodes; ++a) {
      nodal[a] = u.segment<3>(3L * mesh.element(e)[a]);
      here += N[a] * nodal[a];
    }
    const State exact = field.at(place);
    const element::Stress found = element::stress_of_gradient(
        element::gradient_at<Nodes>(x, nodal, L).gradient, law);
    element::Stress d;
    for (int k = 0; k < 6; ++k) {
      d[k] = found[k] - exact.stress[k];
    }
    sum.l2 += volume * (here - exact.u).squaredNorm();
    sum.energy += volume * element::complementary_product(d, d, law);
    sum.l2_exact += volume * exact.u.squaredNorm();
    sum.energy_exact += volume * element::complementary_product(
                                     exact.stress, exact.stress, law);
  });
  return {std::sqrt(sum.l2), std::sqrt(sum.energy), std::sqrt(sum.l2_exact),
          std::sqrt(sum.energy_exact)};
}

}  // namespace

Field::Field(const element::Material& material, Displacement displacement)
    : material_(material),
      lame_(element::lame(material)),
      displacement_(std::move(displacement)) {}

State Field::at(const Vec3& x) const {
  const DualVec u =
      displacement_({Dual::variable(x.x(), 0), Dual::variable(x.y(), 1),
                     Dual::variable(x.z(), 2)});
  State state;
  Mat3 H;
  for (int i = 0; i < 3; ++i) {
    state.u[i] = u[i].value;
    H.row(i) = u[i].gradient.transpose();
  }
  state.stress = element::stress_of_gradient(H, element::ElasticLaw(lame_));
  for (int i = 0; i < 3; ++i) {
    // div stress = (lambda + mu) grad div u + mu laplace u
    double slope = 0.0;
    for (int j = 0; j < 3; ++j) {
      slope += u[j].hessian(j, i);
    }
    state.body_force[i] =
        -(lame_.lambda + lame_.mu) * slope - lame_.mu * u[i].hessian.trace();
  }
  return state;
}

VectorX loads(const TetMesh& mesh, const Field& field,
              const std::vector<std::string>& surfaces, BodyForce body) {
  VectorX f = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  for (const std::string& surface : surfaces) {
    for_surface_points(
        mesh, surface,
        [&](const auto& ids, const auto& N, const Vec3& x, const Vec3& normal) {
          const Vec3 t = tensor(field.at(x).stress) * normal;
          for (std::size_t a = 0; a < ids.size(); ++a) {
            f.segment<3>(3L * ids[a]) += N[a] * t;
          }
        });
  }
  if (body == BodyForce::Included) {
    mesh.order == 1 ? add_body_force<4>(mesh, field, f)
                    : add_body_force<10>(mesh, field, f);
  }
  return f;
}

double mean_displacement(const TetMesh& mesh, const Field& field,
                         const std::string& surface, const Vec3& direction) {
  double area = 0.0;
  double sum = 0.0;
  for_surface_points(
      mesh, surface,
      [&](const auto&, const auto&, const Vec3& x, const Vec3& normal) {
        area += normal.norm();
        sum += normal.norm() * field.at(x).u.dot(direction);
      });
  return sum / (area * direction.norm());
}

Norms error_norms(const TetMesh& mesh, const Field& field, const VectorX& u) {
  return mesh.order == 1 ? norms<4>(mesh, field, u) : norms<10>(mesh, field, u);
}

}  // namespace meniscus::exact
