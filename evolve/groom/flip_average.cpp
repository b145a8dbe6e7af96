#include <algorithm>
#include <cmath>
#include <queue>

#include "core/geometry/edge_key.h"
#include "core/heed_stop.h"
#include "evolve/groom/surface_editor.h"

namespace meniscus::groom {

namespace {

// Smallest gain of a flip [tangent]: keeps rounding from flipping for ever.
constexpr double kLeastGain = 1e-7;
// The two diagonals of a flip may be this far apart, x the shorter one: the
// surface of a coarse circle of 12 pieces needs 0.13.
constexpr double kFlipHeight = 0.15;
// A flip may bend the surface up to this much, or less than it bent before.
const double kFlatCosine = std::cos(0.6);
// Averaging may lower the worst angle around a vertex to this.
constexpr double kGoodTangent = 0.7;
constexpr int kMoveTrials = 3;  // each half as long as the last

}  // namespace

bool SurfaceEditor::should_flip(int a, int b, int c, int d,
                                FlipRule rule) const {
  const Vec3& pa = mesh_.points[a];
  const Vec3& pb = mesh_.points[b];
  const Vec3& pc = mesh_.points[c];
  const Vec3& pd = mesh_.points[d];
  const double now = std::min(films::smallest_tangent(pa, pb, pc),
                              films::smallest_tangent(pb, pa, pd));
  const double then = std::min(films::smallest_tangent(pc, pd, pb),
                               films::smallest_tangent(pd, pc, pa));
  if (!(then > now + kLeastGain) || line(c, d) != nullptr || has_edge(c, d)) {
    return false;
  }
  if (rule == FlipRule::AnglesOnly) {
    return true;
  }
  const Vec3 across = (pb - pa).cross(pd - pc);
  const double height = std::abs(across.dot(pc - pa));
  if (height * height >
      kFlipHeight * kFlipHeight * across.squaredNorm() *
          std::min((pb - pa).squaredNorm(), (pd - pc).squaredNorm())) {
    return false;
  }
  const Vec3 old_left = (pb - pa).cross(pc - pa);
  const Vec3 old_right = (pa - pb).cross(pd - pb);
  const Vec3 new_b = (pd - pc).cross(pb - pc);
  const Vec3 new_a = (pc - pd).cross(pa - pd);
  const Vec3 mean = old_left + old_right;
  const double bound_new = new_a.norm() * new_b.norm();
  const double bound_old = old_left.norm() * old_right.norm();
  const double bend_new = new_a.dot(new_b);
  const bool flat = bend_new >= kFlatCosine * bound_new;
  const bool flatter =
      bend_new * bound_old >= old_left.dot(old_right) * bound_new;
  return (flat || flatter) &&
         new_a.dot(mean) > 0.5 * new_a.norm() * mean.norm() &&
         new_b.dot(mean) > 0.5 * new_b.norm() * mean.norm();
}

// Edge a-b with `left` = (a, b, c) and `right` = (b, a, d) becomes c-d.
void SurfaceEditor::flip(int a, int b, int left, int right, int c, int d) {
  mesh_.facets[left] = {c, d, b};
  mesh_.facets[right] = {d, c, a};
  drop_from_star(a, left);
  drop_from_star(b, right);
  star_[d].push_back(left);
  star_[c].push_back(right);
}

int SurfaceEditor::flip_all(FlipRule rule) {
  // Only where something has changed since the last time.
  std::queue<Edge> queue;
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    const Triangle& t = mesh_.facets[f];
    if (!alive(f) || frozen_[f] != 0 ||
        changed_[t[0]] + changed_[t[1]] + changed_[t[2]] == 0) {
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      // The facet beside queues it unless only this one has a changed corner.
      if (a < b || changed_[a] + changed_[b] == 0) {
        queue.push(edge_key(a, b));
      }
    }
  }
  std::fill(changed_.begin(), changed_.end(), 0);
  int flips = 0;
  while (!queue.empty()) {
    heed_stop("film");
    const auto [a, b] = queue.front();
    queue.pop();
    if (line(a, b) != nullptr || !gather(a, b)) {
      continue;
    }
    const Triangle& t = mesh_.facets[wings_[0].facet];
    const bool first_left = (t[0] == a && t[1] == b) ||
                            (t[1] == a && t[2] == b) ||
                            (t[2] == a && t[0] == b);
    const Wing left = wings_[first_left ? 0 : 1];
    const Wing right = wings_[first_left ? 1 : 0];
    if (!should_flip(a, b, left.corner, right.corner, rule)) {
      continue;
    }
    flip(a, b, left.facet, right.facet, left.corner, right.corner);
    ++flips;
    for (const int u : {a, b}) {
      for (const int v : {left.corner, right.corner}) {
        queue.push(edge_key(u, v));
      }
    }
  }
  return flips;
}

// To the centre of the star, along its mean plane, whose normal is returned;
// zero when there is no such plane.
Vec3 SurfaceEditor::film_move(int v, const EdgeTarget& target,
                              Vec3& normal) const {
  Vec3 centre = Vec3::Zero();
  normal = Vec3::Zero();
  double area = 0.0;
  double sum = 0.0;
  for (const int f : star_[v]) {
    const Triangle& t = mesh_.facets[f];
    const Vec3 n = normal2(f);
    const Vec3 middle =
        (mesh_.points[t[0]] + mesh_.points[t[1]] + mesh_.points[t[2]]) / 3.0;
    double weight = n.norm();
    area += weight;
    if (target.field) {
      const double edge = target.at(middle);
      weight /= edge * edge;
    }
    centre += weight * middle;
    sum += weight;
    normal += n;
  }
  if (!(normal.norm() > 1e-9 * area)) {
    return Vec3::Zero();
  }
  normal.normalize();
  const Vec3 move = centre / sum - mesh_.points[v];
  return move - normal.dot(move) * normal;
}

// Along the chord of the two neighbours to where both edges are alike.
Vec3 SurfaceEditor::line_move(int v, const EdgeTarget& target) const {
  const Vec3& p = mesh_.points[v];
  const Vec3& one = mesh_.points[lines_[v][0].to];
  const Vec3& two = mesh_.points[lines_[v][1].to];
  const Vec3 chord = two - one;
  if (!(chord.squaredNorm() > 0.0)) {
    return Vec3::Zero();
  }
  const double to_one = target.at(0.5 * (one + p));
  const double to_two = target.at(0.5 * (two + p));
  const Vec3 aim = one + to_one / (to_one + to_two) * chord;
  return chord.dot(aim - p) / chord.squaredNorm() * chord;
}

films::PlacedVertex SurfaceEditor::moved(int v, const Vec3& move) const {
  films::PlacedVertex result = placed(v);
  const Vec3 aim = result.place + move;
  if (result.vertex.kind == films::VertexKind::Slides) {
    const curves::CurveShape& shape =
        complex_.curves[result.vertex.curve].shape;
    result.vertex.t = films::nearest_parameter(shape, aim, result.vertex.t);
    result.place = curves::point_at(shape, result.vertex.t);
  } else if (result.vertex.constraints >= 0) {
    result.place = films::onto_walls(complex_, result.vertex.constraints,
                                     result.vertex.held, aim);
  } else {
    result.place = aim;
  }
  return result;
}

// Of the facets around v; -1 when one is turned away from its old normal
// (one per facet, or one for all).
double SurfaceEditor::worst_shape(int v,
                                  const std::vector<Vec3>& normals) const {
  double least = 2.0;
  for (std::size_t i = 0; i < star_[v].size(); ++i) {
    const int f = star_[v][i];
    const Triangle& t = mesh_.facets[f];
    least = std::min(
        least, films::smallest_tangent(mesh_.points[t[0]], mesh_.points[t[1]],
                                       mesh_.points[t[2]]));
    if (!(normal2(f).dot(normals[normals.size() > 1 ? i : 0]) > 0.0)) {
      return -1.0;
    }
  }
  return least;
}

void SurfaceEditor::average(const EdgeTarget& target,
                            const std::vector<char>& marked) {
  std::vector<Vec3> normals;
  for (int v = 0; v < static_cast<int>(mesh_.points.size()); ++v) {
    heed_stop("film");
    if (rank_[v] == Rank::Held || star_[v].empty() ||
        (!marked.empty() && marked[v] == 0)) {
      continue;
    }
    Vec3 move;
    normals.clear();
    if (rank_[v] == Rank::Line) {
      move = line_move(v, target);
      for (const int f : star_[v]) {
        normals.push_back(normal2(f));
      }
    } else {
      normals.emplace_back();
      move = film_move(v, target, normals[0]);
    }
    if (!(move.squaredNorm() > 0.0)) {
      continue;
    }
    const films::PlacedVertex old = placed(v);
    const double before = std::min(worst_shape(v, normals), kGoodTangent);
    for (int trial = 0; trial < kMoveTrials; ++trial) {
      const films::PlacedVertex now = moved(v, move);
      mesh_.points[v] = now.place;
      complex_.vertices[v] = now.vertex;
      if (worst_shape(v, normals) >= before) {
        changed_[v] = 1;
        break;
      }
      move *= 0.5;
      mesh_.points[v] = old.place;
      complex_.vertices[v] = old.vertex;
    }
  }
}

void make_isotropic(SurfaceEditor& editor, const EdgeTarget& target,
                    int passes) {
  constexpr double kLong = 4.0 / 3.0;
  constexpr double kShort = 0.8;
  constexpr int kSmoothing = 3;
  // Merging wider pieces of long needles would cost volume.
  constexpr double kNarrow = 0.65;
  // Needles are cut down by halves, and narrow ones merged in between: cut to
  // size at once they would leave far too many facets and take a flip for each
  // pair. No flips of long edges: they would change the shape.
  double limit = 0.5 * editor.longest(target);
  for (; limit > kLong; limit *= 0.5) {
    editor.split_above(limit, target);
    editor.collapse_below(kNarrow, limit, target);
  }
  for (int pass = 0; pass < passes; ++pass) {
    editor.split_above(kLong, target);
    editor.flip_all();
    editor.collapse_below(kShort, kLong, target);
    editor.flip_all();
    editor.average(target);
    editor.flip_all();
  }
  for (int step = 0; step < kSmoothing; ++step) {
    editor.average(target);
    editor.flip_all();
  }
}

}  // namespace meniscus::groom
