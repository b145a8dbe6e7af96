#include "fea/equations/equilibrium_check.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace meniscus::equations {

namespace {

/// Rounding of the largest terms of a row, with room for their sum.
constexpr double kRounding = 1e-14;
/// A free load so small beside all of it is what a solution left.
constexpr double kHeldAlone = 1e-9;
/// A residual's norm weighs short waves more than the energy norm does.
constexpr double kShortWaves = 1e4;
/// The sum of residuals is the work of the error on a rigid motion that the
/// supports cut off, so that imbalance / tolerance may reach |u| |motion| /
/// |f| in energy norms, sqrt(compliance x stiffness of the elements at the
/// supports): about 40 for a slender part, and more on fine meshes.
constexpr double kCutMotion = 1e3;

/// 1 on the nodes of pins that nothing but the part holds.
std::vector<char> on_free_pins(const supports::Restraints& restraints) {
  std::vector<char> marks(static_cast<std::size_t>(restraints.freedom.nodes),
                          0);
  for (const supports::PinFrame& pin : restraints.pins) {
    for (const int node : pin.nodes) {
      marks[node] = pin.is_free() ? 1 : 0;
    }
  }
  return marks;
}

}  // namespace

Equilibrium check_equilibrium(const EquilibriumInput& input) {
  Equilibrium result;
  result.reactions = VectorX::Zero(input.f.size());
  double load = 0.0;
  double all = 0.0;
  double error = 0.0;
  double rounding = 0.0;
  std::size_t h = 0;
  const solver::NodeFreedom& freedom = input.restraints.freedom;
  // What the held pass on to the rest is load where they are moved.
  const bool driven = input.enforced || !input.restraints.pins.empty();
  double total = 0.0;
  // Node by node, P the projector on what is free: reactions
  // (I - P)(K u - f) - P S u and the residual P (f - K u - S u).
  for (Eigen::Index i = 0; i < input.f.size() / 3; ++i) {
    Mat3 P = Mat3::Identity();
    if (h < freedom.held.size() && freedom.held[h] == i) {
      P = freedom.projector[h++];
    }
    const Vec3 f = P * input.f.segment<3>(3 * i);
    const Vec3 pull = input.springs.segment<3>(3 * i);
    const Vec3 gap =
        input.f.segment<3>(3 * i) - input.internal.segment<3>(3 * i);
    result.reactions.segment<3>(3 * i) = P * gap - gap - P * pull;
    load += f.squaredNorm();
    all += input.f.segment<3>(3 * i).squaredNorm();
    total += input.f.segment<3>(3 * i).norm();
    if (driven) {
      const Vec3 passed = input.internal.segment<3>(3 * i) -
                          P * input.internal.segment<3>(3 * i);
      load += passed.squaredNorm();
      total += passed.norm();
    }
    error += (P * (gap - pull)).squaredNorm();
    rounding += input.diagonal.segment<3>(3 * i)
                    .cwiseProduct(P * input.u.segment<3>(3 * i))
                    .squaredNorm();
  }
  // Relative to the free load; rounding as the diagonal lets u carry it. Loads
  // on what is held alone, as the dual ones of the strain energy where
  // displacements are enforced, leave the rest what the solution left it.
  if (load > kHeldAlone * kHeldAlone * all) {
    result.residual = std::sqrt(error / load);
    result.rounding = kRounding * std::sqrt(rounding / load);
  }
  // Moments about the middle, over the part's size: forces and moments then
  // have one unit and add up.
  Vec3 centre = Vec3::Zero();
  for (const Vec3& x : input.x) {
    centre += x / static_cast<double>(input.x.size());
  }
  double size = 0.0;
  for (const Vec3& x : input.x) {
    size = std::max(size, (x - centre).norm());
  }
  // Loads and reactions of a body at rest sum to zero.
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  const std::vector<char> balanced = on_free_pins(input.restraints);
  for (std::size_t i = 0; i < input.x.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    const Vec3 held = balanced[i] == 0 ? Vec3(result.reactions.segment<3>(at))
                                       : Vec3(-input.springs.segment<3>(at));
    const Vec3 sum = input.f.segment<3>(at) + held;
    force += sum;
    moment += ((input.x[i] - centre) / size).cross(sum);
  }
  result.imbalance = (force.norm() + moment.norm()) / total;
  result.energy = 0.5 * input.u.dot(input.internal);
  return result;
}

std::optional<Failure> check_residual(const Equilibrium& equilibrium,
                                      double tolerance,
                                      const std::string& load_case) {
  const double residual_bound =
      std::max(kShortWaves * tolerance, equilibrium.rounding);
  if (!(equilibrium.residual <= residual_bound)) {
    return Failure{
        FailureKind::SolverFailed,
        fmt::format("load case '{}': the relative residual of the displacement "
                    "is {:.2e}, above {:.2e}: the part is nearly a mechanism, "
                    "or its elements are badly shaped",
                    load_case, equilibrium.residual, residual_bound)};
  }
  const double balance_bound =
      std::max(kCutMotion * tolerance, equilibrium.rounding);
  if (!(equilibrium.imbalance <= balance_bound)) {
    return Failure{
        FailureKind::SolverFailed,
        fmt::format("load case '{}': reactions and loads differ by {:.2e} of "
                    "the load, above {:.2e}: the part is nearly a mechanism, "
                    "or its elements are badly shaped",
                    load_case, equilibrium.imbalance, balance_bound)};
  }
  return std::nullopt;
}

}  // namespace meniscus::equations
