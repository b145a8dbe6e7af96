#include "fea/element/stress_measures.h"

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/math/dense.h"

namespace meniscus::element {

namespace {

Mat3 tensor(const Stress& s) {
  Mat3 t;
  t << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return t;
}

}  // namespace

double von_mises(const Stress& s) {
  const double a = s[0] - s[1];
  const double b = s[1] - s[2];
  const double c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) +
                   3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

Vec3 principal_stresses(const Stress& stress) {
  return principal_frame(stress).stress;
}

PrincipalFrame principal_frame(const Stress& stress) {
  const auto solver = symmetric_eigen(tensor(stress));
  PrincipalFrame frame;
  frame.stress = solver.values.reverse();
  frame.direction.col(0) = solver.vectors.col(2);
  frame.direction.col(1) = solver.vectors.col(1);
  frame.direction.col(2) = frame.direction.col(0).cross(frame.direction.col(1));
  return frame;
}

Stress stress_of_gradient(const Mat3& H, const Lame& m) {
  const double pressure = m.lambda * H.trace();
  return {pressure + 2.0 * m.mu * H(0, 0), pressure + 2.0 * m.mu * H(1, 1),
          pressure + 2.0 * m.mu * H(2, 2), m.mu * (H(0, 1) + H(1, 0)),
          m.mu * (H(1, 2) + H(2, 1)),      m.mu * (H(2, 0) + H(0, 2))};
}

Strain strain_of(const Stress& s, const Lame& m) {
  const double half = 0.5 / m.mu;
  const double common =
      half * m.lambda / (3.0 * m.lambda + 2.0 * m.mu) * (s[0] + s[1] + s[2]);
  return {half * s[0] - common, half * s[1] - common, half * s[2] - common,
          half * s[3],          half * s[4],          half * s[5]};
}

double complementary_product(const Stress& a, const Stress& b, const Lame& m) {
  const Strain e = strain_of(b, m);
  return a[0] * e[0] + a[1] * e[1] + a[2] * e[2] +
         2.0 * (a[3] * e[3] + a[4] * e[4] + a[5] * e[5]);
}

double strain_energy_density(const Stress& stress, const Lame& material) {
  return 0.5 * complementary_product(stress, stress, material);
}

}  // namespace meniscus::element
