#include "evolve/frozen/line_lead.h"

#include <utility>

namespace meniscus::frozen {

std::vector<int> lines_of(const films::FilmComplex& reference,
                          const energy::FilmSpace& space) {
  std::vector<int> result;
  for (std::size_t v = 0; v < reference.vertices.size(); ++v) {
    const auto id = static_cast<int>(v);
    if (space.rank(id) > 1 &&
        reference.vertices[v].kind == films::VertexKind::Free) {
      result.push_back(id);
    }
  }
  return result;
}

LineLead::LineLead(const energy::FilmEnergy& energy, films::FilmTargets targets,
                   Points base, energy::FilmPaths paths, Points points,
                   VectorX heights, VectorX pressure, std::vector<int> lines)
    : targets_(std::move(targets)),
      base_(std::move(base)),
      paths_(std::move(paths)),
      points_(std::move(points)),
      heights_(std::move(heights)),
      pressure_(std::move(pressure)),
      lines_(std::move(lines)),
      adjoint_(energy, targets_, base_, paths_, points_, heights_, pressure_) {}

FilmAdjoint::Rates LineLead::differences(const films::FilmTargets& goal) const {
  FilmAdjoint::Rates result;
  result.tensions.resize(std::ssize(goal.tension));
  for (Eigen::Index s = 0; s < result.tensions.size(); ++s) {
    const auto k = static_cast<std::size_t>(s);
    result.tensions[s] = goal.tension[k] - targets_.tension[k];
  }
  const auto functionals = std::ssize(goal.bodies);
  result.volumes = VectorX::Zero(functionals);
  result.pressures = VectorX::Zero(functionals);
  for (Eigen::Index b = 0; b < functionals; ++b) {
    const films::ComplexBody& now = goal.bodies[static_cast<std::size_t>(b)];
    const films::ComplexBody& then =
        targets_.bodies[static_cast<std::size_t>(b)];
    result.volumes[b] = now.volume.value_or(0.0) - then.volume.value_or(0.0);
    result.pressures[b] =
        now.pressure.value_or(0.0) - then.pressure.value_or(0.0);
  }
  for (std::size_t q = 0; q < goal.numbers.size(); ++q) {
    result.numbers.push_back(goal.numbers[q] - targets_.numbers[q]);
  }
  return result;
}

Points LineLead::at_lines(const Points& all) const {
  Points result(all.size(), Vec3::Zero());
  for (const int v : lines_) {
    result[v] = all[v];
  }
  return result;
}

Points LineLead::moves(const FilmAdjoint::Rates& rates) const {
  return at_lines(adjoint_.tangent(rates));
}

FilmAdjoint::Result LineLead::transpose(const Points& by_moves) const {
  return adjoint_.transpose({.points = at_lines(by_moves)});
}

}  // namespace meniscus::frozen
