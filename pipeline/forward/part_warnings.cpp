#include "pipeline/forward/part_warnings.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "fea/functionals/thickness.h"
#include "fea/stress/peak_stress.h"
#include "pipeline/shells/shell_advice.h"

namespace meniscus::forward {

namespace {

// Beyond this part of the part's size, rotations are no longer small.
constexpr double kLargeDisplacement = 0.05;
// Flat facets of a curved wall lie closer than it is thick.
constexpr double kFlatFacets = 0.02;
// An eigenvalue x area / tension below it is a free mode that the facets hold:
// 3 and more of drops that stand upright between two circles, 0.003 to 0.05 of
// those that hang to a side.
constexpr double kFreeMode = 0.1;

double largest_displacement(const VectorX& u) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k + 2 < u.size(); k += 3) {
    largest = std::max(largest, u.segment<3>(k).norm());
  }
  return largest;
}

std::string yield_warning(const case_data::Case& input,
                          const std::string& load_case,
                          const StressFigures::Safety& s, const char* where) {
  return fmt::format(
      "stress above yield{}: load case '{}' reaches {:.4g} {} at ({:.4g}, "
      "{:.4g}, {:.4g}), '{}' yields at {:.4g} {} (safety factor {:.3g}); a "
      "linear analysis does not hold there (at a clamped edge the value grows "
      "with every refinement)",
      where, load_case, s.von_mises, input.units.pressure, s.position.x(),
      s.position.y(), s.position.z(), s.material, s.yield_strength,
      input.units.pressure, s.factor);
}

/// Of the load cases whose peak is where the material is one element thick.
std::string thin_warning(const case_data::Case& input, const TetMesh& mesh,
                         const std::vector<StressFigures>& stress) {
  std::vector<std::string> places;
  for (const StressFigures& figures : stress) {
    if (figures.is_unit_load) {
      continue;
    }
    const stress::Peak& peak = figures.readings.largest();
    if (peak.von_mises > 0.0 &&
        stress::one_element_through(mesh, peak.position, peak.region)) {
      places.push_back(fmt::format("of '{}' at ({:.4g}, {:.4g}, {:.4g})",
                                   figures.load_case, peak.position.x(),
                                   peak.position.y(), peak.position.z()));
    }
  }
  return places.empty()
             ? ""
             : fmt::format(
                   "one element through the material at the peak stress {}: it "
                   "may be too low, and by more than its +-; take a shorter "
                   "resolution.fea (now {:.4g} {}), or analyse the films of "
                   "thin walls as [shells]",
                   fmt::join(places, ", "), input.resolution.fea,
                   input.units.length);
}

std::map<std::string, Points> points_by_film(const SurfaceMesh& film) {
  std::map<std::string, Points> points;
  for (std::size_t f = 0; f < film.facets.size(); ++f) {
    Points& own = points[film.labels[film.facet_label[f]]];
    for (const int corner : film.facets[f]) {
      own.push_back(film.points[corner]);
    }
  }
  return points;
}

}  // namespace

std::vector<std::string> part_warnings(
    const case_data::Case& input, const EvaluationFields& fields,
    const std::vector<StressFigures>& stress) {
  std::vector<std::string> warnings;
  const double size = bounding_diagonal(fields.mesh.nodes);
  for (std::size_t k = 0; k < stress.size(); ++k) {
    if (stress[k].is_unit_load) {
      continue;
    }
    if (stress[k].safety && stress[k].safety->factor < 1.0) {
      warnings.push_back(
          yield_warning(input, stress[k].load_case, *stress[k].safety, ""));
    }
    const auto& out = stress[k].excluded;
    if (out && out->safety && out->safety->factor < 1.0) {
      warnings.push_back(yield_warning(input, stress[k].load_case, *out->safety,
                                       " in an exclusion zone"));
    }
    if (has_no_limit(stress[k])) {
      warnings.push_back(no_limit_text(stress[k], input.units));
    }
    const double largest =
        largest_displacement(fields.solution.displacements[k]);
    if (largest > kLargeDisplacement * size) {
      warnings.push_back(fmt::format(
          "deflection not small: load case '{}' moves a point by {:.4g} {}, "
          "{:.1f} % of the part's size; a linear analysis does not hold",
          stress[k].load_case, largest, input.units.length,
          100.0 * largest / size));
    }
  }
  if (fields.shell) {
    for (std::string& thick :
         shells::thick_shell_warnings(input, *fields.shell)) {
      warnings.push_back(std::move(thick));
    }
    return warnings;
  }
  std::string thin = thin_warning(input, fields.mesh, stress);
  if (!thin.empty()) {
    warnings.push_back(std::move(thin));
  }
  for (std::string& advice : shells::thin_wall_advice(
           input, fields.inputs, points_by_film(fields.film))) {
    warnings.push_back(std::move(advice));
  }
  return warnings;
}

std::vector<std::string> film_warnings(const case_data::Case& input,
                                       const settle::FilmReport& film) {
  const double held = film.min_eigenvalue * film.area;
  if (film.index > 0 || !(held < kFreeMode * film.tension)) {
    return {};
  }
  return {fmt::format(
      "the film can move almost freely (smallest eigenvalue {:.2g} {}/{}3, "
      "{:.2g} of tension / area): along that mode the mesh chooses its shape, "
      "not the liquid, so that another mesh gives another part; as a drop with "
      "more liquid than its curves hold upright, which hangs to one side. Look "
      "at film.png, and check the volumes",
      film.min_eigenvalue, input.units.force, input.units.length,
      held / film.tension)};
}

std::vector<std::string> wall_warnings(const ForwardModel& model) {
  std::vector<std::string> warnings;
  if (model.walls() == nullptr) {
    return warnings;
  }
  for (const walls::ThickWall& wall : model.walls()->walls()) {
    const walls::SafeThickness& safe = wall.safe;
    if (safe.limit != walls::WallLimit::None && safe.asked >= safe.value) {
      warnings.push_back(safe.message);
    }
  }
  return warnings;
}

std::vector<std::string> process_warnings(const case_data::Case& input,
                                          const TetMesh& mesh) {
  const case_data::ProcessEntry& process = input.process;
  if (!(process.smallest_feature > 0.0)) {
    return {};
  }
  const double limit = (1.0 - kFlatFacets) * process.smallest_feature;
  functionals::ThinPlace thin;
  try {
    thin = functionals::thinnest_place(mesh, functionals::thickness_pairs(mesh),
                                       limit);
  } catch (const InvalidInput&) {  // no two faces across from each other
    return {};
  }
  if (thin.value >= limit) {
    return {};
  }
  return {fmt::format(
      "too thin to be made: {:.3g} {} at ({:.4g}, {:.4g}, {:.4g}), and {} "
      "makes nothing thinner than {:.4g} {}; so is {:.3g} % of the surface: "
      "make the part thicker there (as a constraint: a response of kind "
      "thickness), or take another process",
      thin.value, input.units.length, thin.place.x(), thin.place.y(),
      thin.place.z(), process.name.empty() ? "the process" : process.name,
      process.smallest_feature, input.units.length, 100.0 * thin.share)};
}

std::vector<std::string> factor_warnings(const EvaluationFields& fields) {
  std::vector<std::string> warnings;
  const responses::ResponseModes& modes = fields.response_modes;
  for (const responses::ModalSum& sum : modes.sums) {
    const responses::FoundModes& found = modes.problems[sum.problem];
    if (found.kind != case_data::ResponseKind::BucklingFactor) {
      continue;
    }
    Eigen::Index most = 0;
    sum.weights.maxCoeff(&most);
    const auto mode = static_cast<std::size_t>(most);
    const auto c = static_cast<std::size_t>(found.load_case);
    modes::BucklingFigures figures;
    figures.modes.factors = {found.values[mode]};
    figures.stresses = {stress_in_mode(fields, c, found.shapes[mode])};
    if (!matters(figures, 0)) {
      warnings.push_back(fmt::format(
          "'{}' is the factor of a mode that does not matter: the material "
          "gives way long before, and at edges where stress has no limit such "
          "factors fall with every refinement; bound the stress instead",
          sum.response));
    }
  }
  return warnings;
}

std::vector<std::string> eigen_warnings(const EigenFigures& figures) {
  std::vector<std::string> warnings;
  for (const modes::BucklingFigures& b : figures.buckling) {
    const std::vector<std::string> own = buckling_warnings(b);
    warnings.insert(warnings.end(), own.begin(), own.end());
  }
  if (!figures.remark.empty()) {
    warnings.push_back(figures.remark);
  }
  if (figures.frequencies && figures.frequencies->modes.failure) {
    warnings.push_back("not all natural frequencies: " +
                       figures.frequencies->modes.failure->message);
  }
  return warnings;
}

}  // namespace meniscus::forward
