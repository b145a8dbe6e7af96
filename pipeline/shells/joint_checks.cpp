#include "pipeline/shells/joint_checks.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

namespace {

const std::vector<case_data::ResponseKind>& kinds_of_both() {
  using K = case_data::ResponseKind;
  static const std::vector<case_data::ResponseKind> kinds = {
      K::MeanDisplacement, K::DisplacementNorm, K::Rotation,
      K::Compliance,       K::StrainEnergy,     K::Mass,
      K::Volume,           K::MaxVonMises,      K::Envelope,
      K::Expression};
  return kinds;
}

/// Notes of one case with shells and solids.
class JointChecks {
 public:
  JointChecks(const case_data::Case& input, case_data::CaseProblems& problems)
      : input_(input),
        problems_(problems),
        shell_(input.shells.front().name),
        solid_(case_data::solid_bodies(input).front().name) {}

  void check() {
    check_part();
    check_materials();
    for (const case_data::LoadCaseEntry& load_case : input_.load_cases) {
      check_supports(load_case);
      for (const case_data::LoadEntry& load : load_case.loads) {
        check_load(load_case, load);
      }
    }
    for (const case_data::ResponseEntry& response : input_.responses) {
      check_response(response);
    }
    if (input_.analysis.frequencies > 0 ||
        input_.analysis.buckling.value_or(0) > 0) {
      refuse(0, "natural frequencies and buckling factors",
             "take them out of [analysis]");
    }
  }

 private:
  void refuse(case_data::SourceLine line, const std::string& what,
              const std::string& instead) {
    problems_.add(line, fmt::format("{} cannot yet be had with shells.{} "
                                    "beside bodies.{}; {}",
                                    what, shell_, solid_, instead));
  }

  void check_part() {
    if (!input_.symmetry.empty()) {
      refuse(input_.shells.front().line, "planes of symmetry",
             "draw the whole part");
    }
    for (const case_data::ShellEntry& shell : input_.shells) {
      for (const case_data::BodyEntry& body : input_.bodies) {
        for (const std::string& film : shell.films) {
          if (body.material != case_data::kVoid &&
              std::count(body.enclosed_by.begin(), body.enclosed_by.end(),
                         film) > 0) {
            problems_.add(
                shell.line,
                fmt::format("shells.{} is of film '{}', which encloses the "
                            "solid bodies.{}; a film is a wall or bounds a "
                            "solid: make the body's material \"void\", so that "
                            "it only shapes its films, or take the film out "
                            "of one of them",
                            shell.name, film, body.name));
          }
        }
      }
    }
  }

  void check_materials() {
    std::vector<std::string> found;
    const case_data::CaseValues values(
        input_, case_data::initial_design(input_), found);
    for (const case_data::BodyEntry& body : input_.bodies) {
      if (body.material == case_data::kVoid) {
        continue;
      }
      const case_data::MaterialEntry& material =
          input_.materials[static_cast<std::size_t>(body.material)];
      if (values.follows_design(material.density) ||
          (!material.orthotropic &&
           values.follows_design(material.youngs_modulus))) {
        refuse(material.line,
               fmt::format("'{}', which follows the design,", material.name),
               "give it fixed numbers");
      }
    }
  }

  void check_supports(const case_data::LoadCaseEntry& load_case) {
    for (const case_data::SupportEntry& support : load_case.supports) {
      const std::string where = fmt::format("load case '{}': ", load_case.name);
      if (support.displacement || support.rotation) {
        refuse(support.line,
               where + (support.displacement ? "an enforced displacement"
                                             : "an enforced rotation"),
               "hold it at 0, and load it");
      } else if (!is_on_shells(input_, support.support.surface) &&
                 (support.at ||
                  support.support.fix_rotation != std::array<bool, 3>{})) {
        problems_.add(
            support.line,
            fmt::format("load case '{}' holds '{}' of a solid by `at` or "
                        "fix_rotation, which shells have; hold components "
                        "(fix) of its whole surface",
                        load_case.name, support.support.surface));
      }
    }
    for (const loads::SpringBed& bed : load_case.springs) {
      if (is_on_shells(input_, bed.surface)) {
        refuse(load_case.line,
               fmt::format("load case '{}': springs on the shell's '{}'",
                           load_case.name, bed.surface),
               "spring a surface of the solid");
      }
    }
    if (!load_case.pins.empty()) {
      refuse(load_case.pins.front().line,
             fmt::format("load case '{}': a rigid support", load_case.name),
             "hold components (fix) of the surface");
    }
  }

  void check_load(const case_data::LoadCaseEntry& load_case,
                  const case_data::LoadEntry& load) {
    const std::string where = fmt::format("load case '{}': ", load_case.name);
    const auto on_shells =
        std::count_if(load.surfaces.begin(), load.surfaces.end(),
                      [&](const std::string& surface) {
                        return is_on_shells(input_, surface);
                      });
    if (on_shells > 0 && on_shells < std::ssize(load.surfaces)) {
      refuse(load.line, where + "a load on both together",
             "give each an entry with its share");
    } else if (load.size) {
      refuse(load.line, where + "a load from any direction",
             "give load cases of forces");
    } else if (load.by == case_data::LoadPath::Rigid) {
      refuse(load.line, where + "a rigid load", "spread it (take `by` out)");
    } else if (load.kind == case_data::LoadKind::Temperature) {
      refuse(load.line, where + "a temperature", "take [walls] for it");
    } else if (load.kind == case_data::LoadKind::Preload) {
      refuse(load.line, where + "a bolt", "give its force to the surfaces");
    }
  }

  void check_response(const case_data::ResponseEntry& response) {
    const std::vector<case_data::ResponseKind>& kinds = kinds_of_both();
    const case_data::ResponseRow& row = case_data::row_of(response.kind);
    if (!row.of_films &&
        std::find(kinds.begin(), kinds.end(), response.kind) == kinds.end()) {
      refuse(response.line,
             fmt::format("responses.{} of kind {}", response.name, row.name),
             fmt::format("there are {} and those of films",
                         fmt::join(case_data::names_of(kinds), ", ")));
    } else if (response.kind == case_data::ResponseKind::StrainEnergy &&
               !input_.load_cases[static_cast<std::size_t>(response.load_case)]
                    .springs.empty()) {
      refuse(response.line,
             fmt::format("responses.{}, the strain energy beside springs,",
                         response.name),
             "ask for the compliance");
    }
  }

  const case_data::Case& input_;
  case_data::CaseProblems& problems_;
  std::string shell_;
  std::string solid_;
};

}  // namespace

bool is_on_shells(const case_data::Case& input, const std::string& surface) {
  if (!case_data::has_solids(input)) {
    return true;
  }
  const std::string film = film_of(surface);
  return std::any_of(input.shells.begin(), input.shells.end(),
                     [&](const case_data::ShellEntry& shell) {
                       return std::count(shell.films.begin(), shell.films.end(),
                                         film) > 0;
                     });
}

void check_joint(const case_data::Case& input,
                 case_data::CaseProblems& problems) {
  JointChecks(input, problems).check();
}

}  // namespace meniscus::shells
