#include "evolve/surface_editor.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include <Eigen/Geometry>

namespace meniscus {

namespace {

// Smallest gain of a flip [tangent]: keeps rounding from flipping for ever.
constexpr double kLeastGain = 1e-7;
// The two diagonals of a flip may be this far apart, x the shorter one: the
// surface of a coarse circle of 12 pieces needs 0.13.
constexpr double kFlipHeight = 0.15;
// A flip may bend the surface up to this much, or less than it bent before.
const double kFlatCosine = std::cos(0.6);
// A collapse may turn a facet up to this much, and leave no smaller angle
// than this unless the facets around were worse.
const double kTurnCosine = std::cos(0.6);
constexpr double kLeastTangent = 0.2;
// Averaging may lower the worst angle around a vertex to this.
constexpr double kGoodTangent = 0.7;

using QueuedEdge = std::tuple<double, int, int>;  // key, first id, second id

// Tangent of a triangle's smallest angle (at most 60 degrees): orders shapes
// as the angle does, for less work.
double smallest_tangent(const Vec3& a, const Vec3& b, const Vec3& c) {
  // It lies opposite the shortest side.
  const Vec3 ab = b - a;
  const Vec3 bc = c - b;
  const double la = bc.squaredNorm();
  const double lb = (a - c).squaredNorm();
  const double lc = ab.squaredNorm();
  const double below = 0.5 * (la + lb + lc) - std::min({la, lb, lc});
  return below > 0.0 ? ab.cross(bc).norm() / below : 0.0;
}

}  // namespace

double smallest_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::atan(smallest_tangent(a, b, c));
}

SurfaceEditor::SurfaceEditor(SurfaceMesh mesh, EditLimits limits)
    : mesh_(std::move(mesh)),
      limits_(std::move(limits)),
      star_(mesh_.points.size()),
      old_points_(static_cast<int>(mesh_.points.size())) {
  limits_.held.resize(mesh_.points.size(), 0);
  limits_.frozen.resize(mesh_.facets.size(), 0);
  limits_.rim_next.resize(mesh_.points.size(), -1);
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    for (const int v : mesh_.facets[f]) {
      star_[v].push_back(f);
    }
  }
  hold_border_vertices();
}

template <typename Visit>
void SurfaceEditor::for_each_edge(const Visit& visit) const {
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    if (!alive(f) || limits_.frozen[f] != 0) {
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const int a = mesh_.facets[f][k];
      const int b = mesh_.facets[f][(k + 1) % 3];
      if (a < b) {  // a free edge runs once each way
        visit(a, b);
      }
    }
  }
}

bool SurfaceEditor::has_edge(int a, int b) const {
  const bool turn = star_[b].size() < star_[a].size();
  const auto& star = star_[turn ? b : a];
  const int end = turn ? a : b;
  return std::any_of(star.begin(), star.end(), [&](int f) {
    const Triangle& t = mesh_.facets[f];
    return t[0] == end || t[1] == end || t[2] == end;
  });
}

bool SurfaceEditor::is_rim(int a, int b) const {
  return limits_.rim_next[a] == b || limits_.rim_next[b] == a;
}

// True when exactly two facets of one surface, running opposite ways and
// neither of them frozen, share the edge.
bool SurfaceEditor::free_pair(int a, int b, Pair& pair) const {
  pair = Pair{};
  if (is_rim(a, b)) {
    return false;
  }
  const auto& star = star_[star_[b].size() < star_[a].size() ? b : a];
  for (const int f : star) {
    const Triangle& t = mesh_.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int from = t[k];
      const int to = t[(k + 1) % 3];
      const bool along = from == a && to == b;
      if (!along && !(from == b && to == a)) {
        continue;
      }
      int& slot = along ? pair.left : pair.right;
      if (slot >= 0 || limits_.frozen[f] != 0) {
        return false;
      }
      slot = f;
      (along ? pair.left_corner : pair.right_corner) = t[(k + 2) % 3];
    }
  }
  return pair.left >= 0 && pair.right >= 0 &&
         mesh_.facet_label[pair.left] == mesh_.facet_label[pair.right] &&
         pair.left_corner != pair.right_corner;
}

void SurfaceEditor::hold_border_vertices() {
  Pair pair;
  for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
    const Triangle t = mesh_.facets[f];
    for (int k = 0; k < 3; ++k) {
      if (limits_.frozen[f] != 0) {
        limits_.held[t[k]] = 1;
      }
      const int next = t[(k + 1) % 3];
      if (limits_.held[t[k]] != 0 && limits_.held[next] != 0) {
        continue;
      }
      if (!free_pair(t[k], next, pair)) {
        limits_.held[t[k]] = 1;
        limits_.held[next] = 1;
      }
    }
  }
}

void SurfaceEditor::replace_corner(int facet, int from, int to) {
  for (int& v : mesh_.facets[facet]) {
    if (v == from) {
      v = to;
    }
  }
}

void SurfaceEditor::drop_from_star(int vertex, int facet) {
  auto& star = star_[vertex];
  star.erase(std::find(star.begin(), star.end(), facet));
}

int SurfaceEditor::add_facet(const Triangle& corners, int label) {
  const int id = static_cast<int>(mesh_.facets.size());
  mesh_.facets.push_back(corners);
  mesh_.facet_label.push_back(label);
  limits_.frozen.push_back(0);
  for (const int v : corners) {
    star_[v].push_back(id);
  }
  return id;
}

int SurfaceEditor::split(int a, int b, const Pair& pair) {
  const int m = static_cast<int>(mesh_.points.size());
  mesh_.points.push_back(0.5 * (mesh_.points[a] + mesh_.points[b]));
  limits_.held.push_back(0);
  limits_.rim_next.push_back(-1);
  star_.emplace_back();
  // Left (a, b, c) keeps a, right (b, a, d) keeps a; the halves at b are new.
  for (const int f : {pair.left, pair.right}) {
    replace_corner(f, b, m);
    drop_from_star(b, f);
    star_[m].push_back(f);
  }
  add_facet({m, b, pair.left_corner}, mesh_.facet_label[pair.left]);
  add_facet({b, m, pair.right_corner}, mesh_.facet_label[pair.right]);
  return m;
}

void SurfaceEditor::split_above(double limit) {
  std::priority_queue<QueuedEdge> queue;
  const auto push = [&](int a, int b) {
    const double l = length(a, b);
    if (l > limit) {
      queue.emplace(l, std::min(a, b), std::max(a, b));
    }
  };
  for_each_edge(push);
  Pair pair;
  while (!queue.empty()) {
    const auto [l, a, b] = queue.top();
    queue.pop();
    if (!free_pair(a, b, pair)) {
      continue;
    }
    const int m = split(a, b, pair);
    for (const int v : {a, b, pair.left_corner, pair.right_corner}) {
      push(v, m);
    }
  }
}

// The link condition on the whole complex, frozen facets included: the only
// common neighbours are the corners off the edge.
bool SurfaceEditor::link_allows(int gone, int kept, const Pair& pair) const {
  for (const int f : star_[gone]) {
    for (const int v : mesh_.facets[f]) {
      if (v != gone && v != kept && v != pair.left_corner &&
          v != pair.right_corner && has_edge(kept, v)) {
        return false;
      }
    }
  }
  // A closed tetrahedron would collapse onto itself.
  return star_[pair.left_corner].size() > 3 &&
         star_[pair.right_corner].size() > 3;
}

bool SurfaceEditor::can_collapse(int gone, int kept, const Vec3& place,
                                 double longest) const {
  double before = kLeastTangent;
  double after = kLeastTangent;
  for (const int end : {gone, kept}) {
    const int other = end == gone ? kept : gone;
    if (end == kept && limits_.held[kept] != 0) {
      break;  // only the facets around the vertex that goes are changed
    }
    for (const int f : star_[end]) {
      const Triangle& t = mesh_.facets[f];
      std::array<Vec3, 3> p;
      bool dies = false;
      for (int k = 0; k < 3; ++k) {
        dies = dies || t[k] == other;
        p[k] = t[k] == end ? place : mesh_.points[t[k]];
        if (t[k] != end && t[k] != other &&
            (mesh_.points[t[k]] - place).norm() > longest) {
          return false;
        }
      }
      const Vec3 old = normal2(f);
      before = std::min(before,
                        smallest_tangent(mesh_.points[t[0]], mesh_.points[t[1]],
                                       mesh_.points[t[2]]));
      if (dies) {
        continue;
      }
      const Vec3 now = (p[1] - p[0]).cross(p[2] - p[0]);
      const double bound = old.norm() * now.norm();
      if (!(old.dot(now) > kTurnCosine * bound)) {
        return false;
      }
      after = std::min(after, smallest_tangent(p[0], p[1], p[2]));
    }
  }
  return after >= before;
}

void SurfaceEditor::collapse(int gone, int kept, const Vec3& place,
                             const Pair& pair) {
  for (const int f : {pair.left, pair.right}) {
    for (const int v : Triangle(mesh_.facets[f])) {
      drop_from_star(v, f);
    }
    mesh_.facets[f] = {-1, -1, -1};
  }
  for (const int f : star_[gone]) {
    replace_corner(f, gone, kept);
    star_[kept].push_back(f);
  }
  star_[gone].clear();
  mesh_.points[kept] = place;
}

void SurfaceEditor::collapse_below(double limit, double longest) {
  std::priority_queue<QueuedEdge, std::vector<QueuedEdge>, std::greater<>>
      queue;
  const auto push = [&](int a, int b) {
    const double l = length(a, b);
    if (l < limit) {
      queue.emplace(l, std::min(a, b), std::max(a, b));
    }
  };
  for_each_edge(push);
  Pair pair;
  while (!queue.empty()) {
    const auto [l, a, b] = queue.top();
    queue.pop();
    const bool a_held = limits_.held[a] != 0;
    const bool b_held = limits_.held[b] != 0;
    if ((a_held && b_held) || !free_pair(a, b, pair) || length(a, b) != l) {
      continue;
    }
    const int kept = a_held || !b_held ? a : b;
    const int gone = kept == a ? b : a;
    const Vec3 place = a_held || b_held
                           ? mesh_.points[kept]
                           : Vec3(0.5 * (mesh_.points[a] + mesh_.points[b]));
    if (!link_allows(gone, kept, pair) ||
        !can_collapse(gone, kept, place, longest)) {
      continue;
    }
    collapse(gone, kept, place, pair);
    for (const int f : star_[kept]) {
      const Triangle& t = mesh_.facets[f];
      const int k = t[0] == kept ? 0 : t[1] == kept ? 1 : 2;
      push(kept, t[(k + 1) % 3]);
    }
  }
}

bool SurfaceEditor::should_flip(int a, int b, const Pair& pair) const {
  const int c = pair.left_corner;
  const int d = pair.right_corner;
  const Vec3& pa = mesh_.points[a];
  const Vec3& pb = mesh_.points[b];
  const Vec3& pc = mesh_.points[c];
  const Vec3& pd = mesh_.points[d];
  const double now =
      std::min(smallest_tangent(pa, pb, pc), smallest_tangent(pb, pa, pd));
  const double then =
      std::min(smallest_tangent(pc, pd, pb), smallest_tangent(pd, pc, pa));
  if (!(then > now + kLeastGain) || is_rim(c, d) || has_edge(c, d)) {
    return false;
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

void SurfaceEditor::flip(int a, int b, const Pair& pair) {
  const int c = pair.left_corner;
  const int d = pair.right_corner;
  mesh_.facets[pair.left] = {c, d, b};
  mesh_.facets[pair.right] = {d, c, a};
  drop_from_star(a, pair.left);
  drop_from_star(b, pair.right);
  star_[d].push_back(pair.left);
  star_[c].push_back(pair.right);
}

int SurfaceEditor::flip_all() {
  std::queue<Edge> queue;
  for_each_edge([&](int a, int b) { queue.push({a, b}); });
  int flips = 0;
  Pair pair;
  while (!queue.empty()) {
    const auto [a, b] = queue.front();
    queue.pop();
    if (!free_pair(a, b, pair) || !should_flip(a, b, pair)) {
      continue;
    }
    flip(a, b, pair);
    ++flips;
    for (const int u : {a, b}) {
      for (const int v : {pair.left_corner, pair.right_corner}) {
        queue.push({std::min(u, v), std::max(u, v)});
      }
    }
  }
  return flips;
}

void SurfaceEditor::average() {
  for (int v = 0; v < static_cast<int>(mesh_.points.size()); ++v) {
    if (limits_.held[v] != 0 || star_[v].empty()) {
      continue;
    }
    Vec3 centre = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double area = 0.0;
    for (const int f : star_[v]) {
      const Triangle& t = mesh_.facets[f];
      const Vec3 n = normal2(f);
      const double weight = n.norm();
      centre += weight / 3.0 *
                (mesh_.points[t[0]] + mesh_.points[t[1]] + mesh_.points[t[2]]);
      normal += n;
      area += weight;
    }
    if (!(normal.norm() > 1e-9 * area)) {
      continue;
    }
    normal.normalize();
    Vec3 move = centre / area - mesh_.points[v];
    move -= normal.dot(move) * normal;
    const Vec3 old = mesh_.points[v];
    const auto worst = [&] {
      double least = 2.0;
      for (const int f : star_[v]) {
        const Triangle& t = mesh_.facets[f];
        least = std::min(least,
                         smallest_tangent(mesh_.points[t[0]], mesh_.points[t[1]],
                                        mesh_.points[t[2]]));
        if (!(normal2(f).dot(normal) > 0.0)) {
          least = -1.0;
        }
      }
      return least;
    };
    const double before = std::min(worst(), kGoodTangent);
    for (int trial = 0; trial < 3; ++trial) {
      mesh_.points[v] = old + move;
      if (worst() >= before) {
        break;
      }
      move *= 0.5;
      mesh_.points[v] = old;
    }
  }
}

void make_isotropic(SurfaceEditor& editor, double edge, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    editor.split_above(4.0 / 3.0 * edge);
    editor.flip_all();
    editor.collapse_below(0.8 * edge, 4.0 / 3.0 * edge);
    editor.flip_all();
    editor.average();
    editor.flip_all();
  }
  for (int step = 0; step < 3; ++step) {
    editor.average();
    editor.flip_all();
  }
}

SurfaceMesh SurfaceEditor::finish(std::vector<int>* origin) const {
  SurfaceMesh result;
  result.labels = mesh_.labels;
  std::vector<int> number(mesh_.points.size(), -1);
  if (origin != nullptr) {
    origin->clear();
  }
  for (int v = 0; v < static_cast<int>(mesh_.points.size()); ++v) {
    if (star_[v].empty()) {
      continue;
    }
    number[v] = static_cast<int>(result.points.size());
    result.points.push_back(mesh_.points[v]);
    if (origin != nullptr) {
      origin->push_back(v < old_points_ ? v : -1);
    }
  }
  for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
    const Triangle& t = mesh_.facets[f];
    if (t[0] >= 0) {
      result.facets.push_back({number[t[0]], number[t[1]], number[t[2]]});
      result.facet_label.push_back(mesh_.facet_label[f]);
    }
  }
  return result;
}

}  // namespace meniscus
