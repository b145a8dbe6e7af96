// Models without liquid: plane faces and ruled rings.
#include "evolve/frozen/film_model_impl.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/equilibrium.h"
#include "evolve/start/start_complex.h"

namespace meniscus::frozen {

namespace {

// Refinements whose vertices a meshed surface uses: a split facet's corners
// are of the first, its mid-sides of the second.
constexpr int kMeshedLevels = 2;

}  // namespace

void FilmModel::Impl::build_rigid(const films::FilmSystem& initial,
                                  const FilmModelOptions& options) {
  start_edge = options.edge;
  complex = start::build_start(initial, start_edge);
  meshed = complex.mesh;
  meshed_complex = complex;
  for (int level = 0; level < options.refinements; ++level) {
    refine_once(level);
  }
  energy.emplace(complex);
  targets = energy::targets_of(complex);
  reference = rigid_state(complex.mesh.points, targets);
}

void FilmModel::Impl::refine_once(int level) {
  groom::Refinement finer = groom::refine(complex);
  complex = std::move(finer.complex);
  parents.insert(parents.end(), finer.parents.begin(), finer.parents.end());
  if (level < kMeshedLevels) {
    near_parents = parents.size();
  }
  ++refinements;
}

/// Of a part without liquid: nothing settles.
settle::FilmState FilmModel::Impl::rigid_state(
    const Points& points, const films::FilmTargets& goal) const {
  settle::FilmState state;
  state.points = points;
  state.heights = VectorX::Zero(0);
  state.report = settle::figures_of(*energy, goal, points,
                                    VectorX::Zero(energy->functionals()));
  state.report.verdict = "no films: faces of their curves alone";
  return state;
}

/// Of a part without liquid: its faces follow their curves and nothing else.
std::vector<FilmGradient> FilmModel::Impl::rigid_gradients(
    const std::vector<FilmCovector>& responses) const {
  std::vector<FilmGradient> result;
  result.reserve(responses.size());
  for (const FilmCovector& response : responses) {
    Points by_points = response.points;
    by_points.resize(complex.vertices.size(), Vec3::Zero());
    const auto bodies = static_cast<Eigen::Index>(complex.bodies.size());
    result.push_back(
        {rim_gradients(carry->transpose(by_points)),
         VectorX::Zero(static_cast<Eigen::Index>(complex.surfaces.size())),
         VectorX::Zero(bodies), VectorX::Zero(bodies)});
  }
  return result;
}

}  // namespace meniscus::frozen
