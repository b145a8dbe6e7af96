#include "fea/shell_peaks/shell_peak_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/taped_facet.h"

namespace meniscus::shell {

namespace {

using element::Stress;

constexpr int kHeights = 3;  // of a ply: faces, and half way between

double height_of(const LaminateLaw& law, int ply, int k) {
  return law.from[ply] + 0.5 * k * (law.to[ply] - law.from[ply]);
}

/// A node of one surface, and how many facets there it is the mean of.
struct Copies {
  std::vector<std::array<int, kNodes>> of;  // per facet
  std::vector<double> facets;
  std::vector<int> section;
};

Copies copies_of(const ShellPeakInput& in) {
  Copies copies;
  std::map<std::pair<int, int>, int> number;  // of node and surface
  for (std::size_t f = 0; f < in.mesh.facets.size(); ++f) {
    std::array<int, kNodes>& own = copies.of.emplace_back();
    for (int i = 0; i < kNodes; ++i) {
      const auto [at, is_new] =
          number.try_emplace({in.mesh.facets[f][i], in.surface[f]},
                             static_cast<int>(copies.facets.size()));
      if (is_new) {
        copies.facets.push_back(0.0);
        copies.section.push_back(in.mesh.section[f]);
      }
      own[i] = at->second;
      copies.facets[at->second] += 1.0;
    }
  }
  return copies;
}

/// At the heights of one ply.
using PlyStress = std::array<Stress, kHeights>;
/// Per ply, per copy.
using StateStress = std::vector<std::vector<PlyStress>>;

StateStress stress_of(const ShellPeakInput& in, const ShellState& state,
                      const Copies& copies) {
  StateStress result;
  visit_ply_stresses(in.mesh, in.sections, state.loads, state.displacement,
                     [&](int, const std::vector<FacetStress>& stress) {
                       std::vector<PlyStress>& mean = result.emplace_back();
                       mean.assign(copies.facets.size(), PlyStress{});
                       for (std::size_t f = 0; f < stress.size(); ++f) {
                         for (int i = 0; i < kNodes; ++i) {
                           const int copy = copies.of[f][i];
                           const WallStress& wall = stress[f][i];
                           const double share = 1.0 / copies.facets[copy];
                           for (int c = 0; c < 6; ++c) {
                             mean[copy][0][c] += share * wall.negative[c];
                             mean[copy][1][c] += share * wall.middle[c];
                             mean[copy][2][c] += share * wall.positive[c];
                           }
                         }
                       }
                     });
  return result;
}

/// What one facet's value is of: per stress point, ply and height a tensor A,
/// its part A : stress.
struct FacetTensors {
  std::array<std::vector<std::array<Mat3, kHeights>>, 3> at;
  bool is_zero = true;
};

/// A : stress at one point of a facet.
template <class T>
T stress_work(const Facet& facet, const WallState& state,
              const FacetFrame<T>& frame, const FacetStrain<T>& strain,
              const T& thickness,
              const std::vector<std::array<Mat3, kHeights>>& tensors) {
  const LaminateLaw& law = *facet.law;
  T sum(0.0);
  for (int p = 0; p < static_cast<int>(law.plies.size()); ++p) {
    const PlyLaw& ply = law.plies[p];
    for (int k = 0; k < kHeights; ++k) {
      const Mat3& A = tensors[p][k];
      if (A.isZero(0.0)) {
        continue;
      }
      const double at = height_of(law, p, k);
      const T zeta = (at + facet.offset) * thickness;
      const LayerStrain<T> e =
          layer_strain(strain, inverse(shifter(frame.curvature, zeta)), zeta);
      const Vec3 free = state.free_strain(ply, at);
      const auto along = [&](int i, int j) {
        const Triple<T>& b = frame.axes[j];
        Triple<T> Ab{};
        for (int r = 0; r < 3; ++r) {
          Ab[r] = A(r, 0) * b[0] + A(r, 1) * b[1] + A(r, 2) * b[2];
        }
        return dot(frame.axes[i], Ab);
      };
      const std::array<T, 3> on = {along(0, 0), along(1, 1), 2.0 * along(0, 1)};
      for (int i = 0; i < 3; ++i) {
        sum = sum + on[i] * (ply.plane(i, 0) * (e.plane[0] - free[0]) +
                             ply.plane(i, 1) * (e.plane[1] - free[1]) +
                             ply.plane(i, 2) * (e.plane[2] - free[2]));
      }
      const double parabola = 1.5 - 6.0 * at * at;
      for (int i = 0; i < 2; ++i) {
        sum = sum + 2.0 * parabola * along(i, 2) *
                        (law.across(i, 0) * e.across[0] +
                         law.across(i, 1) * e.across[1]);
      }
      sum = sum + state.stress(at) * along(2, 2);
    }
  }
  return sum;
}

/// By the law and the state: stress_work() transposed.
void add_by_law(const Facet& facet, const WallState& state,
                const FacetFrame<double>& frame,
                const FacetStrain<double>& strain, double thickness,
                const std::vector<std::array<Mat3, kHeights>>& tensors,
                LawGradient& sum, StateGradient& by_state) {
  const LaminateLaw& law = *facet.law;
  Mat3 axes;
  axes << as_vector(frame.axes[0]), as_vector(frame.axes[1]),
      as_vector(frame.axes[2]);
  for (int p = 0; p < static_cast<int>(law.plies.size()); ++p) {
    for (int k = 0; k < kHeights; ++k) {
      const Mat3 A = axes.transpose() * tensors[p][k] * axes;
      const double at = height_of(law, p, k);
      const double zeta = (at + facet.offset) * thickness;
      const LayerStrain<double> e =
          layer_strain(strain, inverse(shifter(frame.curvature, zeta)), zeta);
      const Vec3 on(A(0, 0), A(1, 1), 2.0 * A(0, 1));
      PlyLaw& by = sum.by[p];
      by.plane +=
          on * (as_vector(e.plane) - state.free_strain(law.plies[p], at))
                   .transpose();
      const Vec3 on_free = -law.plies[p].plane.transpose() * on;
      by_state.add_free_strain(state, law.plies[p], at, on_free, by);
      by_state.add_stress(at, A(2, 2));
      sum.by_across += (3.0 - 12.0 * at * at) *
                       Eigen::Vector2d(A(0, 2), A(1, 2)) *
                       Eigen::RowVector2d(e.across[0], e.across[1]);
    }
  }
}

/// One facet under one state.
struct LoadedFacet {
  Facet facet;
  WallStates states;
  FacetField field;
  Eigen::Vector2d bubble;
};

WholeGradient facet_gradient(const LoadedFacet& solved,
                             const FacetTensors& tensors, Tape& tape) {
  const Facet& facet = solved.facet;
  WholeGradient gradient;
  // By places and thicknesses, all unknowns held.
  const TapedFacet taped(facet, tape);
  const Triple<Taped> of_u = taped.bubble(solved.bubble);
  Taped sum(0.0);
  for (int q = 0; q < 3; ++q) {
    const FacetPoint& p = stress_points()[q];
    const FacetFrame<Taped> frame = facet_frame(taped.X, p, facet.direction);
    sum = sum + stress_work<Taped>(
                    facet, solved.states.at(p), frame,
                    facet_strain(taped.X, p, frame, solved.field, of_u),
                    taped.thickness_at(p), tensors.at[q]);
  }
  gradient.by = taped.transpose(sum);
  // By the unknowns, which strains are linear in, and by the law.
  const auto X = triples(facet);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = bubble_turn(axes, solved.bubble);
  LawGradient by_law(*facet.law);
  for (int q = 0; q < 3; ++q) {
    const FacetPoint& p = stress_points()[q];
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const double t = thickness_at(facet, p);
    StateGradient by_state;
    add_by_law(facet, solved.states.at(p), frame,
               facet_strain(X, p, frame, solved.field, bubble), t,
               tensors.at[q], by_law, by_state);
    by_state.add_to(p, gradient.by_loads);
    const auto work = [&](const FacetField& field,
                          const Triple<double>& turned) {
      return stress_work<double>(facet, {}, frame,
                                 facet_strain(X, p, frame, field, turned), t,
                                 tensors.at[q]);
    };
    add_linear_work(axes, work, gradient.by_whole);
  }
  gradient.by_ply = by_law.by_ply();
  return gradient;
}

class PeakOfShell {
 public:
  PeakOfShell(const ShellPeakInput& in,
              const functionals::NodeCriterion& criterion)
      : in_(in),
        criterion_(criterion),
        laws_(laminate_laws(in.sections)),
        copies_(copies_of(in)) {
    int next = 0;
    for (const LaminateLaw& law : laws_) {
      first_.push_back(next);
      next += static_cast<int>(law.plies.size());
    }
    double count = 0.0;
    for (const int section : copies_.section) {
      count += static_cast<double>(kHeights * laws_[section].plies.size());
    }
    power_ = std::max(
        4.0, std::log(count * criterion.terms) / std::log1p(in.excess));
    for (const ShellState& state : in.states) {
      stress_.push_back(stress_of(in, state, copies_));
    }
  }

  ShellPeakBound find() {
    ShellPeakBound bound;
    find_value(bound);
    if (in_.derivatives == element::Derivatives::All) {
      differentiate(bound);
    }
    return bound;
  }

 private:
  /// visit(copy, ply, height, the states' stresses there).
  template <class Visit>
  void for_each_value(const Visit& visit) const {
    std::vector<Stress> stress(in_.states.size());
    for (std::size_t copy = 0; copy < copies_.section.size(); ++copy) {
      const LaminateLaw& law = laws_[copies_.section[copy]];
      for (std::size_t p = 0; p < law.plies.size(); ++p) {
        for (int k = 0; k < kHeights; ++k) {
          for (std::size_t s = 0; s < stress.size(); ++s) {
            stress[s] = stress_[s][p][copy][k];
          }
          visit(copy, p, k, stress);
        }
      }
    }
  }

  int layer_of(std::size_t copy, std::size_t ply) const {
    return first_[copies_.section[copy]] + static_cast<int>(ply);
  }

  void find_value(ShellPeakBound& bound) {
    double largest = 0.0;
    for_each_value([&](std::size_t copy, std::size_t p, int,
                       const std::vector<Stress>& stress) {
      const double v = std::max(
          0.0, criterion_.value(layer_of(copy, p), power_, stress, {}));
      values_.push_back(v);
      if (v > largest || bound.largest.empty()) {
        largest = std::max(largest, v);
        bound.largest = stress;
      }
    });
    double sum = 0.0;
    for (const double v : values_) {
      sum += largest > 0.0 ? std::pow(v / largest, power_) : 0.0;
    }
    bound.value = largest > 0.0 ? largest * std::pow(sum, 1.0 / power_) : 0.0;
  }

  /// By the stresses of each state.
  std::vector<StateStress> by_stress(double bound) const {
    constexpr double kNothing = 1e-14;  // of the largest: 0 to rounding
    std::vector<StateStress> by = stress_;
    for (StateStress& state : by) {
      for (std::vector<PlyStress>& ply : state) {
        std::fill(ply.begin(), ply.end(), PlyStress{});
      }
    }
    std::vector<Stress> slope(in_.states.size());
    std::size_t next = 0;
    for_each_value([&](std::size_t copy, std::size_t p, int k,
                       const std::vector<Stress>& stress) {
      const double v = values_[next++];
      const double weight =
          bound > 0.0 ? std::pow(v / bound, power_ - 1.0) : 0.0;
      if (weight < kNothing) {
        return;
      }
      std::fill(slope.begin(), slope.end(), Stress{});
      criterion_.value(layer_of(copy, p), power_, stress, slope);
      for (std::size_t s = 0; s < slope.size(); ++s) {
        for (int c = 0; c < 6; ++c) {
          by[s][p][copy][k][c] = weight * slope[s][c];
        }
      }
    });
    return by;
  }

  /// The means and extensions to the nodes, transposed.
  FacetTensors tensors_of(int f, const StateStress& by) const {
    FacetTensors result;
    const std::size_t plies = laws_[in_.mesh.section[f]].plies.size();
    for (int q = 0; q < 3; ++q) {
      result.at[q].resize(plies);
      for (std::size_t p = 0; p < plies; ++p) {
        for (int k = 0; k < kHeights; ++k) {
          Mat3& A = result.at[q][p][k];
          A.setZero();
          for (int i = 0; i < kNodes; ++i) {
            const int copy = copies_.of[f][i];
            const double share = node_share(i, q) / copies_.facets[copy];
            const Stress& s = by[p][copy][k];
            Mat3 own;
            own << s[0], 0.5 * s[3], 0.5 * s[5], 0.5 * s[3], s[1], 0.5 * s[4],
                0.5 * s[5], 0.5 * s[4], s[2];
            A += share * own;
          }
          result.is_zero = result.is_zero && A.isZero(0.0);
        }
      }
    }
    return result;
  }

  void differentiate(ShellPeakBound& bound) const {
    const double value = bound.value;
    bound.by_nodes.assign(in_.mesh.nodes.size(), Vec3::Zero());
    bound.by_thickness.assign(in_.mesh.facets.size(), Vec3::Zero());
    const std::vector<StateStress> by = by_stress(value);
    for (std::size_t s = 0; s < in_.states.size(); ++s) {
      add_state(in_.states[s], by[s], bound);
    }
    bound.value = value;
  }

  void add_state(const ShellState& state, const StateStress& by,
                 ShellPeakBound& bound) const {
    const std::vector<FacetLoad> own = facet_loads(in_.mesh, state.loads);
    std::vector<WholeGradient> parts(in_.mesh.facets.size());
    std::vector<Eigen::Vector2d> on_bubbles(parts.size(),
                                            Eigen::Vector2d::Zero());
    parallel_for(
        static_cast<std::ptrdiff_t>(parts.size()), [&](std::ptrdiff_t k) {
          static thread_local Tape tape;
          const int f = static_cast<int>(k);
          const FacetTensors tensors = tensors_of(f, by);
          if (tensors.is_zero) {
            return;
          }
          const Facet facet = facet_of(in_.mesh, in_.sections, laws_, f);
          const FacetVector u = numbers_of(in_.mesh, f, state.displacement);
          const WholeMatrix K = whole_stiffness(facet);
          parts[k] = facet_gradient(
              {facet, wall_states(state.loads, own[k]),
               Eigen::Map<const FacetField>(u.data()),
               bubble_rotation(K, facet_forces(facet, state.loads, own[k]), u)},
              tensors, tape);
          add_field_slopes(facet, own[k], parts[k].by_loads,
                           parts[k].by.data());
          // The bubble follows the nodes: condensed as forces are.
          on_bubbles[k] = parts[k].by_whole.tail<2>();
          condensed(K, &parts[k].by_whole);
        });
    // And places, thicknesses and the law: its equilibrium, to which its
    // derivatives are the adjoint's forces.
    const VectorX none = VectorX::Zero(state.displacement.size());
    ShellGradient sum =
        residual_gradient(in_.mesh, in_.sections, state.loads, none,
                          state.displacement, &on_bubbles);
    VectorX& by_displacement = bound.by_displacement.emplace_back(none);
    for (std::size_t f = 0; f < parts.size(); ++f) {
      add_facet(in_.mesh, static_cast<int>(f), parts[f], sum);
      for (int i = 0; i < kNodes; ++i) {
        by_displacement.segment<6>(6L * in_.mesh.facets[f][i]) +=
            parts[f].by_whole.segment<6>(6L * i);
      }
    }
    for (std::size_t i = 0; i < sum.by_nodes.size(); ++i) {
      bound.by_nodes[i] += sum.by_nodes[i];
    }
    for (std::size_t f = 0; f < sum.by_thickness.size(); ++f) {
      bound.by_thickness[f] += sum.by_thickness[f];
    }
    add_plies(1.0, sum.by_ply, bound.by_ply);
    bound.by_state_actions.push_back(std::move(sum.by_actions));
  }

  const ShellPeakInput& in_;
  const functionals::NodeCriterion& criterion_;
  std::vector<LaminateLaw> laws_;
  Copies copies_;
  std::vector<int> first_;  // each section's first ply among all
  std::vector<StateStress> stress_;
  std::vector<double> values_;
  double power_ = 4.0;
};

}  // namespace

ShellPeakBound shell_peak_bound(const ShellPeakInput& input,
                                const functionals::NodeCriterion& criterion) {
  check_shell(input.mesh, input.sections);
  if (!(input.excess > 0.0 && input.excess < 1.0)) {
    throw InvalidInput(
        fmt::format("a peak's excess is {}; give it one above 0 and below 1",
                    input.excess));
  }
  return PeakOfShell(input, criterion).find();
}

}  // namespace meniscus::shell
