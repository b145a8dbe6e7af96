#include "evolve/datafile/fe_integral_places.h"

namespace meniscus::datafile {

bool fe_is_boundary(const films::FilmComplex& complex, int curve) {
  const curves::CurveShape& shape = complex.curves[curve].shape;
  return std::holds_alternative<curves::Circle>(shape) ||
         std::holds_alternative<curves::Ellipse>(shape) ||
         std::holds_alternative<curves::ParametricCurve>(shape);
}

bool fe_on_boundary(const films::FilmComplex& complex,
                    const films::ComplexEdge& edge) {
  return (edge.kind == films::VertexKind::OnCurve ||
          edge.kind == films::VertexKind::Slides) &&
         fe_is_boundary(complex, edge.curve);
}

bool fe_has_levels(const films::ComplexEdge& edge) {
  return edge.kind == films::VertexKind::Free && edge.constraints >= 0;
}

FeIntegralPlaces::FeIntegralPlaces(const films::FilmComplex& complex) {
  constexpr int kNone = -1;
  constexpr int kUnseen = -2;
  of_curve.assign(complex.curves.size(), kUnseen);
  of_level.assign(complex.level_sets.size(), kUnseen);
  const auto see = [](int& of, int set) {
    of = of == kUnseen || of == set ? set : kNone;
  };
  for (const films::ComplexEdge& edge : complex.edges) {
    if (fe_on_boundary(complex, edge)) {
      see(of_curve[edge.curve], edge.integrals);
    } else if (fe_has_levels(edge)) {
      const std::vector<int>& levels =
          complex.constraint_sets[edge.constraints];
      for (std::size_t k = 0; k < levels.size(); ++k) {
        see(of_level[levels[k]], k == 0 ? edge.integrals : kNone);
      }
    }
  }
  int next = static_cast<int>(complex.level_sets.size()) + 1;
  for (const films::ComplexEdge& edge : complex.edges) {
    if (needs_carrier(complex, edge) &&
        carriers.emplace(key_of(complex, edge), next).second) {
      ++next;
    }
  }
}

bool FeIntegralPlaces::needs_carrier(const films::FilmComplex& complex,
                                     const films::ComplexEdge& edge) const {
  if (edge.integrals < 0) {
    return false;
  }
  if (fe_on_boundary(complex, edge)) {
    return of_curve[edge.curve] != edge.integrals;
  }
  return !fe_has_levels(edge) ||
         of_level[complex.constraint_sets[edge.constraints][0]] !=
             edge.integrals;
}

std::array<int, 2> FeIntegralPlaces::key_of(const films::FilmComplex& complex,
                                            const films::ComplexEdge& edge) {
  return {
      fe_has_levels(edge) ? complex.constraint_sets[edge.constraints][0] : -1,
      edge.integrals};
}

}  // namespace meniscus::datafile
