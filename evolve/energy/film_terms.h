/// Energies and held functionals of a complex beside tension x area and cone
/// volumes: tension that varies, weight, line integrals on walls, named
/// quantities. Each is a sum over small elements (a facet, or an edge of one)
/// with value, gradient and Hessian in the corners' coordinates.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math/place_field.h"
#include "evolve/films/film_complex.h"
#include "evolve/films/film_targets.h"

namespace meniscus::energy {

/// Derivatives of one element, the nine coordinates of its facet's corners.
struct FacetJet {
  double value = 0.0;
  Eigen::Matrix<double, 9, 1> gradient = Eigen::Matrix<double, 9, 1>::Zero();
  Eigen::Matrix<double, 9, 9> hessian = Eigen::Matrix<double, 9, 9>::Zero();
};

enum class JetOrder { Value = 0, Gradient = 1, Hessian = 2 };

class FilmTerm {
 public:
  virtual ~FilmTerm() = default;

  struct Element {
    int facet;    // whose corners it depends on
    double sign;  // factor
    int first;    // corner where its edge starts (edges only)
  };
  const std::vector<Element>& elements() const { return elements_; }
  /// -1: energy, else the held functional (bodies, then held quantities) that
  /// it belongs to; -2: only reported.
  int functional() const { return functional_; }
  int quantity() const { return quantity_; }  // index, or -1
  /// Where the numbers of its field stand in films::FilmTargets::numbers.
  int field() const { return field_; }

  using Corners = std::array<Vec3, 3>;
  using Vector9 = Eigen::Matrix<double, 9, 1>;

  /// One element's share, sign included. Throws ExpressionError.
  virtual FacetJet jet(const Element& element, const Corners& corner,
                       JetOrder order, Numbers numbers) const = 0;

  /// True where its field has numbers.
  virtual bool has_numbers() const { return false; }
  /// True where jets are worth two threads.
  virtual bool is_costly() const { return has_numbers(); }
  /// Adds factor x the derivative of motion . gradient by each number.
  virtual void add_by_numbers(const Element& /*element*/,
                              const Corners& /*corner*/,
                              const Corners& /*motion*/, double /*factor*/,
                              Numbers /*numbers*/, VectorX& /*sum*/) const {}
  /// The same of the value itself.
  virtual void add_value_by_numbers(const Element& /*element*/,
                                    const Corners& /*corner*/,
                                    double /*factor*/, Numbers /*numbers*/,
                                    VectorX& /*sum*/) const {}
  /// How fast the gradient changes as the numbers do.
  virtual Vector9 gradient_rate(const Element& /*element*/,
                                const Corners& /*corner*/, Numbers /*numbers*/,
                                Numbers /*rates*/) const {
    return Vector9::Zero();
  }

 protected:
  std::vector<Element> elements_;
  int functional_ = -1;
  int quantity_ = -1;
  int field_ = -1;
  friend class FilmTermBuilder;
};

/// The terms of a complex, in a fixed order. Throws InvalidInput for a held
/// functional over nothing.
std::vector<std::unique_ptr<FilmTerm>> film_terms(
    const films::FilmComplex& complex);

/// True where the body's facets close it, so that cones measure its volume
/// whatever the rule.
bool closed_by_facets(const films::FilmComplex& complex, int body);

/// Quantities that are held, in order: functional bodies + k.
std::vector<int> held_quantities(const films::FilmComplex& complex);

/// What a complex asks of its liquid.
films::FilmTargets targets_of(const films::FilmComplex& complex);

}  // namespace meniscus::energy
