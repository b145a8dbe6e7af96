#include "pipeline/accuracy/mesh_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/response_kinds.h"

namespace meniscus::accuracy {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Clamped rims are singular: displacements show 0.6 to 1 there, never more for
// long. Where two changes differ in sign no order is seen.
constexpr double kLeastOrder = 0.5;
constexpr double kMostOrder = 1.0;
constexpr double kUnseenOrder = 0.7;
// Of the value, while edges are halved: a right-angled clamp or notch grows by
// a fifth and more (orders of -0.29 and -0.46), smooth peaks on coarse meshes
// by less.
constexpr double kNoTrend = 0.1;
constexpr double kSafety = 1.5;
// Films show 2 (docs/verification.md). Their coarsest model, of few edges
// around a rim, may be far off: the change to the nearer one counts.
constexpr double kLeastFilmOrder = 1.0;
constexpr double kMostFilmOrder = 2.0;
// The error over the change, where facets were halved at that order.
constexpr double kWholeError = 4.0 / 3.0;

/// What is left after a mesh whose edges are `factor` times shorter moved a
/// figure by `change`, at that order.
double rest(double change, double factor, double order) {
  return kSafety * std::abs(change) / (std::pow(factor, order) - 1.0);
}

/// Of an extreme, which shows no order; one that has a limit for sure falls
/// with the edges. The factor is that of a change between edges h and 2 h for
/// every change: the changes of a peak come in leaps.
double rest_of_extreme(double change, bool has_limit) {
  return rest(change, kEdgeFactors[2], has_limit ? kMostOrder : kLeastOrder);
}

FigureKind kind_of(const case_data::Case& input, int response) {
  if (case_data::is_extreme(input, response)) {
    return FigureKind::Extreme;
  }
  const auto r = static_cast<std::size_t>(response);
  return case_data::row_of(input.responses[r].kind).of_films
             ? FigureKind::Film
             : FigureKind::Integral;
}

/// A response on all meshes.
MeshValues values_of(const MeshSequence& meshes, int response) {
  MeshValues values{};
  for (std::size_t m = 0; m < values.size(); ++m) {
    values[m] =
        meshes.responses[m].size() > 0 ? meshes.responses[m][response] : kNaN;
  }
  return values;
}

}  // namespace

FigureError figure_error(const MeshValues& values, FigureKind kind) {
  const auto [fine, middle, coarse, finer] = values;
  const bool has_middle = std::isfinite(middle);
  const bool has_coarse = std::isfinite(coarse);
  const bool has_other = has_middle || has_coarse || std::isfinite(finer);
  if (!std::isfinite(fine) || !has_other) {
    return {kNaN, true};
  }
  // 1. Two meshes show no order: the least is assumed.
  const bool of_film = kind == FigureKind::Film;
  if (!has_middle || !has_coarse) {
    const double order = of_film ? kLeastFilmOrder : kLeastOrder;
    if (has_coarse) {
      return {rest(fine - coarse, kEdgeFactors[2], order), true};
    }
    if (has_middle) {
      return {rest(fine - middle, kEdgeFactors[1], order), true};
    }
    const double factor = 1.0 / kEdgeFactors[kFinerMesh];
    return {
        kSafety * std::abs(fine - finer) + rest(fine - finer, factor, order),
        true};
  }
  // 2. The order of three, and whether the changes shrink.
  const double last = fine - middle;
  const double before = middle - coarse;
  const double change =
      std::max({std::abs(last), std::abs(before), std::abs(fine - coarse)});
  if (change <= kAlike * std::abs(fine)) {
    return {kNaN, true};
  }
  const bool same_way = last * before > 0.0;
  const double order = same_way
                           ? std::log(before / last) / std::log(kEdgeFactors[1])
                           : kUnseenOrder;
  const bool falls = kind == FigureKind::Peak && last < 0.0;
  const bool settles = !same_way || falls || order >= kLeastOrder ||
                       change <= kNoTrend * std::abs(fine);
  // 3. What is left.
  if (kind == FigureKind::Extreme || kind == FigureKind::Peak) {
    return {rest_of_extreme(change, kind == FigureKind::Peak && settles),
            settles};
  }
  if (of_film) {
    return {rest(last, kEdgeFactors[1],
                 same_way ? std::clamp(order, kLeastFilmOrder, kMostFilmOrder)
                          : kLeastFilmOrder),
            settles};
  }
  return {
      rest(change, kEdgeFactors[2], std::clamp(order, kLeastOrder, kMostOrder)),
      settles};
}

double finer_film_error(double own, double finer, FilmLaw law) {
  if (law == FilmLaw::Smooth) {
    return kSafety * kWholeError * std::abs(own - finer);
  }
  const double square = own * own;
  const double limit = square - kWholeError * (square - finer * finer);
  return kSafety * std::abs(own - std::sqrt(limit < 0.0 ? 0.0 : limit));
}

double margin_to_hold(double lower, double own, double error) {
  // 1. The change of the square: error = kSafety (own - sqrt(own^2 - change)),
  // the whole square where no film is left.
  const double limit = std::max(0.0, own - error / kSafety);
  const double change = own * own - limit * limit;
  // 2. x - kSafety (x - sqrt(x^2 - change)) = lower, of x the larger root: with
  // the safety S (2 S - 1) x^2 - 2 (S - 1) lower x - lower^2 - S^2 change = 0.
  const double a = 2.0 * kSafety - 1.0;
  const double b = (kSafety - 1.0) * lower;
  return (b +
          std::sqrt(b * b + a * (lower * lower + kSafety * kSafety * change))) /
         a;
}

namespace {

/// What the film's own finer facets say of a response; NaN where they say
/// nothing, as of one without films.
double error_by_finer_film(const case_data::Case& input,
                           const MeshSequence& meshes, int response) {
  const VectorX& finer = meshes.finer_film.responses;
  if (finer.size() == 0) {
    return kNaN;
  }
  const double own = meshes.responses[0][response];
  if (std::abs(own - finer[response]) <= kAlike * std::abs(own)) {
    return kNaN;
  }
  const bool is_margin =
      input.responses[static_cast<std::size_t>(response)].kind ==
      case_data::ResponseKind::CollapseMargin;
  return finer_film_error(own, finer[response],
                          is_margin ? FilmLaw::Root : FilmLaw::Smooth);
}

}  // namespace

std::vector<FigureError> response_errors(
    const case_data::Case& input, const MeshSequence& meshes,
    const VectorX& dual, const std::vector<FigureError>& peaks) {
  std::vector<FigureError> errors;
  for (int r = 0; r < static_cast<int>(input.responses.size()); ++r) {
    const FigureKind kind = kind_of(input, r);
    const case_data::ResponseEntry& response =
        input.responses[static_cast<std::size_t>(r)];
    FigureError error =
        !peaks.empty() && response.kind == case_data::ResponseKind::MaxVonMises
            ? peaks[static_cast<std::size_t>(response.load_case)]
            : figure_error(values_of(meshes, r), kind);
    const double film = error_by_finer_film(input, meshes, r);
    if (kind == FigureKind::Film) {
      // Other meshes stand in where the film's own facets say nothing, but for
      // a film that is not there on finer ones.
      if (std::isfinite(film) || meshes.finer_film.is_lost) {
        error = {film, true};
      }
    } else {
      error.bound = std::fmax(error.bound, film);
    }
    // A dual of 0 is that of a figure in which the elements make no error: no
    // error of its own where the meshes gave none.
    if (dual.size() > 0 && std::isfinite(dual[r]) && dual[r] != 0.0) {
      error.bound = std::fmax(error.bound, std::abs(dual[r]));
    }
    errors.push_back(error);
  }
  return errors;
}

VectorX bounds_of(const std::vector<FigureError>& errors) {
  VectorX bounds(static_cast<Eigen::Index>(errors.size()));
  for (std::size_t r = 0; r < errors.size(); ++r) {
    bounds[static_cast<Eigen::Index>(r)] = errors[r].bound;
  }
  return bounds;
}

void add_eigen_errors(MeshSequence& meshes) {
  auto& [fine, middle, coarse, finer] = meshes.eigen;
  for (std::size_t k = 0; k < fine.buckling.size(); ++k) {
    const auto factor = [k](const forward::EigenFigures& figures,
                            std::size_t mode) {
      return k < figures.buckling.size() &&
                     mode < figures.buckling[k].modes.factors.size()
                 ? figures.buckling[k].modes.factors[mode]
                 : kNaN;
    };
    for (std::size_t m = 0; m < fine.buckling[k].modes.factors.size(); ++m) {
      fine.buckling[k].errors.push_back(
          figure_error({factor(fine, m), factor(middle, m), factor(coarse, m),
                        factor(finer, m)},
                       FigureKind::Extreme)
              .bound);
    }
  }
  if (!fine.frequencies) {
    return;
  }
  const auto frequency = [](const forward::EigenFigures& figures,
                            std::size_t k) {
    return figures.frequencies &&
                   k < figures.frequencies->modes.frequencies.size()
               ? figures.frequencies->modes.frequencies[k]
               : kNaN;
  };
  for (std::size_t k = 0; k < fine.frequencies->modes.frequencies.size(); ++k) {
    fine.frequencies->errors.push_back(
        figure_error({frequency(fine, k), frequency(middle, k),
                      frequency(coarse, k), frequency(finer, k)},
                     FigureKind::Integral)
            .bound);
  }
}

std::string unsettled_text(const case_data::Case& input,
                           const std::string& name, const MeshValues& values,
                           const ShownUnit& unit, Dimension dimension) {
  const auto text = [&](std::size_t mesh) {
    return fmt::format("{:.4g}", unit.factor * values[mesh]);
  };
  return fmt::format(
      "{} may have no limit: it is {}, {} and {} at edges of {:.3g}, {:.3g} "
      "and {:.3g} {}, so its +- is no bound. {}",
      name, text(2), text(1), unit.text(values[0], 4),
      kEdgeFactors[2] * input.resolution.fea,
      kEdgeFactors[1] * input.resolution.fea, input.resolution.fea,
      input.units.length,
      dimension == Dimension::Pressure
          ? "Stress has none at a clamped rim or a sharp corner: leave such "
            "places out by analysis.exclude, or look at shorter edges"
          : "Look at shorter edges");
}

std::vector<std::string> unsettled_warnings(
    const case_data::Case& input, const MeshSequence& meshes,
    const std::vector<FigureError>& errors) {
  std::vector<std::string> warnings;
  for (int r = 0; r < static_cast<int>(errors.size()); ++r) {
    // Integrals have a limit, which their error knows.
    if (errors[r].settles || !case_data::is_extreme(input, r)) {
      continue;
    }
    warnings.push_back(
        unsettled_text(input, fmt::format("'{}'", input.responses[r].name),
                       values_of(meshes, r), case_data::shown_unit(input, r),
                       case_data::row_of(input.responses[r].kind).dimension));
  }
  return warnings;
}

}  // namespace meniscus::accuracy
