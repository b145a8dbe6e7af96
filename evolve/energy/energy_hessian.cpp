// The Hessian of FilmEnergy: pattern, elements, assembly.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/operation_count.h"
#include "evolve/energy/energy.h"
#include "evolve/energy/facet_terms.h"
#include "evolve/energy/over_term.h"

namespace meniscus::energy {

namespace {

FacetFrame frame_of(const Points& points, const Triangle& t, const Vec3& origin,
                    const Vec3* flat) {
  return {points[t[0]] - origin, points[t[1]] - origin, points[t[2]] - origin,
          flat};
}

/// Of all facets' elements without fields: the frame, a corner's vector, a pair
/// of corners and what two different ones add.
double hessian_work(const std::vector<int>& corner_start) {
  constexpr double kFrame = 38.0;
  constexpr double kCorner = 20.0;
  constexpr double kPair = 6.0;
  constexpr double kTwist = 26.0;
  double work = 0.0;
  for (std::size_t f = 0; f + 1 < corner_start.size(); ++f) {
    const double c = corner_start[f + 1] - corner_start[f];
    const double twists = 0.5 * c * (c - 1.0);
    work += kFrame + kCorner * c + kPair * (twists + c) + kTwist * twists;
  }
  return work;
}

}  // namespace

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
  // The first pass counts entries per column and where the element matrix of
  // each facet, a packed lower triangle, starts.
  element_start_.reserve(facets_.size() + 1);
  element_start_.push_back(0);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for_pairs(f, [&](int /*a*/, int b) { ++count[b + 1]; });
    const int c = corner_start_[f + 1] - corner_start_[f];
    element_start_.push_back(element_start_.back() + c * (c + 1) / 2);
  }
  std::partial_sum(count.begin(), count.end(), count.begin());
  // The second pass puts the rows in their columns: a counting sort.
  std::vector<int> rows(count.back());
  {
    std::vector<int> at(count.begin(), count.end() - 1);
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      for_pairs(f, [&](int a, int b) { rows[at[b]++] = a; });
    }
  }
  // Pairs that several facets share become one entry of the lower triangle in
  // compressed columns.
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
  // Where every element entry goes, so that assembly is a plain sum.
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

std::vector<int> FilmEnergy::vertex_order() const {
  std::unordered_set<int> listed;
  std::vector<int> result;
  for (const int unknown : order()) {
    const int v = vertices()[unknown];
    if (listed.insert(v).second) {
      result.push_back(v);
    }
  }
  return result;
}

/// Per surface the pressure behind its facets less that in front of them.
std::vector<double> FilmEnergy::pressure_jumps(const VectorX& pressure) const {
  std::vector<double> jump(side_.size(), 0.0);
  for (std::size_t s = 0; s < side_.size(); ++s) {
    for (int b = 0; b < body_count_; ++b) {
      jump[s] += cone_[b] != 0 ? side_[s][b] * pressure[b] : 0.0;
    }
  }
  return jump;
}

void FilmEnergy::elements(const Points& points, const Points& directions,
                          const films::FilmTargets& targets,
                          const VectorX& pressure, const WallBends& bends,
                          std::vector<double>& out) const {
  out.assign(element_start_.back(), 0.0);
  count_operations(hessian_work(corner_start_));
  const Vec3 origin = cone_origin(points);
  const std::vector<double> p_of = pressure_jumps(pressure);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const double t = plain_[label_[f]] != 0 ? targets.tension[label_[f]] : 0.0;
    const double p = p_of[label_[f]];
    if (t == 0.0 && p == 0.0) {
      continue;
    }
    // Second derivatives along the corners' directions of T A - p V, with the
    // facet's area A and the volume V of its cone to the origin.
    const FacetFrame frame =
        frame_of(points, facets_[f], origin, flat(static_cast<int>(f)));
    const double area_factor = frame.turns ? 0.5 * t / frame.area2 : 0.0;
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
        // The turn of the normal costs u_i . u_j / 4A times T; N itself is
        // bilinear in two different corners, and so is the cone's volume.
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
  // Fields bring their own second derivatives; walls bring the curvature of the
  // surface that vertices slide on, (grad L . n) II.
  add_terms(points, targets.numbers, pressure, directions, out);
  for (const BentArea& area : bent_) {
    for (const FilmTerm::Element& e : area.elements) {
      add_jet(e.facet, targets.tension[area.surface],
              jet_of(area, e, points, JetOrder::Hessian), directions, out);
    }
  }
  if (bends.second != nullptr) {
    add_bends(bends, out);
  } else if (space_.has_walls()) {
    add_wall_curvature(points, directions, bends.gradient, out);
  }
}

void FilmEnergy::add_jet(int facet, double factor, const FacetJet& jet,
                         const Points& directions,
                         std::vector<double>& out) const {
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b <= a; ++b) {
      add_block(facet, a, b, factor * jet.hessian.block<3, 3>(3 * a, 3 * b),
                directions, out);
    }
  }
}

/// Each unknown's once: at the first of its vertex's facets.
void FilmEnergy::add_bends(const WallBends& bends,
                           std::vector<double>& out) const {
  std::vector<char> done(unknowns(), 0);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    int slot = element_start_[f];
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      slot += i - corner_start_[f];  // to the diagonal
      const int unknown = corners_[i].unknown;
      if (done[unknown] == 0) {
        done[unknown] = 1;
        out[slot] +=
            bends.gradient[vertices()[unknown]].dot((*bends.second)[unknown]);
      }
      ++slot;
    }
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

void FilmEnergy::add_terms(const Points& points,
                           const std::vector<VectorX>& numbers,
                           const VectorX& pressure, const Points& directions,
                           std::vector<double>& out) const {
  for (const auto& term : terms_) {
    const int functional = term->functional();
    const double factor = functional == -1  ? 1.0
                          : functional >= 0 ? -pressure[functional]
                                            : 0.0;
    if (factor == 0.0) {
      continue;
    }
    over_term(*term, points, JetOrder::Hessian, numbers_of(*term, numbers),
              [&](const FilmTerm::Element& e, const FacetJet& jet) {
                add_jet(e.facet, factor, jet, directions, out);
              });
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
                         const films::FilmTargets& targets,
                         const VectorX& pressure, SparseMatrix& out,
                         const Points* bends) const {
  WallBends walls{.second = bends};
  if (space_.has_walls()) {
    walls.gradient = gradient(points, targets);
    for (int b = 0; b < functional_count_; ++b) {
      const Points more = functional_gradient(points, b);
      for (std::size_t v = 0; v < more.size(); ++v) {
        walls.gradient[v] -= pressure[b] * more[v];
      }
    }
  }
  std::vector<double> entries;
  elements(points, directions, targets, pressure, walls, entries);
  assemble(entries, out);
}

}  // namespace meniscus::energy
