#include "evolve/films/shared_sides.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/edge_key.h"

namespace meniscus::films {

namespace {

constexpr double kSame = 1e-9;  // x the size of all polygons

double reach_of(const std::vector<curves::Curve>& curves) {
  Points all;
  for (const curves::Curve& curve : curves) {
    for (const CurveSide& side : sides_of(curve.shape)) {
      all.push_back(side.from);
    }
  }
  return all.empty() ? 0.0 : kSame * bounding_diagonal(all);
}

}  // namespace

std::vector<CurveSide> sides_of(const curves::CurveShape& shape) {
  std::vector<CurveSide> sides;
  if (const auto* polygon = std::get_if<curves::Polygon>(&shape)) {
    const Points& corners = polygon->points;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3& next = corners[(k + 1) % corners.size()];
      sides.push_back({corners[k], next, 0.5 * (corners[k] + next)});
    }
  } else if (const auto* line = std::get_if<curves::Polyline>(&shape)) {
    const std::size_t count = line->corners.size();
    for (std::size_t k = 0; k < count; ++k) {
      sides.push_back(
          {line->corners[k], line->corners[(k + 1) % count],
           curves::point_at(shape, (static_cast<double>(k) + 0.5) /
                                       static_cast<double>(count))});
    }
  }
  return sides;
}

std::vector<SharedSide> shared_sides(const std::vector<curves::Curve>& curves) {
  const double reach = reach_of(curves);
  struct Side : CurveSide {
    int curve;
    int number;
  };
  std::vector<Side> sides;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    int number = 0;
    for (const CurveSide& side : sides_of(curves[c].shape)) {
      sides.push_back({side, static_cast<int>(c), number++});
    }
  }
  const auto same = [reach](const Vec3& a, const Vec3& b) {
    return (a - b).norm() <= reach;
  };
  std::vector<SharedSide> result;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      const Side& a = sides[i];
      const Side& b = sides[j];
      if (a.curve == b.curve || !same(a.middle, b.middle)) {
        continue;
      }
      const bool along = same(a.from, b.from) && same(a.to, b.to);
      if (along || (same(a.from, b.to) && same(a.to, b.from))) {
        result.push_back({a.curve, a.number, b.curve, b.number, !along});
      }
    }
  }
  return result;
}

FreePlaces::FreePlaces(const std::vector<curves::Curve>& curves,
                       const std::vector<char>& used) {
  for (const curves::Curve& curve : curves) {
    const std::size_t sides = sides_of(curve.shape).size();
    whole_.push_back(curve.free ? 1 : 0);
    sides_.emplace_back(sides, curve.free ? 1 : 0);
    for (const int side : curve.free_sides) {
      sides_.back()[static_cast<std::size_t>(side)] = 1;
    }
    corners_.emplace_back(sides, 0);
    any_ = any_ || curve.free || !curve.free_sides.empty();
  }
  if (!any_) {
    return;
  }
  for (const SharedSide& side : shared_sides(curves)) {
    if (used[side.first_curve] == 0 || used[side.second_curve] == 0) {
      continue;
    }
    char& first = sides_[side.first_curve][side.first_side];
    char& second = sides_[side.second_curve][side.second_side];
    first = second = first != 0 && second != 0 ? 1 : 0;
  }
  Points held;  // corners of sides that are not free
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const std::vector<CurveSide> sides = sides_of(curves[c].shape);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (used[c] != 0 && sides_[c][k] == 0) {
        held.insert(held.end(), {sides[k].from, sides[k].to});
      }
    }
  }
  const double reach = reach_of(curves);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const std::vector<CurveSide> sides = sides_of(curves[c].shape);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const bool is_held = std::any_of(
          held.begin(), held.end(),
          [&](const Vec3& p) { return (p - sides[k].from).norm() <= reach; });
      corners_[c][k] = is_held ? 0 : 1;
    }
  }
}

bool FreePlaces::is_free(int curve, double t) const {
  constexpr double kAtCorner = 1e-9;  // of a side
  const auto c = static_cast<std::size_t>(curve);
  const std::size_t sides = sides_[c].size();
  if (sides == 0 || !any_) {
    return whole_[c] != 0;
  }
  const double at = t * static_cast<double>(sides);
  const double corner = std::round(at);
  if (std::abs(at - corner) < kAtCorner) {
    return corners_[c][static_cast<std::size_t>(corner) % sides] != 0;
  }
  return sides_[c][static_cast<std::size_t>(at) % sides] != 0;
}

SharedRims::SharedRims(const std::vector<curves::Curve>& curves)
    : shares_(curves.size(), 0), reach_(reach_of(curves)) {
  for (const SharedSide& side : shared_sides(curves)) {
    shares_[static_cast<std::size_t>(side.first_curve)] = 1;
    shares_[static_cast<std::size_t>(side.second_curve)] = 1;
  }
}

int SharedRims::corner(int curve, int k, const CurveSide& side, int sides,
                       FilmComplex& complex) {
  for (const int known : corners_) {
    if ((complex.mesh.points[known] - side.from).norm() <= reach_) {
      return known;
    }
  }
  corners_.push_back(static_cast<int>(complex.mesh.points.size()));
  complex.mesh.points.push_back(side.from);
  complex.vertices.push_back(
      {VertexKind::OnCurve, curve,
       static_cast<double>(k) / static_cast<double>(sides)});
  return corners_.back();
}

/// The side's vertices, made where it is new; `inner`: parameters between its
/// ends.
const SharedRims::Chain& SharedRims::chain(int curve, int number,
                                           const CurveSide& side,
                                           const Edge& ends,
                                           const std::vector<double>& inner,
                                           FilmComplex& complex) {
  std::vector<Chain>& between = sides_[edge_key(ends[0], ends[1])];
  for (const Chain& known : between) {
    if ((known.middle - side.middle).norm() <= reach_) {
      return known;
    }
  }
  Chain& chain = between.emplace_back();
  chain.curve = curve;
  chain.side = number;
  chain.middle = side.middle;
  chain.from = {ends[0]};
  const curves::CurveShape& shape = complex.curves[curve].shape;
  for (const double at : inner) {
    chain.from.push_back(static_cast<int>(complex.mesh.points.size()));
    complex.mesh.points.push_back(curves::point_at(shape, at));
    complex.vertices.push_back({VertexKind::OnCurve, curve, at});
  }
  chain.from.push_back(ends[1]);
  if (ends[0] > ends[1]) {
    std::reverse(chain.from.begin(), chain.from.end());
  }
  return chain;
}

std::vector<int> SharedRims::rim(int curve, const std::vector<double>& t,
                                 FilmComplex& complex) {
  const std::vector<CurveSide> sides = sides_of(complex.curves[curve].shape);
  const auto n = static_cast<int>(sides.size());
  std::vector<int> corners;
  corners.reserve(n);
  for (int k = 0; k < n; ++k) {
    corners.push_back(corner(curve, k, sides[k], n, complex));
  }
  std::vector<int> around;
  std::size_t next = 0;  // of t
  for (int k = 0; k < n; ++k) {
    std::vector<double> inner;  // of this side, ends left out
    for (; next < t.size() && t[next] < (k + 1.0) / n; ++next) {
      inner.push_back(t[next]);
    }
    inner.erase(inner.begin());
    const int a = corners[k];
    const int b = corners[(k + 1) % n];
    std::vector<int> way =
        chain(curve, k, sides[k], {a, b}, inner, complex).from;
    if (a > b) {
      std::reverse(way.begin(), way.end());
    }
    around.insert(around.end(), way.begin(), way.end() - 1);
  }
  return around;
}

void SharedRims::mark_edges(const FreePlaces& free,
                            FilmComplex& complex) const {
  for (const auto& [ends, chains] : sides_) {
    for (const Chain& chain : chains) {
      if (free.is_side_free(chain.curve, chain.side)) {
        continue;
      }
      for (std::size_t k = 0; k + 1 < chain.from.size(); ++k) {
        ComplexEdge mark;
        mark.a = chain.from[k];
        mark.b = chain.from[k + 1];
        mark.kind = VertexKind::OnCurve;
        mark.curve = chain.curve;
        complex.edges.push_back(mark);
      }
    }
  }
}

}  // namespace meniscus::films
