#include "core/geometry/mesh_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

#include "core/geometry/chambers.h"
#include "core/geometry/edge_uses.h"
#include "core/geometry/facet_pairs.h"
#include "core/geometry/findings.h"
#include "core/heed_stop.h"

namespace meniscus {

namespace {

// Sound surfaces need about 60 box comparisons a facet, fans some more.
constexpr std::int64_t kStepsPerFacet = 200;
constexpr std::int64_t kFreeSteps = 2'000'000;
constexpr std::size_t kMostFacetsNamed = 8;

class Checker {
 public:
  Checker(const SurfaceMesh& mesh, const SurfaceCheckOptions& options)
      : mesh_(mesh), options_(options) {}

  std::vector<Finding> run() {
    check_corners();
    check_duplicates();
    check_shapes();
    check_edges();
    check_pairs();
    check_nesting();
    std::stable_sort(
        found_.begin(), found_.end(),
        [](const Finding& a, const Finding& b) { return a.facets < b.facets; });
    if (found_.size() > most()) {
      found_.resize(most());
    }
    for (Finding& finding : found_) {
      describe(mesh_, finding);
    }
    return std::move(found_);
  }

 private:
  std::size_t most() const {
    return static_cast<std::size_t>(std::max(options_.max_findings, 0));
  }
  int facet_count() const { return static_cast<int>(mesh_.facets.size()); }

  bool add(FindingKind kind, std::vector<int> facets, const Vec3& position) {
    if (++count_[kind] > most()) {
      return false;
    }
    if (facets.size() > kMostFacetsNamed) {
      facets.resize(kMostFacetsNamed);
    }
    found_.push_back({kind, std::move(facets), position, {}});
    return true;
  }

  Vec3 centre(int facet) const {
    const Triangle& t = mesh_.facets[facet];
    return (mesh_.points[t[0]] + mesh_.points[t[1]] + mesh_.points[t[2]]) / 3.0;
  }

  bool bodies_sound(int facet) const {
    if (mesh_.facet_bodies.empty()) {
      return true;
    }
    if (facet >= static_cast<int>(mesh_.facet_bodies.size())) {
      return false;
    }
    const FacetBodies& b = mesh_.facet_bodies[facet];
    return b.behind >= 0 && b.front >= -1 && b.behind != b.front &&
           std::max(b.behind, b.front) < facet_count();
  }

  // Facets with sound corners; nothing else is looked at afterwards.
  void check_corners() {
    const int points = static_cast<int>(mesh_.points.size());
    const int labels = static_cast<int>(mesh_.labels.size());
    usable_.assign(mesh_.facets.size(), 0);
    Points finite;
    for (const Vec3& p : mesh_.points) {
      if (p.allFinite()) {
        finite.push_back(p);
      }
    }
    tolerance_ = options_.closeness * bounding_diagonal(finite);
    for (int f = 0; f < facet_count(); ++f) {
      const Triangle& t = mesh_.facets[f];
      const bool inside = std::all_of(
          t.begin(), t.end(), [&](int v) { return v >= 0 && v < points; });
      const bool labelled = f < static_cast<int>(mesh_.facet_label.size()) &&
                            mesh_.facet_label[f] >= 0 &&
                            mesh_.facet_label[f] < labels;
      if (!inside || !labelled || !bodies_sound(f)) {
        add(FindingKind::BadIndex, {f}, inside ? centre(f) : Vec3::Zero());
      } else if (!mesh_.points[t[0]].allFinite() ||
                 !mesh_.points[t[1]].allFinite() ||
                 !mesh_.points[t[2]].allFinite()) {
        add(FindingKind::NotFinite, {f}, centre(f));
      } else if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        add(FindingKind::Degenerate, {f}, centre(f));
      } else {
        usable_[f] = 1;
      }
    }
  }

  void check_duplicates() {
    std::vector<std::tuple<Triangle, int>> sorted;
    sorted.reserve(mesh_.facets.size());
    for (int f = 0; f < facet_count(); ++f) {
      if (usable_[f] != 0) {
        Triangle t = mesh_.facets[f];
        std::sort(t.begin(), t.end());
        sorted.emplace_back(t, f);
      }
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (std::get<0>(sorted[i]) == std::get<0>(sorted[i - 1])) {
        const int f = std::get<1>(sorted[i - 1]);
        add(FindingKind::Duplicate, {f, std::get<1>(sorted[i])}, centre(f));
      }
    }
  }

  void check_shapes() {
    shaped_ = usable_;
    const double least = options_.needle_angle_deg * std::numbers::pi / 180.0;
    for (int f = 0; f < facet_count(); ++f) {
      if (usable_[f] == 0) {
        continue;
      }
      const Triangle& t = mesh_.facets[f];
      const double twice_area = area_vector2(mesh_, f).norm();
      double angle = std::numbers::pi;
      for (int k = 0; k < 3; ++k) {
        const Vec3& p = mesh_.points[t[k]];
        const Vec3 u = mesh_.points[t[(k + 1) % 3]] - p;
        const Vec3 v = mesh_.points[t[(k + 2) % 3]] - p;
        angle = std::min(angle, std::atan2(twice_area, u.dot(v)));
      }
      if (!(angle >= least) || !(twice_area > 0.0)) {
        shaped_[f] = 0;
        add(FindingKind::Degenerate, {f}, centre(f));
      }
    }
  }

  void check_edges() {
    for_each_edge(mesh_, usable_, [&](std::span<EdgeUse> uses) {
      if (const auto kind = fault_of(uses)) {
        std::vector<int> facets;
        for (const EdgeUse& use : uses) {
          facets.push_back(use.facet);
        }
        std::sort(facets.begin(), facets.end());
        const Edge& e = uses[0].edge;
        add(*kind, std::move(facets),
            0.5 * (mesh_.points[e[0]] + mesh_.points[e[1]]));
      }
    });
  }

  std::optional<FindingKind> fault_of(std::span<EdgeUse> uses) const {
    if (uses.size() == 1) {
      return FindingKind::OpenEdge;
    }
    if (uses.size() > 2) {
      std::vector<int> bodies;
      for (const EdgeUse& use : uses) {
        bodies.push_back(body_of_side(mesh_, 2 * use.facet));
        bodies.push_back(body_of_side(mesh_, 2 * use.facet + 1));
      }
      std::sort(bodies.begin(), bodies.end());
      for (std::size_t i = 2; i < bodies.size(); ++i) {
        if (bodies[i] >= 0 && bodies[i] == bodies[i - 2]) {
          return FindingKind::NonManifoldEdge;
        }
      }
      sort_around(mesh_, uses);
    }
    for (std::size_t i = 0; i < uses.size(); ++i) {
      const EdgeUse& next = uses[(i + 1) % uses.size()];
      if (body_of_side(mesh_, uses[i].side_after()) !=
          body_of_side(mesh_, next.side_before())) {
        const bool turned =
            uses.size() == 2 && uses[0].forward == uses[1].forward;
        return turned ? FindingKind::Misoriented : FindingKind::BodyMismatch;
      }
    }
    return std::nullopt;
  }

  void check_pairs() {
    std::vector<int> facets;
    for (int f = 0; f < facet_count(); ++f) {
      if (shaped_[f] != 0) {
        facets.push_back(f);
      }
    }
    int last = -1;
    const bool finished = for_each_near_pair(
        mesh_, facets, tolerance_,
        [&](int f, int g) {
          last = f;
          heed_stop("mesh");
          const PairVerdict verdict = classify_pair(mesh_, f, g, tolerance_);
          return verdict.state == PairState::Apart ||
                 add(verdict.state == PairState::Crossing
                         ? FindingKind::Crossing
                         : FindingKind::TooClose,
                     {f, g}, verdict.position);  // a soup ends here
        },
        kFreeSteps + kStepsPerFacet * facet_count());
    if (!finished && last >= 0) {
      add(FindingKind::Crowded, {last}, centre(last));
    }
  }

  // Closed parts must float in what the outsides of their facets say.
  void check_nesting() {
    for (const auto& [kind, count] : count_) {
      if (kind != FindingKind::Degenerate && kind != FindingKind::TooClose) {
        return;
      }
    }
    if (mesh_.facets.empty()) {
      return;
    }
    std::vector<int> facets(mesh_.facets.size());
    std::iota(facets.begin(), facets.end(), 0);
    const Chambers chambers = find_chambers(mesh_);
    const FacetTree tree(mesh_, facets);
    const auto around = find_surroundings(mesh_, chambers, tree);
    for (const Shell& shell : chambers.shells) {
      const auto& outside = around[shell.part];
      if (shell.volume > 0.0 || !outside || outside->body == shell.body) {
        continue;
      }
      if (shell.body >= 0 && outside->body < 0) {
        add(FindingKind::NegativeVolume, {shell.facet}, centre(shell.facet));
      } else {
        add(FindingKind::BadNesting, {shell.facet, outside->facet},
            centre(shell.facet));
      }
    }
  }

  const SurfaceMesh& mesh_;
  const SurfaceCheckOptions& options_;
  double tolerance_ = 0.0;
  std::vector<Finding> found_;
  std::map<FindingKind, std::size_t> count_;  // also of those not kept
  std::vector<char> usable_;                  // per facet: sound corners
  std::vector<char> shaped_;  // per facet: sound corners and an area
};

}  // namespace

std::vector<Finding> check_surface(const SurfaceMesh& mesh,
                                   const SurfaceCheckOptions& options) {
  return Checker(mesh, options).run();
}

}  // namespace meniscus
