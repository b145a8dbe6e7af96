#include "core/mesh_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/facet_pairs.h"

namespace meniscus {

namespace {

struct Words {
  const char* what;
  const char* advice;
};

Words words_of(FindingKind kind) {
  switch (kind) {
    case FindingKind::NotFinite:
      return {"has a coordinate that is not finite",
              "look for a division by zero in the curves"};
    case FindingKind::BadIndex:
      return {"names a point or label that does not exist",
              "the file or its reader is damaged"};
    case FindingKind::OpenEdge:
      return {"has an open edge", "close the surface there with a cap or film"};
    case FindingKind::NonManifoldEdge:
      return {"shares an edge with more than one other",
              "leave out surfaces that do not bound the body"};
    case FindingKind::Misoriented:
      return {"runs the same way as its neighbour along their edge",
              "turn one of the two surfaces"};
    case FindingKind::Duplicate:
      return {"lies on another with the same corners", "remove one of them"};
    case FindingKind::Degenerate:
      return {"is a needle or has no area",
              "remesh the film or use another "
              "edge length"};
    case FindingKind::Crossing:
      return {"crosses or overlaps another",
              "move the curves apart or give the body another volume"};
    case FindingKind::TooClose:
      return {"nearly touches another",
              "move the curves apart or give the body another volume"};
    case FindingKind::NegativeVolume:
      return {"belongs to a closed part that is inside out",
              "turn the facets of that part"};
  }
  return {"", ""};
}

class Checker {
 public:
  Checker(const SurfaceMesh& mesh, const SurfaceCheckOptions& options)
      : mesh_(mesh), options_(options) {}

  std::vector<Finding> run() {
    check_corners();
    check_duplicates();
    check_shapes();
    check_edges();
    check_volumes();
    check_pairs();
    std::stable_sort(
        found_.begin(), found_.end(),
        [](const Finding& a, const Finding& b) { return a.facets < b.facets; });
    if (found_.size() > most()) {
      found_.resize(most());
    }
    return std::move(found_);
  }

 private:
  std::size_t most() const {
    return static_cast<std::size_t>(std::max(options_.max_findings, 0));
  }

  std::string surface_of(int facet) const {
    if (facet >= static_cast<int>(mesh_.facet_label.size())) {
      return "?";
    }
    const int label = mesh_.facet_label[facet];
    const bool known =
        label >= 0 && label < static_cast<int>(mesh_.labels.size());
    return known ? mesh_.labels[label] : "?";
  }

  void add(FindingKind kind, std::vector<int> facets, const Vec3& position) {
    std::string others;
    for (std::size_t i = 1; i < facets.size(); ++i) {
      others += fmt::format("{}{} ('{}')", i == 1 ? " with facet " : ", ",
                            facets[i], surface_of(facets[i]));
    }
    const Words words = words_of(kind);
    std::string message =
        fmt::format("facet {} ('{}') {}{} at ({:.6g}, {:.6g}, {:.6g}): {}",
                    facets[0], surface_of(facets[0]), words.what, others,
                    position.x(), position.y(), position.z(), words.advice);
    found_.push_back({kind, std::move(facets), position, std::move(message)});
  }

  Vec3 centre(int facet) const {
    const Triangle& t = mesh_.facets[facet];
    return (mesh_.points[t[0]] + mesh_.points[t[1]] + mesh_.points[t[2]]) / 3.0;
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
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      const Triangle& t = mesh_.facets[f];
      const bool inside = std::all_of(
          t.begin(), t.end(), [&](int v) { return v >= 0 && v < points; });
      const bool labelled = f < static_cast<int>(mesh_.facet_label.size()) &&
                            mesh_.facet_label[f] >= 0 &&
                            mesh_.facet_label[f] < labels;
      if (!inside || !labelled) {
        add(FindingKind::BadIndex, {f}, Vec3::Zero());
        continue;
      }
      if (!mesh_.points[t[0]].allFinite() || !mesh_.points[t[1]].allFinite() ||
          !mesh_.points[t[2]].allFinite()) {
        add(FindingKind::NotFinite, {f}, centre(f));
        continue;
      }
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        add(FindingKind::Degenerate, {f}, centre(f));
        continue;
      }
      usable_[f] = 1;
    }
  }

  void check_duplicates() {
    std::vector<std::tuple<Triangle, int>> sorted;
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
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
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
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

  struct Use {
    Edge edge;
    int facet;
    bool forward;
    bool operator<(const Use& other) const {
      return std::tie(edge, facet) < std::tie(other.edge, other.facet);
    }
  };

  int root(int facet) {
    while (part_[facet] != facet) {
      part_[facet] = part_[part_[facet]];
      facet = part_[facet];
    }
    return facet;
  }

  void check_edges() {
    std::vector<Use> uses;
    part_.resize(mesh_.facets.size());
    std::iota(part_.begin(), part_.end(), 0);
    sealed_.assign(mesh_.facets.size(), 1);
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      for (int k = 0; usable_[f] != 0 && k < 3; ++k) {
        const int a = mesh_.facets[f][k];
        const int b = mesh_.facets[f][(k + 1) % 3];
        uses.push_back({{std::min(a, b), std::max(a, b)}, f, a < b});
      }
    }
    std::sort(uses.begin(), uses.end());
    for (std::size_t i = 0; i < uses.size();) {
      std::size_t j = i;
      while (j < uses.size() && uses[j].edge == uses[i].edge) {
        part_[root(uses[j].facet)] = root(uses[i].facet);
        ++j;
      }
      if (j - i == 1) {
        add_edge(FindingKind::OpenEdge, uses, i, j);
      } else if (j - i > 2) {
        add_edge(FindingKind::NonManifoldEdge, uses, i, j);
      } else if (uses[i].forward == uses[i + 1].forward) {
        add_edge(FindingKind::Misoriented, uses, i, j);
      }
      i = j;
    }
  }

  void add_edge(FindingKind kind, const std::vector<Use>& uses,
                std::size_t first, std::size_t last) {
    std::vector<int> facets;
    for (std::size_t i = first; i < last; ++i) {
      facets.push_back(uses[i].facet);
      sealed_[uses[i].facet] = 0;
    }
    const Edge& e = uses[first].edge;
    add(kind, std::move(facets),
        0.5 * (mesh_.points[e[0]] + mesh_.points[e[1]]));
  }

  // Closed parts must run outward, but hollows inside others inward.
  void check_volumes() {
    std::vector<double> volume(mesh_.facets.size(), 0.0);
    std::vector<char> closed(mesh_.facets.size(), 1);
    std::vector<int> roots;
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      if (usable_[f] == 0) {
        continue;
      }
      const int part = root(f);
      const Triangle& t = mesh_.facets[f];
      const Vec3& origin = mesh_.points[mesh_.facets[part][0]];
      volume[part] += (mesh_.points[t[0]] - origin)
                          .dot((mesh_.points[t[1]] - origin)
                                   .cross(mesh_.points[t[2]] - origin));
      closed[part] = closed[part] != 0 && sealed_[f] != 0 ? 1 : 0;
      if (part == f) {
        roots.push_back(f);
      }
    }
    std::size_t asked = 0;
    for (const int part : roots) {
      if (asked == most()) {
        return;  // each question costs a pass over all facets
      }
      asked += closed[part] != 0 && volume[part] < 0.0 ? 1 : 0;
      if (closed[part] != 0 && volume[part] < 0.0 &&
          parts_around(part, roots, closed) % 2 == 0) {
        add(FindingKind::NegativeVolume, {part}, centre(part));
      }
    }
  }

  // Closed parts that have the given one inside, by their solid angle.
  int parts_around(int part, const std::vector<int>& roots,
                   const std::vector<char>& closed) {
    const Vec3 point = mesh_.points[mesh_.facets[part][0]];
    std::vector<double> angle(mesh_.facets.size(), 0.0);
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      if (usable_[f] == 0 || root(f) == part) {
        continue;
      }
      const Triangle& t = mesh_.facets[f];
      const Vec3 a = mesh_.points[t[0]] - point;
      const Vec3 b = mesh_.points[t[1]] - point;
      const Vec3 c = mesh_.points[t[2]] - point;
      const double la = a.norm();
      const double lb = b.norm();
      const double lc = c.norm();
      angle[root(f)] += 2.0 * std::atan2(a.dot(b.cross(c)),
                                         la * lb * lc + a.dot(b) * lc +
                                             b.dot(c) * la + c.dot(a) * lb);
    }
    return static_cast<int>(
        std::count_if(roots.begin(), roots.end(), [&](int other) {
          return closed[other] != 0 && std::abs(angle[other]) > 6.0;
        }));
  }

  void check_pairs() {
    std::vector<int> facets;
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      if (shaped_[f] != 0) {
        facets.push_back(f);
      }
    }
    std::size_t count = 0;
    for_each_near_pair(mesh_, std::move(facets), tolerance_, [&](int f, int g) {
      const PairVerdict verdict = judge_pair(mesh_, f, g, tolerance_);
      if (verdict.state != PairState::Apart) {
        add(verdict.state == PairState::Crossing ? FindingKind::Crossing
                                                 : FindingKind::TooClose,
            {f, g}, verdict.position);
        ++count;
      }
      return count < most();  // a soup of crossings ends here
    });
  }

  const SurfaceMesh& mesh_;
  const SurfaceCheckOptions& options_;
  double tolerance_ = 0.0;
  std::vector<Finding> found_;
  std::vector<char> usable_;  // per facet: sound corners
  std::vector<char> shaped_;  // per facet: sound corners and an area
  std::vector<char> sealed_;  // per facet: no faulty edge
  std::vector<int> part_;     // per facet: union-find of connected parts
};

}  // namespace

std::vector<Finding> check_surface(const SurfaceMesh& mesh,
                                   const SurfaceCheckOptions& options) {
  return Checker(mesh, options).run();
}

std::string summary(const std::vector<Finding>& findings, int most) {
  std::string text;
  const int shown = std::min(static_cast<int>(findings.size()), most);
  for (int i = 0; i < shown; ++i) {
    text += (i == 0 ? "" : ". ") + findings[i].message;
  }
  const int left = static_cast<int>(findings.size()) - std::max(shown, 0);
  if (left > 0) {
    text += fmt::format("{}{} findings{}", shown > 0 ? "; and " : "", left,
                        shown > 0 ? " more" : "");
  }
  return text;
}

}  // namespace meniscus
