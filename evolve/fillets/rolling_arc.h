/// A ball in the corner between two surfaces, in the plane across the curve
/// where they meet: where it touches them, and where points of either come to
/// lie when the ball's arc takes the corner's place. Values, or with duals of
/// first order their derivatives.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/types.h"
#include "evolve/fillets/section.h"

namespace meniscus::fillets {

/// Where the ball touches the two sections, by their s [length].
struct Contact {
  double a = 0.0;
  double b = 0.0;
  double sign = 0.0;  // 1: the ball lies outside and fills the corner; -1: it
                      // lies within the material and takes the edge away; 0:
                      // the surfaces go on as one
};

/// Two sections that begin at one point of the curve.
template <class T>
struct Corner {
  using Vector = Eigen::Matrix<T, 3, 1>;
  Section<T> a;
  Section<T> b;
  Vector along;        // the curve's direction, of any length
  T radius = T(0.0);   // of the ball, >= 0 [length]
  double share = 0.0;  // of the arc, from b's end on, where the curve goes
};

/// Centers of balls that touch a section, in the plane across the curve and
/// from its point there.
template <class T>
struct BallCenters {
  using Vector = Eigen::Matrix<T, 3, 1>;
  Vector along;  // unit
  Vector foot;
  T reach;  // radius x Contact::sign

  Vector across(const Vector& v) const { return v - along * along.dot(v); }
  /// The section's outward normal.
  Vector normal(const Section<T>& section, const T& s) const;
  Vector at(const Section<T>& section, const T& s) const {
    return across(section.at(s) - foot) + normal(section, s) * reach;
  }
  Vector rate(const Section<T>& section, const T& s) const;
  /// A step of Newton's towards the ball that touches both.
  void step(const Corner<T>& corner, T& a, T& b) const;
};

/// Empty where there is no such ball, or none within the sections.
std::optional<Contact> find_contact(const Corner<double>& corner);

/// How much of a section's pace over arc and surface is that of the frozen
/// design, by which points stay on the arc and facets keep their shape while
/// the radius changes; the rest is even, by which none shrink to nothing.
inline constexpr double kKept = 0.75;

/// The corner's points once the ball is there: section `a` runs over its part
/// of the arc and then on itself, so that its far end stays; so does `b`.
template <class T>
class RollingArc {
 public:
  using Vector = Eigen::Matrix<T, 3, 1>;

  /// `contact`: of the corner's values.
  RollingArc(Corner<T> corner, const Contact& contact);

  /// Of the curve's own point.
  Vector rim_move() const {
    return flat_ ? zero()
                 : Vector(on_arc(T(corner_.share)) - corner_.a.nodes[0]);
  }
  /// What of a section's length the arc takes at an even pace.
  T arc_length(bool of_a) const;
  /// Of the point at s of a section, in (0, length).
  Vector move(bool of_a, double s) const;

 private:
  double part_of(bool of_a) const {
    return of_a ? 1.0 - corner_.share : corner_.share;
  }
  static Vector zero() { return Vector::Constant(T(0.0)); }
  void touch(const Contact& contact);
  Vector on_arc(const T& share) const;

  Corner<T> corner_;
  Vector along_;  // unit
  bool flat_ = true;
  double sign_ = 0.0;
  T at_a_ = T(0.0), at_b_ = T(0.0);
  Vector normal_a_, normal_b_;
  Vector center_;                          // in the plane, from the curve
  T turn_ = T(0.0);                        // of the arc [rad]
  T along_a_ = T(0.0), along_b_ = T(0.0);  // of the contacts, along the curve
};

template <class T>
typename BallCenters<T>::Vector BallCenters<T>::normal(
    const Section<T>& section, const T& s) const {
  using std::sqrt;
  const Vector inward = across(section.slope(s));
  return along.cross(inward) * T(T(section.out) / sqrt(inward.dot(inward)));
}

template <class T>
typename BallCenters<T>::Vector BallCenters<T>::rate(const Section<T>& section,
                                                     const T& s) const {
  using std::sqrt;
  const Vector inward = across(section.slope(s));
  const T speed = sqrt(inward.dot(inward));
  const Vector unit = inward / speed;
  const Vector bent = across(section.bend(s));
  const Vector turned = (bent - unit * unit.dot(bent)) / speed;
  return inward + along.cross(turned) * T(T(section.out) * reach);
}

template <class T>
void BallCenters<T>::step(const Corner<T>& corner, T& a, T& b) const {
  const Vector gap = at(corner.a, a) - at(corner.b, b);
  const Vector by_a = rate(corner.a, a);
  const Vector by_b = rate(corner.b, b);
  const T area = along.dot(by_b.cross(by_a));
  a = a - along.dot(by_b.cross(gap)) / area;
  b = b + along.dot(gap.cross(by_a)) / area;
}

template <class T>
RollingArc<T>::RollingArc(Corner<T> corner, const Contact& contact)
    : corner_(std::move(corner)),
      flat_(contact.sign == 0.0),
      sign_(contact.sign) {
  if (!flat_) {
    touch(contact);
  }
}

/// Where the equations hold a step of Newton's changes no value, and gives the
/// contact its derivatives.
template <class T>
void RollingArc<T>::touch(const Contact& contact) {
  using std::atan2;
  using std::sqrt;
  along_ = corner_.along / T(sqrt(corner_.along.dot(corner_.along)));
  const Vector foot = corner_.a.nodes[0];
  const BallCenters<T> centers{along_, foot, corner_.radius * T(sign_)};
  at_a_ = T(contact.a);
  at_b_ = T(contact.b);
  centers.step(corner_, at_a_, at_b_);
  normal_a_ = centers.normal(corner_.a, at_a_);
  normal_b_ = centers.normal(corner_.b, at_b_);
  center_ = centers.at(corner_.b, at_b_);
  along_a_ = along_.dot(corner_.a.at(at_a_) - foot);
  along_b_ = along_.dot(corner_.b.at(at_b_) - foot);
  const Vector turning = normal_b_.cross(normal_a_);
  turn_ = atan2(T(sqrt(turning.dot(turning))), normal_a_.dot(normal_b_));
}

template <class T>
typename RollingArc<T>::Vector RollingArc<T>::on_arc(const T& share) const {
  using std::sin;
  const T rest = T(1.0) - share;
  const Vector way =
      (normal_b_ * T(sin(rest * turn_)) + normal_a_ * T(sin(share * turn_))) /
      T(sin(turn_));
  return corner_.a.nodes[0] + center_ - way * T(corner_.radius * T(sign_)) +
         along_ * T(rest * along_b_ + share * along_a_);
}

template <class T>
T RollingArc<T>::arc_length(bool of_a) const {
  if (flat_) {
    return T(0.0);
  }
  const Section<T>& section = of_a ? corner_.a : corner_.b;
  const T arc = corner_.radius * turn_ * T(part_of(of_a));
  return T(section.length) * arc /
         (arc + T(section.length) - (of_a ? at_a_ : at_b_));
}

template <class T>
typename RollingArc<T>::Vector RollingArc<T>::move(bool of_a, double s) const {
  if (flat_) {
    return zero();
  }
  const Section<T>& section = of_a ? corner_.a : corner_.b;
  const T& touched = of_a ? at_a_ : at_b_;
  const double part = part_of(of_a);
  const T arc = corner_.radius * turn_ * T(part);
  const T rest = T(section.length) - touched;
  const double even = s / section.length;
  const T kept = s < section.arc
                     ? T(arc * T(s / section.arc))
                     : T(arc + rest * T((s - section.arc) /
                                        (section.length - section.arc)));
  const T way = T(1.0 - kKept) * (arc + rest) * T(even) + T(kKept) * kept;
  const Vector from = section.at(T(s));
  if (way < arc) {
    const T gone = way / arc * T(part);
    const T share(corner_.share);
    return on_arc(of_a ? T(share + gone) : T(share - gone)) - from;
  }
  return section.at(T(touched + way - arc)) - from;
}

}  // namespace meniscus::fillets
