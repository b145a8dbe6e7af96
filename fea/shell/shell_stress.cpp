#include "fea/shell/shell_stress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/facet_matrices.h"

namespace meniscus::shell {

namespace {

using element::Stress;

Stress global_stress(const FacetFrame<double>& frame, const Vec3& plane,
                     const Eigen::Vector2d& across, double normal) {
  Mat3 own;
  own << plane[0], plane[2], across[0],  //
      plane[2], plane[1], across[1],     //
      across[0], across[1], normal;
  Mat3 axes;
  axes << as_vector(frame.axes[0]), as_vector(frame.axes[1]),
      as_vector(frame.axes[2]);
  const Mat3 s = axes * own * axes.transpose();
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

/// The ply at a height between the faces, the lower of two.
int ply_at(const LaminateLaw& law, double at) {
  int ply = 0;
  while (ply + 1 < static_cast<int>(law.plies.size()) && law.to[ply] < at) {
    ++ply;
  }
  return ply;
}

struct WallPoint {
  const Facet& facet;
  const FacetFrame<double>& frame;
  const FacetStrain<double>& strain;
  double thickness;
  WallState state;
};

Stress stress_at(const WallPoint& point, double at, int number) {
  const LaminateLaw& law = *point.facet.law;
  const PlyLaw& ply = law.plies[number];
  const double zeta = (at + point.facet.offset) * point.thickness;
  const LayerStrain<double> e = layer_strain(
      point.strain, inverse(shifter(point.frame.curvature, zeta)), zeta);
  const Vec3 strain = as_vector(e.plane) - point.state.free_strain(ply, at);
  const double transverse = 1.5 - 6.0 * at * at;
  const Eigen::Vector2d across =
      transverse * law.across * Eigen::Vector2d(e.across[0], e.across[1]);
  return global_stress(point.frame, ply.plane * strain, across,
                       point.state.stress(at));
}

/// Of the whole wall.
WallStress wall_stress(const WallPoint& point) {
  const LaminateLaw& law = *point.facet.law;
  return {stress_at(point, -0.5, 0), stress_at(point, 0.0, ply_at(law, 0.0)),
          stress_at(point, 0.5, static_cast<int>(law.plies.size()) - 1)};
}

WallStress ply_stress(const WallPoint& point, int ply) {
  const LaminateLaw& law = *point.facet.law;
  if (ply >= static_cast<int>(law.plies.size())) {
    return {};
  }
  return {stress_at(point, law.from[ply], ply),
          stress_at(point, 0.5 * (law.from[ply] + law.to[ply]), ply),
          stress_at(point, law.to[ply], ply)};
}

/// Linear functions through the inner points, at the nodes.
constexpr double kOut[kNodes][3] = {
    {5.0 / 3.0, -1.0 / 3.0, -1.0 / 3.0}, {-1.0 / 3.0, 5.0 / 3.0, -1.0 / 3.0},
    {-1.0 / 3.0, -1.0 / 3.0, 5.0 / 3.0}, {2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0},
    {-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0},  {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0}};

void add(WallStress& sum, double weight, const WallStress& stress) {
  for (int c = 0; c < 6; ++c) {
    sum.negative[c] += weight * stress.negative[c];
    sum.middle[c] += weight * stress.middle[c];
    sum.positive[c] += weight * stress.positive[c];
  }
}

/// A shell with its solution, and the bubbles that go with it.
class SolvedShell {
 public:
  SolvedShell(const ShellMesh& mesh, const std::vector<Section>& sections,
              const ShellLoads& loads, const VectorX& displacement)
      : mesh_(mesh),
        sections_(sections),
        displacement_(displacement),
        laws_(laminate_laws(sections)) {
    check_shell(mesh, sections);
    if (displacement.size() !=
        static_cast<Eigen::Index>(6 * mesh.nodes.size())) {
      throw InvalidInput(
          fmt::format("a shell of {} nodes has a displacement of {} numbers; "
                      "six a node are needed",
                      mesh.nodes.size(), displacement.size()));
    }
    own_ = facet_loads(mesh, loads);
    bubbles_.resize(mesh.facets.size());
    states_.resize(mesh.facets.size());
    parallel_for(count(), [&](std::ptrdiff_t k) {
      const Facet facet =
          facet_of(mesh_, sections_, laws_, static_cast<int>(k));
      bubbles_[k] = bubble_rotation(
          whole_stiffness(facet), facet_forces(facet, loads, own_[k]),
          numbers_of(mesh_, static_cast<int>(k), displacement_));
      states_[k] = wall_states(loads, own_[k]);
    });
  }

  std::size_t most_plies() const {
    std::size_t most = 0;
    for (const LaminateLaw& law : laws_) {
      most = std::max(most, law.plies.size());
    }
    return most;
  }

  /// at(point of the wall), facet by facet.
  template <class At>
  std::vector<FacetStress> stress(const At& at) const {
    std::vector<FacetStress> result(mesh_.facets.size());
    parallel_for(count(), [&](std::ptrdiff_t k) {
      result[k] = facet_stress(static_cast<int>(k), at);
    });
    return result;
  }

 private:
  std::ptrdiff_t count() const {
    return static_cast<std::ptrdiff_t>(mesh_.facets.size());
  }

  template <class At>
  FacetStress facet_stress(int f, const At& at) const {
    const Facet facet = facet_of(mesh_, sections_, laws_, f);
    const auto X = triples(facet);
    const Triple<double> bubble = bubble_turn(bubble_axes(X), bubbles_[f]);
    const FacetVector u = numbers_of(mesh_, f, displacement_);
    const FacetField field = Eigen::Map<const FacetField>(u.data());
    FacetStress result{};
    for (int q = 0; q < 3; ++q) {
      const FacetPoint& p = stress_points()[q];
      const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
      const FacetStrain<double> strain =
          facet_strain(X, p, frame, field, bubble);
      const WallStress wall = at(WallPoint{
          facet, frame, strain, thickness_at(facet, p), states_[f].at(p)});
      for (int i = 0; i < kNodes; ++i) {
        add(result[i], node_share(i, q), wall);
      }
    }
    return result;
  }

  const ShellMesh& mesh_;
  const std::vector<Section>& sections_;
  const VectorX& displacement_;
  std::vector<LaminateLaw> laws_;
  std::vector<Eigen::Vector2d> bubbles_;
  std::vector<FacetLoad> own_;
  std::vector<WallStates> states_;
};

}  // namespace

const std::array<FacetPoint, 3>& stress_points() {
  static const std::array<FacetPoint, 3> points = {
      facet_point(1.0 / 6.0, 1.0 / 6.0), facet_point(2.0 / 3.0, 1.0 / 6.0),
      facet_point(1.0 / 6.0, 2.0 / 3.0)};
  return points;
}

double node_share(int node, int q) { return kOut[node][q]; }

std::vector<FacetStress> shell_stress(const ShellMesh& mesh,
                                      const std::vector<Section>& sections,
                                      const ShellLoads& loads,
                                      const VectorX& displacement) {
  return SolvedShell(mesh, sections, loads, displacement).stress(wall_stress);
}

void visit_ply_stresses(
    const ShellMesh& mesh, const std::vector<Section>& sections,
    const ShellLoads& loads, const VectorX& displacement,
    const std::function<void(int ply, const std::vector<FacetStress>& stress)>&
        visit) {
  const SolvedShell solved(mesh, sections, loads, displacement);
  const auto plies = static_cast<int>(solved.most_plies());
  for (int ply = 0; ply < plies; ++ply) {
    visit(ply, solved.stress([ply](const WallPoint& point) {
      return ply_stress(point, ply);
    }));
  }
}

std::vector<FacetStress> averaged_stress(const ShellMesh& mesh,
                                         const std::vector<FacetStress>& stress,
                                         double fold) {
  struct Use {
    int facet;
    int place;
    Vec3 normal;
  };
  std::vector<std::vector<Use>> uses(mesh.nodes.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto& c = mesh.facets[f];
    const Vec3& o = mesh.nodes[c[0]];
    const Vec3 n =
        (mesh.nodes[c[1]] - o).cross(mesh.nodes[c[2]] - o).normalized();
    for (int i = 0; i < kNodes; ++i) {
      uses[c[i]].push_back({static_cast<int>(f), i, n});
    }
  }
  const double least = std::cos(fold);
  std::vector<FacetStress> mean(stress.size());
  for (const auto& at : uses) {
    for (const Use& own : at) {
      WallStress sum{};
      double count = 0.0;
      for (const Use& other : at) {
        if (mesh.section[own.facet] == mesh.section[other.facet] &&
            own.normal.dot(other.normal) >= least) {
          add(sum, 1.0, stress[other.facet][other.place]);
          count += 1.0;
        }
      }
      add(mean[own.facet][own.place], 1.0 / count, sum);
    }
  }
  return mean;
}

}  // namespace meniscus::shell
