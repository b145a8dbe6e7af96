#include "evolve/films/put_on_constraints.h"

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"

namespace meniscus::films {

namespace {

constexpr int kSteps = 60;
constexpr double kOff = 1e-10;    // Evolver's own tolerance is 1e-12
constexpr double kStill = 1e-15;  // of the position: rounding

// Largest value of the formulas that must vanish at p; their values and
// gradients (rows).
double violation(const FilmComplex& complex, int set, const Vec3& p,
                 Eigen::VectorXd& f, Eigen::MatrixXd& gradients) {
  const std::array<Dual, 3> at = {Dual::variable(p.x(), 0, 3),
                                  Dual::variable(p.y(), 1, 3),
                                  Dual::variable(p.z(), 2, 3)};
  std::vector<Dual> rows;
  for (const int index : complex.constraint_sets[set]) {
    const LevelSet& level = complex.level_sets[index];
    Dual value = level.formula.evaluate(at);
    const bool holds =
        (level.side == LevelSet::Side::AtLeast && value.value >= 0.0) ||
        (level.side == LevelSet::Side::AtMost && value.value <= 0.0);
    if (!holds && !value.is_constant()) {
      rows.push_back(std::move(value));
    } else if (!holds && value.value != 0.0) {
      throw InvalidInput(fmt::format("'{}' has the value {} everywhere",
                                     level.name, value.value));
    }
  }
  f.resize(static_cast<Eigen::Index>(rows.size()));
  gradients.resize(f.size(), 3);
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    f[k] = rows[k].value;
    gradients.row(k) = rows[k].gradient.transpose();
  }
  return f.size() == 0 ? 0.0 : f.cwiseAbs().maxCoeff();
}

}  // namespace

Vec3 put_on_constraints(const FilmComplex& complex, int set, const Vec3& from) {
  if (set < 0) {
    return from;
  }
  Vec3 p = from;
  double off = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::VectorXd f;
    Eigen::MatrixXd gradients;
    try {
      off = violation(complex, set, p, f, gradients);
    } catch (const ExpressionError& error) {
      throw InvalidInput(error.what());
    }
    if (off == 0.0) {
      return p;
    }
    const Vec3 move = least_norm(gradients, f);
    p -= move;
    if (!p.allFinite() || move.norm() <= kStill * p.norm()) {
      break;
    }
  }
  if (!(off <= kOff)) {
    throw InvalidInput(fmt::format(
        "the vertex at ({}, {}, {}) cannot be put onto its constraints: a "
        "formula stays at {}; start nearer to them",
        from.x(), from.y(), from.z(), off));
  }
  return p;
}

}  // namespace meniscus::films
