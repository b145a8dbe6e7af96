#include "evolve/energy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

#include "core/error.h"
#include "evolve/facet_terms.h"

namespace meniscus {

namespace {

FacetFrame frame_of(const Points& points, const Triangle& t,
                    const Vec3& origin) {
  return {points[t[0]] - origin, points[t[1]] - origin, points[t[2]] - origin};
}

std::array<Vec3, 3> corners_of(const Points& points, const Triangle& t) {
  return {points[t[0]], points[t[1]], points[t[2]]};
}

int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

}  // namespace

FilmTargets targets_of(const FilmComplex& complex) {
  FilmTargets targets;
  for (const ComplexSurface& surface : complex.surfaces) {
    targets.tension.push_back(surface.liquid ? surface.tension : 0.0);
  }
  targets.bodies = complex.bodies;
  for (const int q : held_quantities(complex)) {
    ComplexBody held;
    held.name = complex.quantities[q].name;
    held.volume = complex.quantities[q].target;
    targets.bodies.push_back(std::move(held));
  }
  return targets;
}

FilmEnergy::~FilmEnergy() = default;
FilmEnergy::FilmEnergy(FilmEnergy&&) noexcept = default;
FilmEnergy& FilmEnergy::operator=(FilmEnergy&&) noexcept = default;

FilmEnergy::FilmEnergy(const FilmComplex& complex, FilmMotion motion)
    : space_(complex, motion),
      facets_(complex.mesh.facets),
      label_(complex.mesh.facet_label),
      terms_(film_terms(complex)),
      body_count_(static_cast<int>(complex.bodies.size())),
      quantity_count_(static_cast<int>(complex.quantities.size())),
      gravity_(complex.gravity) {
  functional_count_ =
      body_count_ + static_cast<int>(held_quantities(complex).size());
  volume_offset_ = VectorX::Zero(functional_count_);
  for (int b = 0; b < body_count_; ++b) {
    const bool closed = closed_by_facets(complex, b);
    cone_.push_back(closed || complex.volume_rule == VolumeRule::Cone);
    open_cones_ = open_cones_ || (cone_.back() != 0 && !closed);
    volume_offset_[b] = complex.bodies[b].volume_offset;
  }
  for (const ComplexSurface& surface : complex.surfaces) {
    liquid_.push_back(surface.liquid ? 1 : 0);
    plain_.push_back(surface.liquid && !surface.tension_field ? 1 : 0);
    resisted_ = resisted_ || surface.tension_field;
    std::vector<int> sides(body_count_, 0);
    const int s = static_cast<int>(side_.size());
    for (int b = 0; b < body_count_; ++b) {
      for (const BodySide& side : complex.bodies[b].sides) {
        sides[b] += side.surface == s ? side.sign : 0;
      }
    }
    side_.push_back(std::move(sides));
  }
  for (const FilmQuantity& quantity : complex.quantities) {
    const bool energy = quantity.role == FilmQuantity::Role::Energy;
    modulus_.push_back(energy ? quantity.modulus : 1.0);
    resisted_ = resisted_ || quantity.role != FilmQuantity::Role::Info;
  }
  corner_start_.reserve(facets_.size() + 1);
  corner_start_.push_back(0);
  for (const Triangle& t : facets_) {
    for (int k = 0; k < 3; ++k) {
      const int first = space_.first(t[k]);
      for (int r = 0; r < space_.rank(t[k]); ++r) {
        corners_.push_back({k, first + r});
      }
    }
    corner_start_.push_back(static_cast<int>(corners_.size()));
  }
  find_floating(complex);
  build_pattern();
}

void FilmEnergy::find_floating(const FilmComplex& complex) {
  floating_.assign(unknowns(), -1);
  if (resisted_) {
    return;
  }
  const int points = static_cast<int>(complex.mesh.points.size());
  std::vector<char> held(points, 0);
  bool any_free = false;
  for (int v = 0; v < points; ++v) {
    held[v] = complex.vertices[v].kind != VertexKind::Free ||
              (space_.rank(v) == 0 && space_.vertex_count() > v);
    any_free = any_free || held[v] == 0;
  }
  std::vector<int> parent(points);
  std::iota(parent.begin(), parent.end(), 0);
  for (const Triangle& t : facets_) {
    for (int k = 1; k < 3; ++k) {
      parent[root_of(parent, t[k])] = root_of(parent, t[0]);
    }
  }
  for (int v = 0; v < points; ++v) {
    if (held[v] != 0) {
      held[root_of(parent, v)] = 1;
    }
  }
  std::vector<int> number(points, -1);
  for (int i = 0; i < unknowns(); ++i) {
    const int root = root_of(parent, vertices()[i]);
    if (held[root] == 0) {
      if (number[root] < 0) {
        number[root] = floating_count_++;
      }
      floating_[i] = number[root];
    }
  }
}

void FilmEnergy::build_pattern() {
  // Pairs of unknowns column by column: by counting, sorting and merging.
  const int n = unknowns();
  std::vector<int> count(n + 1, 0);
  const auto for_pairs = [&](std::size_t f, const auto& visit) {
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      for (int j = corner_start_[f]; j <= i; ++j) {
        const int a = corners_[i].unknown;
        const int b = corners_[j].unknown;
        visit(std::max(a, b), std::min(a, b));
      }
    }
  };
  element_start_.reserve(facets_.size() + 1);
  element_start_.push_back(0);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for_pairs(f, [&](int /*a*/, int b) { ++count[b + 1]; });
    const int c = corner_start_[f + 1] - corner_start_[f];
    element_start_.push_back(element_start_.back() + c * (c + 1) / 2);
  }
  std::partial_sum(count.begin(), count.end(), count.begin());
  std::vector<int> rows(count.back());
  {
    std::vector<int> at(count.begin(), count.end() - 1);
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      for_pairs(f, [&](int a, int b) { rows[at[b]++] = a; });
    }
  }
  std::vector<int> outer(n + 1, 0);
  int kept = 0;
  for (int b = 0; b < n; ++b) {
    const auto first = rows.begin() + count[b];
    const auto last = rows.begin() + count[b + 1];
    std::sort(first, last);
    const auto end = std::unique(first, last);
    for (auto it = first; it != end; ++it) {
      rows[kept++] = *it;
    }
    outer[b + 1] = kept;
  }
  rows.resize(kept);
  pattern_.resize(n, n);
  pattern_.resizeNonZeros(kept);
  std::copy(outer.begin(), outer.end(), pattern_.outerIndexPtr());
  std::copy(rows.begin(), rows.end(), pattern_.innerIndexPtr());
  std::fill(pattern_.valuePtr(), pattern_.valuePtr() + kept, 0.0);
  slots_.reserve(element_start_.back());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for_pairs(f, [&](int a, int b) {
      const auto at = std::lower_bound(rows.begin() + outer[b],
                                       rows.begin() + outer[b + 1], a);
      slots_.push_back(static_cast<int>(at - rows.begin()));
    });
  }
}

const std::vector<int>& FilmEnergy::order() const {
  if (order_.empty() && unknowns() > 0) {
    order_ = nested_dissection(pattern_);
  }
  return order_;
}

double FilmEnergy::value(const Points& points,
                         const FilmTargets& targets) const {
  double sum = 0.0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (plain_[label_[f]] != 0) {
      const Triangle& t = facets_[f];
      const Vec3& a = points[t[0]];
      sum += targets.tension[label_[f]] *
             (points[t[1]] - a).cross(points[t[2]] - a).norm();
    }
  }
  sum *= 0.5;
  for (const auto& term : terms_) {
    if (term->functional() == -1) {
      for (const FilmTerm::Element& e : term->elements()) {
        sum +=
            term->jet(e, corners_of(points, facets_[e.facet]), JetOrder::Value)
                .value;
      }
    }
  }
  return sum;
}

double FilmEnergy::area(const Points& points) const {
  double sum = 0.0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] != 0) {
      const Triangle& t = facets_[f];
      const Vec3& a = points[t[0]];
      sum += (points[t[1]] - a).cross(points[t[2]] - a).norm();
    }
  }
  return 0.5 * sum;
}

/// A point of the film keeps the cones of closed bodies small. The line
/// integrals that close others count on cones to the origin.
Vec3 FilmEnergy::cone_origin(const Points& points) const {
  return points.empty() || open_cones_ ? Vec3::Zero() : points.front();
}

VectorX FilmEnergy::volumes(const Points& points) const {
  VectorX sum = volume_offset_;
  const Vec3 origin = cone_origin(points);
  for (std::size_t f = 0; f < facets_.size() && body_count_ > 0; ++f) {
    const Triangle& t = facets_[f];
    const Vec3 a = points[t[0]] - origin;
    const double cone =
        a.dot((points[t[1]] - origin).cross(points[t[2]] - origin)) / 6.0;
    for (int b = 0; b < body_count_; ++b) {
      if (cone_[b] != 0) {
        sum[b] += side_[label_[f]][b] * cone;
      }
    }
  }
  for (const auto& term : terms_) {
    if (term->functional() >= 0) {
      for (const FilmTerm::Element& e : term->elements()) {
        sum[term->functional()] +=
            term->jet(e, corners_of(points, facets_[e.facet]), JetOrder::Value)
                .value;
      }
    }
  }
  return sum;
}

VectorX FilmEnergy::quantities(const Points& points) const {
  VectorX sum = VectorX::Zero(quantity_count_);
  for (const auto& term : terms_) {
    const int q = term->quantity();
    for (const FilmTerm::Element& e : term->elements()) {
      if (q >= 0) {
        sum[q] +=
            term->jet(e, corners_of(points, facets_[e.facet]), JetOrder::Value)
                .value;
      }
    }
  }
  for (int q = 0; q < quantity_count_; ++q) {
    sum[q] = modulus_[q] != 0.0 ? sum[q] / modulus_[q] : 0.0;
  }
  return sum;
}

Points FilmEnergy::gradient(const Points& points,
                            const FilmTargets& targets) const {
  Points sum(points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (plain_[label_[f]] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3 ab = points[t[1]] - points[t[0]];
    const Vec3 ac = points[t[2]] - points[t[0]];
    Vec3 n = ab.cross(ac);
    const double size = n.norm();
    if (size > 0.0) {
      n *= 0.5 * targets.tension[label_[f]] / size;
    }
    // dA/dx_i = n x e_i / 2, e_i opposite: e_b = -ac, e_c = ab.
    const Vec3 at_b = ac.cross(n);
    const Vec3 at_c = n.cross(ab);
    sum[t[1]] += at_b;
    sum[t[2]] += at_c;
    sum[t[0]] -= at_b + at_c;
  }
  for (const auto& term : terms_) {
    if (term->functional() != -1) {
      continue;
    }
    for (const FilmTerm::Element& e : term->elements()) {
      const Triangle& t = facets_[e.facet];
      const FacetJet jet =
          term->jet(e, corners_of(points, t), JetOrder::Gradient);
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] += jet.gradient.segment<3>(3 * k);
      }
    }
  }
  return sum;
}

Points FilmEnergy::functional_gradient(const Points& points,
                                       int functional) const {
  Points sum(points.size(), Vec3::Zero());
  const Vec3 origin = cone_origin(points);
  if (functional < body_count_ && cone_[functional] != 0) {
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const int sign = side_[label_[f]][functional];
      if (sign == 0) {
        continue;
      }
      const Triangle& t = facets_[f];
      const Vec3 a = points[t[0]] - origin;
      const Vec3 b = points[t[1]] - origin;
      const Vec3 c = points[t[2]] - origin;
      const double w = sign / 6.0;
      sum[t[0]] += w * b.cross(c);
      sum[t[1]] += w * c.cross(a);
      sum[t[2]] += w * a.cross(b);
    }
  }
  for (const auto& term : terms_) {
    if (term->functional() != functional) {
      continue;
    }
    for (const FilmTerm::Element& e : term->elements()) {
      const Triangle& t = facets_[e.facet];
      const FacetJet jet =
          term->jet(e, corners_of(points, t), JetOrder::Gradient);
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] += jet.gradient.segment<3>(3 * k);
      }
    }
  }
  return sum;
}

void FilmEnergy::elements(const Points& points, const Points& directions,
                          const FilmTargets& targets, const VectorX& pressure,
                          const Points& gradient,
                          std::vector<double>& out) const {
  out.assign(element_start_.back(), 0.0);
  const Vec3 origin = cone_origin(points);
  std::vector<double> p_of(side_.size(), 0.0);  // per surface
  for (std::size_t s = 0; s < side_.size(); ++s) {
    for (int b = 0; b < body_count_; ++b) {
      p_of[s] += cone_[b] != 0 ? side_[s][b] * pressure[b] : 0.0;
    }
  }
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const double t = plain_[label_[f]] != 0 ? targets.tension[label_[f]] : 0.0;
    const double p = p_of[label_[f]];
    if (t == 0.0 && p == 0.0) {
      continue;
    }
    const FacetFrame frame = frame_of(points, facets_[f], origin);
    const double area_factor = frame.area2 > 0.0 ? 0.5 * t / frame.area2 : 0.0;
    int slot = element_start_[f];
    std::array<Vec3, 9> u;  // e_i x v, without its part along the normal
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      const int a = corners_[i].corner;
      const Vec3& v = directions[corners_[i].unknown];
      Vec3& u_i = u[i - corner_start_[f]];
      u_i = frame.opposite[a].cross(v);
      u_i -= frame.normal.dot(u_i) * frame.normal;
      for (int j = corner_start_[f]; j <= i; ++j) {
        const int b = corners_[j].corner;
        const Vec3& w = directions[corners_[j].unknown];
        double sum = area_factor * u_i.dot(u[j - corner_start_[f]]);
        if (a != b) {
          const Vec3 twist = w.cross(v);
          const double sign = b == (a + 2) % 3 ? 1.0 : -1.0;
          sum += sign * (0.5 * t * frame.normal.dot(twist) -
                         p / 6.0 * frame.corner[3 - a - b].dot(twist));
        }
        out[slot++] = sum;
      }
    }
  }
  add_terms(points, pressure, directions, out);
  if (space_.has_walls()) {
    add_wall_curvature(points, directions, gradient, out);
  }
}

void FilmEnergy::add_block(int facet, int corner_a, int corner_b,
                           const Eigen::Matrix3d& block,
                           const Points& directions,
                           std::vector<double>& out) const {
  int slot = element_start_[facet];
  for (int i = corner_start_[facet]; i < corner_start_[facet + 1]; ++i) {
    for (int j = corner_start_[facet]; j <= i; ++j, ++slot) {
      if (corners_[i].corner == corner_a && corners_[j].corner == corner_b) {
        out[slot] += directions[corners_[i].unknown].dot(
            block * directions[corners_[j].unknown]);
      }
    }
  }
}

void FilmEnergy::add_terms(const Points& points, const VectorX& pressure,
                           const Points& directions,
                           std::vector<double>& out) const {
  for (const auto& term : terms_) {
    const int functional = term->functional();
    const double factor = functional == -1  ? 1.0
                          : functional >= 0 ? -pressure[functional]
                                            : 0.0;
    if (factor == 0.0) {
      continue;
    }
    for (const FilmTerm::Element& e : term->elements()) {
      const FacetJet jet =
          term->jet(e, corners_of(points, facets_[e.facet]), JetOrder::Hessian);
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b <= a; ++b) {
          add_block(e.facet, a, b,
                    factor * jet.hessian.block<3, 3>(3 * a, 3 * b), directions,
                    out);
        }
      }
    }
  }
}

void FilmEnergy::add_wall_curvature(const Points& points,
                                    const Points& directions,
                                    const Points& gradient,
                                    std::vector<double>& out) const {
  std::vector<int> wall(points.size(), -1);
  for (std::size_t k = 0; k < space_.walled().size(); ++k) {
    wall[space_.walled()[k]] = static_cast<int>(k);
  }
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for (int a = 0; a < 3; ++a) {
      const int v = facets_[f][a];
      if (wall[v] >= 0) {
        add_block(static_cast<int>(f), a, a,
                  space_.wall_curvature(wall[v], points[v], gradient[v]),
                  directions, out);
        wall[v] = -1;  // once
      }
    }
  }
}

void FilmEnergy::assemble(const std::vector<double>& elements,
                          SparseMatrix& out) const {
  double* values = out.valuePtr();
  std::fill(values, values + out.nonZeros(), 0.0);
  for (std::size_t e = 0; e < slots_.size(); ++e) {
    values[slots_[e]] += elements[e];
  }
}

void FilmEnergy::hessian(const Points& points, const Points& directions,
                         const FilmTargets& targets, const VectorX& pressure,
                         SparseMatrix& out) const {
  Points slope;
  if (space_.has_walls()) {
    slope = gradient(points, targets);
    for (int b = 0; b < functional_count_; ++b) {
      const Points more = functional_gradient(points, b);
      for (std::size_t v = 0; v < slope.size(); ++v) {
        slope[v] -= pressure[b] * more[v];
      }
    }
  }
  std::vector<double> entries;
  elements(points, directions, targets, pressure, slope, entries);
  assemble(entries, out);
}

VectorX FilmEnergy::lumped_area(const Points& points) const {
  std::vector<double> at(points.size(), 0.0);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3& a = points[t[0]];
    const double area2 = (points[t[1]] - a).cross(points[t[2]] - a).norm();
    for (const int v : t) {
      at[v] += area2 / 6.0;
    }
  }
  VectorX sum(unknowns());
  for (int i = 0; i < unknowns(); ++i) {
    sum[i] = at[vertices()[i]];
  }
  return sum;
}

double FilmEnergy::smallest_cosine(const Points& points, const Points& base,
                                   int* facet) const {
  double least = 1.0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] == 0 || corner_start_[f] == corner_start_[f + 1]) {
      continue;
    }
    const Triangle& t = facets_[f];
    const auto normal2 = [&t](const Points& x) -> Vec3 {
      return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    };
    const Vec3 now = normal2(points);
    const Vec3 was = normal2(base);
    const double size = std::sqrt(now.squaredNorm() * was.squaredNorm());
    const double cosine = size > 0.0 ? now.dot(was) / size : -1.0;
    if (!(cosine >= least)) {  // not finite counts as folded
      least = std::isfinite(cosine) ? cosine : -1.0;
      if (facet != nullptr) {
        *facet = static_cast<int>(f);
      }
    }
  }
  return least;
}

double FilmEnergy::mean_edge(const Points& points) const {
  double sum = 0.0;
  long count = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] != 0) {
      for (int k = 0; k < 3; ++k) {
        sum += (points[facets_[f][(k + 1) % 3]] - points[facets_[f][k]]).norm();
      }
      count += 3;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

Eigen::MatrixXd FilmEnergy::rigid_motions(const Points& points,
                                          const Points& directions,
                                          const VectorX& metric) const {
  constexpr double kFree = 1e-9;     // of a wall's resistance
  constexpr double kVisible = 1e-2;  // of a motion that moves the film
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const int n = unknowns();
  std::vector<VectorX> columns;
  for (int part = 0; part < floating_count_; ++part) {
    Vec3 center = Vec3::Zero();
    double weight = 0.0;
    for (int i = 0; i < n; ++i) {
      if (floating_[i] == part) {
        center += metric[i] * points[vertices()[i]];
        weight += metric[i];
      }
    }
    center /= std::max(weight, 1e-300);
    double size2 = 0.0;
    for (int i = 0; i < n; ++i) {
      if (floating_[i] == part) {
        size2 += metric[i] * (points[vertices()[i]] - center).squaredNorm();
      }
    }
    const double size = std::sqrt(size2 / std::max(weight, 1e-300));
    // What resists: walls that the part slides on, and gravity.
    Eigen::Matrix<double, 6, 6> resists = Eigen::Matrix<double, 6, 6>::Zero();
    const auto add = [&](const Vec3& at, const Vec3& normal) {
      Vector6 row;
      row << normal, (at - center).cross(normal) / size;
      resists += row * row.transpose();
    };
    for (std::size_t k = 0; k < space_.walled().size(); ++k) {
      const int v = space_.walled()[k];
      if (space_.rank(v) > 0 && floating_[space_.first(v)] == part) {
        const Eigen::MatrixX3d rows =
            space_.wall_normals(static_cast<int>(k), points[v]);
        for (Eigen::Index r = 0; r < rows.rows(); ++r) {
          add(points[v], rows.row(r).normalized());
        }
      }
    }
    if (!gravity_.isZero(0.0)) {
      const Vec3 g = gravity_.normalized();
      const Eigen::Matrix3d across =
          Eigen::Matrix3d::Identity() - g * g.transpose();
      resists.topLeftCorner<3, 3>() += g * g.transpose();
      resists.bottomRightCorner<3, 3>() += across;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(
        resists);
    const double most = std::max(1.0, eigen.eigenvalues()[5]);
    Eigen::MatrixXd found(n, 0);
    for (int m = 0; m < 6; ++m) {
      if (eigen.eigenvalues()[m] > kFree * most) {
        break;
      }
      const Vector6 motion = eigen.eigenvectors().col(m);
      VectorX column = VectorX::Zero(n);
      for (int i = 0; i < n; ++i) {
        if (floating_[i] == part) {
          const Vec3 arm = points[vertices()[i]] - center;
          const Vec3 move =
              motion.head<3>() + Vec3(motion.tail<3>()).cross(arm) / size;
          column[i] = move.dot(directions[i]);
        }
      }
      found.conservativeResize(n, found.cols() + 1);
      found.rightCols<1>() = column;
    }
    if (found.cols() == 0) {
      continue;
    }
    // Motions that leave the film where it is (a sphere's rotations) are out.
    const Eigen::MatrixXd gram =
        found.transpose() * metric.asDiagonal() * found / weight;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> seen(gram);
    for (Eigen::Index m = 0; m < gram.cols(); ++m) {
      if (seen.eigenvalues()[m] > kVisible) {
        columns.push_back(
            metric.cwiseProduct(found * seen.eigenvectors().col(m)));
      }
    }
  }
  Eigen::MatrixXd result(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    result.col(static_cast<Eigen::Index>(c)) = columns[c];
  }
  return result;
}

}  // namespace meniscus
