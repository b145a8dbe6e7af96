#include "evolve/settle/curvature_flow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "core/error.h"
#include "core/math/dense.h"
#include "evolve/energy/laplacian.h"
#include "evolve/films/triangle_shape.h"
#include "evolve/groom/flip_average.h"

namespace meniscus::settle {

namespace {

constexpr double kVolumeStep = 0.15;     // most relative change a step
constexpr double kVolumeReached = 1e-6;  // relative
constexpr int kPressureIterations = 12;
// Facets with a smaller angle are evened out: as far as a rim that slides
// squeezes them, they would hold the film up.
constexpr double kThin = 10.0 * std::numbers::pi / 180.0;

constexpr double kJunctionsRest = 1e-3;  // way in a step, over the mean edge
// The Laplacian of a film that stands still already resists its own motion:
// of a tube by T/R^2, so that this share of the spines' stiffness makes every
// step stable, and more of it only slow.
constexpr double kSpineShare = 0.6;
// Way in a step, over the mean edge, at the usual change of energy.
constexpr double kSpinesRest = 0.1;
constexpr double kProbe = 1e-3;  // x mean edge
constexpr int kPasses = 10;      // of averaging, a step at most

bool has_thin_facet(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.facets[f];
    if (complex.surfaces[mesh.facet_label[f]].liquid &&
        films::smallest_angle(mesh.points[a], mesh.points[b], mesh.points[c]) <
            kThin) {
      return true;
    }
  }
  return false;
}

class Flow {
 public:
  Flow(films::FilmComplex& complex, const FlowOptions& options)
      : complex_(complex),
        energy_(complex),
        targets_(energy::targets_of(complex)),
        most_motion_(options.most_motion),
        short_volume_steps_(options.short_volume_steps) {
    const std::size_t count = complex.mesh.points.size();
    unknown_of_.assign(count, -1);
    for (const int v : energy_.vertices()) {
      if (unknown_of_[v] < 0) {
        unknown_of_[v] = static_cast<int>(movers_.size());
        movers_.push_back(v);
      }
    }
    const double most = films::largest_tension(targets_);
    for (const int label : complex.mesh.facet_label) {
      // A film whose tension is a function or 0 still keeps its facets apart.
      const bool film = complex.surfaces[label].liquid;
      facet_weight_.push_back(
          film ? std::max(targets_.tension[label], 0.1 * most) : 0.0);
    }
    spined_ =
        std::any_of(complex.quantities.begin(), complex.quantities.end(),
                    [](const auto& q) {
                      return q.kind == films::FilmQuantity::Kind::BodyPoles;
                    });
    const energy::FilmSpace& space = energy_.space();
    for (std::size_t k = 0; k < space.walled().size(); ++k) {
      const int v = space.walled()[k];
      if (unknown_of_[v] >= 0 && space.is_on_bent(static_cast<int>(k)) &&
          space.line_ends(v)[0] >= 0) {
        bent_rims_.push_back(v);
      }
    }
    const double edge = energy_.mean_edge(complex.mesh.points);
    const double diagonal = bounding_diagonal(complex.mesh.points);
    tau_ = options.smoothing * options.smoothing * edge * edge;
    most_tau_ = std::max(tau_, diagonal * diagonal);
    for (int b = 0; b < energy_.functionals(); ++b) {
      if (targets_.bodies[b].volume) {
        held_.push_back(b);
      }
    }
  }

  const energy::FilmEnergy& film() const { return energy_; }

  /// Largest way of a place where lines meet since `old`, over the mean edge.
  /// Newton keeps a line's other vertices where they are along it, so it moves
  /// such a place by a part of an edge only: the flow has to bring it there.
  double junction_motion(const Points& old) const {
    const Points& x = complex_.mesh.points;
    double most = 0.0;
    for (const int v : movers_) {
      if (energy_.space().rank(v) == 3) {
        most = std::max(most, (x[v] - old[v]).norm());
      }
    }
    return most / energy_.mean_edge(x);
  }

  bool is_spined() const { return spined_; }

  /// Largest way along the film's normals since `old`, over the mean edge.
  double normal_motion(const Points& old) const {
    const Points normals = energy_.space().directions(old);
    double most = 0.0;
    for (const int v : movers_) {
      const int first = energy_.space().first(v);
      const Vec3 way = complex_.mesh.points[v] - old[v];
      for (int r = 0; r < energy_.space().rank(v); ++r) {
        most = std::max(most, std::abs(way.dot(normals[first + r])));
      }
    }
    return most / energy_.mean_edge(old);
  }

  bool has_unknowns() const { return energy_.unknowns() > 0; }

  bool at_volume() const {
    const VectorX v = energy_.volumes(complex_.mesh.points);
    return std::all_of(held_.begin(), held_.end(), [&](int b) {
      const double target = *targets_.bodies[b].volume;
      return std::abs(v[b] - target) <= kVolumeReached * std::abs(target);
    });
  }

  double energy() const {
    const Points& x = complex_.mesh.points;
    double sum = energy_.value(x, targets_);
    const VectorX v = energy_.volumes(x);
    for (int b = 0; b < energy_.functionals(); ++b) {
      sum -= targets_.bodies[b].pressure.value_or(0.0) * v[b];
    }
    return sum;
  }

  /// False when even short steps fail.
  bool step() {
    const bool hold = at_volume();
    const double before = energy();
    const Points old = complex_.mesh.points;
    if (!find_forces()) {
      return false;
    }
    for (int attempt = 0; attempt < 6; ++attempt) {
      if (holds_up(before, hold) && !too_far(old)) {
        tau_ = std::min(most_tau_, 2.0 * tau_);
        volume_step_ = std::min(kVolumeStep, 2.0 * volume_step_);
        return true;
      }
      complex_.mesh.points = old;
      tau_ *= 0.25;
      volume_step_ *= short_volume_steps_ ? 0.5 : 1.0;
    }
    return false;
  }

 private:
  bool too_far(const Points& old) const {
    return most_motion_ > 0.0 &&
           std::any_of(movers_.begin(), movers_.end(), [&](int v) {
             return (complex_.mesh.points[v] - old[v]).squaredNorm() >
                    most_motion_ * most_motion_;
           });
  }

  /// Of the film as it is; false where a formula has no slope there.
  bool find_forces() {
    const Points& x = complex_.mesh.points;
    stiffness_ = VectorX::Zero(static_cast<Eigen::Index>(movers_.size()));
    try {
      pull_ = energy_.gradient(x, targets_);
    } catch (const ExpressionError&) {
      return false;
    }
    try {
      find_stiffness(x);
    } catch (const ExpressionError&) {
      // Beside the film a formula has no slope: steps may be short.
    }
    return true;
  }

  /// How much the spines' force on each mover grows against it as the film
  /// moves along its normals; where it does not, or lines and walls hold the
  /// mover, 0. Without it, steps longer than their own time overshoot.
  /// The tensions' part of the difference is a film's Gaussian curvature.
  void find_stiffness(const Points& x) {
    if (!spined_) {
      return;
    }
    const double way = kProbe * energy_.mean_edge(x);
    const Points normals = energy_.space().directions(x);
    const auto normal_of = [&](int v) {
      return energy_.space().rank(v) == 1 ? normals[energy_.space().first(v)]
                                          : Vec3(Vec3::Zero());
    };
    Points moved = x;
    for (const int v : movers_) {
      moved[v] += way * normal_of(v);
    }
    const Points after = energy_.gradient(moved, targets_);
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      const int v = movers_[i];
      const double rate = normal_of(v).dot(after[v] - pull_[v]) / way;
      stiffness_[static_cast<Eigen::Index>(i)] =
          kSpineShare * std::max(0.0, rate);
    }
  }

  /// A step; false where it is to be taken back.
  bool holds_up(double before, bool hold) {
    try {
      if (!try_step()) {
        return false;
      }
      const double after = energy();
      return std::isfinite(after) && (!hold || after <= before);
    } catch (const ExpressionError&) {
      return false;  // it went where a formula has no value
    } catch (const MeshError&) {
      return false;  // or where a wall cannot be reached
    }
  }

  bool try_step() {
    Points& x = complex_.mesh.points;
    const auto n = static_cast<int>(movers_.size());
    const auto held = static_cast<int>(held_.size());
    energy::LaplaceSystem laplace =
        energy::cotan_laplacian(complex_.mesh, facet_weight_, unknown_of_, n,
                                energy::CotanWeights::Exact);
    const VectorX mass = lumped_area();
    for (int i = 0; i < n; ++i) {
      laplace.inner.coeffRef(i, i) += mass[i] / tau_ + stiffness_[i];
    }
    if (!factor_) {
      const bool plain = n == energy_.unknowns();
      factor_.emplace(laplace.inner, FactorKind::Cholesky,
                      plain ? energy_.order() : std::vector<int>{});
    }
    if (!factor_->factorize(laplace.inner)) {
      return false;
    }
    Eigen::MatrixXd right(n, 3 * (1 + held));
    right.leftCols<3>() = -rows_of(pull_);
    for (int b = 0; b < energy_.functionals(); ++b) {
      if (const double p = targets_.bodies[b].pressure.value_or(0.0);
          p != 0.0) {
        right.leftCols<3>() += p * rows_of(energy_.functional_gradient(x, b));
      }
    }
    for (int k = 0; k < held; ++k) {
      right.middleCols<3>(3 + 3 * k) =
          rows_of(energy_.functional_gradient(x, held_[k]));
    }
    Eigen::MatrixXd dx = factor_->solve(right);
    keep_along_rims(dx);
    return move_at_volume(dx);
  }

  VectorX lumped_area() const {
    const VectorX of_unknown = energy_.lumped_area(complex_.mesh.points);
    VectorX mass(static_cast<Eigen::Index>(movers_.size()));
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      mass[static_cast<Eigen::Index>(i)] =
          of_unknown[energy_.space().first(movers_[i])];
    }
    return mass;
  }

  /// The movers' rows; at walls only what runs along them.
  Eigen::MatrixX3d rows_of(const Points& slope) const {
    Eigen::MatrixX3d rows(static_cast<Eigen::Index>(movers_.size()), 3);
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) = slope[movers_[i]];
    }
    const energy::FilmSpace& space = energy_.space();
    for (std::size_t k = 0; k < space.walled().size(); ++k) {
      const int v = space.walled()[k];
      if (unknown_of_[v] < 0) {
        continue;
      }
      const Eigen::MatrixX3d normals =
          space.wall_normals(static_cast<int>(k), complex_.mesh.points[v]);
      const Vec3& force = slope[v];
      const VectorX pull = least_norm(normals.transpose(), force);
      rows.row(unknown_of_[v]) = force - normals.transpose() * pull;
    }
    keep_along_rims(rows);
    return rows;
  }

  /// Takes out what runs along rims on bent walls. Their edges are chords that
  /// enclose less film the less even they are, while the wall behind them
  /// counts whole: they would run together on one side of a tube.
  void keep_along_rims(Eigen::Ref<Eigen::MatrixXd> rows) const {
    const Points& x = complex_.mesh.points;
    for (const int v : bent_rims_) {
      const Edge& ends = energy_.space().line_ends(v);
      const Vec3 along = (x[ends[1]] - x[ends[0]]).normalized();
      for (Eigen::Index c = 0; c < rows.cols(); c += 3) {
        auto row = rows.block<1, 3>(unknown_of_[v], c);
        row -= row.dot(along) * along.transpose();
      }
    }
  }

  Points moved(const Eigen::MatrixXd& dx, const VectorX& pressure) const {
    Points x = complex_.mesh.points;
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      const auto row = dx.row(static_cast<Eigen::Index>(i));
      Vec3 sum = row.head<3>();
      for (Eigen::Index k = 0; k < pressure.size(); ++k) {
        sum += pressure[k] * row.segment<3>(3 + 3 * k).transpose();
      }
      x[movers_[i]] += sum;
    }
    if (energy_.space().has_walls()) {
      energy_.space().project(x);
    }
    return x;
  }

  /// How fast the held volumes grow at `at` along each motion in dx: that
  /// without pressure first, then one per held volume.
  Eigen::MatrixXd volume_slopes(const Points& at,
                                const Eigen::MatrixXd& dx) const {
    const auto held = static_cast<Eigen::Index>(held_.size());
    Eigen::MatrixXd slopes(held, 1 + held);
    for (Eigen::Index k = 0; k < held; ++k) {
      const Eigen::MatrixX3d b =
          rows_of(energy_.functional_gradient(at, held_[k]));
      for (Eigen::Index j = 0; j <= held; ++j) {
        slopes(k, j) = b.cwiseProduct(dx.middleCols<3>(3 * j)).sum();
      }
    }
    return slopes;
  }

  /// Finds the pressures at which the moved film has this step's volumes.
  bool move_at_volume(const Eigen::MatrixXd& dx) {
    const auto held = static_cast<Eigen::Index>(held_.size());
    VectorX goal(held);
    const VectorX now = energy_.volumes(complex_.mesh.points);
    for (Eigen::Index k = 0; k < held; ++k) {
      const double target = *targets_.bodies[held_[k]].volume;
      const double most = volume_step_ * std::abs(target);
      goal[k] = now[held_[k]] + std::clamp(target - now[held_[k]], -most, most);
    }
    const auto missing = [&](const Points& at) {
      const VectorX volumes = energy_.volumes(at);
      VectorX gap(held);
      for (Eigen::Index k = 0; k < held; ++k) {
        gap[k] = goal[k] - volumes[held_[k]];
      }
      return gap;
    };
    VectorX pressure = VectorX::Zero(held);
    if (held > 0 && energy_.space().has_walls()) {
      // Along walls a film without pressure may run far away: start with the
      // pressure that holds it on its straight way.
      const Points& start = complex_.mesh.points;
      const Eigen::MatrixXd slopes = volume_slopes(start, dx);
      pressure =
          least_norm(slopes.rightCols(held), missing(start) - slopes.col(0));
    }
    Points x = moved(dx, pressure);
    bool reached = held == 0;
    for (int i = 0; i < kPressureIterations && !reached; ++i) {
      const VectorX gap = missing(x);
      if (gap.cwiseAbs().maxCoeff() <=
          1e-3 * kVolumeReached * goal.cwiseAbs().maxCoeff()) {
        reached = true;
        break;
      }
      pressure += least_norm(volume_slopes(x, dx).rightCols(held), gap);
      x = moved(dx, pressure);
    }
    if (!reached || !flat(x).allFinite()) {
      return false;  // a shorter step will
    }
    complex_.mesh.points = std::move(x);
    return true;
  }

  films::FilmComplex& complex_;
  energy::FilmEnergy energy_;
  films::FilmTargets targets_;
  std::vector<int> unknown_of_;  // per vertex: its mover, or -1
  std::vector<int> movers_;      // vertices
  std::vector<int> bent_rims_;   // vertices
  std::vector<double> facet_weight_;
  std::vector<int> held_;
  bool spined_ = false;
  Points pull_;        // dE/dx where the step begins
  VectorX stiffness_;  // per mover [force/length]
  std::optional<SymmetricFactor> factor_;
  double most_motion_ = 0.0;
  bool short_volume_steps_ = false;
  double volume_step_ = kVolumeStep;
  double tau_ = 0.0;
  double most_tau_ = 0.0;
};

}  // namespace

FlowReport flow_to_rest(films::FilmComplex& complex,
                        const FlowOptions& options) {
  Flow flow(complex, options);
  FlowReport report;
  if (!flow.has_unknowns()) {
    report.settled = true;
    return report;
  }
  double energy = flow.energy();
  for (; report.steps < options.max_steps; ++report.steps) {
    if (options.monitor != nullptr) {
      throw_if_stopped(*options.monitor, "film");
    }
    const bool hold = flow.at_volume();
    const Points before = complex.mesh.points;
    if (!flow.step()) {
      break;
    }
    if (options.torn && options.torn(flow.film(), complex.mesh.points)) {
      report.torn = true;
      break;
    }
    const bool junctions_rest = flow.junction_motion(before) <= kJunctionsRest;
    // Spines hold each place by itself. The energy of a large film says nothing
    // about one, and falls for ever while vertices slide along the film.
    const bool places_rest =
        flow.is_spined() &&
        flow.normal_motion(before) <=
            kSpinesRest *
                std::sqrt(options.energy_change / FlowOptions().energy_change);
    for (int pass = 0; pass < kPasses && has_thin_facet(complex); ++pass) {
      groom::average_vertices(complex);
    }
    const double next = flow.energy();
    const bool energy_rests =
        std::abs(energy - next) <= options.energy_change * std::abs(energy);
    if (hold && junctions_rest &&
        (flow.is_spined() ? places_rest : energy_rests)) {
      report.settled = true;
      break;
    }
    energy = next;
  }
  return report;
}

}  // namespace meniscus::settle
