#include "evolve/films/shared_sides.h"

#include <algorithm>

#include "core/geometry/edge_key.h"

namespace meniscus::films {

namespace {

constexpr double kSame = 1e-9;  // x the size of all polygons

const Points& corners_of(const curves::Curve& curve) {
  static const Points none;
  const auto* polygon = std::get_if<curves::Polygon>(&curve.shape);
  return polygon != nullptr ? polygon->points : none;
}

double reach_of(const std::vector<curves::Curve>& curves) {
  Points all;
  for (const curves::Curve& curve : curves) {
    const Points& corners = corners_of(curve);
    all.insert(all.end(), corners.begin(), corners.end());
  }
  return all.empty() ? 0.0 : kSame * bounding_diagonal(all);
}

}  // namespace

std::vector<SharedSide> shared_sides(const std::vector<curves::Curve>& curves) {
  const double reach = reach_of(curves);
  struct Side {
    int curve;
    int number;
    const Vec3* from;
    const Vec3* to;
  };
  std::vector<Side> sides;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Points& corners = corners_of(curves[c]);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      sides.push_back({static_cast<int>(c), static_cast<int>(k), &corners[k],
                       &corners[(k + 1) % corners.size()]});
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
      if (a.curve == b.curve) {
        continue;
      }
      const bool along = same(*a.from, *b.from) && same(*a.to, *b.to);
      if (along || (same(*a.from, *b.to) && same(*a.to, *b.from))) {
        result.push_back({a.curve, a.number, b.curve, b.number, !along});
      }
    }
  }
  return result;
}

SharedRims::SharedRims(const std::vector<curves::Curve>& curves)
    : shares_(curves.size(), 0), reach_(reach_of(curves)) {
  for (const SharedSide& side : shared_sides(curves)) {
    shares_[static_cast<std::size_t>(side.first_curve)] = 1;
    shares_[static_cast<std::size_t>(side.second_curve)] = 1;
  }
}

int SharedRims::corner(int curve, int k, FilmComplex& complex) {
  const Points& corners = corners_of(complex.curves[curve]);
  const Vec3& place = corners[k];
  for (const int known : corners_) {
    if ((complex.mesh.points[known] - place).norm() <= reach_) {
      return known;
    }
  }
  corners_.push_back(static_cast<int>(complex.mesh.points.size()));
  complex.mesh.points.push_back(place);
  complex.vertices.push_back(
      {VertexKind::OnCurve, curve,
       static_cast<double>(k) / static_cast<double>(corners.size())});
  return corners_.back();
}

std::vector<int> SharedRims::rim(int curve, const std::vector<double>& t,
                                 FilmComplex& complex) {
  const curves::CurveShape shape = complex.curves[curve].shape;
  const auto n = static_cast<int>(corners_of(complex.curves[curve]).size());
  std::vector<int> corners;
  corners.reserve(n);
  for (int k = 0; k < n; ++k) {
    corners.push_back(corner(curve, k, complex));
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
    const auto [known, first] = sides_.try_emplace(edge_key(a, b));
    Chain& chain = known->second;
    if (first) {
      chain.curve = curve;
      chain.from = {a};
      for (const double at : inner) {
        chain.from.push_back(static_cast<int>(complex.mesh.points.size()));
        complex.mesh.points.push_back(curves::point_at(shape, at));
        complex.vertices.push_back({VertexKind::OnCurve, curve, at});
      }
      chain.from.push_back(b);
      if (a > b) {
        std::reverse(chain.from.begin(), chain.from.end());
      }
    }
    std::vector<int> way = chain.from;
    if (a > b) {
      std::reverse(way.begin(), way.end());
    }
    around.insert(around.end(), way.begin(), way.end() - 1);
  }
  return around;
}

void SharedRims::mark_edges(FilmComplex& complex) const {
  for (const auto& [ends, chain] : sides_) {
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

}  // namespace meniscus::films
