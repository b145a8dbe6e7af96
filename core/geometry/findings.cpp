// What findings are called and what they say.
#include "core/geometry/findings.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/count_text.h"

namespace meniscus {

namespace {

struct Words {
  const char* name;
  const char* what;
  const char* advice;
};

Words words_of(FindingKind kind) {
  switch (kind) {
    case FindingKind::NotFinite:
      return {"not_finite", "has a coordinate that is not finite",
              "look for a division by zero in the curves"};
    case FindingKind::BadIndex:
      return {"bad_index", "names a point, label or body that does not exist",
              "the file or its reader is damaged"};
    case FindingKind::OpenEdge:
      return {"open_edge", "has an open edge",
              "close the surface there with a cap or film"};
    case FindingKind::NonManifoldEdge:
      return {"non_manifold_edge", "shares an edge with more than one other",
              "leave out surfaces that do not bound the body"};
    case FindingKind::Misoriented:
      return {"misoriented",
              "runs the same way as its neighbour along their edge",
              "turn one of the two surfaces"};
    case FindingKind::Duplicate:
      return {"duplicate", "lies on another with the same corners",
              "remove one of them"};
    case FindingKind::Degenerate:
      return {"degenerate", "is a needle or has no area",
              "remesh the film or use another edge length"};
    case FindingKind::Crossing:
      return {"crossing", "crosses or overlaps another",
              "surfaces must not meet but at their common edges"};
    case FindingKind::TooClose:
      return {"too_close", "nearly touches another",
              "surfaces must keep apart but at their common edges"};
    case FindingKind::NegativeVolume:
      return {"negative_volume", "belongs to a closed part that is inside out",
              "turn the facets of that part"};
    case FindingKind::BodyMismatch:
      return {"body_mismatch",
              "does not look at the same body as the next facet about their "
              "edge",
              "films cross or fold over there, or a body between them is "
              "missing"};
    case FindingKind::BadNesting:
      return {"bad_nesting", "belongs to a closed part inside another body",
              "turn its facets round for a cavity, or leave one of them out"};
    case FindingKind::Crowded:
      return {"crowded", "has more facets about it than can be compared",
              "remesh the surface evenly"};
  }
  return {"", "", ""};
}

std::string surface_of(const SurfaceMesh& mesh, int facet) {
  if (facet >= static_cast<int>(mesh.facet_label.size())) {
    return "?";
  }
  const int label = mesh.facet_label[facet];
  const bool known = label >= 0 && label < static_cast<int>(mesh.labels.size());
  return known ? mesh.labels[label] : "?";
}

bool same_surfaces(const Finding& a, const Finding& b) {
  return std::is_permutation(a.surfaces.begin(), a.surfaces.end(),
                             b.surfaces.begin(), b.surfaces.end());
}

}  // namespace

const char* name_of(FindingKind kind) { return words_of(kind).name; }

void describe(const SurfaceMesh& mesh, Finding& finding) {
  std::string others;
  const std::vector<int>& facets = finding.facets;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const std::string surface = surface_of(mesh, facets[i]);
    if (i > 0) {
      others += fmt::format("{}{} ('{}')", i == 1 ? " with facet " : ", ",
                            facets[i], surface);
    }
    auto& names = finding.surfaces;
    if (std::find(names.begin(), names.end(), surface) == names.end()) {
      names.push_back(surface);
    }
  }
  const Words words = words_of(finding.kind);
  const Vec3& at = finding.position;
  finding.message =
      fmt::format("facet {} ('{}') {}{} at ({:.6g}, {:.6g}, {:.6g}): {}",
                  facets[0], surface_of(mesh, facets[0]), words.what, others,
                  at.x(), at.y(), at.z(), words.advice);
}

std::string summary(const std::vector<Finding>& findings, int most) {
  std::vector<std::pair<const Finding*, int>> groups;  // the first, how many
  for (const Finding& finding : findings) {
    const auto like =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
          return group.first->kind == finding.kind &&
                 same_surfaces(*group.first, finding);
        });
    if (like == groups.end()) {
      groups.emplace_back(&finding, 1);
    } else {
      ++like->second;
    }
  }
  std::string text;
  int told = 0;
  for (int i = 0; i < std::min(static_cast<int>(groups.size()), most); ++i) {
    const auto& [first, count] = groups[static_cast<std::size_t>(i)];
    text += (i == 0 ? "" : ". ") + first->message;
    text += count > 1 ? fmt::format(" (and {} like it)",
                                    count_text(count - 1, "place"))
                      : "";
    told += count;
  }
  const int left = static_cast<int>(findings.size()) - told;
  if (left > 0) {
    text += fmt::format("{}{}{}", told > 0 ? "; and " : "",
                        count_text(left, "finding"), told > 0 ? " more" : "");
  }
  return text;
}

}  // namespace meniscus
