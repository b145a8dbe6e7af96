#include "fea/stress_measures.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace meniscus {

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
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(tensor(stress));
  PrincipalFrame frame;
  frame.stress = solver.eigenvalues().reverse();
  frame.direction.col(0) = solver.eigenvectors().col(2);
  frame.direction.col(1) = solver.eigenvectors().col(1);
  frame.direction.col(2) = frame.direction.col(0).cross(frame.direction.col(1));
  return frame;
}

Stress stress_of_gradient(const Mat3& H, const ElasticLaw& law) {
  const Mat3 s = law.stress(H);
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

Mat6 compliance(const ElasticLaw& law) {
  return law.stiffness.ldlt().solve(Mat6::Identity());
}

std::vector<Mat6> compliances(const std::vector<Material>& materials) {
  std::vector<Mat6> all;
  all.reserve(materials.size());
  for (const Material& material : materials) {
    all.push_back(compliance(elastic_law(material)));
  }
  return all;
}

Strain strain_of(const Stress& stress, const Mat6& compliance) {
  Strain strain;
  Eigen::Map<Vec6>(strain.data()) =
      compliance * Eigen::Map<const Vec6>(stress.data());
  return strain;
}

double complementary_product(const Stress& a, const Stress& b,
                             const Mat6& compliance) {
  return Eigen::Map<const Vec6>(a.data()).dot(compliance *
                                              Eigen::Map<const Vec6>(b.data()));
}

double strain_energy_density(const Stress& stress, const Mat6& compliance) {
  return 0.5 * complementary_product(stress, stress, compliance);
}

}  // namespace meniscus
