#include "mesh_tet/improve_tets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/heed_stop.h"
#include "mesh_tet/tet_cavity.h"
#include "mesh_tet/tet_editor.h"

namespace meniscus::mesh_tet {

namespace {

constexpr std::size_t kLongestRing = 7;
// Of the merit; a flip costs nothing. What replaces elements without volume,
// whose merit is below 0, must have some.
constexpr double kFlipGain = 1.05;
double flip_floor(double merit) { return kFlipGain * std::max(merit, 0.0); }
// A few seconds where most elements are bad, as in plates of one layer; some
// ten evaluations an element are usual.
constexpr std::int64_t kFreeEvaluations = 20'000'000;
constexpr std::int64_t kEvaluationsPerElement = 300;
constexpr double kNodeGain = 1.44;  // worth a node: 20 % of the sine

/// Along the axes and the diagonals of space.
std::array<Vec3, 14> make_directions() {
  std::array<Vec3, 14> d;
  int n = 0;
  for (int axis = 0; axis < 3; ++axis) {
    d[n++] = Vec3::Unit(axis);
    d[n++] = -Vec3::Unit(axis);
  }
  for (int corner = 0; corner < 8; ++corner) {
    d[n++] = Vec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                  (corner & 4) != 0 ? 1 : -1) /
             std::numbers::sqrt3;
  }
  return d;
}

/// The triangulation of a ring whose elements, up to a and down to b, have
/// the best worst merit: by dynamic programming over its chords.
class RingFiller {
 public:
  RingFiller(const TetEditor& tets, int a, int b, const std::vector<int>& ring,
             double floor)
      : tets_(tets), a_(a), b_(b), ring_(ring), floor_(floor) {}

  /// The elements, none when no triangulation is above the floor.
  std::vector<TetNodes> fill() {
    const std::size_t n = ring_.size();
    for (std::size_t span = 2; span < n; ++span) {
      for (std::size_t i = 0; i + span < n; ++i) {
        choose(i, i + span);
      }
    }
    std::vector<TetNodes> fresh;
    if (merit_[0][n - 1] > floor_) {
      collect(0, n - 1, fresh);
    }
    return fresh;
  }

 private:
  TetNodes above(std::size_t i, std::size_t j, std::size_t k) const {
    return {ring_[i], ring_[j], ring_[k], b_};
  }
  TetNodes below(std::size_t i, std::size_t j, std::size_t k) const {
    return {ring_[i], ring_[k], ring_[j], a_};
  }

  void choose(std::size_t i, std::size_t k) {
    double& best = merit_[i][k];
    best = -2.0;
    for (std::size_t j = i + 1; j < k; ++j) {
      double merit = std::min(part(i, j), part(j, k));
      if (merit > std::max(best, floor_)) {
        merit = std::min(merit, tets_.merit_of(above(i, j, k)));
      }
      if (merit > std::max(best, floor_)) {
        merit = std::min(merit, tets_.merit_of(below(i, j, k)));
      }
      if (merit > best) {
        best = merit;
        middle_[i][k] = j;
      }
    }
  }
  double part(std::size_t i, std::size_t j) const {
    return j == i + 1 ? 2.0 : merit_[i][j];
  }
  void collect(std::size_t i, std::size_t k, std::vector<TetNodes>& fresh) {
    if (k == i + 1) {
      return;
    }
    const std::size_t j = middle_[i][k];
    fresh.push_back(above(i, j, k));
    fresh.push_back(below(i, j, k));
    collect(i, j, fresh);
    collect(j, k, fresh);
  }

  using Table = std::array<std::array<double, kLongestRing>, kLongestRing>;
  const TetEditor& tets_;
  int a_, b_;
  const std::vector<int>& ring_;
  double floor_;
  Table merit_{};
  std::array<std::array<std::size_t, kLongestRing>, kLongestRing> middle_{};
};

class Improver {
 public:
  Improver(TetMesh& mesh, int fixed, double bound)
      : tets_(mesh, fixed),
        bound_(bound),
        budget_(kFreeEvaluations +
                kEvaluationsPerElement * mesh.element_count()),
        directions_(make_directions()),
        settled_(mesh.nodes.size(), 0) {}

  /// One pass over the bad elements; the number of changes.
  int sweep(ImproveReport& report) {
    std::vector<int> bad;
    for (int e = 0; e < tets_.element_count(); ++e) {
      if (is_bad(e)) {
        bad.push_back(e);
      }
    }
    const ImproveReport before = report;
    for (const int e : bad) {
      heed_stop("mesh");
      if (tets_.evaluations() > budget_) {
        return 0;
      }
      mend(e, report);
    }
    return report.moved - before.moved + report.flipped - before.flipped +
           report.added - before.added;
  }

  void finish() { tets_.finish(); }

 private:
  bool is_bad(int e) const { return tets_.alive(e) && tets_.merit(e) < bound_; }

  void mend(int e, ImproveReport& report) {
    for (int k = 0; k < 4 && is_bad(e); ++k) {
      const int node = tets_.nodes(e)[k];
      if (!tets_.is_fixed(node) && settled_[node] == 0 && smooth(node)) {
        ++report.moved;
      }
    }
    tried_.resize(tets_.element_count(), 0);
    if (!is_bad(e) || settled(e)) {
      return;
    }
    const double before = tets_.merit(e);
    if (remove_edge(e) || remove_face(e)) {
      ++report.flipped;
    } else if (split_edge(e) || insert_node(e)) {
      ++report.added;
    }
    if (tets_.alive(e) && tets_.merit(e) == before) {
      tried_[e] = 1;
    }
  }

  /// Whether e was tried with the nodes where they are.
  bool settled(int e) const {
    return tried_[e] != 0 && std::ranges::all_of(tets_.nodes(e), [&](int node) {
             return tets_.is_fixed(node) || settled_[node] != 0;
           });
  }

  double star_size(int node) const {
    double sum = 0.0;
    for (const int e : tets_.star(node)) {
      for (const int other : tets_.nodes(e)) {
        sum += (tets_.point(other) - tets_.point(node)).norm();
      }
    }
    return sum / (3.0 * static_cast<double>(tets_.star(node).size()));
  }

  void unsettle(std::span<const int> elements) {
    tried_.resize(tets_.element_count(), 0);
    for (const int e : elements) {
      tried_[e] = 0;
      for (const int node : tets_.nodes(e)) {
        settled_[node] = 0;
      }
    }
  }

  /// Pattern search for the position with the best worst element.
  bool smooth(int node) {
    constexpr int kHalvings = 6;
    constexpr double kFirstStep = 0.3;  // x mean distance of neighbours
    const double before = tets_.star_merit(node);
    double best = before;
    Vec3 place = tets_.point(node);
    double step = kFirstStep * star_size(node);
    for (int halving = 0; halving < kHalvings && best < 4.0 * bound_;
         ++halving) {
      while (try_step(node, step, best, place)) {
      }
      step *= 0.5;
    }
    if (best > before) {
      tets_.move(node, place);
      unsettle(tets_.star(node));
    }
    settled_[node] = 1;
    return best > before;
  }

  /// Takes the best of the steps if it gains noticeably.
  bool try_step(int node, double step, double& best, Vec3& place) {
    constexpr double kNoticeable = 1e-3;  // of the bound
    const Vec3 from = place;
    double found = best + kNoticeable * bound_;
    bool gained = false;
    for (const Vec3& direction : directions_) {
      const Vec3 to = from + step * direction;
      const double merit = tets_.star_merit_at(node, to, found);
      if (merit > found) {
        found = merit;
        place = to;
        gained = true;
      }
    }
    best = gained ? found : best;
    return gained;
  }

  /// Whether the face or the edges within a ring that `fresh` makes are not in
  /// the mesh yet.
  bool is_new(const std::vector<int>& ring,
              const std::vector<TetNodes>& fresh) const {
    if (ring.size() == 3) {
      return !tets_.has(ring);
    }
    const auto place = [&](int node) {
      return std::find(ring.begin(), ring.end(), node) - ring.begin();
    };
    for (const TetNodes& nodes : fresh) {
      for (int k = 0; k < 3; ++k) {
        const Edge edge = {nodes[k], nodes[(k + 1) % 3]};
        const auto apart = std::abs(place(edge[0]) - place(edge[1]));
        if (apart != 1 && apart != std::ssize(ring) - 1 && tets_.has(edge)) {
          return false;
        }
      }
    }
    return true;
  }

  bool remove_edge(int e) {
    const TetNodes ids = tets_.nodes(e);
    for (const Edge& edge : kTetEdges) {
      const int a = ids[edge[0]];
      const int b = ids[edge[1]];
      const auto ring = tets_.ring(a, b);
      if (!ring || ring->nodes.size() > kLongestRing) {
        continue;
      }
      RingFiller filler(tets_, a, b, ring->nodes, flip_floor(ring->merit));
      const std::vector<TetNodes> fresh = filler.fill();
      if (!fresh.empty() && is_new(ring->nodes, fresh)) {
        unsettle(ring->elements);
        tets_.replace(ring->elements, fresh);
        return true;
      }
    }
    return false;
  }

  /// Two elements become three about the edge between their apexes.
  bool remove_face(int e) {
    for (int corner = 0; corner < 4; ++corner) {
      const int other = tets_.neighbour(e, corner);
      if (other < 0) {
        continue;
      }
      const TetNodes ids = tets_.nodes(e);
      const auto& face = kTetFaces[corner];
      const std::array<int, 3> ends = {ids[face[0]], ids[face[1]],
                                       ids[face[2]]};
      int apex = -1;
      for (const int node : tets_.nodes(other)) {
        apex = std::find(ends.begin(), ends.end(), node) == ends.end() ? node
                                                                       : apex;
      }
      // The face is counter-clockwise seen from the apex.
      std::array<TetNodes, 3> fresh;
      double merit = 2.0;
      for (int k = 0; k < 3; ++k) {
        fresh[k] = {ids[corner], apex, ends[k], ends[(k + 1) % 3]};
        merit = std::min(merit, tets_.merit_of(fresh[k]));
      }
      const double before = std::min(tets_.merit(e), tets_.merit(other));
      const Edge edge = {ids[corner], apex};
      if (merit > flip_floor(before) && !tets_.has(edge)) {
        const std::array<int, 2> old = {e, other};
        unsettle(old);
        tets_.replace(old, fresh);
        return true;
      }
    }
    return false;
  }

  /// Tries the inner edges of a bad element, longest first.
  bool split_edge(int e) {
    const TetNodes ids = tets_.nodes(e);
    std::array<std::pair<double, int>, 6> order;
    for (int k = 0; k < 6; ++k) {
      const auto [i, j] = kTetEdges[k];
      order[k] = {-(tets_.point(ids[i]) - tets_.point(ids[j])).norm(), k};
    }
    std::sort(order.begin(), order.end());
    return std::any_of(order.begin(), order.end(), [&](const auto& entry) {
      const Edge& edge = kTetEdges[entry.second];
      return split(ids[edge[0]], ids[edge[1]]);
    });
  }

  /// A node in the middle of edge a-b, moved to its best place; undone when
  /// the worst element around is not better than before.
  bool split(int a, int b) {
    const auto ring = tets_.ring(a, b);
    if (!ring) {
      return false;
    }
    std::vector<int> taken = ring->elements;
    std::vector<TetNodes> old;
    std::vector<TetNodes> fresh;
    const int node = tets_.add_node(0.5 * (tets_.point(a) + tets_.point(b)));
    settled_.push_back(0);
    for (const int e : ring->elements) {
      TetNodes ids = tets_.nodes(e);
      old.push_back(ids);
      std::replace(ids.begin(), ids.end(), b, node);
      fresh.push_back(ids);
    }
    for (TetNodes ids : old) {
      std::replace(ids.begin(), ids.end(), a, node);
      fresh.push_back(ids);
    }
    const int first = tets_.element_count();
    tets_.replace(taken, fresh);
    for (int e = first; e < tets_.element_count(); ++e) {
      taken.push_back(e);
    }
    smooth(node);
    if (tets_.star_merit(node) > kNodeGain * std::max(ring->merit, 0.0)) {
      unsettle(taken);
      return true;
    }
    tets_.replace(taken, old);
    tets_.drop_last_node();
    settled_.pop_back();
    return false;
  }

  /// Whether `fresh` has the volume of the elements: a cavity with elements
  /// turned inside out may have a boundary that encloses another.
  bool fills(std::span<const int> elements,
             std::span<const TetNodes> fresh) const {
    constexpr double kRounding = 1e-9;
    double volume = 0.0;
    double sum = 0.0;
    const auto add = [&](const TetNodes& nodes, double sign) {
      const Vec3& origin = tets_.point(nodes[0]);
      const double part = (tets_.point(nodes[1]) - origin)
                              .cross(tets_.point(nodes[2]) - origin)
                              .dot(tets_.point(nodes[3]) - origin);
      volume += sign * part;
      sum += std::abs(part);
    };
    for (const int e : elements) {
      add(tets_.nodes(e), 1.0);
    }
    for (const TetNodes& nodes : fresh) {
      add(nodes, -1.0);
    }
    return std::abs(volume) <= kRounding * sum;
  }

  /// A node beside a bad element, most often one that lies flat on the
  /// surface, in the best of some cavities that take the bad one away.
  bool insert_node(int e) {
    const std::array<int, 1> seeds = {e};
    double floor = kNodeGain * std::max(tets_.merit(e), 0.0);
    std::optional<Cavity> best;
    Vec3 place;
    for (const Vec3& candidate : places_beside(tets_, e)) {
      auto cavity = grow_cavity(tets_, seeds, candidate, floor);
      if (cavity) {
        floor = std::max(floor, cavity->merit);
        best = std::move(cavity);
        place = candidate;
      }
    }
    if (!best) {
      return false;
    }
    const int node = tets_.add_node(place);
    settled_.push_back(0);
    std::vector<TetNodes> fresh;
    for (const auto& face : best->faces) {
      fresh.push_back({face[0], face[2], face[1], node});
    }
    if (!fills(best->elements, fresh)) {
      tets_.drop_last_node();
      settled_.pop_back();
      return false;
    }
    unsettle(best->elements);
    tets_.replace(best->elements, fresh);
    smooth(node);
    return true;
  }

  TetEditor tets_;
  double bound_;  // of the merit
  std::int64_t budget_;
  std::array<Vec3, 14> directions_;
  std::vector<char> settled_;  // nodes that gain nothing where they are
  std::vector<char> tried_;    // elements that nothing helped
};

}  // namespace

ImproveReport improve_tets(TetMesh& mesh, int fixed,
                           const ImproveOptions& options) {
  ImproveReport report;
  const double sine = std::sin(options.below_deg * std::numbers::pi / 180.0);
  Improver improver(mesh, fixed, sine * sine);
  for (int round = 0; round < options.rounds; ++round) {
    if (improver.sweep(report) == 0) {
      break;
    }
  }
  improver.finish();
  return report;
}

}  // namespace meniscus::mesh_tet
