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

/// The number of a piece run backwards, and the share of a place on it.
int turned_piece(int piece, std::size_t count) {
  return static_cast<int>(count) - 1 - piece;
}

double nearest_turn(double d, double length) {
  return d - length * std::round(d / length);
}

}  // namespace

SolidRims::SolidRims(const SurfaceMesh& mesh, const std::vector<NamedRim>& rims)
    : mesh_(mesh),
      same_(kSameCorner * bounding_diagonal(mesh.points)),
      lines_(mesh, {}) {
  for (std::size_t r = 0; r < rims.size(); ++r) {
    curves_.push_back(rims[r].curve);
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
  add_named(rims);
}

void SolidRims::add_named(const std::vector<NamedRim>& rims) {
  std::set<int> on_rims;
  std::vector<std::set<int>> members;
  for (const NamedRim& rim : rims) {
    members.emplace_back(rim.vertices.begin(), rim.vertices.end());
    on_rims.insert(rim.vertices.begin(), rim.vertices.end());
  }
  // A vertex of several rims is told with one of them, and is on all.
  for (const Side& side : shared_) {
    for (const int v : on_rims) {
      if (lies_on(side, mesh_.points[v])) {
        members[side.rim].insert(v);
      }
    }
  }
  for (std::size_t r = 0; r < rims.size(); ++r) {
    Named& named = named_.emplace_back();
    for (const int v : members[r]) {
      named.places[v] = curves_[r].nearest(mesh_.points[v]);
      named.order.push_back(v);
    }
    std::stable_sort(named.order.begin(), named.order.end(), [&](int v, int w) {
      return named.places.at(v) < named.places.at(w);
    });
  }
}

void SolidRims::set_faces(const std::vector<std::vector<int>>& faces) {
  lines_ = FaceLines(mesh_, faces);
}

std::vector<SolidRims::Side> SolidRims::sides_of(int rim) const {
  std::vector<Side> sides;
  for (int k = 0; k < curves_[rim].piece_count(); ++k) {
    const RimPiece& piece = curves_[rim].piece(k);
    const bool whole = curves_[rim].piece_count() == 1;
    if (!whole && !std::holds_alternative<SplineCurve>(piece.curve)) {
      sides.push_back({piece, point_of(piece.curve, piece.first),
                       point_of(piece.curve, piece.last), rim});
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

bool SolidRims::on_shared_side(const Edge& edge) const {
  return std::any_of(shared_.begin(), shared_.end(), [&](const Side& side) {
    return lies_on(side, mesh_.points[edge[0]]) &&
           lies_on(side, mesh_.points[edge[1]]);
  });
}

/// Next to each other on the rim, either way.
bool SolidRims::has_next(const Named& named, int v, int w) const {
  const auto at = std::find(named.order.begin(), named.order.end(), v);
  const auto count = static_cast<std::ptrdiff_t>(named.order.size());
  const std::ptrdiff_t k = at - named.order.begin();
  return k < count && (named.order[(k + 1) % count] == w ||
                       named.order[(k + count - 1) % count] == w);
}

/// The first that the whole line runs along; -1: none.
int SolidRims::named_rim_of(const FaceLine& line) const {
  const std::vector<int>& v = line.vertices;
  for (std::size_t r = 0; r < named_.size(); ++r) {
    bool along = true;
    for (std::size_t k = 0; k < v.size() && along; ++k) {
      const std::size_t next = (k + 1) % v.size();
      along =
          named_[r].places.count(v[k]) > 0 &&
          ((next == 0 && !line.closed) || has_next(named_[r], v[k], v[next]));
    }
    if (along) {
      return static_cast<int>(r);
    }
  }
  return -1;
}

bool SolidRims::ends_at_crease(const FaceLine& line) const {
  const std::vector<int>& v = line.vertices;
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (creases_.count(edge_key(v[k], v[(k + 1) % v.size()])) > 0) {
      return true;
    }
  }
  return false;
}

/// With a corner wherever a rim has one too, on straight sides as well.
PointCurve SolidRims::polygon_through(const Points& points, bool closed) const {
  const std::size_t n = points.size();
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = points[i];
    const Side across{
        {StraightLine{}}, points[(i + n - 1) % n], points[(i + 1) % n]};
    const bool end = !closed && (i == 0 || i + 1 == n);
    if (end || !lies_on(across, p) ||
        std::any_of(sides_.begin(), sides_.end(), [&](const Side& side) {
          return (side.from - p).norm() <= same_;
        })) {
      corners.push_back(i);
    }
  }
  PointCurve result;
  result.at.assign(n, {});
  for (std::size_t c = 0; c + (closed ? 0 : 1) < corners.size(); ++c) {
    const std::size_t first = corners[c];
    const std::size_t last = corners[(c + 1) % corners.size()];
    const Vec3 way = points[last] - points[first];
    result.pieces.push_back(
        {StraightLine{points[first], way.normalized()}, 0.0, way.norm()});
    for (std::size_t i = first; i != last; i = (i + 1) % n) {
      result.at[i] = {static_cast<int>(c),
                      way.dot(points[i] - points[first]) / way.squaredNorm()};
    }
  }
  if (!closed) {
    result.at.back() = {static_cast<int>(result.pieces.size()) - 1, 1.0};
  }
  return result;
}

/// The exact curve between the line's ends.
PointCurve SolidRims::named_part(int rim, const FaceLine& line) const {
  const RimCurve& curve = curves_[rim];
  const std::map<int, double>& places = named_[rim].places;
  std::vector<double> way{places.at(line.vertices[0])};
  for (std::size_t k = 1; k < line.vertices.size(); ++k) {
    way.push_back(way.back() + nearest_turn(places.at(line.vertices[k]) -
                                                places.at(line.vertices[k - 1]),
                                            curve.length()));
  }
  const bool back = way.back() < way.front();
  const double low = back ? way.back() : way.front();
  const double high = back ? way.front() : way.back();
  const double start = curve.wrapped(low);
  std::vector<double> ends;
  PointCurve result;
  result.pieces = curve.between(start, start + high - low, ends);
  for (const double place : way) {
    const double s = start + std::clamp(place - low, 0.0, high - low);
    const auto piece = std::min<std::ptrdiff_t>(
        std::lower_bound(ends.begin(), ends.end(), s) - ends.begin(),
        static_cast<std::ptrdiff_t>(ends.size()) - 1);
    const double from = piece > 0 ? ends[piece - 1] : start;
    result.at.emplace_back(static_cast<int>(piece),
                           (s - from) / (ends[piece] - from));
  }
  if (back) {
    std::reverse(result.pieces.begin(), result.pieces.end());
    for (RimPiece& piece : result.pieces) {
      piece = reversed(piece);
    }
    for (auto& [piece, share] : result.at) {
      piece = turned_piece(piece, result.pieces.size());
      share = 1.0 - share;
    }
  }
  return result;
}

/// Of an open line, or of a closed one that lies on no named rim.
const PointCurve& SolidRims::curve_of(int line) {
  const auto found = line_curves_.find(line);
  if (found != line_curves_.end()) {
    return found->second;
  }
  const FaceLine& way = lines_.lines()[line];
  Points points;
  for (const int v : way.vertices) {
    points.push_back(mesh_.points[v]);
  }
  const int named = way.closed ? -1 : named_rim_of(way);
  return line_curves_[line] = named >= 0 ? named_part(named, way)
                              : ends_at_crease(way)
                                  ? polygon_through(points, way.closed)
                                  : curve_through(points, way.closed);
}

SolidLoop SolidRims::loop_of(const std::vector<int>& loop) {
  const std::vector<int> vertices = lines_.begins_at_end(loop);
  const std::vector<LineRun> runs = lines_.runs(vertices);
  return lines_.lines()[runs[0].line].closed ? closed_loop(vertices, runs[0])
                                             : composed_loop(vertices, runs);
}

SolidLoop SolidRims::closed_loop(const std::vector<int>& loop,
                                 const LineRun& run) {
  const FaceLine& line = lines_.lines()[run.line];
  auto at = rim_of_line_.find(run.line);
  if (at == rim_of_line_.end()) {
    int rim = named_rim_of(line);
    if (rim < 0) {
      rim = static_cast<int>(curves_.size());
      curves_.emplace_back(curve_of(run.line).pieces);
    }
    at = rim_of_line_.emplace(run.line, rim).first;
  }
  SolidLoop result{at->second, loop, {}, run.forward};
  const RimCurve& curve = curves_[result.rim];
  const bool named = result.rim < static_cast<int>(named_.size());
  for (const int v : loop) {
    if (named) {
      result.places.push_back(named_[result.rim].places.at(v));
      continue;
    }
    const auto k = std::find(line.vertices.begin(), line.vertices.end(), v) -
                   line.vertices.begin();
    const auto& [piece, share] = curve_of(run.line).at[k];
    result.places.push_back(
        curve.start_of(piece) +
        share * (curve.start_of(piece + 1) - curve.start_of(piece)));
  }
  if (named) {
    result.growing =
        nearest_turn(result.places[1] - result.places[0], curve.length()) > 0.0;
  }
  return result;
}

SolidLoop SolidRims::composed_loop(const std::vector<int>& loop,
                                   const std::vector<LineRun>& runs) {
  std::vector<RimPiece> pieces;
  std::vector<Source> sources;
  std::vector<std::pair<int, double>> at;  // per vertex of the loop
  for (const LineRun& run : runs) {
    const PointCurve& curve = curve_of(run.line);
    const int first = static_cast<int>(pieces.size());
    const int count = static_cast<int>(curve.pieces.size());
    for (int k = 0; k < count; ++k) {
      const int piece = run.forward ? k : count - 1 - k;
      pieces.push_back(run.forward ? curve.pieces[piece]
                                   : reversed(curve.pieces[piece]));
      sources.push_back({run.line, piece, !run.forward});
    }
    // The last vertex is the next line's first.
    const std::size_t steps = curve.at.size() - 1;
    for (std::size_t k = 0; k < steps; ++k) {
      const auto& [piece, share] = curve.at[run.forward ? k : steps - k];
      at.emplace_back(
          first + (run.forward ? piece : turned_piece(piece, count)),
          run.forward ? share : 1.0 - share);
    }
  }
  SolidLoop result{static_cast<int>(curves_.size()), loop, {}, true};
  const RimCurve& curve = curves_.emplace_back(std::move(pieces));
  composed_[result.rim] = std::move(sources);
  for (const auto& [piece, share] : at) {
    result.places.push_back(curve.wrapped(
        curve.start_of(piece) +
        share * (curve.start_of(piece + 1) - curve.start_of(piece))));
  }
  return result;
}

std::vector<RimEdges> SolidRims::edges(const std::set<int>& used) const {
  std::vector<RimEdges> rims(curves_.begin(), curves_.end());
  struct Owner {
    int rim = 0;
    int piece = 0;
    bool reversed = false;
  };
  std::map<std::pair<int, int>, Owner> owned;  // by line and piece
  for (const int r : used) {
    const auto sources = composed_.find(r);
    for (int k = 0;
         sources != composed_.end() && k < rims[r].curve().piece_count(); ++k) {
      const Source& source = sources->second[k];
      const auto [owner, fresh] = owned.emplace(
          std::pair(source.line, source.piece), Owner{r, k, source.reversed});
      if (!fresh) {
        rims[r].share(k, rims[owner->second.rim], owner->second.piece,
                      source.reversed != owner->second.reversed);
      }
    }
  }
  return rims;
}

}  // namespace meniscus::solid
