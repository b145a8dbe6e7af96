#include "pipeline/shells/shell_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "evolve/walls/rim_shape.h"
#include "evolve/walls/wall_films.h"
#include "pipeline/shells/shell_holds.h"

namespace meniscus::shells {

namespace {

using shell::Line;

/// Corners numbered as facets first name them.
SurfaceNodes nodes_of(const walls::WallFilms& films) {
  SurfaceMesh mesh = films.mesh;
  std::vector<int> corner;
  std::vector<int> id(mesh.points.size(), -1);
  for (Triangle& facet : mesh.facets) {
    for (int& v : facet) {
      if (id[v] < 0) {
        id[v] = static_cast<int>(corner.size());
        corner.push_back(v);
      }
      v = id[v];
    }
  }
  const std::vector<char> straight(mesh.points.size(), 0);
  mesh.points.clear();
  return surface_nodes(std::move(mesh), std::move(corner), films.middles,
                       straight);
}

/// Points along a curve, or in a plane on which films slide.
struct NamedPoints {
  std::string ending;  // of the rims there: "/rim:CURVE", "/symmetry_1"
  std::vector<int> vertices;
};

std::vector<NamedPoints> named_points(const walls::WallFilms& films) {
  std::vector<NamedPoints> result;
  for (const walls::RimName& name : films.names) {
    result.push_back({"/rim:" + name.curve, name.vertices});
  }
  for (std::size_t p = 0; p < films.planes.planes.size(); ++p) {
    NamedPoints& plane =
        result.emplace_back(NamedPoints{"/" + films.planes.planes[p].rim, {}});
    for (std::size_t v = 0; v < films.planes.at.size(); ++v) {
      const std::vector<int>& own = films.planes.at[v];
      if (std::count(own.begin(), own.end(), static_cast<int>(p)) > 0) {
        plane.vertices.push_back(static_cast<int>(v));
      }
    }
  }
  return result;
}

/// Per point: the rims that it is on, ascending.
std::map<int, std::vector<int>> rims_at(const std::vector<NamedPoints>& names) {
  std::map<int, std::vector<int>> rims;
  for (std::size_t n = 0; n < names.size(); ++n) {
    for (const int v : names[n].vertices) {
      std::vector<int>& at = rims[v];
      if (at.empty() || at.back() != static_cast<int>(n)) {
        at.push_back(static_cast<int>(n));
      }
    }
  }
  return rims;
}

/// The films' edges of which both ends and the middle are on a curve, or in a
/// plane.
std::map<std::string, Line> rims_of(const walls::WallFilms& films,
                                    const SurfaceNodes& nodes) {
  const std::vector<NamedPoints> names = named_points(films);
  const std::map<int, std::vector<int>> at = rims_at(names);
  const auto kept = [&](const std::vector<int>& rims, int v) {
    std::vector<int> common;
    if (const auto there = at.find(v); there != at.end()) {
      std::set_intersection(rims.begin(), rims.end(), there->second.begin(),
                            there->second.end(), std::back_inserter(common));
    }
    return common;
  };
  const auto corners = static_cast<int>(nodes.corner.size());
  std::map<std::string, Line> rims;
  std::set<std::array<int, 3>> taken;  // of a film, a rim and an edge
  for (std::size_t f = 0; f < nodes.mesh.facets.size(); ++f) {
    const int label = nodes.mesh.facet_label[f];
    for (int k = 0; k < 3; ++k) {
      const int a = nodes.mesh.facets[f][k];
      const int b = nodes.mesh.facets[f][(k + 1) % 3];
      const int edge = nodes.facet_edges[f][k];
      const auto first = at.find(nodes.corner[a]);
      if (first == at.end()) {
        continue;
      }
      for (const int n :
           kept(kept(first->second, nodes.corner[b]), nodes.mid[edge])) {
        if (taken.insert({label, n, edge}).second) {
          rims[films.mesh.labels[label] + names[n].ending].push_back(
              {a, b, corners + edge});
        }
      }
    }
  }
  return rims;
}

double offset_of(walls::WallSide side) {
  switch (side) {
    case walls::WallSide::Both:
      return 0.0;
    case walls::WallSide::Inside:
      return -0.5;
    case walls::WallSide::Outside:
      return 0.5;
  }
  return 0.0;
}

TetMesh skin_of(const QuadraticSurface& surface,
                const shell::ShellMesh& shell) {
  TetMesh skin;
  skin.order = 2;
  skin.nodes = shell.nodes;
  skin.corner_count = static_cast<int>(surface.base.points.size());
  for (const std::array<int, 6>& facet : shell.facets) {
    skin.faces.insert(skin.faces.end(), facet.begin(), facet.end());
  }
  skin.face_label = surface.base.facet_label;
  skin.labels = surface.base.labels;
  return skin;
}

}  // namespace

ShellModel::ShellModel(const case_data::Case& input,
                       const case_data::EvaluatedCase& inputs,
                       const frozen::FilmModel& film) {
  const Points& points = film.reference().points;
  const walls::WallFilms films =
      walls::wall_films(film, inputs.film_system, points, inputs.shells);
  nodes_ = nodes_of(films);
  for (const int label : nodes_.mesh.facet_label) {
    section_.push_back(films.wall[label]);
  }
  for (const int corner : nodes_.corner) {
    reference_.push_back(points[static_cast<std::size_t>(corner)]);
  }
  specs_ = walls::on_films(inputs.shells, films.mesh, films.wall, films.rims);
  for (const case_data::ShellEntry& entry : input.shells) {
    keys_.push_back(fmt::format("{}: shells.{}.thickness",
                                case_data::place(input, entry.line),
                                entry.name));
    std::vector<double>& shares = shares_.emplace_back();
    for (const case_data::LayerEntry& layer : entry.layers) {
      shares.push_back(layer.share);
    }
    directions_.push_back(entry.direction);
  }
  rims_ = rims_of(films, nodes_);
  for (const walls::WallPlane& plane : films.planes.planes) {
    for (const std::string& label : films.mesh.labels) {
      const std::string end = label + "/" + plane.rim;
      if (rims_.contains(end)) {
        planes_[end] = plane.normal;
      }
    }
  }
  straighten_folded(nodes_, points);
}

double ShellModel::thickness_at(std::size_t shell, Numbers numbers,
                                const Vec3& at) const {
  double thickness = 0.0;
  try {
    thickness = value_at(specs_[shell].thickness, numbers, at);
  } catch (const ExpressionError& error) {
    throw InvalidInput(
        fmt::format("{} has no value: {}", keys_[shell], error.what()));
  }
  if (!(thickness > 0.0) || !std::isfinite(thickness)) {
    throw InvalidInput(fmt::format(
        "{} is {:g} at ({:.4g}, {:.4g}, {:.4g}); it must be above 0 on the "
        "whole film",
        keys_[shell], thickness, at.x(), at.y(), at.z()));
  }
  return thickness;
}

std::shared_ptr<ShellPart> ShellModel::part(
    const case_data::EvaluatedCase& inputs, const Points& film) const {
  auto part = std::make_shared<ShellPart>();
  const QuadraticSurface surface = nodes_.at(film);
  part->mesh = shell::shell_mesh(
      surface, VectorX::Ones(std::ssize(surface.base.points)));
  part->mesh.section = section_;
  for (std::size_t f = 0; f < section_.size(); ++f) {
    const auto s = static_cast<std::size_t>(section_[f]);
    for (int k = 0; k < 3; ++k) {
      part->mesh.thickness[f][k] =
          thickness_at(s, inputs.shells[s].thickness.own(),
                       reference_[nodes_.mesh.facets[f][k]]);
    }
  }
  // Those of bodies stand before them.
  std::size_t layer = inputs.materials.size();
  for (const std::vector<double>& shares : shares_) {
    layer -= shares.size();
  }
  part->first_layer = static_cast<int>(layer);
  for (std::size_t s = 0; s < inputs.shells.size(); ++s) {
    shell::Section& section = part->sections.emplace_back();
    section.offset = offset_of(inputs.shells[s].side);
    for (const double share : shares_[s]) {
      const element::Material& material = inputs.materials[layer];
      section.laminate.plies.push_back(
          {material, share, inputs.layer_angles[layer]});
      if (material.orthotropic && !section.direction) {
        section.direction =
            directions_[s].value_or(material.orthotropic->axes.first);
      }
      ++layer;
    }
  }
  shell::check_shell(part->mesh, part->sections);
  part->skin = skin_of(surface, part->mesh);
  part->frozen = reference_;
  part->rims = rims_;
  part->planes = planes_;
  return part;
}

Points ShellModel::to_film(const Points& by_nodes, std::size_t points) const {
  const auto corners = static_cast<std::ptrdiff_t>(nodes_.corner.size());
  return nodes_.transpose({by_nodes.begin(), by_nodes.begin() + corners},
                          {by_nodes.begin() + corners, by_nodes.end()}, points);
}

std::vector<VectorX> ShellModel::to_numbers(
    const case_data::EvaluatedCase& inputs,
    const std::vector<Vec3>& by_thickness) const {
  std::vector<VectorX> sums;
  for (const walls::WallSpec& spec : inputs.shells) {
    sums.push_back(VectorX::Zero(spec.thickness.numbers.size()));
  }
  for (std::size_t f = 0; f < by_thickness.size(); ++f) {
    const auto s = static_cast<std::size_t>(section_[f]);
    for (int k = 0; k < 3; ++k) {
      add_by_numbers(specs_[s].thickness, inputs.shells[s].thickness.own(),
                     reference_[nodes_.mesh.facets[f][k]], by_thickness[f][k],
                     Vec3::Zero(), sums[s]);
    }
  }
  return sums;
}

namespace {

bool are_held_alike(const loads::LoadCase& a, const loads::LoadCase& b) {
  return a.supports == b.supports && a.springs == b.springs && a.pins == b.pins;
}

/// Of all load cases that are held as this one.
std::shared_ptr<const shell::ShellSystem> system_of(
    const case_data::EvaluatedCase& inputs, const loads::LoadCase& own,
    const ShellPart& part, Monitor* monitor) {
  std::vector<shell::ShellLoads> loads;
  for (std::size_t k = 0; k < inputs.load_cases.size(); ++k) {
    if (are_held_alike(own, inputs.load_cases[k])) {
      loads.push_back(part.cases[k].actions.loads);
    }
  }
  return std::make_shared<shell::ShellSystem>(
      part.mesh, part.sections, node_supports(part, own), shell::facet_rule(),
      shell::ShellFactorOptions{.monitor = monitor}, ground_springs(part, own),
      rigid_rims(part, own), loads);
}

/// |reactions + loads| over the sum of |loads|, nodal forces all of them.
double imbalance(const VectorX& forces, const VectorX& reactions) {
  Vec3 left = Vec3::Zero();
  double all = 0.0;
  for (Eigen::Index i = 0; i < forces.size(); i += 3) {
    left += forces.segment<3>(i) + reactions.segment<3>(i);
    all += forces.segment<3>(i).norm();
  }
  return all > 0.0 ? left.norm() / all : 0.0;
}

void add_case(const loads::LoadCase& load_case,
              const shell::ShellSolution& found, ShellPart& part,
              ShellCase& own, equations::ElasticSolution& solution) {
  equations::ElasticReport& report = solution.report;
  const Timer timer;
  own.displacement = found.displacement;
  own.reaction = found.reaction;
  const VectorX forces =
      shell::nodal_forces(part.mesh, part.sections, own.actions.loads);
  const VectorX u = shell::displacements_of(found.displacement);
  const VectorX reactions =
      shell::displacements_of(found.reaction) -
      supports::spring_forces(spring_blocks(part, load_case), u);
  // Reactions of what is free are the residual.
  const double size = std::max(forces.norm(), found.reaction.norm());
  const double left = own.system->freedom().restrict(found.reaction).norm();
  report.residual = std::max(report.residual, size > 0.0 ? left / size : left);
  if (solution.displacements.empty()) {
    report.dofs = own.system->freedom().unknowns();
    report.strain_energy = found.strain_energy;
    report.reaction_imbalance =
        imbalance(shell::displacements_of(forces), reactions);
  }
  solution.displacements.push_back(u);
  solution.reactions.push_back(reactions);
  report.solve_seconds += timer.seconds();
}

}  // namespace

equations::ElasticSolution solve_load_cases(
    const case_data::EvaluatedCase& inputs, ShellPart& part,
    const std::function<void(std::size_t load_case,
                             equations::ElasticSolution& solution)>& solve) {
  equations::ElasticSolution solution;
  solution.report.solver = "cholmod";
  part.cases.resize(inputs.load_cases.size());
  std::size_t k = 0;
  const auto failed = [&](const std::exception& error) {
    const std::string own =
        fmt::format("load case '{}'", inputs.load_cases[k].name);
    const std::string said = error.what();
    solution.failure =
        Failure{FailureKind::SolverFailed,
                said.starts_with(own) ? said : own + ": " + said};
  };
  try {
    for (; k < part.cases.size(); ++k) {
      solve(k, solution);
    }
  } catch (const SolverError& error) {
    failed(error);
  } catch (const InvalidInput& error) {
    failed(error);
  } catch (const MeshError& error) {
    solution.failure = Failure{FailureKind::ElementsInverted, error.what()};
  }
  return solution;
}

equations::ElasticSolution solve_shell(const case_data::EvaluatedCase& inputs,
                                       ShellPart& part, Monitor* monitor) {
  const std::vector<loads::LoadCase>& all = inputs.load_cases;
  const equations::ElasticSolution loaded = solve_load_cases(
      inputs, part, [&](std::size_t k, equations::ElasticSolution&) {
        part.cases[k].actions = shell_actions(part, all[k]);
      });
  if (loaded.failure) {
    return loaded;
  }
  return solve_load_cases(
      inputs, part, [&](std::size_t k, equations::ElasticSolution& solution) {
        const Timer setup;
        // The earlier ones that its system serves.
        std::size_t before = 0;
        for (std::size_t j = 0; j < k; ++j) {
          if (are_held_alike(all[j], all[k])) {
            part.cases[k].system = part.cases[j].system;
            ++before;
          }
        }
        if (before == 0) {
          part.cases[k].system = system_of(inputs, all[k], part, monitor);
        }
        solution.report.setup_seconds += setup.seconds();
        add_case(all[k], part.cases[k].system->solutions()[before], part,
                 part.cases[k], solution);
      });
}

}  // namespace meniscus::shells
