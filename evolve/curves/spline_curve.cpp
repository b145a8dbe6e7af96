#include "evolve/curves/spline_curve.h"

#include <algorithm>

#include "evolve/curves/arc_side.h"

namespace meniscus::curves::curve_shape {

namespace {

/// Solves rows b[k] x[k-1] + d[k] x[k] + b[k+1] x[k+1] = right[k] around the
/// circle: a chain with one more right-hand side for the link that closes it
/// (Sherman and Morrison). Diagonally dominant: no pivoting.
template <class Scalar>
std::vector<Vector<Scalar>> solve_circle(std::vector<Scalar> diagonal,
                                         const std::vector<Scalar>& below,
                                         std::vector<Vector<Scalar>> right) {
  const std::size_t n = diagonal.size();
  const Scalar& corner = below[0];
  const Scalar gamma = -diagonal[0];
  diagonal[0] = diagonal[0] - gamma;
  diagonal[n - 1] = diagonal[n - 1] - corner * corner / gamma;
  std::vector<Scalar> link(n, Scalar(0.0));
  link[0] = gamma;
  link[n - 1] = corner;
  for (std::size_t k = 1; k < n; ++k) {
    const Scalar factor = below[k] / diagonal[k - 1];
    diagonal[k] = diagonal[k] - factor * below[k];
    right[k] = Vector<Scalar>(right[k] - factor * right[k - 1]);
    link[k] = link[k] - factor * link[k - 1];
  }
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n) {
      right[k] = Vector<Scalar>(right[k] - below[k + 1] * right[k + 1]);
      link[k] = link[k] - below[k + 1] * link[k + 1];
    }
    right[k] = Vector<Scalar>(right[k] / diagonal[k]);
    link[k] = link[k] / diagonal[k];
  }
  const Scalar share = corner / gamma;
  const Vector<Scalar> sum =
      (right[0] + share * right[n - 1]) / (1.0 + link[0] + share * link[n - 1]);
  for (std::size_t k = 0; k < n; ++k) {
    right[k] = Vector<Scalar>(right[k] - link[k] * sum);
  }
  return right;
}

}  // namespace

template <class Scalar>
SplineCurve<Scalar>::SplineCurve(std::vector<Vector<Scalar>> points)
    : points_(std::move(points)) {
  using std::sqrt;
  const std::size_t n = points_.size();
  knots_.push_back(Scalar(0.0));
  for (std::size_t k = 0; k < n; ++k) {
    const Vector<Scalar> chord = points_[(k + 1) % n] - points_[k];
    chords_.push_back(sqrt(chord.dot(chord)));
    knots_.push_back(knots_.back() + chords_.back());
  }
  std::vector<Scalar> diagonal;
  std::vector<Scalar> below;
  std::vector<Vector<Scalar>> right;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = (k + n - 1) % n;
    diagonal.push_back(2.0 * (chords_[before] + chords_[k]));
    below.push_back(chords_[before]);
    const Vector<Scalar> after =
        (points_[(k + 1) % n] - points_[k]) / chords_[k];
    const Vector<Scalar> so_far =
        (points_[k] - points_[before]) / chords_[before];
    right.push_back(Scalar(6.0) * (after - so_far));
  }
  bends_ = solve_circle(std::move(diagonal), below, std::move(right));
}

template <class Scalar>
Vector<Scalar> SplineCurve<Scalar>::at(double t) const {
  const std::size_t n = points_.size();
  const Scalar u = (t - std::floor(t)) * knots_.back();
  const auto above =
      std::upper_bound(knots_.begin() + 1, knots_.end() - 1, plain(u),
                       [](double x, const Scalar& k) { return x < plain(k); });
  const auto k = static_cast<std::size_t>(above - knots_.begin()) - 1;
  const std::size_t next = (k + 1) % n;
  const Scalar h = chords_[k];
  const Scalar x = u - knots_[k];
  const Scalar y = h - x;
  const Scalar at_k = y / h;
  const Scalar at_next = x / h;
  const Scalar bend_k = (y * y * at_k - h * y) / 6.0;
  const Scalar bend_next = (x * x * at_next - h * x) / 6.0;
  return at_k * points_[k] + at_next * points_[next] + bend_k * bends_[k] +
         bend_next * bends_[next];
}

template <class Scalar>
Vector<Scalar> SplineCurve<Scalar>::slope(int k) const {
  const auto here = static_cast<std::size_t>(k);
  const std::size_t next = (here + 1) % points_.size();
  const Scalar h = chords_[here];
  const Scalar sixth = h / 6.0;
  const Scalar third = h / 3.0;
  return (points_[next] - points_[here]) / h - third * bends_[here] -
         sixth * bends_[next];
}

template class SplineCurve<double>;
template class SplineCurve<Dual1>;

}  // namespace meniscus::curves::curve_shape
