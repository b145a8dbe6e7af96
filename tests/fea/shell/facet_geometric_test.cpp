#include "fea/shell/facet_geometric.h"

#include <array>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "fea/shell/facet_resultants.h"

namespace meniscus::facet_geometric_test {
namespace {

using namespace shell;  // NOLINT: the room under test

class Numbers {
 public:
  double between(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Vec3 vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  FacetVector field(double size) {
    FacetVector x;
    for (int i = 0; i < kUnknowns; ++i) {
      x[i] = between(-size, size);
    }
    return x;
  }

 private:
  std::mt19937 random_{11};
};

/// Two crossed plies on a curved facet, beside its surface.
struct DrawnFacet {
  explicit DrawnFacet(Numbers& draw)
      : section{.laminate = {.plies = {ply(draw), ply(draw)}},
                .offset = draw.between(-0.5, 0.5)},
        law(laminate_law(section.laminate)) {
    const std::array<Vec3, kNodes> flat = {Vec3(0, 0, 0),     Vec3(1, 0, 0),
                                           Vec3(0, 1, 0),     Vec3(0.5, 0, 0),
                                           Vec3(0.5, 0.5, 0), Vec3(0, 0.5, 0)};
    for (int i = 0; i < kNodes; ++i) {
      facet.nodes[i] = flat[i] + draw.vector(0.08);
    }
    facet.thickness = Vec3(0.2, 0.2, 0.2) + draw.vector(0.05);
    facet.offset = section.offset;
    facet.law = &law;
    own.negative = draw.between(-1.0, 1.0);
    own.middle = draw.between(-1.0, 1.0);
    own.positive = draw.between(-1.0, 1.0);
    loads.gravity = draw.vector(1.0);
    loads.temperature = WallTemperature{draw.between(-1, 1), 0.3};
    u = draw.field(0.1);
  }
  DrawnFacet(const DrawnFacet&) = delete;
  DrawnFacet& operator=(const DrawnFacet&) = delete;
  ~DrawnFacet() = default;

  static Ply ply(Numbers& draw) {
    element::Material material{"m", draw.between(50, 80), 0.3, 2.0, {}};
    material.thermal_expansion = Vec3::Constant(1e-2);
    return {.material = material, .share = draw.between(0.5, 1.0)};
  }

  Section section;
  LaminateLaw law;
  Facet facet;
  FacetLoad own;
  ShellLoads loads;
  FacetVector u;
};

/// The facet moved by s x, its rotations finite.
class MovedFacet {
 public:
  MovedFacet(const DrawnFacet& drawn, const FacetVector& x, double s)
      : X_(triples(drawn.facet)),
        x_(s * Eigen::Map<const FacetField>(x.data())) {}

  Vec3 slope(const FacetPoint& p, int a) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < kNodes; ++i) {
      sum += p.slope(i, a) * place(i);
    }
    return sum;
  }

  Mat3 turn(const FacetPoint& p) const {
    Vec3 theta = Vec3::Zero();
    for (int i = 0; i < kNodes; ++i) {
      theta += p.shape[i] * x_.col(i).tail<3>();
    }
    const double angle = theta.norm();
    return angle > 0.0
               ? Eigen::AngleAxisd(angle, theta / angle).toRotationMatrix()
               : Mat3::Identity();
  }

  Vec3 normal(const FacetPoint& p) const {
    return turn(p) * as_vector(facet_frame(X_, p, nullptr).axes[2]);
  }

  Vec3 normal_slope(const FacetPoint& p, int a) const {
    constexpr double kStep = 1e-4;
    const Vec3 at = corner_shares(p);
    const auto there = [&](double way) {
      return normal(facet_functions(at[1] + (a == 0 ? way : 0.0),
                                    at[2] + (a == 1 ? way : 0.0)));
    };
    return (there(kStep) - there(-kStep)) / (2.0 * kStep);
  }

  /// Products of the surface's tangents, interpolated as strains are.
  Vec3 metric(const FacetPoint& p) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j < kNodes; ++j) {
        sum += place(i).dot(place(j)) * p.stretched.block<3, 1>(3 * i, j);
      }
    }
    return sum;
  }

 private:
  Vec3 place(int i) const { return as_vector(X_[i]) + x_.col(i).head<3>(); }

  std::array<Triple<double>, kNodes> X_;
  FacetField x_;
};

/// Work of held resultants on the strains of Green and Lagrange, x,a and (R
/// n),a in place of tangents and their derivatives; the loads' taken off.
double work_on_strains(const DrawnFacet& drawn, const FacetVector& x,
                       double s) {
  const Facet& facet = drawn.facet;
  const auto X = triples(facet);
  const FacetField field = Eigen::Map<const FacetField>(drawn.u.data());
  const Eigen::Vector2d b =
      bubble_rotation(whole_stiffness(facet),
                      facet_forces(facet, drawn.loads, drawn.own), drawn.u);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = plus(times(b[0], axes[0]), b[1], axes[1]);
  const MovedFacet moved(drawn, x, s);
  double sum = 0.0;
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, nullptr);
    const FacetStrain<double> strain = facet_strain(X, p, frame, field, bubble);
    const FacetResultants<double> r =
        facet_resultants<double>({facet, drawn.loads, drawn.own, p, frame,
                                  strain, thickness_at(facet, p)});
    const auto along = [&](int i, const auto& by_coordinate) -> Vec3 {
      return frame.by_axis[i][0] * by_coordinate(0) +
             frame.by_axis[i][1] * by_coordinate(1);
    };
    std::array<Vec3, 2> tangent;
    std::array<Vec3, 2> turning;
    for (int i = 0; i < 2; ++i) {
      tangent[i] = along(i, [&](int a) { return moved.slope(p, a); });
      turning[i] = along(i, [&](int a) { return moved.normal_slope(p, a); });
    }
    const Mat3 R = moved.turn(p);
    const Vec3 n = moved.normal(p);
    const Vec3 metric = moved.metric(p);
    const auto& g = frame.by_axis;
    double here = -as_vector(r.lever).dot(n);
    for (int i = 0; i < 2; ++i) {
      here += r.shear[i] * tangent[i].dot(n);
      here += (i == 0 ? 1.0 : -1.0) * r.drilling *
              (R.transpose() * tangent[i]).dot(as_vector(frame.axes[1 - i]));
      for (int j = 0; j < 2; ++j) {
        const double stretch =
            g[i][0] * g[j][0] * metric[0] +
            (g[i][0] * g[j][1] + g[i][1] * g[j][0]) * metric[1] +
            g[i][1] * g[j][1] * metric[2];
        here += 0.5 * r.stress[0][i][j] * stretch +
                r.stress[1][i][j] * tangent[i].dot(turning[j]) +
                0.5 * r.stress[2][i][j] * turning[i].dot(turning[j]);
      }
    }
    sum += p.weight * frame.area * here;
  }
  return sum;
}

/// Second difference of fourth order, of turns of 1/100.
double curvature_of_work(const DrawnFacet& drawn, const FacetVector& x) {
  constexpr double kStep = 1e-2;
  const auto at = [&](double s) { return work_on_strains(drawn, x, s); };
  return (16.0 * (at(kStep) + at(-kStep)) - at(2 * kStep) - at(-2 * kStep) -
          30.0 * at(0.0)) /
         (12.0 * kStep * kStep);
}

TEST(FacetGeometric, IsTheCurvatureOfWorkOnFiniteTurns) {
  constexpr double kDifferences = 1e-6;
  Numbers draw;
  for (int k = 0; k < 5; ++k) {
    const DrawnFacet drawn(draw);
    const FacetMatrix K =
        facet_geometric(drawn.facet, drawn.loads, drawn.own, drawn.u);
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
    const FacetVector x = draw.field(1.0);
    EXPECT_NEAR(x.dot(K * x), curvature_of_work(drawn, x),
                kDifferences * K.norm() * x.squaredNorm());
  }
}

}  // namespace
}  // namespace meniscus::facet_geometric_test
