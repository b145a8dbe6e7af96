#include "fea/shell/shell_norm.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/taped_facet.h"

namespace meniscus::shell {

namespace {

/// Exact to degree two.
const std::array<FacetPoint, 3>& norm_points() {
  static const std::array<FacetPoint, 3> points = {
      facet_point(1.0 / 6.0, 1.0 / 6.0), facet_point(2.0 / 3.0, 1.0 / 6.0),
      facet_point(1.0 / 6.0, 2.0 / 3.0)};
  return points;
}
constexpr double kPointWeight = 1.0 / 6.0;

/// One face of the wall.
struct WallFace {
  double at;  // in thicknesses, from the middle
  const PlyLaw* ply;
  Vec3 free;      // strain of no stress in the surface
  double normal;  // stress across
};

std::array<WallFace, 2> faces_of(const Facet& facet, const WallState& state) {
  const LaminateLaw& law = *facet.law;
  const auto face = [&](double at, const PlyLaw& ply) -> WallFace {
    return {at, &ply, state.free_strain(ply, at), state.stress(at)};
  };
  return {face(-0.5, law.plies.front()), face(0.5, law.plies.back())};
}

/// Stress in the surface along the frame's axes: 11, 22, 12.
template <class T>
Triple<T> face_stress(const WallFace& face, const FacetFrame<T>& frame,
                      const FacetStrain<T>& strain, const T& zeta) {
  const LayerStrain<T> e =
      layer_strain(strain, inverse(shifter(frame.curvature, zeta)), zeta);
  Triple<T> stress{};
  for (int i = 0; i < 3; ++i) {
    stress[i] = T(0.0);
    for (int j = 0; j < 3; ++j) {
      stress[i] =
          stress[i] + face.ply->plane(i, j) * (e.plane[j] - face.free[j]);
    }
  }
  return stress;
}

template <class T>
T von_mises_square(const Triple<T>& s, double normal) {
  const T a = s[0] - s[1];
  const T b = s[1] - normal;
  const T c = normal - s[0];
  return 0.5 * (a * a + b * b + c * c) + 3.0 * s[2] * s[2];
}

/// Of one facet: area, and both faces' squares at its points.
struct FaceSquares {
  double area = 0.0;
  std::array<double, 3> share = {};  // of the area
  std::array<std::array<double, 2>, 3> square = {};
};

/// One facet with its solution.
struct SolvedFacet {
  Facet facet;
  WallState state;
  FacetField field;
  Eigen::Vector2d bubble;
  WholeMatrix stiffness;
};

FaceSquares squares_of(const SolvedFacet& solved) {
  const Facet& facet = solved.facet;
  const auto X = triples(facet);
  const Triple<double> bubble = bubble_turn(bubble_axes(X), solved.bubble);
  const std::array<WallFace, 2> faces = faces_of(facet, solved.state);
  FaceSquares result;
  for (int q = 0; q < 3; ++q) {
    const FacetPoint& p = norm_points()[q];
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain =
        facet_strain(X, p, frame, solved.field, bubble);
    result.share[q] = kPointWeight * frame.area;
    result.area += result.share[q];
    for (int k = 0; k < 2; ++k) {
      const double zeta = (faces[k].at + facet.offset) * thickness_at(facet, p);
      result.square[q][k] = von_mises_square(
          face_stress(faces[k], frame, strain, zeta), faces[k].normal);
    }
  }
  return result;
}

/// What the norm is of: mean = sum of share / 2 (square / scale)^(power / 2)
/// over the area.
struct NormTerms {
  double power = 0.0;
  double scale = 1.0;  // the largest square
  double by_sum = 0.0;
  double by_area = 0.0;

  double term(double square) const {
    return std::pow(square / scale, 0.5 * power);
  }
  double slope(double square) const {
    return square > 0.0 ? 0.5 * power * term(square) / square : 0.0;
  }
};

struct FacetNormGradient : FacetGradient {
  WholeVector by_whole = WholeVector::Zero();  // with the bubble's two numbers
};

/// By places and thicknesses, nodes' numbers and bubble held.
ByShape norm_by_shape(const SolvedFacet& solved, const NormTerms& terms,
                      Tape& tape) {
  const Facet& facet = solved.facet;
  const TapedFacet taped(facet, tape);
  const Triple<Taped> bubble = taped.bubble(solved.bubble);
  const std::array<WallFace, 2> faces = faces_of(facet, solved.state);
  Taped sum(0.0);
  for (const FacetPoint& p : norm_points()) {
    const FacetFrame<Taped> frame = facet_frame(taped.X, p, facet.direction);
    const FacetStrain<Taped> strain =
        facet_strain(taped.X, p, frame, solved.field, bubble);
    const Taped thickness = taped.thickness_at(p);
    Taped here(terms.by_area);
    for (const WallFace& face : faces) {
      const Taped zeta = (face.at + facet.offset) * thickness;
      const Taped square =
          von_mises_square(face_stress(face, frame, strain, zeta), face.normal);
      here = here + 0.5 * terms.by_sum *
                        chain(square, terms.term(square.value),
                              terms.slope(square.value), 0.0);
    }
    sum = sum + kPointWeight * frame.area * here;
  }
  return taped.transpose(sum);
}

/// By the stresses of a face: from the square's derivative to the strain in
/// the surface.
Vec3 by_plane_strain(const WallFace& face, const Triple<double>& s,
                     double by_square) {
  const Vec3 by_stress(2.0 * s[0] - s[1] - face.normal,
                       2.0 * s[1] - s[0] - face.normal, 6.0 * s[2]);
  return by_square * face.ply->plane.transpose() * by_stress;
}

/// By the nodes' numbers and the bubble, which strains are linear in.
void add_by_unknowns(const SolvedFacet& solved, const NormTerms& terms,
                     FacetNormGradient& gradient) {
  const Facet& facet = solved.facet;
  const auto X = triples(facet);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = bubble_turn(axes, solved.bubble);
  const std::array<WallFace, 2> faces = faces_of(facet, solved.state);
  for (const FacetPoint& p : norm_points()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain =
        facet_strain(X, p, frame, solved.field, bubble);
    std::array<double, 2> zeta = {};
    std::array<Vec3, 2> by_plane;
    for (int k = 0; k < 2; ++k) {
      zeta[k] = (faces[k].at + facet.offset) * thickness_at(facet, p);
      const Triple<double> s = face_stress(faces[k], frame, strain, zeta[k]);
      const double by_square =
          0.5 * kPointWeight * frame.area * terms.by_sum *
          terms.slope(von_mises_square(s, faces[k].normal));
      by_plane[k] = by_plane_strain(faces[k], s, by_square);
    }
    const auto work = [&](const FacetField& field,
                          const Triple<double>& turned) {
      const FacetStrain<double> own = facet_strain(X, p, frame, field, turned);
      double sum = 0.0;
      for (int k = 0; k < 2; ++k) {
        const LayerStrain<double> e = layer_strain(
            own, inverse(shifter(frame.curvature, zeta[k])), zeta[k]);
        sum += by_plane[k].dot(as_vector(e.plane));
      }
      return sum;
    };
    const Triple<double> still = {0.0, 0.0, 0.0};
    for (int n = 0; n < kUnknowns; ++n) {
      FacetField unit = FacetField::Zero();
      unit(n % 6, n / 6) = 1.0;
      gradient.by_whole[n] += work(unit, still);
    }
    for (int k = 0; k < 2; ++k) {
      gradient.by_whole[kUnknowns + k] += work(FacetField::Zero(), axes[k]);
    }
  }
}

/// Of all facets: solved, their squares, and the norm.
class NormOfShell {
 public:
  NormOfShell(const ShellMesh& mesh, const std::vector<Section>& sections,
              const ShellLoads& loads, const VectorX& u)
      : mesh_(mesh),
        sections_(sections),
        loads_(loads),
        u_(u),
        laws_(laminate_laws(sections)),
        own_(facet_loads(mesh, loads)) {}

  StressNorm find(double power, NormDerivatives derivatives) const {
    std::vector<FaceSquares> squares(mesh_.facets.size());
    parallel_for(count(), [&](std::ptrdiff_t k) {
      squares[k] = squares_of(solved(static_cast<int>(k)));
    });
    double area = 0.0;
    NormTerms terms{.power = power, .scale = 0.0};
    for (const FaceSquares& facet : squares) {
      area += facet.area;
      for (const auto& at : facet.square) {
        terms.scale = std::max({terms.scale, at[0], at[1]});
      }
    }
    StressNorm norm;
    double sum = 0.0;
    if (terms.scale > 0.0) {
      for (const FaceSquares& facet : squares) {
        for (int q = 0; q < 3; ++q) {
          sum +=
              0.5 * facet.share[q] *
              (terms.term(facet.square[q][0]) + terms.term(facet.square[q][1]));
        }
      }
      norm.value = std::sqrt(terms.scale) * std::pow(sum / area, 1.0 / power);
    }
    if (derivatives == NormDerivatives::All) {
      terms.by_sum = sum > 0.0 ? norm.value / (power * sum) : 0.0;
      terms.by_area = -norm.value / (power * area);
      if (!(terms.scale > 0.0)) {
        terms.scale = 1.0;
      }
      add_derivatives(terms, norm);
    }
    return norm;
  }

 private:
  std::ptrdiff_t count() const {
    return static_cast<std::ptrdiff_t>(mesh_.facets.size());
  }

  SolvedFacet solved(int f) const {
    const Facet facet = facet_of(mesh_, sections_, laws_, f);
    const FacetVector u = numbers_of(mesh_, f, u_);
    const WholeMatrix K = whole_stiffness(facet);
    return {facet, wall_state(loads_, own_[f]),
            Eigen::Map<const FacetField>(u.data()),
            bubble_rotation(K, facet_forces(facet, loads_, own_[f]), u), K};
  }

  void add_derivatives(const NormTerms& terms, StressNorm& norm) const {
    std::vector<FacetNormGradient> parts(mesh_.facets.size());
    std::vector<Eigen::Vector2d> on_bubbles(mesh_.facets.size());
    parallel_for(count(), [&](std::ptrdiff_t k) {
      static thread_local Tape tape;
      const SolvedFacet facet = solved(static_cast<int>(k));
      parts[k].by = norm_by_shape(facet, terms, tape);
      add_by_unknowns(facet, terms, parts[k]);
      // The bubble follows the nodes: condensed as forces are.
      on_bubbles[k] = parts[k].by_whole.tail<2>();
      condensed(facet.stiffness, &parts[k].by_whole);
    });
    // And places and thicknesses: its equilibrium, to which its derivatives are
    // the adjoint's forces.
    const VectorX none = VectorX::Zero(u_.size());
    ShellGradient state =
        residual_gradient(mesh_, sections_, loads_, none, u_, &on_bubbles);
    norm.by_displacement = none;
    for (std::size_t f = 0; f < parts.size(); ++f) {
      add_facet(mesh_, static_cast<int>(f), parts[f], state);
      for (int i = 0; i < kNodes; ++i) {
        const int node = mesh_.facets[f][i];
        norm.by_displacement.segment<6>(6L * node) +=
            parts[f].by_whole.segment<6>(6L * i);
      }
    }
    norm.by_nodes = std::move(state.by_nodes);
    norm.by_thickness = std::move(state.by_thickness);
  }

  const ShellMesh& mesh_;
  const std::vector<Section>& sections_;
  const ShellLoads& loads_;
  const VectorX& u_;
  std::vector<LaminateLaw> laws_;
  std::vector<FacetLoad> own_;
};

}  // namespace

StressNorm von_mises_norm(const ShellMesh& mesh,
                          const std::vector<Section>& sections,
                          const ShellLoads& loads, const VectorX& displacement,
                          double power, NormDerivatives derivatives) {
  check_shell(mesh, sections);
  check_loads(mesh, loads);
  if (displacement.size() != static_cast<Eigen::Index>(6 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has a displacement of {} numbers; "
                    "six a node are needed",
                    mesh.nodes.size(), displacement.size()));
  }
  if (!(power > 1.0)) {
    throw InvalidInput(fmt::format(
        "a stress norm has the power {}; give it one above 1", power));
  }
  return NormOfShell(mesh, sections, loads, displacement)
      .find(power, derivatives);
}

}  // namespace meniscus::shell
