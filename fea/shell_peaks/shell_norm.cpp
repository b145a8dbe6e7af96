#include "fea/shell_peaks/shell_norm.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/taped_facet.h"

namespace meniscus::shell {

namespace {

/// Of the stress points: exact to degree two.
constexpr double kPointWeight = 1.0 / 6.0;

/// One face of a ply.
struct WallFace {
  double at;  // in thicknesses, from the middle
  int number;
  const PlyLaw* ply;
  Vec3 free;      // strain of no stress in the surface
  double normal;  // stress across
};

/// Of all plies, from the negative face on.
std::vector<WallFace> faces_of(const Facet& facet, const WallState& state) {
  const LaminateLaw& law = *facet.law;
  std::vector<WallFace> faces;
  for (std::size_t p = 0; p < law.plies.size(); ++p) {
    for (const double at : {law.from[p], law.to[p]}) {
      faces.push_back({at, static_cast<int>(p), &law.plies[p],
                       state.free_strain(law.plies[p], at), state.stress(at)});
    }
  }
  return faces;
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

/// Of one facet: area, and all faces' squares at its points.
struct FaceSquares {
  double area = 0.0;
  std::array<double, 3> share = {};  // of the area
  std::array<std::vector<double>, 3> square = {};
};

/// One facet with its solution.
struct SolvedFacet {
  Facet facet;
  WallStates states;
  FacetField field;
  Eigen::Vector2d bubble;
  WholeMatrix stiffness;
};

FaceSquares squares_of(const SolvedFacet& solved) {
  const Facet& facet = solved.facet;
  const auto X = triples(facet);
  const Triple<double> bubble = bubble_turn(bubble_axes(X), solved.bubble);
  FaceSquares result;
  for (int q = 0; q < 3; ++q) {
    const FacetPoint& p = stress_points()[q];
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain =
        facet_strain(X, p, frame, solved.field, bubble);
    const std::vector<WallFace> faces = faces_of(facet, solved.states.at(p));
    result.share[q] = kPointWeight * frame.area;
    result.area += result.share[q];
    for (const WallFace& face : faces) {
      const double zeta = (face.at + facet.offset) * thickness_at(facet, p);
      result.square[q].push_back(von_mises_square(
          face_stress(face, frame, strain, zeta), face.normal));
    }
  }
  return result;
}

/// What the norm is of: the mean over the faces, by area, of a term of each
/// square.
struct NormTerms {
  double power = 0.0;      // of stresses over the largest; or
  double sharpness = 0.0;  // of exponentials, where it is above 0 [1/pressure]
  double scale = 1.0;      // the largest square
  double by_sum = 0.0;     // the norm's derivatives
  double by_area = 0.0;

  double term(double square) const {
    return sharpness > 0.0
               ? std::exp(sharpness * (std::sqrt(square) - std::sqrt(scale)))
               : std::pow(square / scale, 0.5 * power);
  }
  double slope(double square) const {
    if (!(square > 0.0)) {
      return 0.0;
    }
    return term(square) * (sharpness > 0.0 ? 0.5 * sharpness / std::sqrt(square)
                                           : 0.5 * power / square);
  }
  /// By the sum of terms times area, and the area.
  double value(double sum, double area) const {
    return sharpness > 0.0
               ? std::sqrt(scale) + std::log(sum / area) / sharpness
               : std::sqrt(scale) * std::pow(sum / area, 1.0 / power);
  }
  void differentiate(double sum, double area) {
    const double size =
        sharpness > 0.0 ? 1.0 / sharpness : value(sum, area) / power;
    by_sum = sum > 0.0 ? size / sum : 0.0;
    by_area = -size / area;
  }
};

/// By places and thicknesses, nodes' numbers and bubble held.
ByShape norm_by_shape(const SolvedFacet& solved, const NormTerms& terms,
                      Tape& tape) {
  const Facet& facet = solved.facet;
  const TapedFacet taped(facet, tape);
  const Triple<Taped> bubble = taped.bubble(solved.bubble);
  const double each = 0.5 / static_cast<double>(facet.law->plies.size());
  Taped sum(0.0);
  for (const FacetPoint& p : stress_points()) {
    const FacetFrame<Taped> frame = facet_frame(taped.X, p, facet.direction);
    const FacetStrain<Taped> strain =
        facet_strain(taped.X, p, frame, solved.field, bubble);
    const Taped thickness = taped.thickness_at(p);
    const std::vector<WallFace> faces = faces_of(facet, solved.states.at(p));
    Taped here(terms.by_area);
    for (const WallFace& face : faces) {
      const Taped zeta = (face.at + facet.offset) * thickness;
      const Taped square =
          von_mises_square(face_stress(face, frame, strain, zeta), face.normal);
      here = here + each * terms.by_sum *
                        chain(square, terms.term(square.value),
                              terms.slope(square.value), 0.0);
    }
    sum = sum + kPointWeight * frame.area * here;
  }
  return taped.transpose(sum);
}

/// From the square's derivative to the stress in the surface.
Vec3 by_stress(const WallFace& face, const Triple<double>& s,
               double by_square) {
  return by_square * Vec3(2.0 * s[0] - s[1] - face.normal,
                          2.0 * s[1] - s[0] - face.normal, 6.0 * s[2]);
}

/// By the nodes' numbers and the bubble, which strains are linear in, and by
/// the law.
void add_by_unknowns(const SolvedFacet& solved, const NormTerms& terms,
                     WholeGradient& gradient) {
  const Facet& facet = solved.facet;
  const auto X = triples(facet);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = bubble_turn(axes, solved.bubble);
  const std::size_t count = 2 * facet.law->plies.size();
  const double each = 1.0 / static_cast<double>(count);
  std::vector<double> zeta(count);
  std::vector<Vec3> by_plane(count);
  LawGradient by_law(*facet.law);
  for (const FacetPoint& p : stress_points()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain =
        facet_strain(X, p, frame, solved.field, bubble);
    const WallState state = solved.states.at(p);
    const std::vector<WallFace> faces = faces_of(facet, state);
    StateGradient by_state;
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const WallFace& face = faces[k];
      zeta[k] = (face.at + facet.offset) * thickness_at(facet, p);
      const Triple<double> s = face_stress(face, frame, strain, zeta[k]);
      const double by_square = each * kPointWeight * frame.area * terms.by_sum *
                               terms.slope(von_mises_square(s, face.normal));
      const Vec3 by = by_stress(face, s, by_square);
      by_plane[k] = face.ply->plane.transpose() * by;
      const LayerStrain<double> e = layer_strain(
          strain, inverse(shifter(frame.curvature, zeta[k])), zeta[k]);
      PlyLaw& law = by_law.by[face.number];
      law.plane += by * (as_vector(e.plane) - face.free).transpose();
      by_state.add_free_strain(state, *face.ply, face.at, -by_plane[k], law);
      by_state.add_stress(face.at,
                          by_square * (2.0 * face.normal - s[0] - s[1]));
    }
    by_state.add_to(p, gradient.by_loads);
    const auto work = [&](const FacetField& field,
                          const Triple<double>& turned) {
      const FacetStrain<double> own = facet_strain(X, p, frame, field, turned);
      double sum = 0.0;
      for (std::size_t k = 0; k < faces.size(); ++k) {
        const LayerStrain<double> e = layer_strain(
            own, inverse(shifter(frame.curvature, zeta[k])), zeta[k]);
        sum += by_plane[k].dot(as_vector(e.plane));
      }
      return sum;
    };
    add_linear_work(axes, work, gradient.by_whole);
  }
  gradient.by_ply = by_law.by_ply();
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

  /// `terms` says the kind of mean.
  StressNorm find(NormTerms terms, NormDerivatives derivatives) const {
    std::vector<FaceSquares> squares(mesh_.facets.size());
    parallel_for(count(), [&](std::ptrdiff_t k) {
      squares[k] = squares_of(solved(static_cast<int>(k)));
    });
    double area = 0.0;
    terms.scale = 0.0;
    for (const FaceSquares& facet : squares) {
      area += facet.area;
      for (const std::vector<double>& at : facet.square) {
        terms.scale =
            std::max(terms.scale, *std::max_element(at.begin(), at.end()));
      }
    }
    StressNorm norm;
    double sum = 0.0;
    if (terms.scale > 0.0) {
      for (const FaceSquares& facet : squares) {
        for (int q = 0; q < 3; ++q) {
          double own = 0.0;
          for (const double square : facet.square[q]) {
            own += terms.term(square);
          }
          sum += facet.share[q] * own /
                 static_cast<double>(facet.square[q].size());
        }
      }
      norm.value = terms.value(sum, area);
    }
    if (derivatives == NormDerivatives::All) {
      terms.differentiate(sum, area);
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
    return {facet, wall_states(loads_, own_[f]),
            Eigen::Map<const FacetField>(u.data()),
            bubble_rotation(K, facet_forces(facet, loads_, own_[f]), u), K};
  }

  void add_derivatives(const NormTerms& terms, StressNorm& norm) const {
    std::vector<WholeGradient> parts(mesh_.facets.size());
    std::vector<Eigen::Vector2d> on_bubbles(mesh_.facets.size());
    parallel_for(count(), [&](std::ptrdiff_t k) {
      static thread_local Tape tape;
      const SolvedFacet facet = solved(static_cast<int>(k));
      parts[k].by = norm_by_shape(facet, terms, tape);
      add_by_unknowns(facet, terms, parts[k]);
      add_field_slopes(facet.facet, own_[k], parts[k].by_loads,
                       parts[k].by.data());
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
    norm.by_ply = std::move(state.by_ply);
    norm.by_actions = std::move(state.by_actions);
  }

  const ShellMesh& mesh_;
  const std::vector<Section>& sections_;
  const ShellLoads& loads_;
  const VectorX& u_;
  std::vector<LaminateLaw> laws_;
  std::vector<FacetLoad> own_;
};

void check_solution(const ShellMesh& mesh, const std::vector<Section>& sections,
                    const ShellLoads& loads, const VectorX& displacement) {
  check_shell(mesh, sections);
  check_loads(mesh, loads);
  if (displacement.size() != static_cast<Eigen::Index>(6 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has a displacement of {} numbers; "
                    "six a node are needed",
                    mesh.nodes.size(), displacement.size()));
  }
}

}  // namespace

StressNorm von_mises_norm(const ShellMesh& mesh,
                          const std::vector<Section>& sections,
                          const ShellLoads& loads, const VectorX& displacement,
                          double power, NormDerivatives derivatives) {
  check_solution(mesh, sections, loads, displacement);
  if (!(power > 1.0)) {
    throw InvalidInput(fmt::format(
        "a stress norm has the power {}; give it one above 1", power));
  }
  return NormOfShell(mesh, sections, loads, displacement)
      .find({.power = power}, derivatives);
}

StressNorm von_mises_ks(const ShellMesh& mesh,
                        const std::vector<Section>& sections,
                        const ShellLoads& loads, const VectorX& displacement,
                        const StressKs& options, NormDerivatives derivatives) {
  check_solution(mesh, sections, loads, displacement);
  if (!(options.sharpness > 0.0) || !(options.scale > 0.0)) {
    throw InvalidInput(fmt::format(
        "a mean of exponentials has the sharpness {} and the scale {}; both "
        "must be above 0",
        options.sharpness, options.scale));
  }
  return NormOfShell(mesh, sections, loads, displacement)
      .find({.sharpness = options.sharpness / options.scale}, derivatives);
}

}  // namespace meniscus::shell
