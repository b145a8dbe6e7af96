#include "cad/solid/solid_rims.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <Eigen/Geometry>

namespace meniscus::solid {

namespace {

// Of the part's size; a case lets corners be a tenth of that apart.
constexpr double kSameCorner = 1e-8;

}  // namespace

SolidRims::SolidRims(const SurfaceMesh& mesh, const std::vector<NamedRim>& rims)
    : mesh_(mesh), same_(kSameCorner * bounding_diagonal(mesh.points)) {
  std::set<int> on_rims;
  for (std::size_t r = 0; r < rims.size(); ++r) {
    curves_.push_back(rims[r].curve);
    members_.emplace_back(rims[r].vertices.begin(), rims[r].vertices.end());
    on_rims.insert(rims[r].vertices.begin(), rims[r].vertices.end());
    const std::vector<Side> own = sides_of(static_cast<int>(r));
    sides_.insert(sides_.end(), own.begin(), own.end());
  }
  for (const Side& side : sides_) {
    if (std::any_of(sides_.begin(), sides_.end(), [&](const Side& other) {
          return other.rim != side.rim && alike(side, other);
        })) {
      shared_.push_back(side);
    }
  }
  // A vertex of several rims is told with one of them, and is on all.
  for (const Side& side : shared_) {
    for (const int v : on_rims) {
      if (lies_on(side, mesh_.points[v])) {
        members_[side.rim].insert(v);
      }
    }
  }
}

std::vector<SolidRims::Side> SolidRims::sides_of(int rim) const {
  std::vector<Side> sides;
  for (int k = 0; k < curves_[rim].piece_count(); ++k) {
    const RimPiece& piece = curves_[rim].piece(k);
    const bool whole = curves_[rim].piece_count() == 1;
    if (!whole && !std::holds_alternative<SplineCurve>(piece.curve)) {
      sides.push_back({piece, point_of(piece.curve, piece.first),
                       point_of(piece.curve, piece.last), rim, k});
    }
  }
  return sides;
}

bool SolidRims::alike(const Side& a, const Side& b) const {
  const auto same = [this](const Vec3& p, const Vec3& q) {
    return (p - q).norm() <= same_;
  };
  const auto middle = [](const Side& side) {
    const RimPiece& piece = side.shape;
    return point_of(piece.curve, 0.5 * (piece.first + piece.last));
  };
  return ((same(a.from, b.from) && same(a.to, b.to)) ||
          (same(a.from, b.to) && same(a.to, b.from))) &&
         same(middle(a), middle(b));
}

bool SolidRims::lies_on(const Side& side, const Vec3& p) const {
  if (const auto* arc = std::get_if<EllipseCurve>(&side.shape.curve)) {
    const Vec3 d = p - arc->center;
    const double angle = std::atan2(d.dot(arc->v) / arc->v.squaredNorm(),
                                    d.dot(arc->u) / arc->u.squaredNorm());
    // The turn within which the piece begins.
    const double turn = 2.0 * std::numbers::pi;
    const double t =
        angle + turn * std::ceil((side.shape.first - angle) / turn);
    const bool at_end =
        (p - side.from).norm() <= same_ || (p - side.to).norm() <= same_;
    return at_end ||
           (t <= side.shape.last && (point_of(*arc, t) - p).norm() <= same_);
  }
  const Vec3 way = side.to - side.from;
  const double share =
      std::clamp(way.dot(p - side.from) / way.squaredNorm(), 0.0, 1.0);
  return (side.from + share * way - p).norm() <= same_;
}

int SolidRims::rim_of(const std::vector<int>& loop) {
  for (std::size_t r = 0; r < members_.size(); ++r) {
    if (std::all_of(loop.begin(), loop.end(),
                    [&](int v) { return members_[r].count(v) > 0; })) {
      return static_cast<int>(r);
    }
  }
  Points points;
  points.reserve(loop.size());
  for (const int v : loop) {
    points.push_back(mesh_.points[v]);
  }
  curves_.push_back(ends_at_creases(loop) ? polygon_around(points)
                                          : rim_through(points));
  members_.emplace_back(loop.begin(), loop.end());
  return static_cast<int>(members_.size()) - 1;
}

bool SolidRims::ends_at_creases(const std::vector<int>& loop) const {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (creases_.count(edge_key(loop[i], loop[(i + 1) % loop.size()])) > 0) {
      return true;
    }
  }
  return false;
}

/// With a corner wherever a rim has one too, on straight sides as well.
RimCurve SolidRims::polygon_around(const Points& points) const {
  const std::size_t n = points.size();
  Points corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = points[i];
    const Vec3& before = points[(i + n - 1) % n];
    const Vec3& after = points[(i + 1) % n];
    const Side across{{StraightLine{}}, before, after};
    if (!lies_on(across, p) ||
        std::any_of(sides_.begin(), sides_.end(), [&](const Side& side) {
          return (side.from - p).norm() <= same_;
        })) {
      corners.push_back(p);
    }
  }
  std::vector<RimPiece> pieces;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 way = corners[(k + 1) % corners.size()] - corners[k];
    pieces.push_back(
        {StraightLine{corners[k], way.normalized()}, 0.0, way.norm()});
  }
  return RimCurve(std::move(pieces));
}

bool SolidRims::on_shared_side(const Edge& edge) const {
  return std::any_of(shared_.begin(), shared_.end(), [&](const Side& side) {
    return lies_on(side, mesh_.points[edge[0]]) &&
           lies_on(side, mesh_.points[edge[1]]);
  });
}

std::vector<RimEdges> SolidRims::edges(const std::set<int>& used) const {
  std::vector<RimEdges> rims(curves_.begin(), curves_.end());
  std::vector<Side> owned;
  for (const int r : used) {
    for (const Side& side : sides_of(r)) {
      const auto owner =
          std::find_if(owned.begin(), owned.end(), [&](const Side& other) {
            return other.rim != r && alike(side, other);
          });
      if (owner == owned.end()) {
        owned.push_back(side);
        continue;
      }
      rims[r].share(side.piece, rims[owner->rim], owner->piece,
                    (side.from - owner->from).norm() > same_);
    }
  }
  return rims;
}

}  // namespace meniscus::solid
