/// Checks of what films of facets start from, and of solids in their way.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "evolve/start/start_complex.h"
#include "evolve/start/start_edge.h"
#include "pipeline/case_data/case_checks.h"

namespace meniscus::case_data {

bool has_facets(const Case& input) {
  return std::any_of(input.films.begin(), input.films.end(),
                     [](const FilmEntry& film) {
                       return film.spec.kind == films::FilmKind::Facets;
                     }) ||
         std::any_of(input.caps.begin(), input.caps.end(),
                     [](const CapEntry& cap) { return cap.is_file; });
}

bool has_facets(const Case& input, const BodyEntry& body) {
  const auto encloses = [&](const std::string& name) {
    return std::find(body.enclosed_by.begin(), body.enclosed_by.end(), name) !=
           body.enclosed_by.end();
  };
  return std::any_of(input.films.begin(), input.films.end(),
                     [&](const FilmEntry& film) {
                       return film.spec.kind == films::FilmKind::Facets &&
                              encloses(film.spec.name);
                     }) ||
         std::any_of(input.caps.begin(), input.caps.end(),
                     [&](const CapEntry& cap) {
                       return cap.is_file && encloses(cap.spec.name);
                     });
}

SourceLine line_of_start(const Case& input, const std::string& message) {
  SourceLine line = 0;
  const auto look = [&](const std::string& name, SourceLine at) {
    const std::size_t found = message.find("'" + name + "'");
    line = line == 0 && found != std::string::npos ? at : line;
  };
  for (const SpineEntry& spine : input.spines) {
    if (message.rfind("spine '" + spine.name + "'", 0) == 0) {
      return spine.line;
    }
  }
  for (const FilmEntry& film : input.films) {
    look(film.spec.name, film.line);
  }
  for (const CapEntry& cap : input.caps) {
    look(cap.spec.name, cap.line);
  }
  for (const BodyEntry& body : input.bodies) {
    if (message.find("body '" + body.name + "'") != std::string::npos) {
      line = body.enclosure_line;
    }
  }
  return line;
}

namespace {

/// A feature or a STEP solid.
struct FacedSolid {
  std::string name;
  SourceLine line = 0;
};

std::vector<FacedSolid> faced_solids(const Case& input) {
  std::vector<FacedSolid> result;
  for (const FeatureEntry& feature : input.features) {
    result.push_back({feature.name, feature.line});
  }
  for (const StepSolidEntry& solid : input.step_solids) {
    result.push_back({solid.spec.name, solid.line});
  }
  return result;
}

/// The one that a face belongs to, by index; -1: none.
int solid_of(const std::vector<FacedSolid>& solids, const std::string& face) {
  for (std::size_t k = 0; k < solids.size(); ++k) {
    if (face.rfind(solids[k].name + "/", 0) == 0) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

/// Those whose faces cross.
void check_overlaps(const Case& input, const SurfaceMesh& start,
                    CaseProblems& problems) {
  SurfaceMesh faces;
  faces.points = start.points;
  faces.labels = start.labels;
  const std::vector<FacedSolid> solids = faced_solids(input);
  std::vector<int> solid;  // per label
  for (const std::string& label : start.labels) {
    solid.push_back(solid_of(solids, label));
  }
  for (std::size_t f = 0; f < start.facets.size(); ++f) {
    if (solid[start.facet_label[f]] >= 0) {
      faces.facets.push_back(start.facets[f]);
      faces.facet_label.push_back(start.facet_label[f]);
    }
  }
  std::set<std::pair<int, int>> told;
  for (const Finding& finding : check_surface(faces)) {
    std::set<int> both;
    for (const std::string& surface : finding.surfaces) {
      both.insert(solid_of(solids, surface));
    }
    if (finding.kind != FindingKind::Crossing || both.size() != 2 ||
        !told.insert({*both.begin(), *both.rbegin()}).second) {
      continue;
    }
    const FacedSolid& first = solids[*both.begin()];
    const FacedSolid& second = solids[*both.rbegin()];
    problems.add(second.line,
                 fmt::format("solids '{}' and '{}' overlap near ({:.4g}, "
                             "{:.4g}, {:.4g}); move them apart, or let a film "
                             "join them",
                             first.name, second.name, finding.position.x(),
                             finding.position.y(), finding.position.z()));
  }
}

}  // namespace

void check_start(const Case& input, const EvaluatedCase& inputs,
                 CaseProblems& problems) {
  if (!has_facets(input) && input.features.empty() && input.spines.empty()) {
    return;
  }
  try {
    const films::FilmComplex start = start::build_start(
        inputs.film_system,
        start::start_edge(inputs.film_system, inputs.fea_edge));
    check_overlaps(input, start.mesh, problems);
  } catch (const Error& error) {
    const std::string message = error.what();
    problems.add(line_of_start(input, message), message);
  }
}

}  // namespace meniscus::case_data
