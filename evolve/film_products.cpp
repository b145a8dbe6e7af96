#include "evolve/film_products.h"

#include "evolve/facet_terms.h"

namespace meniscus {

namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(const Points& points, const Triangle& t) {
  return {points[t[0]], points[t[1]], points[t[2]]};
}

/// What a motion of its corners does to a facet.
struct FacetMotion {
  std::array<Vec3, 3> opposite;  // of e_i
  Vec3 normal2 = Vec3::Zero();   // of N
  Vec3 normal = Vec3::Zero();    // of n; zero for a facet without area

  FacetMotion(const FacetFrame& frame, const Corners& d)
      : opposite{d[2] - d[1], d[0] - d[2], d[1] - d[0]} {
    for (int i = 0; i < 3; ++i) {
      normal2 += frame.opposite[i].cross(d[i]);
    }
    if (frame.area2 > 0.0) {
      normal =
          (normal2 - frame.normal.dot(normal2) * frame.normal) / frame.area2;
    }
  }
};

}  // namespace

FilmProducts::FilmProducts(const FilmEnergy& energy, const FilmTargets& targets,
                           const VectorX& pressure)
    : energy_(energy), targets_(targets), pressure_(pressure) {}

VectorX FilmProducts::area_rates(const Points& points,
                                 const Points& motion) const {
  const FilmEnergy& e = energy_;
  VectorX sum = VectorX::Zero(static_cast<Eigen::Index>(e.liquid_.size()));
  for (std::size_t f = 0; f < e.facets_.size(); ++f) {
    if (e.liquid_[e.label_[f]] != 0) {
      const Corners c = corners_of(points, e.facets_[f]);
      const Corners d = corners_of(motion, e.facets_[f]);
      const FacetFrame frame(c[0], c[1], c[2]);
      sum[e.label_[f]] += 0.5 * frame.normal.dot(FacetMotion(frame, d).normal2);
    }
  }
  return sum;
}

void FilmProducts::add_facets(const Points& points, const Points& motion,
                              Points& sum) const {
  const FilmEnergy& e = energy_;
  const Vec3 origin = e.cone_origin(points);
  const std::vector<double> jump = e.pressure_jumps(pressure_);
  for (std::size_t f = 0; f < e.facets_.size(); ++f) {
    const Triangle& at = e.facets_[f];
    const int label = e.label_[f];
    const double t = e.plain_[label] != 0 ? targets_.tension[label] : 0.0;
    const double p = jump[label];
    if (t == 0.0 && p == 0.0) {
      continue;
    }
    const Corners d = corners_of(motion, at);
    const FacetFrame frame(points[at[0]] - origin, points[at[1]] - origin,
                           points[at[2]] - origin);
    const FacetMotion moved(frame, d);
    const double half = frame.area2 > 0.0 ? 0.5 * t : 0.0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      // d (n x e_i) / 2 of the area, d (x_j x x_k) / 6 of the cone.
      const Vec3 of_area = moved.normal.cross(frame.opposite[i]) +
                           frame.normal.cross(moved.opposite[i]);
      const Vec3 of_cone =
          d[j].cross(frame.corner[k]) + frame.corner[j].cross(d[k]);
      sum[at[i]] += half * of_area - p / 6.0 * of_cone;
    }
  }
}

void FilmProducts::add_terms(const Points& points, const Points& motion,
                             Points& sum) const {
  for (const auto& term : energy_.terms_) {
    const int functional = term->functional();
    const double factor = functional == -1  ? 1.0
                          : functional >= 0 ? -pressure_[functional]
                                            : 0.0;
    if (factor == 0.0) {
      continue;
    }
    for (const FilmTerm::Element& e : term->elements()) {
      const Triangle& at = energy_.facets_[e.facet];
      Eigen::Matrix<double, 9, 1> d;
      d << motion[at[0]], motion[at[1]], motion[at[2]];
      if (d.isZero(0.0)) {
        continue;
      }
      const FacetJet jet =
          term->jet(e, corners_of(points, at), JetOrder::Hessian);
      const Eigen::Matrix<double, 9, 1> product = factor * (jet.hessian * d);
      for (int i = 0; i < 3; ++i) {
        sum[at[i]] += product.segment<3>(3 * i);
      }
    }
  }
}

Points FilmProducts::hessian_times(const Points& points,
                                   const Points& motion) const {
  Points sum(points.size(), Vec3::Zero());
  add_facets(points, motion, sum);
  add_terms(points, motion, sum);
  return sum;
}

}  // namespace meniscus
