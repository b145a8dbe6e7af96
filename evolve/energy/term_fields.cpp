#include "evolve/energy/term_fields.h"

#include "evolve/energy/film_space.h"

namespace meniscus::energy {

FieldFunction expression_field(const films::VectorField& field) {
  return [field](const Vec3& at, JetOrder order) {
    FieldJet jet;
    for (int m = 0; m < 3; ++m) {
      if (order == JetOrder::Value) {  // duals cost several times as much
        jet.value[m] = value_at(field[m], at);
        continue;
      }
      const PlaceJet part = jet_at(field[m], at);
      jet.value[m] = part.value;
      jet.slope.row(m) = part.gradient;
      jet.bend[m] = part.hessian;
    }
    return jet;
  };
}

FieldFunction weight_field(double density, const Vec3& g) {
  return [density, g](const Vec3& at, JetOrder /*order*/) {
    FieldJet jet;
    const double along = g.dot(at);
    const double scale = -density / g.squaredNorm();
    jet.value = 0.5 * scale * along * along * g;
    jet.slope = scale * along * g * g.transpose();
    for (int m = 0; m < 3; ++m) {
      jet.bend[m] = scale * g[m] * g * g.transpose();
    }
    return jet;
  };
}

FieldJet column_field(const Vec3& at, JetOrder /*order*/) {
  FieldJet jet;
  jet.value = Vec3(0, 0, at.z());
  jet.slope(2, 2) = 1.0;
  jet.bend.fill(Eigen::Matrix3d::Zero());
  return jet;
}

FieldJet cone_field(const Vec3& at, JetOrder /*order*/) {
  FieldJet jet;
  jet.value = at / 3.0;
  jet.slope = Eigen::Matrix3d::Identity() / 3.0;
  jet.bend.fill(Eigen::Matrix3d::Zero());
  return jet;
}

}  // namespace meniscus::energy
