#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/count_text.h"
#include "pipeline/case_data/composed_responses.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/study_kinds.h"
#include "pipeline/forward/eigen_figures.h"
#include "pipeline/forward/norm_peaks.h"
#include "pipeline/results/multiplier_figures.h"
#include "pipeline/results/results.h"

namespace meniscus::results {

namespace {

/// All finite ones of a row; "up to" the largest where there are several.
std::string row_error(const case_data::Case& input,
                      const case_data::DesignRow& row, const VectorX& errors) {
  double largest = -1.0;
  for (std::size_t k = row.first; k < row.first + row.count; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (i < errors.size() && std::isfinite(errors[i])) {
      largest = std::max(largest, errors[i]);
    }
  }
  return largest < 0.0
             ? ""
             : fmt::format("  +- {}{}", row.vector == nullptr ? "" : "up to ",
                           case_data::shown_unit(input, input.design[row.first])
                               .text(largest, 2));
}

std::string with_error(double value, const VectorX& errors, Eigen::Index k,
                       const ShownUnit& unit) {
  std::string text = unit.text(value);
  if (k < errors.size() && std::isfinite(errors[k])) {
    text += "  +- " + unit.text(errors[k], 2);
  }
  return text;
}

/// "   at its lower bound", "   3 at their lower bound" of variables that a
/// study moved there.
std::string at_bound(const case_data::Case& input,
                     const case_data::DesignRow& row, const VectorX& design) {
  std::string text;
  for (const std::string side : {"lower", "upper"}) {
    const std::size_t count = count_at_bound(input, row, design, side);
    if (count > 0) {
      text += row.vector == nullptr
                  ? fmt::format("   at its {} bound", side)
                  : fmt::format("   {} at their {} bound", count, side);
    }
  }
  return text;
}

/// Of variables that the targets of a match do not hold.
std::string free_text(const case_data::DesignRow& row, const VectorX& errors) {
  std::size_t count = 0;
  for (std::size_t k = row.first; k < row.first + row.count; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    count += i < errors.size() && std::isnan(errors[i]) ? 1 : 0;
  }
  return count == 0
             ? ""
             : fmt::format(
                   "   {}not fixed by the targets",
                   row.vector == nullptr ? "" : fmt::format("{} ", count));
}

std::string popped_text(const case_data::Case& input,
                        const settle::FilmReport& film) {
  std::string text;
  for (const settle::PulledFilm& popped : film.popped) {
    text += fmt::format(
        "  film {}, pulled from {} where films met as none keeps: area {:.6g} "
        "{}, about ({:.4g}, {:.4g}, {:.4g})\n",
        popped.name, popped.pulled_from, popped.area,
        input.units.unit_of(Dimension::Area), popped.place.x(),
        popped.place.y(), popped.place.z());
  }
  return text;
}

/// What another mesh changed most, relative to the answer.
std::string shift_text(const case_data::Case& input,
                       const store::Refreeze& refreeze, const VectorX& answer) {
  constexpr double kOfNothing = 1.0;
  Eigen::Index worst = -1;
  double largest = 0.0;
  for (Eigen::Index k = 0; k < refreeze.shift.size(); ++k) {
    const double relative = std::abs(refreeze.shift[k] / answer[k]);
    // Of an answer near 0 a part of it says nothing.
    if (relative < kOfNothing && relative > largest) {
      worst = k;
      largest = relative;
    }
  }
  return worst < 0 ? ""
                   : fmt::format("; the new mesh changes '{}' by {:.2g} %",
                                 input.responses[worst].name, 100.0 * largest);
}

/// "at least 0.05 mm, at most 0.1 mm".
std::string bounds_text(const case_data::Case& input,
                        const case_data::ConstraintEntry& entry) {
  const ShownUnit unit = case_data::shown_unit(input, entry.response);
  const auto shown = [&](double value) { return unit.text(value); };
  if (entry.lower == entry.upper) {
    return "wanted " + shown(entry.lower);
  }
  std::string bounds;
  if (std::isfinite(entry.lower)) {
    bounds = "at least " + shown(entry.lower);
  }
  if (std::isfinite(entry.upper)) {
    bounds += (bounds.empty() ? "at most " : ", at most ") + shown(entry.upper);
  }
  return bounds;
}

/// "  sway   0.09 mm, at most 0.1 mm: kept"; a margin that the search held
/// higher says at what.
std::string constraint_text(const case_data::Case& input,
                            const case_data::ConstraintEntry& entry,
                            const study::Constraint& constraint) {
  constexpr double kAtBound = 1e-3;  // of the bound
  const ShownUnit unit = case_data::shown_unit(input, entry.response);
  const auto is_at = [&](double bound) {
    return std::isfinite(bound) &&
           std::abs(constraint.value - bound) <= kAtBound * std::abs(bound);
  };
  const bool active =
      entry.lower != entry.upper && (is_at(entry.lower) || is_at(entry.upper));
  const std::string held =
      !constraint.held
          ? ""
          : fmt::format(
                "{}the search held it at {} or more for the mesh's "
                "error of it",
                is_at(*constraint.held) ? ", where it stands: " : "; ",
                unit.text(*constraint.held));
  return fmt::format("  {:<20} {}, {}: {}{}\n", constraint.name,
                     unit.text(constraint.value), bounds_text(input, entry),
                     !constraint.satisfied ? "VIOLATED"
                     : active              ? "kept, at its bound"
                                           : "kept",
                     held);
}

/// "58 evaluations (45 of models before the last, 13 of the last; 2 failed)".
std::string counts_text(const study::RunResult& result) {
  std::string text =
      count_text(static_cast<std::size_t>(result.evaluations), "evaluation");
  std::string parts;
  if (result.evaluations_of_models.size() > 1) {
    const int last = result.evaluations_of_models.back().second;
    parts = fmt::format("{} on models frozen before, {} on the last",
                        result.evaluations - last, last);
  }
  if (result.failed_evaluations > 0) {
    parts += fmt::format("{}{} failed", parts.empty() ? "" : "; ",
                         result.failed_evaluations);
  }
  return parts.empty() ? text : text + " (" + parts + ")";
}

std::string elements_text(const case_data::Case& input,
                          const forward::Evaluation& best) {
  if (best.tet.facets > 0) {
    return fmt::format(
        "{} ten-node tetrahedra and {} six-node facets of shells, {} unknowns",
        best.tet.elements, best.tet.facets, best.fea.dofs);
  }
  return input.shells.empty()
             ? fmt::format(
                   "{} ten-node tetrahedra, {} unknowns, dihedral "
                   "angles {:.1f} to {:.1f} degrees",
                   best.tet.elements, best.fea.dofs, best.tet.min_dihedral_deg,
                   best.tet.max_dihedral_deg)
             : fmt::format("{} six-node facets of shells, {} unknowns",
                           best.tet.elements, best.fea.dofs);
}

}  // namespace

std::string bound_reached(const case_data::DesignVariable& variable,
                          double value) {
  constexpr double kThere = 1e-5;  // of the range
  const double near = kThere * (variable.upper - variable.lower);
  if (!(variable.upper > variable.lower)) {
    return "";
  }
  return value <= variable.lower + near   ? "lower"
         : value >= variable.upper - near ? "upper"
                                          : "";
}

std::size_t count_at_bound(const case_data::Case& input,
                           const case_data::DesignRow& row,
                           const VectorX& design, std::string_view side) {
  std::size_t count = 0;
  for (std::size_t k = row.first; k < row.first + row.count; ++k) {
    const double value = design[static_cast<Eigen::Index>(k)];
    count += bound_reached(input.design[k], value) == side ? 1 : 0;
  }
  return count;
}

std::string result_text(const case_data::Case& input,
                        const study::RunResult& result) {
  std::string text;
  if (!result.best || result.best->responses.size() == 0) {
    return text;
  }
  const forward::Evaluation& best = *result.best;
  const bool moves = input.study.kind != case_data::StudyKind::Analyse;
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    text += fmt::format("  {:<20} {}{}{}{}\n", row.label(),
                        case_data::row_text(input, row, best.design),
                        row_error(input, row, result.design_errors),
                        moves ? at_bound(input, row, best.design) : "",
                        free_text(row, result.design_errors));
  }
  const std::vector<std::string> names = case_data::response_names(input);
  const bool moved = result.start && result.start->design != best.design;
  for (Eigen::Index k = 0; k < best.responses.size(); ++k) {
    const ShownUnit unit = case_data::shown_unit(input, static_cast<int>(k));
    text += fmt::format(
        "  {:<20} {}", names[k],
        with_error(best.responses[k], result.response_errors, k, unit));
    if (moved && result.start->responses.size() > k) {
      text += "   (at the start " + unit.text(result.start->responses[k]) + ")";
    }
    if (const case_data::ResponseEntry& response = input.responses[k];
        response.kind == case_data::ResponseKind::Envelope) {
      text +=
          fmt::format("   ({} '{}')", response.least ? "least" : "most",
                      names[case_data::extreme_part(response, best.responses)]);
    }
    for (const responses::WorstLoad& worst : result.worst_loads) {
      text += worst.response == k
                  ? fmt::format("   (worst along {})",
                                responses::direction_text(worst.direction))
                  : "";
    }
    text += "\n";
  }
  const bool matches = input.study.kind == case_data::StudyKind::Match;
  for (std::size_t k = 0; k < result.constraints.size(); ++k) {
    const study::Constraint& c = result.constraints[k];
    text += matches
                ? fmt::format("  {:<20} mismatch {:.2e}, tolerance {:.1e}\n",
                              c.name, c.value, c.bound)
                : constraint_text(input, input.study.constraints[k], c);
  }
  if (result.multipliers) {
    text += multipliers_text(input, *result.multipliers, result.objective);
  }
  for (const forward::NormPeak& peak :
       forward::norm_peaks(input, best.responses, result.stress)) {
    text += forward::norm_text(input, peak);
  }
  text += forward::stress_text(result.stress, input.units);
  if (result.sweep) {
    text += study::sweep_text(input, *result.sweep);
  }
  if (result.tolerance) {
    text += study::tolerance_text(input, *result.tolerance);
  }
  if (result.front) {
    text += study::front_text(input, *result.front);
  }
  for (const forward::ExclusionShare& zone : result.exclusion.zones) {
    text += fmt::format(
        "  left out of stress figures: {}: {} elements, {:.2g} % of the "
        "volume\n",
        zone.where, zone.elements, 100.0 * zone.volume_share);
  }
  if (result.coarse) {
    text += fmt::format(
        "  first with edges {:.3g} times as long: {} and {}{}\n",
        result.coarse->edge_factor,
        count_text(static_cast<std::size_t>(result.coarse->evaluations),
                   "evaluation"),
        count_text(static_cast<std::size_t>(result.coarse->gradients),
                   "gradient"),
        result.coarse->design.size() > 0 ? "" : ", which gave no start");
  }
  for (const store::Refreeze& r : result.refrozen) {
    text += fmt::format("  frozen anew at evaluation {}: {}{}\n", r.evaluation,
                        r.reason, shift_text(input, r, best.responses));
  }
  for (const store::TopologyEvent& event : result.topology) {
    text += "  " + store::event_text(input, event) + "\n";
  }
  text += popped_text(input, best.film);
  if (result.eigen) {
    text += forward::eigen_text(*result.eigen);
  }
  if (result.adaptation) {
    const forward::AdaptedState& before = result.adaptation->before;
    const forward::AdaptedState& after = result.adaptation->after;
    text += fmt::format(
        "  adapted: {} elements with an energy error of {:.2g} % to {} with "
        "{:.2g} %\n",
        before.tet.elements, 100.0 * before.errors.energy, after.tet.elements,
        100.0 * after.errors.energy);
  }
  text += fmt::format(
      "  film: {}, {} facets, residual {:.1e} (bound {:.1e}), smallest "
      "eigenvalue {:.3g}\n"
      "  elements: {}\n"
      "  {} and {} in {:.1f} s (film {:.1f}, mesh "
      "{:.1f}, elasticity {:.1f}, gradients {:.1f})\n",
      best.film.verdict, best.film.facets, best.film.residual,
      best.film.residual_bound, best.film.min_eigenvalue,
      elements_text(input, best), counts_text(result),
      count_text(static_cast<std::size_t>(result.gradient_evaluations),
                 "gradient"),
      result.total_seconds, result.seconds.film, result.seconds.mesh,
      result.seconds.fea, result.seconds.gradient);
  return text;
}

std::string study_text(const case_data::Case& input) {
  const case_data::StudyEntry& study = input.study;
  const auto name_of = [&](int response) {
    return input.responses[static_cast<std::size_t>(response)].name;
  };
  std::vector<std::string> parts;
  for (const std::optional<int>& sought :
       {study.fit, study.objective, study.second}) {
    if (sought) {
      parts.push_back(name_of(*sought));
    }
  }
  if (!study.equal.empty()) {
    parts.push_back(fmt::format("{}", fmt::join(study.equal, " = ")));
  }
  for (const auto& [name, value] : study.targets) {
    const ShownUnit unit =
        case_data::shown_unit(input, case_data::response_index(input, name));
    parts.push_back(fmt::format("{} = {}", name, unit.text(value)));
  }
  for (const case_data::ConstraintEntry& entry : study.constraints) {
    parts.push_back(fmt::format("{} {}", name_of(entry.response),
                                bounds_text(input, entry)));
  }
  return (study.members.empty() ? "" : "each member: ") +
         std::string(case_data::row_of(study.kind).name) +
         (parts.empty() ? "" : " ") + fmt::format("{}", fmt::join(parts, "; "));
}

std::string film_text(const case_data::Case& input,
                      const settle::FilmReport& film) {
  std::string text = fmt::format(
      "film: {}\n  {} vertices, {} facets, area {:.8g} {}, energy {:.8g} {}\n"
      "  residual {:.2e} {} (bound {:.2e}), smallest eigenvalue {:.4g}, index "
      "{}\n  smallest neck {:.4g} {} at ({:.4g}, {:.4g}, {:.4g})\n",
      film.verdict, film.vertices, film.facets, film.area,
      input.units.unit_of(Dimension::Area), film.energy,
      input.units.unit_of(Dimension::Energy), film.residual, input.units.force,
      film.residual_bound, film.min_eigenvalue, settle::index_text(film),
      film.smallest_neck, input.units.length, film.neck_position.x(),
      film.neck_position.y(), film.neck_position.z());
  text += popped_text(input, film);
  for (const settle::BodyState& body : film.bodies) {
    text += fmt::format("  body {}: volume {:.8g} {}, pressure {:.6g} {}\n",
                        body.name, body.volume,
                        input.units.unit_of(Dimension::Volume), body.pressure,
                        input.units.pressure);
  }
  return text;
}

}  // namespace meniscus::results
