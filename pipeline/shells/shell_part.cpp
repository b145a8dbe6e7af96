#include "pipeline/shells/shell_part.h"

#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/stress_measures.h"
#include "fea/loads/load_checks.h"
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

/// A field's gradient there, for derivatives; not a number where it has none.
Vec3 slope_at(const loads::VectorOfPlace& slope, const Vec3& x,
              const loads::LoadCase& load_case, const std::string& what) {
  try {
    return loads::field_value(slope, x, load_case, what);
  } catch (const InvalidInput&) {
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

/// Of a load's field at the nodes of one facet, `factor` times.
shell::NodeValues values_at(const ShellPart& part, int facet,
                            const loads::SurfacePressure& load, double factor,
                            const loads::LoadCase& load_case) {
  shell::NodeValues values;
  const std::string what = fmt::format("the pressure on '{}'", load.surface);
  for (std::size_t i = 0; i < values.value.size(); ++i) {
    const Vec3& x = part.mesh.nodes[part.mesh.facets[facet][i]];
    values.value[i] =
        factor * loads::field_value(load.field, x, load_case, what);
    if (load.slope) {
      values.slope[i] = factor * slope_at(load.slope, x, load_case, what);
    }
  }
  return values;
}

void add_pressure(const ShellPart& part, const loads::SurfacePressure& load,
                  const loads::LoadCase& load_case, shell::ShellLoads& sum) {
  const int label = part.skin.label_of(film_of(load.surface));
  const bool on_back = load.surface.ends_with("/back");
  const double sign = on_back ? 1.0 : -1.0;
  const auto side =
      on_back ? shell::WallSide::Negative : shell::WallSide::Positive;
  for (int f = 0; f < part.skin.face_count(); ++f) {
    if (part.skin.face_label[f] != label) {
      continue;
    }
    if (load.field) {
      sum.field_pressures.push_back(
          {f, values_at(part, f, load, sign, load_case), side});
    } else {
      sum.pressures.push_back(
          {.facet = f, .pressure = sign * load.pressure, .side = side});
    }
  }
}

/// Changes from the reference, where the field has its places.
void set_temperature(const ShellPart& part, const loads::LoadCase& load_case,
                     shell::ShellLoads& sum) {
  const loads::Temperature& heat = *load_case.temperature;
  if (!heat.field) {
    sum.temperature = {.mean = heat.value - heat.reference};
    return;
  }
  shell::NodalTemperature& nodal = sum.nodal_temperature.emplace();
  nodal.value.resize(std::ssize(part.mesh.nodes));
  for (std::size_t i = 0; i < part.mesh.nodes.size(); ++i) {
    const Vec3& x = part.mesh.nodes[i];
    nodal.value[static_cast<Eigen::Index>(i)] =
        loads::field_value(heat.field, x, load_case, "the temperature") -
        heat.reference;
    if (heat.slope) {
      nodal.slope.push_back(
          slope_at(heat.slope, x, load_case, "the temperature"));
    }
  }
}

/// All that a rim's own film has: two where it goes on beyond.
std::vector<shell::FacetEdge> edges_on(const ShellPart& part,
                                       const std::string& rim) {
  std::set<int> middles;
  for (const std::array<int, 3>& edge : rim_of(part, rim)) {
    middles.insert(edge[2]);
  }
  std::vector<shell::FacetEdge> edges;
  const int label = part.skin.label_of(film_of(rim));
  for (int f = 0; f < part.skin.face_count(); ++f) {
    for (int edge = 0; edge < 3 && part.skin.face_label[f] == label; ++edge) {
      if (middles.contains(part.mesh.facets[f][3 + edge])) {
        edges.push_back({f, edge});
      }
    }
  }
  return edges;
}

bool on_rims(const loads::Surfaces& surfaces) {
  return is_rim(surfaces.front());
}

/// What rims carry together, in the load case's order.
std::vector<shell::LineLoad> lines_of(const ShellPart& part,
                                      const loads::LoadCase& load_case) {
  std::vector<shell::LineLoad> lines;
  for (const loads::SurfaceForce& force : load_case.forces) {
    if (on_rims(force.surfaces)) {
      lines.push_back({.edges = rim_edges(part, force.surfaces),
                       .force = force.total,
                       .name = force.surfaces.text()});
    }
  }
  for (const loads::RemoteLoad& load : load_case.remote_loads) {
    if (on_rims(load.surfaces)) {
      lines.push_back({.edges = rim_edges(part, load.surfaces),
                       .point = load.point,
                       .force = load.force,
                       .moment = load.moment,
                       .name = load.surfaces.text()});
    }
  }
  return lines;
}

/// Of what acts on films as it would on a solid's faces.
loads::LoadCase on_films(const loads::LoadCase& load_case) {
  loads::LoadCase result{.name = load_case.name};
  for (loads::SurfaceForce force : load_case.forces) {
    if (!on_rims(force.surfaces)) {
      force.surfaces = films_of(force.surfaces);
      result.forces.push_back(std::move(force));
    }
  }
  for (loads::SurfaceTraction traction : load_case.tractions) {
    if (!is_rim(traction.surface)) {
      traction.surface = film_of(traction.surface);
      result.tractions.push_back(std::move(traction));
    }
  }
  for (loads::RemoteLoad remote : load_case.remote_loads) {
    if (!on_rims(remote.surfaces)) {
      remote.surfaces = films_of(remote.surfaces);
      result.remote_loads.push_back(std::move(remote));
    }
  }
  for (loads::SpringBed bed : load_case.springs) {
    bed.surface = film_of(bed.surface);
    result.springs.push_back(std::move(bed));
  }
  return result;
}

/// All that is no force at nodes.
shell::ShellLoads facet_loads_of(const ShellPart& part,
                                 const loads::LoadCase& load_case) {
  shell::ShellLoads result;
  result.gravity = load_case.gravity;
  if (load_case.temperature) {
    set_temperature(part, load_case, result);
  }
  for (const loads::SurfacePressure& load : load_case.pressures) {
    if (!is_rim(load.surface)) {
      add_pressure(part, load, load_case, result);
      continue;
    }
    for (const auto& [facet, edge] : edges_on(part, load.surface)) {
      result.tractions.push_back(
          {.facet = facet, .edge = edge, .pressure = load.pressure});
    }
  }
  for (const loads::SurfaceTraction& load : load_case.tractions) {
    if (is_rim(load.surface)) {
      for (const auto& [facet, edge] : rim_edges(part, load.surface)) {
        result.tractions.push_back(
            {.facet = facet, .edge = edge, .traction = load.traction});
      }
    }
  }
  for (const loads::RimTension& load : load_case.rim_tensions) {
    for (const auto& [facet, edge] : edges_on(part, load.rim)) {
      result.pulls.push_back({facet, edge, load.tension});
    }
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

std::vector<shell::FacetEdge> rim_edges(const ShellPart& part,
                                        const loads::Surfaces& rims) {
  std::vector<shell::FacetEdge> edges;
  std::set<int> middles;
  for (const std::string& rim : rims) {
    for (const shell::FacetEdge& edge : edges_on(part, rim)) {
      if (middles.insert(part.mesh.facets[edge.facet][3 + edge.edge]).second) {
        edges.push_back(edge);
      }
    }
  }
  return edges;
}

ShellActions shell_actions(const ShellPart& part,
                           const loads::LoadCase& load_case) {
  ShellActions result{.loads = facet_loads_of(part, load_case),
                      .on_films = on_films(load_case),
                      .lines = lines_of(part, load_case)};
  result.loads.spin = load_case.spin;
  if (acts_on_films(result.on_films)) {
    result.loads.nodal =
        shell::with_rotations(loads::nodal_forces(part.skin, result.on_films));
  }
  for (const shell::LineLoad& line : result.lines) {
    const VectorX forces = shell::line_forces(part.mesh, line);
    if (result.loads.nodal.size() == 0) {
      result.loads.nodal = forces;
    } else {
      result.loads.nodal += forces;
    }
  }
  return result;
}

supports::SpringBlocks spring_blocks(const ShellPart& part,
                                     const loads::LoadCase& load_case) {
  return supports::spring_blocks(part.skin, on_films(load_case), 2);
}

void add_spring_gradient(const ShellPart& part, std::size_t load_case,
                         const VectorX& v, const VectorX& u, Points& by_nodes) {
  const loads::LoadCase& films = part.cases[load_case].actions.on_films;
  if (!films.springs.empty()) {
    supports::add_spring_gradient(part.skin, films, shell::displacements_of(u),
                                  shell::displacements_of(v), by_nodes);
  }
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
  add_spring_gradient(part, load_case, v, u, gradient.by_nodes);
  for (const shell::LineLoad& line : actions.lines) {
    shell::line_gradient(part.mesh, line, v, &gradient);
  }
  return gradient;
}

namespace {

shell::ShellLoads facet_rates_of(const ShellPart& part,
                                 const loads::LoadCase& load_case,
                                 const loads::LoadCase& rates) {
  shell::ShellLoads own = facet_loads_of(part, rates);
  if (load_case.spin) {
    own.mass_force = shell::mass_force_rate(*load_case.spin, *rates.spin);
  }
  return own;
}

}  // namespace

double action_rate(const ShellPart& part, const loads::LoadCase& load_case,
                   const loads::LoadCase& rates,
                   const shell::ActionGradient& by) {
  if (by.facets.empty() || !loads::changes(rates)) {
    return 0.0;
  }
  return shell::action_rate(part.mesh, by,
                            facet_rates_of(part, load_case, rates));
}

double work_rate(const ShellPart& part, const loads::LoadCase& load_case,
                 const loads::LoadCase& rates, const VectorX& v) {
  if (!loads::changes(rates)) {  // by most variables
    return 0.0;
  }
  const shell::ShellLoads own = facet_rates_of(part, load_case, rates);
  double rate = v.dot(shell::nodal_forces(part.mesh, part.sections, own));
  const loads::LoadCase films = on_films(load_case);
  if (acts_on_films(films)) {
    rate += loads::load_rate(
        loads::load_gradient(part.skin, {}, films, shell::displacements_of(v)),
        on_films(rates));
  }
  const std::vector<shell::LineLoad> lines = lines_of(part, load_case);
  const std::vector<shell::LineLoad> line_rates = lines_of(part, rates);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const shell::LineGradient by =
        shell::line_gradient(part.mesh, lines[k], v, nullptr);
    const shell::LineLoad& rate_of = line_rates[k];
    rate += by.by_force.dot(rate_of.force) + by.by_moment.dot(rate_of.moment) +
            by.by_point.dot(rate_of.point.value_or(Vec3::Zero()));
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

std::vector<int> first_layers(const ShellPart& part) {
  std::vector<int> first;
  int next = part.first_layer;
  for (const shell::Section& section : part.sections) {
    first.push_back(next);
    next += static_cast<int>(section.laminate.plies.size());
  }
  return first;
}

LayerGradient layer_gradient(const ShellPart& part,
                             const shell::PlyGradients& by_ply) {
  const std::vector<double> of_solids(
      static_cast<std::size_t>(part.first_layer), 0.0);
  LayerGradient result{of_solids, of_solids, of_solids};
  for (std::size_t s = 0; s < part.sections.size(); ++s) {
    for (std::size_t p = 0; p < part.sections[s].laminate.plies.size(); ++p) {
      const shell::PlyGradient own = s < by_ply.size() && p < by_ply[s].size()
                                         ? by_ply[s][p]
                                         : shell::PlyGradient{};
      result.modulus.push_back(own.modulus);
      result.density.push_back(own.density);
      result.angle.push_back(own.angle);
    }
  }
  return result;
}

void visit_nodal_stresses(
    const ShellPart& part, std::size_t load_case,
    const std::function<void(int facet, int node, int layer,
                             const element::Stress& stress)>& visit) {
  const ShellCase& own = part.cases[load_case];
  const std::vector<int> first = first_layers(part);
  shell::visit_ply_stresses(
      part.mesh, part.sections, own.actions.loads, own.displacement,
      [&](int ply, const std::vector<shell::FacetStress>& stress) {
        const auto mean = shell::averaged_stress(part.mesh, stress);
        for (std::size_t f = 0; f < mean.size(); ++f) {
          const int s = part.mesh.section[f];
          if (ply >= std::ssize(part.sections[s].laminate.plies)) {
            continue;
          }
          for (std::size_t i = 0; i < mean[f].size(); ++i) {
            const shell::WallStress& wall = mean[f][i];
            for (const element::Stress& at :
                 {wall.negative, wall.middle, wall.positive}) {
              visit(static_cast<int>(f), static_cast<int>(i), first[s] + ply,
                    at);
            }
          }
        }
      });
}

ShellPeak shell_peak(const ShellPart& part, std::size_t load_case) {
  ShellPeak peak;
  visit_nodal_stresses(
      part, load_case,
      [&](int facet, int node, int layer, const element::Stress& stress) {
        if (const double value = element::von_mises(stress);
            value > peak.von_mises) {
          peak = {value, part.mesh.nodes[part.mesh.facets[facet][node]], layer};
        }
      });
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
