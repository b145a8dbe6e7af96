#include "pipeline/shells/shell_part.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/stress_measures.h"
#include "fea/loads/load_rates.h"
#include "fea/loads/loads.h"
#include "fea/supports/surface_load_gradient.h"

namespace meniscus::shells {

namespace {

loads::Surfaces films_of(const loads::Surfaces& surfaces) {
  loads::Surfaces films;
  for (const std::string& surface : surfaces) {
    films.push_back(film_of(surface));
  }
  return films;
}

void add_pressure(const ShellPart& part, const loads::SurfacePressure& load,
                  shell::ShellLoads& sum) {
  const int label = part.skin.label_of(film_of(load.surface));
  const bool on_back = load.surface.ends_with("/back");
  for (int f = 0; f < part.skin.face_count(); ++f) {
    if (part.skin.face_label[f] == label) {
      sum.pressures.push_back(
          {.facet = f,
           .pressure = on_back ? load.pressure : -load.pressure,
           .side = on_back ? shell::WallSide::Negative
                           : shell::WallSide::Positive});
    }
  }
}

void add_rim_force(const ShellPart& part, const RimForce& force,
                   shell::ShellLoads& sum) {
  const shell::Line& rim = rim_of(part, force.rim);
  const double length = shell::line_length(part.mesh, rim);
  for (const std::array<int, 3>& edge : rim) {
    sum.edges.push_back({.nodes = edge, .force = force.total / length});
  }
}

/// On the facets of the rim's own film.
void add_rim_tension(const ShellPart& part, const loads::RimTension& load,
                     shell::ShellLoads& sum) {
  std::set<int> middles;
  for (const std::array<int, 3>& edge : rim_of(part, load.rim)) {
    middles.insert(edge[2]);
  }
  const int label = part.skin.label_of(film_of(load.rim));
  for (int f = 0; f < part.skin.face_count(); ++f) {
    for (int edge = 0; edge < 3 && part.skin.face_label[f] == label; ++edge) {
      if (middles.contains(part.mesh.facets[f][3 + edge])) {
        sum.pulls.push_back({f, edge, load.tension});
      }
    }
  }
}

/// Of what acts on films as it would on a solid's faces.
loads::LoadCase on_films(const loads::LoadCase& load_case) {
  loads::LoadCase result{.name = load_case.name};
  for (loads::SurfaceForce force : load_case.forces) {
    if (!is_rim(force.surfaces.front())) {
      force.surfaces = films_of(force.surfaces);
      result.forces.push_back(std::move(force));
    }
  }
  for (loads::SurfaceTraction traction : load_case.tractions) {
    traction.surface = film_of(traction.surface);
    result.tractions.push_back(std::move(traction));
  }
  for (loads::RemoteLoad remote : load_case.remote_loads) {
    remote.surfaces = films_of(remote.surfaces);
    result.remote_loads.push_back(std::move(remote));
  }
  return result;
}

ShellActions without_nodal(const ShellPart& part,
                           const loads::LoadCase& load_case) {
  ShellActions result;
  result.on_films = on_films(load_case);
  result.loads.gravity = load_case.gravity;
  for (const loads::SurfacePressure& pressure : load_case.pressures) {
    add_pressure(part, pressure, result.loads);
  }
  for (const loads::SurfaceForce& force : load_case.forces) {
    if (is_rim(force.surfaces.front())) {
      result.rims.push_back({force.surfaces.front(), force.total});
      add_rim_force(part, result.rims.back(), result.loads);
    }
  }
  for (const loads::RimTension& tension : load_case.rim_tensions) {
    add_rim_tension(part, tension, result.loads);
  }
  return result;
}

bool acts_on_films(const loads::LoadCase& load_case) {
  return !load_case.forces.empty() || !load_case.tractions.empty() ||
         !load_case.remote_loads.empty();
}

}  // namespace

bool is_rim(const std::string& surface) {
  return surface.find("/rim:") != std::string::npos;
}

std::string film_of(const std::string& surface) {
  constexpr std::string_view kBack = "/back";
  if (const std::size_t at = surface.find("/rim:"); at != std::string::npos) {
    return surface.substr(0, at);
  }
  return surface.ends_with(kBack)
             ? surface.substr(0, surface.size() - kBack.size())
             : surface;
}

const shell::Line& rim_of(const ShellPart& part, const std::string& rim) {
  const auto at = part.rims.find(rim);
  if (at == part.rims.end()) {
    throw InvalidInput(
        fmt::format("the film has no edge on '{}'; name another rim", rim));
  }
  return at->second;
}

ShellActions shell_actions(const ShellPart& part,
                           const loads::LoadCase& load_case) {
  ShellActions result = without_nodal(part, load_case);
  result.loads.spin = load_case.spin;
  if (acts_on_films(result.on_films)) {
    result.loads.nodal =
        shell::with_rotations(loads::nodal_forces(part.skin, result.on_films));
  }
  return result;
}

shell::ShellGradient work_gradient(const ShellPart& part, std::size_t load_case,
                                   const VectorX& v, const VectorX& u) {
  const ShellActions& actions = part.cases[load_case].actions;
  shell::ShellGradient gradient =
      shell::residual_gradient(part.mesh, part.sections, actions.loads, v, u);
  if (acts_on_films(actions.on_films)) {
    supports::add_surface_load_gradient(part.skin, actions.on_films,
                                        shell::displacements_of(v),
                                        gradient.by_nodes);
  }
  // The force per length of a rim falls as the rim grows.
  for (const RimForce& force : actions.rims) {
    const shell::Line& rim = rim_of(part, force.rim);
    const double length = shell::line_length(part.mesh, rim);
    if (!force.total.isZero(0.0)) {
      const double mean =
          shell::mean_displacement(part.mesh, rim, force.total, v).value;
      shell::add_length_gradient(part.mesh, rim,
                                 -force.total.norm() * mean / length,
                                 gradient.by_nodes);
    }
  }
  return gradient;
}

double work_rate(const ShellPart& part, const loads::LoadCase& load_case,
                 const loads::LoadCase& rates, const VectorX& v) {
  double rate = v.dot(shell::nodal_forces(part.mesh, part.sections,
                                          without_nodal(part, rates).loads));
  const loads::LoadCase films = on_films(load_case);
  if (acts_on_films(films)) {
    rate += loads::load_rate(
        loads::load_gradient(part.skin, {}, films, shell::displacements_of(v)),
        on_films(rates));
  }
  return rate;
}

std::vector<shell::FacetStress> shell_stresses(const ShellPart& part,
                                               std::size_t load_case) {
  const ShellCase& own = part.cases[load_case];
  return shell::averaged_stress(
      part.mesh, shell::shell_stress(part.mesh, part.sections,
                                     own.actions.loads, own.displacement));
}

ShellPeak shell_peak(const ShellPart& part,
                     const std::vector<shell::FacetStress>& stress) {
  ShellPeak peak;
  for (std::size_t f = 0; f < stress.size(); ++f) {
    for (std::size_t i = 0; i < stress[f].size(); ++i) {
      const shell::WallStress& wall = stress[f][i];
      for (const element::Stress& s :
           {wall.negative, wall.middle, wall.positive}) {
        if (const double value = element::von_mises(s);
            value > peak.von_mises) {
          peak = {value, part.mesh.nodes[part.mesh.facets[f][i]],
                  static_cast<int>(f)};
        }
      }
    }
  }
  return peak;
}

std::vector<double> nodal_von_mises(
    const ShellPart& part, std::size_t load_case,
    const std::vector<element::Stress shell::WallStress::*>& heights) {
  std::vector<double> values(part.mesh.nodes.size(), 0.0);
  const std::vector<shell::FacetStress>& stress = part.cases[load_case].stress;
  for (std::size_t f = 0; f < stress.size(); ++f) {
    for (std::size_t i = 0; i < stress[f].size(); ++i) {
      double& value = values[part.mesh.facets[f][i]];
      for (const auto height : heights) {
        value = std::max(value, element::von_mises(stress[f][i].*height));
      }
    }
  }
  return values;
}

std::vector<shell::Section> with_density(std::vector<shell::Section> sections,
                                         double density) {
  for (shell::Section& section : sections) {
    for (shell::Ply& ply : section.laminate.plies) {
      ply.material.density = density;
    }
  }
  return sections;
}

}  // namespace meniscus::shells
