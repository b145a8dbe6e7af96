#include "pipeline/forward/shells.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "evolve/walls/rim_shape.h"
#include "evolve/walls/wall_films.h"

namespace meniscus::forward {

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

/// The film's edges of which both ends and the middle are on the curve.
Line edges_on(const SurfaceNodes& nodes, int label,
              const std::set<int>& vertices) {
  const auto corners = static_cast<int>(nodes.corner.size());
  std::set<int> taken;
  Line line;
  for (std::size_t f = 0; f < nodes.mesh.facets.size(); ++f) {
    for (int k = 0; k < 3 && nodes.mesh.facet_label[f] == label; ++k) {
      const int a = nodes.mesh.facets[f][k];
      const int b = nodes.mesh.facets[f][(k + 1) % 3];
      const int edge = nodes.facet_edges[f][k];
      if (vertices.contains(nodes.corner[a]) &&
          vertices.contains(nodes.corner[b]) &&
          vertices.contains(nodes.mid[edge]) && taken.insert(edge).second) {
        line.push_back({a, b, corners + edge});
      }
    }
  }
  return line;
}

std::map<std::string, Line> rims_of(const walls::WallFilms& films,
                                    const SurfaceNodes& nodes) {
  std::map<std::string, Line> rims;
  for (std::size_t label = 0; label < films.mesh.labels.size(); ++label) {
    for (const walls::RimName& name : films.names) {
      const Line line = edges_on(nodes, static_cast<int>(label),
                                 {name.vertices.begin(), name.vertices.end()});
      if (!line.empty()) {
        Line& rim = rims[films.mesh.labels[label] + "/rim:" + name.curve];
        rim.insert(rim.end(), line.begin(), line.end());
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
    line_names_.push_back(fmt::format("{}: shells.{}.thickness",
                                      case_data::place(input, entry.line),
                                      entry.name));
  }
  rims_ = rims_of(films, nodes_);
}

std::shared_ptr<responses::ShellPart> ShellModel::part(
    const case_data::EvaluatedCase& inputs, const Points& film) const {
  auto part = std::make_shared<responses::ShellPart>();
  const QuadraticSurface surface = nodes_.at(film);
  part->mesh = shell::shell_mesh(
      surface, VectorX::Ones(std::ssize(surface.base.points)));
  part->mesh.section = section_;
  for (std::size_t f = 0; f < section_.size(); ++f) {
    const auto s = static_cast<std::size_t>(section_[f]);
    const Numbers numbers = inputs.shells[s].thickness.own();
    for (int k = 0; k < 3; ++k) {
      const Vec3& at = reference_[nodes_.mesh.facets[f][k]];
      double t = 0.0;
      try {
        t = value_at(specs_[s].thickness, numbers, at);
      } catch (const ExpressionError& error) {
        throw InvalidInput(
            fmt::format("{} has no value: {}", line_names_[s], error.what()));
      }
      if (!(t > 0.0) || !std::isfinite(t)) {
        throw InvalidInput(fmt::format(
            "{} is {:g} at ({:.4g}, {:.4g}, {:.4g}); it must be above 0 on the "
            "whole film",
            line_names_[s], t, at.x(), at.y(), at.z()));
      }
      part->mesh.thickness[f][k] = t;
    }
  }
  for (std::size_t s = 0; s < inputs.shells.size(); ++s) {
    part->sections.push_back(
        {.laminate = {.plies = {{.material = inputs.materials[s]}}},
         .offset = offset_of(inputs.shells[s].side)});
  }
  shell::check_shell(part->mesh, part->sections);
  part->skin = skin_of(surface, part->mesh);
  part->rims = rims_;
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

std::vector<shell::NodeSupport> node_supports(
    const responses::ShellPart& part, const loads::LoadCase& load_case) {
  std::vector<shell::NodeSupport> supports;
  for (const loads::Support& support : load_case.supports) {
    std::set<int> nodes;
    if (support.surface.find("/rim:") != std::string::npos) {
      for (const std::array<int, 3>& edge :
           responses::rim_of(part, support.surface)) {
        nodes.insert(edge.begin(), edge.end());
      }
    } else {
      const int label = part.skin.label_of(responses::film_of(support.surface));
      for (int f = 0; f < part.skin.face_count(); ++f) {
        if (part.skin.face_label[f] == label) {
          nodes.insert(part.skin.face(f).begin(), part.skin.face(f).end());
        }
      }
    }
    const auto& turn = support.fix_rotation;
    for (const int node : nodes) {
      supports.push_back({.node = node,
                          .held = {support.fix_x, support.fix_y, support.fix_z,
                                   turn[0], turn[1], turn[2]},
                          .axes = support.axes});
    }
  }
  return supports;
}

equations::ElasticSolution solve_shell(const case_data::EvaluatedCase& inputs,
                                       responses::ShellPart& part) {
  equations::ElasticSolution solution;
  equations::ElasticReport& report = solution.report;
  report.solver = "cholmod";
  part.cases.resize(inputs.load_cases.size());
  try {
    for (std::size_t k = 0; k < inputs.load_cases.size(); ++k) {
      const loads::LoadCase& load_case = inputs.load_cases[k];
      responses::ShellCase& own = part.cases[k];
      const Timer setup;
      for (std::size_t other = 0; other < k && !own.system; ++other) {
        if (inputs.load_cases[other].supports == load_case.supports) {
          own.system = part.cases[other].system;
        }
      }
      if (!own.system) {
        own.system = std::make_shared<shell::ShellSystem>(
            part.mesh, part.sections, node_supports(part, load_case));
      }
      report.setup_seconds += setup.seconds();
      const Timer solve;
      own.actions = responses::shell_actions(part, load_case);
      const shell::ShellSolution found = own.system->solve(own.actions.loads);
      report.solve_seconds += solve.seconds();
      own.displacement = found.displacement;
      solution.displacements.push_back(
          responses::displacements_of(found.displacement));
      solution.reactions.push_back(responses::displacements_of(found.reaction));
      // Reactions of what is free are the residual.
      const VectorX f =
          shell::nodal_forces(part.mesh, part.sections, own.actions.loads);
      const double size = f.norm();
      const double left = own.system->freedom().restrict(found.reaction).norm();
      report.residual =
          std::max(report.residual, size > 0.0 ? left / size : left);
      if (k == 0) {
        report.dofs = own.system->freedom().unknowns();
        report.strain_energy = found.strain_energy;
        Vec3 sum = Vec3::Zero();
        double all = 0.0;
        for (Eigen::Index i = 0; i < f.size(); i += 6) {
          sum += f.segment<3>(i) + found.reaction.segment<3>(i);
          all += f.segment<3>(i).norm();
        }
        report.reaction_imbalance = all > 0.0 ? sum.norm() / all : 0.0;
      }
    }
  } catch (const SolverError& error) {
    solution.failure = Failure{FailureKind::SolverFailed, error.what()};
  } catch (const InvalidInput& error) {
    solution.failure = Failure{FailureKind::SolverFailed, error.what()};
  }
  return solution;
}

}  // namespace meniscus::forward
