#include "cad/solid/film_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "cad/solid/film_knots.h"

namespace meniscus::solid {

namespace {

constexpr int kNormalRounds = 3;
constexpr double kSamePlane = 0.9;  // cosine
constexpr int kHalvings = 3;
constexpr int kMostHalvings = 5;  // the last where faces are far off alone
constexpr double kFarOff = 2.0;   // x the limit

double most_folded(const std::vector<FittedPatch>& patches) {
  double most = 0.0;
  for (const FittedPatch& patch : patches) {
    most = std::max(most, folded_share(patch));
  }
  return most;
}

class FaceBuilder {
 public:
  FaceBuilder(const FilmPiece& film, const std::vector<RimEdges>& rims,
              const FaceLimits& limits, Brep& brep)
      : film_(film),
        on_rims_{film.cut, film.rims, rims},
        brep_(brep),
        knots_(on_rims_, limits) {}

  FilmFaces build();

 private:
  const FilmMesh& mesh() const { return film_.cut.mesh; }
  std::vector<double> shares_of(const std::vector<int>& chain) const;
  int vertex_of(int v);
  Vec3 normal_of(int v, bool& free) const;
  void add_between(const std::vector<int>& chain, CurveFit& fit) const;
  void fit_lines();
  void add_line_edges();
  std::vector<FittedPatch> fit_patches() const;
  std::vector<FittedPatch> fit();
  PatchSides sides_of(const FilmPatch& patch) const;
  void measure_gaps(const FilmPatch& patch, const PatchSides& sides);
  std::vector<BrepUse> outline(const FilmPatch& patch) const;
  Vec3 end_of(int v) { return brep_.vertices[vertex_of(v)]; }

  void average_normals(const std::vector<FittedPatch>& patches);

  const FilmPiece& film_;
  FilmOnRims on_rims_;
  Brep& brep_;
  FilmKnots knots_;
  std::map<int, int> nodes_;  // film vertex: brep vertex
  std::vector<int> line_edges_;
  std::vector<SplineCurve> line_curves_;
  std::vector<SplineCurve> line_normals_;
  std::vector<std::array<bool, 2>> line_free_;  // at their ends
};

std::vector<double> FaceBuilder::shares_of(
    const std::vector<int>& chain) const {
  const double whole = length_of(mesh(), chain);
  std::vector<double> shares{0.0};
  double length = 0.0;
  for (std::size_t k = 1; k < chain.size(); ++k) {
    length += (mesh().points[chain[k]] - mesh().points[chain[k - 1]]).norm();
    shares.push_back(k + 1 == chain.size() ? 1.0 : length / whole);
  }
  return shares;
}

int FaceBuilder::vertex_of(int v) {
  const int rim = film_.cut.rim_of[v];
  if (rim >= 0) {
    return on_rims_.rim(rim).vertex(film_.cut.rim_position[v]);
  }
  const auto found = nodes_.find(v);
  if (found != nodes_.end()) {
    return found->second;
  }
  nodes_[v] = static_cast<int>(brep_.vertices.size());
  brep_.vertices.push_back(mesh().points[v]);
  return nodes_[v];
}

/// The film's normal, at right angles to the rim; at a rim's corner to both of
/// its sides. Where that is not the film's at all, the film has no tangent
/// plane there, and `free` becomes true.
Vec3 FaceBuilder::normal_of(int v, bool& free) const {
  const Vec3& normal = mesh().normals[v];
  free = false;
  const int rim = film_.cut.rim_of[v];
  if (rim < 0) {
    return normal;
  }
  const RimEdges& edges = on_rims_.rim(rim);
  const double place = edges.place(film_.cut.rim_position[v]);
  const int corner = edges.curve().sharp_corner(place);
  if (corner >= 0) {
    Vec3 both = edges.curve().corner_normal(corner);
    both *= both.dot(normal) < 0.0 ? -1.0 : 1.0;
    free = both.dot(normal) < kSamePlane;
    return free ? normal : both;
  }
  const Vec3 tangent = edges.curve().tangent(place);
  return (normal - normal.dot(tangent) * tangent).normalized();
}

/// Points of the film between a line's vertices, some of which are farther
/// apart than knots.
void FaceBuilder::add_between(const std::vector<int>& chain,
                              CurveFit& fit) const {
  for (std::size_t k = 1; k < chain.size(); ++k) {
    for (const double t : {1.0 / 3.0, 2.0 / 3.0}) {
      fit.at.push_back((1.0 - t) * fit.at[k - 1] + t * fit.at[k]);
      fit.points.push_back(
          smooth_edge_point(mesh(), chain[k - 1], chain[k], t));
    }
  }
}

void FaceBuilder::fit_lines() {
  const CutFilm& cut = film_.cut;
  line_curves_.clear();
  line_normals_.clear();
  line_free_.clear();
  for (std::size_t k = 0; k < cut.lines.size(); ++k) {
    const std::vector<int>& chain = cut.lines[k];
    CurveFit fit;
    fit.knots = knots_.of_line(k);
    fit.at = shares_of(chain);
    for (const int v : chain) {
      fit.points.push_back(mesh().points[v]);
    }
    add_between(chain, fit);
    fit.start = end_of(chain.front());
    fit.end = end_of(chain.back());
    const Vec3 none = Vec3::Zero();
    std::array<bool, 2> free{};
    const Vec3 start_normal = normal_of(chain.front(), free[0]);
    const Vec3 end_normal = normal_of(chain.back(), free[1]);
    line_free_.push_back(free);
    fit.start_normal = free[0] ? none : start_normal;
    fit.end_normal = free[1] ? none : end_normal;
    line_curves_.push_back(fit_curve(fit));
    fit.at = shares_of(chain);
    fit.points.clear();
    for (const int v : chain) {
      fit.points.push_back(mesh().normals[v]);
    }
    fit.start = start_normal;
    fit.end = end_normal;
    fit.start_normal = fit.end_normal = Vec3::Zero();
    line_normals_.push_back(fit_curve(fit));
  }
}

void FaceBuilder::add_line_edges() {
  for (std::size_t k = 0; k < line_curves_.size(); ++k) {
    const std::vector<int>& chain = film_.cut.lines[k];
    line_edges_.push_back(static_cast<int>(brep_.edges.size()));
    brep_.edges.push_back({vertex_of(chain.front()), vertex_of(chain.back()),
                           line_curves_[k], 0.0, 1.0});
  }
}

PatchSides FaceBuilder::sides_of(const FilmPatch& patch) const {
  const std::size_t p = &patch - film_.cut.patches.data();
  PatchSides sides;
  for (int side = 0; side < 4; ++side) {
    const int line = patch.lines[side];
    // On a rim: the exact curve as a spline, vertices at shares of arclength.
    if (line < 0) {
      const RimSide rim = on_rims_.side(patch, side);
      sides.curves[side] = fit_rim(rim, knots_.of_patch(p, side % 2), brep_);
      const double start = rim.rim->place(rim.from);
      const double way = rim.rim->way(rim.from, rim.to, rim.growing);
      const double length = rim.rim->curve().length();
      const std::vector<int>& chain = patch.chains[side];
      for (std::size_t k = 0; k < chain.size(); ++k) {
        const double d = (rim.growing ? 1.0 : -1.0) *
                         (film_.cut.rim_position[chain[k]] - start);
        // The ends may be a little off the vertices that they became.
        const double middle = d - 0.5 * way;
        const double share =
            (middle - length * std::round(middle / length) + 0.5 * way) / way;
        sides.at[side].push_back(k == 0 ? 0.0
                                 : k + 1 == chain.size()
                                     ? 1.0
                                     : std::clamp(share, 0.0, 1.0));
      }
      continue;
    }
    // On a line: the curve fitted once for both patches, and the normals that
    // both are to have there (G1 continuity).
    const SplineCurve& curve = line_curves_[line];
    const bool back = patch.reversed[side];
    sides.curves[side] = back ? reversed(curve) : curve;
    sides.normals[side] =
        back ? reversed(line_normals_[line]) : line_normals_[line];
    sides.free_end[side] = line_free_[line];
    if (back) {
      std::swap(sides.free_end[side][0], sides.free_end[side][1]);
    }
    sides.at[side] = shares_of(patch.chains[side]);
  }
  return sides;
}

std::vector<BrepUse> FaceBuilder::outline(const FilmPatch& patch) const {
  std::vector<BrepUse> uses;
  for (int side = 0; side < 4; ++side) {
    const bool along = side < 2;  // the outline runs along growing a or b
    const int line = patch.lines[side];
    if (line >= 0) {
      const bool back = patch.reversed[side];
      uses.push_back({line_edges_[line], along != back,
                      on_side(side, back ? 1.0 : 0.0),
                      on_side(side, back ? 0.0 : 1.0)});
      continue;
    }
    const RimSide rim = on_rims_.side(patch, side);
    std::vector<RimEdges::Step> steps =
        rim.rim->between(rim.from, rim.to, rim.growing);
    if (!along) {
      std::reverse(steps.begin(), steps.end());
    }
    for (const RimEdges::Step& step : steps) {
      uses.push_back({step.edge, along == step.forward,
                      on_side(side, step.first), on_side(side, step.last)});
    }
  }
  return uses;
}

/// How far the surface's own boundary leaves its rims' exact curves.
void FaceBuilder::measure_gaps(const FilmPatch& patch,
                               const PatchSides& sides) {
  constexpr int kSamples = 500;
  for (int side = 0; side < 4; ++side) {
    if (patch.rims[side] < 0) {
      continue;
    }
    const RimSide rim = on_rims_.side(patch, side);
    for (const RimEdges::Step& step :
         rim.rim->between(rim.from, rim.to, rim.growing)) {
      BrepEdge& edge = brep_.edges[step.edge];
      for (int k = 0; k <= kSamples; ++k) {
        const double t = static_cast<double>(k) / kSamples;
        const Vec3 exact =
            point_of(edge.curve, edge.first + t * (edge.last - edge.first));
        const Vec3 own = point_of(sides.curves[side],
                                  step.first + t * (step.last - step.first));
        edge.gap = std::max(edge.gap, (exact - own).norm());
      }
    }
  }
}

/// Normals along the lines between patches become the mean of what the patches
/// have there: near a corner the film's own, which are of facets, ask for a
/// twist that no surface has.
void FaceBuilder::average_normals(const std::vector<FittedPatch>& patches) {
  constexpr int kPerLine = 200;
  std::vector<Points> sums(line_normals_.size(),
                           Points(kPerLine + 1, Vec3::Zero()));
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const FilmPatch& patch = film_.cut.patches[p];
    for (int side = 0; side < 4; ++side) {
      for (int k = 0; k <= kPerLine && patch.lines[side] >= 0; ++k) {
        const double t = static_cast<double>(k) / kPerLine;
        const SurfaceJet jet =
            jet_of(patches[p].surface,
                   on_side(side, patch.reversed[side] ? 1.0 - t : t));
        sums[patch.lines[side]][k] += jet.by_a.cross(jet.by_b).normalized();
      }
    }
  }
  for (std::size_t line = 0; line < sums.size(); ++line) {
    CurveFit fit;
    fit.knots = knots_.of_line(line);
    fit.start = line_normals_[line].poles.front();
    fit.end = line_normals_[line].poles.back();
    for (int k = 0; k <= kPerLine; ++k) {
      fit.at.push_back(static_cast<double>(k) / kPerLine);
      fit.points.push_back(sums[line][k].normalized());
    }
    line_normals_[line] = fit_curve(fit);
  }
}

std::vector<FittedPatch> FaceBuilder::fit_patches() const {
  std::vector<FittedPatch> patches;
  for (const FilmPatch& patch : film_.cut.patches) {
    patches.push_back(fit_patch(mesh(), patch, sides_of(patch)));
  }
  return patches;
}

/// With knots halved where patches leave the film or rims. Of the rounds that
/// fold least the last counts; where later ones fold more, only what leaves
/// rims is halved after it.
std::vector<FittedPatch> FaceBuilder::fit() {
  FilmKnots::Classes best;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round <= kMostHalvings; ++round) {
    fit_lines();
    std::vector<FittedPatch> patches = fit_patches();
    const double folded = most_folded(patches);
    if (folded <= least) {
      least = folded;
      best = knots_.classes();
    }
    const bool done =
        round == kMostHalvings ||
        !knots_.halve(patches, brep_, round < kHalvings ? 1.0 : kFarOff);
    if (done && folded <= least) {
      return patches;
    }
    if (done) {
      break;
    }
  }
  knots_.restore(best);
  for (int round = 0;; ++round) {
    fit_lines();
    std::vector<FittedPatch> patches = fit_patches();
    if (round == kMostHalvings ||
        !knots_.halve(patches, brep_,
                      std::numeric_limits<double>::infinity())) {
      return patches;
    }
  }
}

FilmFaces FaceBuilder::build() {
  FilmFaces faces;
  faces.patches = fit();
  for (int round = 0; round < kNormalRounds; ++round) {
    average_normals(faces.patches);
    std::vector<FittedPatch> patches = fit_patches();
    if (most_folded(patches) > most_folded(faces.patches)) {
      break;  // those of the round before stand
    }
    faces.patches = std::move(patches);
  }
  add_line_edges();
  faces.first_face = static_cast<int>(brep_.faces.size());
  for (std::size_t p = 0; p < faces.patches.size(); ++p) {
    const FilmPatch& patch = film_.cut.patches[p];
    measure_gaps(patch, sides_of(patch));
    brep_.faces.push_back(
        {film_.name, faces.patches[p].surface, {outline(patch)}});
  }
  return faces;
}

}  // namespace

Vec2 on_side(int side, double share) {
  return side == 0   ? Vec2(share, 0.0)
         : side == 1 ? Vec2(1.0, share)
         : side == 2 ? Vec2(share, 1.0)
                     : Vec2(0.0, share);
}

void want_corners(const FilmPiece& film, std::vector<RimEdges>& rims) {
  for (const FilmPatch& patch : film.cut.patches) {
    for (int side = 0; side < 4; ++side) {
      const int rim = patch.rims[side];
      if (rim < 0) {
        continue;
      }
      for (const int v :
           {patch.chains[side].front(), patch.chains[side].back()}) {
        rims[film.rims[rim]].want(film.cut.rim_position[v]);
      }
    }
  }
}

FilmFaces add_faces(const FilmPiece& film, const std::vector<RimEdges>& rims,
                    const FaceLimits& limits, Brep& brep) {
  return FaceBuilder(film, rims, limits, brep).build();
}

}  // namespace meniscus::solid
