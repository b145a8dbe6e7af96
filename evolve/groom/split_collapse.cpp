#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/heed_stop.h"
#include "core/memory.h"
#include "evolve/groom/surface_editor.h"

namespace meniscus::groom {

namespace {

// A collapse may turn a facet up to this much, and leave no smaller angle
// than this unless the facets around were worse.
const double kTurnCosine = std::cos(0.6);
constexpr double kLeastTangent = 0.2;
// Halves of a bent edge are shorter than this, x the edge, or it stays.
constexpr double kHalf = 0.9;

using QueuedEdge = std::tuple<double, int, int>;  // key, first id, second id

}  // namespace

template <typename Visit>
void SurfaceEditor::for_each_edge(const Visit& visit) const {
  for (int v = 0; v < static_cast<int>(lines_.size()); ++v) {
    for (const LineEnd& end : lines_[v]) {
      if (end.moves && v < end.to) {
        visit(v, end.to);
      }
    }
  }
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    if (!alive(f) || frozen_[f] != 0) {
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const int a = mesh_.facets[f][k];
      const int b = mesh_.facets[f][(k + 1) % 3];
      if (a < b && line(a, b) == nullptr) {  // runs once each way
        visit(a, b);
      }
    }
  }
}

double SurfaceEditor::longest(const EdgeTarget& target) const {
  double result = 0.0;
  for_each_edge(
      [&](int a, int b) { result = std::max(result, ratio(a, b, target)); });
  return result;
}

double SurfaceEditor::expected_facets(const EdgeTarget& target) const {
  const double of_facet = 0.25 * std::sqrt(3.0);  // area of one with edge 1
  double sum = 0.0;
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    if (alive(f) && frozen_[f] == 0) {
      const Triangle& t = mesh_.facets[f];
      const double edge = target.at(
          (mesh_.points[t[0]] + mesh_.points[t[1]] + mesh_.points[t[2]]) / 3.0);
      double longest = 0.0;
      for (int k = 0; k < 3; ++k) {
        longest = std::max(
            longest,
            (mesh_.points[t[k]] - mesh_.points[t[(k + 1) % 3]]).norm());
      }
      sum +=
          0.5 * normal2(f).norm() / (of_facet * edge * edge) + longest / edge;
    }
  }
  return sum;
}

double SurfaceEditor::most_facets(const EdgeTarget& target) const {
  constexpr double kBytes = 1500.0;  // of a facet, until its film is settled
  constexpr double kMore = 10.0;     // x what is expected
  constexpr double kSmall = 1e5;
  const double expected = expected_facets(target);
  if (kMore * expected <= kSmall) {  // 0.3 GB at most: memory is not asked for
    return kMore * expected + kSmall;
  }
  const double held = available_memory() / kBytes;
  if (expected > held) {
    throw InvalidInput(fmt::format(
        "the film takes about {:.2g} facets at edges of {:.4g}, and memory "
        "holds {:.2g} ({:.2g} GB are free); use longer edges, or look for a "
        "curve that is too far away or an edge that is too short",
        expected, target.edge, held, kBytes * held / 1e9));
  }
  return std::min(kMore * expected + kSmall, held);
}

void SurfaceEditor::split(int a, int b, const films::PlacedVertex& made) {
  const LineEnd* found = line(a, b);
  const bool on_line = found != nullptr;
  const int m = add_vertex(made, on_line ? Rank::Line : Rank::Film);
  if (on_line) {
    const int mark = line_end(a, b).mark;
    int born = -1;
    if (mark >= 0) {
      born = static_cast<int>(marks_.size());
      films::ComplexEdge half = marks_[mark];
      (half.a == b ? half.b : half.a) = m;
      marks_.push_back(half);
      (marks_[mark].a == b ? marks_[mark].a : marks_[mark].b) = m;
    }
    line_end(a, b).to = m;
    line_end(b, a) = {m, born, true};
    lines_[m] = {{a, mark, true}, {b, born, true}};
  }
  // The half at a keeps its facet's number; that at b is new.
  for (const auto& [f, corner] : std::vector<Wing>(wings_)) {
    Triangle other = mesh_.facets[f];
    std::replace(other.begin(), other.end(), a, m);
    replace_corner(f, b, m);
    drop_from_star(b, f);
    star_[m].push_back(f);
    add_facet(other, mesh_.facet_label[f]);
  }
}

std::optional<std::pair<int, int>> SurfaceEditor::longer_side(
    int a, int b, const Vec3& made) const {
  const auto length = [&](int v, int w) {
    return (mesh_.points[v] - mesh_.points[w]).norm();
  };
  const double halved = length(a, b);
  for (const Wing& wing : wings_) {
    if ((mesh_.points[wing.corner] - made).norm() >= halved) {
      const int far = length(a, wing.corner) < length(b, wing.corner) ? b : a;
      return std::minmax(far, wing.corner);
    }
  }
  return std::nullopt;
}

void SurfaceEditor::split_above(double factor, const EdgeTarget& target) {
  std::priority_queue<QueuedEdge> queue;
  // Sides that come before their turn, the last one first, and all that did.
  std::vector<QueuedEdge> before;
  std::set<std::pair<int, int>> longer;
  const auto push = [&](int a, int b) {
    const double r = ratio(a, b, target);
    if (r > factor) {
      queue.emplace(r, std::min(a, b), std::max(a, b));
    }
  };
  for_each_edge(push);
  const double most =
      static_cast<double>(mesh_.facets.size()) + most_facets(target);
  const auto take_next = [&] {
    const QueuedEdge next = before.empty() ? queue.top() : before.back();
    if (before.empty()) {
      queue.pop();
    } else {
      before.pop_back();
    }
    return next;
  };
  while (!queue.empty() || !before.empty()) {
    heed_stop("film");
    const auto [r, a, b] = take_next();
    if (static_cast<double>(mesh_.facets.size()) > most) {
      const Vec3& near = mesh_.points[a];
      throw InvalidInput(fmt::format(
          "the film takes more than {:.2g} facets at edges of {:.4g} and still "
          "more, here near ({:.4g}, {:.4g}, {:.4g}); films that lie on each "
          "other do that, or a number of an edge or a curve that is wrong",
          most, target.edge, near.x(), near.y(), near.z()));
    }
    if (!gather(a, b)) {
      continue;
    }
    // Longer sides that are still there stay: halving beside them would go on
    // for ever.
    double longest = 0.0;
    for (const Wing& wing : wings_) {
      longest = std::max({longest, ratio(a, wing.corner, target),
                          ratio(b, wing.corner, target)});
    }
    const films::PlacedVertex made = middle(a, b, line(a, b));
    // Of a needle whose wanted lengths differ from end to end the side with the
    // largest ratio may not be the longest. The new edge across would be as
    // long as the one that is halved, and so on without end: its longest side
    // is first (Rivara, International Journal for Numerical Methods in
    // Engineering 20, 1984), wanted or not; where that cannot be halved this
    // edge stays as well.
    if (const auto side = longer_side(a, b, made.place)) {
      if (longer.insert(*side).second) {
        before.emplace_back(r, a, b);
        before.emplace_back(std::numeric_limits<double>::infinity(),
                            side->first, side->second);
      }
      continue;
    }
    const double half = kHalf * (mesh_.points[a] - mesh_.points[b]).norm();
    if (longest > (1.0 + 1e-12) * r ||
        (made.place - mesh_.points[a]).norm() > half ||
        (made.place - mesh_.points[b]).norm() > half) {
      continue;
    }
    const int m = static_cast<int>(mesh_.points.size());
    split(a, b, made);
    push(a, m);
    push(b, m);
    for (const Wing& wing : wings_) {
      push(wing.corner, m);
    }
  }
}

// The link condition on the whole complex, frozen facets included: the links
// of the ends have in common what is the link of the edge; on lines likewise.
bool SurfaceEditor::link_allows(int gone, int kept) const {
  const auto beside = [&](int v) {
    return std::any_of(wings_.begin(), wings_.end(),
                       [&](const Wing& wing) { return wing.corner == v; });
  };
  for (const int f : star_[gone]) {
    int others = 0;
    std::array<int, 2> far{};
    bool dies = false;
    for (const int v : mesh_.facets[f]) {
      dies = dies || v == kept;
      if (v != gone && v != kept) {
        far[others++] = v;
        if (!beside(v) && has_edge(kept, v)) {
          return false;
        }
      }
    }
    if (!dies && beside(far[0]) && beside(far[1]) &&
        has_facet(kept, far[0], far[1])) {
      return false;
    }
  }
  return std::none_of(lines_[gone].begin(), lines_[gone].end(),
                      [&](const LineEnd& end) {
                        return end.to != kept && line(kept, end.to) != nullptr;
                      });
}

bool SurfaceEditor::can_collapse(int gone, int kept, const Vec3& place,
                                 double longest,
                                 const EdgeTarget& target) const {
  double before = kLeastTangent;
  double after = kLeastTangent;
  for (const int end : {gone, kept}) {
    const int other = end == gone ? kept : gone;
    if (end == kept && rank_[kept] > rank_[gone]) {
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
            (p[k] - place).norm() > longest * target.at(0.5 * (p[k] + place))) {
          return false;
        }
      }
      before = std::min(before, films::smallest_tangent(mesh_.points[t[0]],
                                                        mesh_.points[t[1]],
                                                        mesh_.points[t[2]]));
      if (dies) {
        continue;
      }
      const Vec3 old = normal2(f);
      const Vec3 now = (p[1] - p[0]).cross(p[2] - p[0]);
      const double bound = old.norm() * now.norm();
      if (!(old.dot(now) > kTurnCosine * bound)) {
        return false;
      }
      after = std::min(after, films::smallest_tangent(p[0], p[1], p[2]));
    }
  }
  return after >= before;
}

void SurfaceEditor::move_lines(int gone, int kept) {
  for (const LineEnd& end : std::vector<LineEnd>(lines_[gone])) {
    if (end.to == kept) {
      auto& ends = lines_[kept];
      ends.erase(std::find_if(ends.begin(), ends.end(),
                              [&](const LineEnd& e) { return e.to == gone; }));
      if (end.mark >= 0) {
        marks_[end.mark].a = -1;
      }
      continue;
    }
    line_end(end.to, gone).to = kept;
    lines_[kept].push_back(end);
    if (end.mark >= 0) {
      films::ComplexEdge& mark = marks_[end.mark];
      (mark.a == gone ? mark.a : mark.b) = kept;
    }
  }
  lines_[gone].clear();
}

void SurfaceEditor::collapse(int gone, int kept,
                             const films::PlacedVertex& place) {
  for (const Wing& wing : wings_) {
    for (const int v : Triangle(mesh_.facets[wing.facet])) {
      drop_from_star(v, wing.facet);
    }
    mesh_.facets[wing.facet] = {-1, -1, -1};
  }
  for (const int f : star_[gone]) {
    replace_corner(f, gone, kept);
    star_[kept].push_back(f);
  }
  changed_[kept] = 1;
  star_[gone].clear();
  move_lines(gone, kept);
  mesh_.points[kept] = place.place;
  complex_.vertices[kept] = place.vertex;
}

// Collapses the gathered edge where that is allowed.
bool SurfaceEditor::try_collapse(int a, int b, double longest,
                                 const EdgeTarget& target, int& kept) {
  kept = rank_[a] >= rank_[b] ? a : b;
  const int gone = kept == a ? b : a;
  const LineEnd* on = line(a, b);
  const films::ComplexVertex& goes = complex_.vertices[gone];
  const films::ComplexVertex& stays = complex_.vertices[kept];
  if (rank_[gone] == Rank::Held ||
      (rank_[gone] == Rank::Line && on == nullptr) ||
      (rank_[gone] == Rank::Wall && goes.constraints != stays.constraints)) {
    return false;
  }
  films::PlacedVertex place = placed(kept);
  if (rank_[gone] == rank_[kept]) {
    place = middle(a, b, on);
    if (rank_[gone] == Rank::Wall) {
      place.vertex = stays;
      place.vertex.held = goes.held && stays.held;
      place.place = films::onto_walls(complex_, stays.constraints,
                                      place.vertex.held, place.place);
    }
  }
  if (!link_allows(gone, kept) ||
      !can_collapse(gone, kept, place.place, longest, target)) {
    return false;
  }
  collapse(gone, kept, place);
  return true;
}

void SurfaceEditor::collapse_below(double factor, double longest,
                                   const EdgeTarget& target) {
  std::priority_queue<QueuedEdge, std::vector<QueuedEdge>, std::greater<>>
      queue;
  const auto push = [&](int a, int b) {
    const double r = ratio(a, b, target);
    if (r < factor) {
      queue.emplace(r, std::min(a, b), std::max(a, b));
    }
  };
  for_each_edge(push);
  while (!queue.empty()) {
    heed_stop("film");
    const auto [r, a, b] = queue.top();
    queue.pop();
    int kept = -1;
    if (ratio(a, b, target) != r || !gather(a, b) ||
        !try_collapse(a, b, longest, target, kept)) {
      continue;
    }
    for (const int f : star_[kept]) {
      const Triangle& t = mesh_.facets[f];
      const int k = t[0] == kept ? 0 : t[1] == kept ? 1 : 2;
      push(kept, t[(k + 1) % 3]);
    }
    for (const LineEnd& end : lines_[kept]) {
      push(kept, end.to);
    }
  }
}

}  // namespace meniscus::groom
