#include "pipeline/shells/shell_checks.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/shells/joint_checks.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

namespace {

const std::vector<case_data::ResponseKind>& kinds_of_shells() {
  using K = case_data::ResponseKind;
  static const std::vector<case_data::ResponseKind> kinds = {
      K::MeanDisplacement, K::DisplacementNorm, K::Rotation,    K::Compliance,
      K::StrainEnergy,     K::BucklingFactor,   K::Frequency,   K::Mass,
      K::Volume,           K::CentreOfMass,     K::Inertia,     K::MaxVonMises,
      K::VonMisesNorm,     K::VonMisesKs,       K::StressRatio, K::Fatigue,
      K::Envelope,         K::Expression};
  return kinds;
}

/// A traction or a pressure.
bool is_of_place(const case_data::LoadEntry& load) {
  return load.place.of_place ||
         std::any_of(load.traction.begin(), load.traction.end(),
                     [](const auto& part) { return part.of_place; });
}

/// Notes of one case with shells.
class ShellChecks {
 public:
  ShellChecks(const case_data::Case& input, case_data::CaseProblems& problems)
      : input_(input), problems_(problems) {}

  void check() {
    check_part();
    for (const case_data::LoadCaseEntry& load_case : input_.load_cases) {
      check_supports(load_case);
      for (const case_data::LoadEntry& load : load_case.loads) {
        check_load(load_case, load);
      }
    }
    std::for_each(
        input_.responses.begin(), input_.responses.end(),
        [this](const case_data::ResponseEntry& r) { check_response(r); });
    check_analysis();
  }

 private:
  template <class Numbers>
  bool follows_design(const Numbers& numbers) const {
    std::vector<std::string> found;
    return case_data::CaseValues(input_, case_data::initial_design(input_),
                                 found)
        .follows_design(numbers);
  }

  void check_part() {
    const case_data::ShellEntry& first = input_.shells.front();
    if (!input_.walls.empty()) {
      problems_.add(first.line,
                    fmt::format("shells.{} stands beside walls.{}; a run "
                                "analyses shells or walls: make all of them "
                                "one",
                                first.name, input_.walls.front().name));
    }
    if (!input_.fillets.empty()) {
      problems_.add(input_.fillets.front().line,
                    fmt::format("fillets.{} stands beside shells.{}, whose "
                                "films meet in lines; take it out",
                                input_.fillets.front().name, first.name));
    }
    if (input_.resolution.refinements == 0) {
      problems_.add(0,
                    fmt::format("resolution.film is as long as "
                                "resolution.fea; shells.{} needs the middles "
                                "of its edges on the film: half as long, or "
                                "take it out",
                                first.name));
    }
    if (!input_.resolution.export_edges.empty()) {
      problems_.add(0, fmt::format("resolution.export is of closed surfaces, "
                                   "which shells.{} has not; take it out",
                                   first.name));
    }
    if (input_.process.smallest_feature > 0.0) {
      problems_.add(0,
                    fmt::format("[process] looks at solids, and shells.{} is "
                                "none; take it out, and bound the thickness "
                                "itself",
                                first.name));
    }
  }

  void check_supports(const case_data::LoadCaseEntry& load_case) {
    const auto refuse = [&](case_data::SourceLine line,
                            const std::string& what) {
      problems_.add(line, fmt::format("load case '{}' has {}, which shells "
                                      "do not know; hold components (fix, "
                                      "fix_rotation)",
                                      load_case.name, what));
    };
    for (const case_data::SupportEntry& support : load_case.supports) {
      if (!is_on_shells(input_, support.support.surface)) {
        continue;
      }
      const std::vector<std::string> ends = case_data::cut_faces(input_);
      const bool is_end =
          std::count(ends.begin(), ends.end(), support.support.surface) > 0;
      if (support.support.kind != loads::SupportKind::Components && !is_end) {
        refuse(support.line, "a support along normals");
      } else if (support.at && follows_design(*support.at)) {
        refuse(support.line, "a support at a point that follows the design");
      }
    }
    if (std::any_of(
            load_case.springs.begin(), load_case.springs.end(),
            [](const loads::SpringBed& bed) { return is_rim(bed.surface); })) {
      refuse(load_case.line, "springs on a rim");
    }
  }

  void check_load(const case_data::LoadCaseEntry& load_case,
                  const case_data::LoadEntry& load) {
    const auto refuse = [&](const std::string& what, const char* instead) {
      problems_.add(load.line,
                    fmt::format("load case '{}' has {}, which shells do not "
                                "know; {}",
                                load_case.name, what, instead));
    };
    if (!load.surfaces.empty() &&
        !is_on_shells(input_, load.surfaces.front())) {
      return;
    }
    const auto rims =
        std::count_if(load.surfaces.begin(), load.surfaces.end(), is_rim);
    const bool on_rim = rims > 0;
    const bool on_both = on_rim && rims < std::ssize(load.surfaces);
    if (load.size) {
      return refuse("a load from any direction", "give load cases of forces");
    }
    if (load.by == case_data::LoadPath::Bearing) {
      return refuse("a bearing load",
                    "spread it (take `by` out), or make it \"rigid\"");
    }
    switch (load.kind) {
      case case_data::LoadKind::Force:
      case case_data::LoadKind::Remote:
        if (on_both) {
          refuse("a force or a moment on rims and films together",
                 "give both an entry with its share");
        }
        break;
      case case_data::LoadKind::Traction:
        if (on_rim && is_of_place(load)) {
          refuse("a traction of place on a rim", "give the rim one vector");
        }
        break;
      case case_data::LoadKind::Pressure:
        if (on_rim && is_of_place(load)) {
          refuse("a pressure of place on a rim", "give the rim one number");
        }
        break;
      case case_data::LoadKind::RimTension:
        if (!std::all_of(load.surfaces.begin(), load.surfaces.end(), is_rim)) {
          refuse("a rim_tension on what is no rim", "name FILM/rim:CURVE");
        }
        break;
      case case_data::LoadKind::Preload:
        refuse("a bolt", "give its force to a film or a rim");
        break;
      case case_data::LoadKind::Temperature:
      case case_data::LoadKind::Spin:
      case case_data::LoadKind::Gravity:
        break;
    }
  }

  void check_response(const case_data::ResponseEntry& response) {
    const std::vector<case_data::ResponseKind>& kinds = kinds_of_shells();
    const case_data::ResponseRow& row = case_data::row_of(response.kind);
    if (!row.of_films &&
        std::find(kinds.begin(), kinds.end(), response.kind) == kinds.end()) {
      problems_.add(response.line,
                    fmt::format("responses.{} is of kind {}, which shells do "
                                "not have; they have {} and those of films",
                                response.name, row.name,
                                fmt::join(case_data::names_of(kinds), ", ")));
    } else if (is_rim(response.surface) &&
               (response.kind != case_data::ResponseKind::MeanDisplacement ||
                response.weight)) {
      problems_.add(response.line,
                    fmt::format("responses.{} is on a rim, where shells have "
                                "mean_displacement without weight; name a film",
                                response.name));
    } else if (response.kind == case_data::ResponseKind::StrainEnergy) {
      check_energy_of_loads(response);
    }
  }

  /// Part of the energy is in what free expansion is held back by, or in
  /// springs.
  void check_energy_of_loads(const case_data::ResponseEntry& response) {
    const case_data::LoadCaseEntry& load_case =
        input_.load_cases[static_cast<std::size_t>(response.load_case)];
    const bool is_hot = std::any_of(
        load_case.loads.begin(), load_case.loads.end(), [](const auto& load) {
          return load.kind == case_data::LoadKind::Temperature;
        });
    if (is_hot || !load_case.springs.empty()) {
      problems_.add(
          response.line,
          fmt::format("responses.{} is the strain_energy of load case '{}', "
                      "which has {}; of shells take compliance",
                      response.name, load_case.name,
                      is_hot ? "a temperature" : "springs"));
    }
  }

  void check_analysis() {
    const case_data::AnalysisEntry& analysis = input_.analysis;
    const auto refuse = [&](const char* what) {
      problems_.add(0, fmt::format("analysis.{} is of solids, and shells.{} is "
                                   "none; take it out",
                                   what, input_.shells.front().name));
    };
    if (analysis.adapt) {
      refuse("adapt");
    }
    if (!analysis.exclude.empty()) {
      refuse("exclude");
    }
    if (analysis.solver != equations::SolverKind::Automatic &&
        analysis.solver != equations::SolverKind::Cholesky) {
      refuse("solver");
    }
  }

  const case_data::Case& input_;
  case_data::CaseProblems& problems_;
};

}  // namespace

void check_shells(const case_data::Case& input,
                  case_data::CaseProblems& problems) {
  if (!input.shells.empty()) {
    ShellChecks(input, problems).check();
    if (case_data::has_solids(input)) {
      check_joint(input, problems);
    }
  }
}

}  // namespace meniscus::shells
