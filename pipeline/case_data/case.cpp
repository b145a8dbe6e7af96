#include "pipeline/case_data/case.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <span>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/energy/fields.h"
#include "evolve/walls/flush_ends.h"
#include "evolve/walls/rim_shape.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_loads.h"
#include "pipeline/case_data/case_responses.h"
#include "pipeline/case_data/case_sides.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/case_wetted.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/response_kinds.h"

namespace meniscus::case_data {

Case::Case() = default;
Case::~Case() = default;
Case::Case(const Case& other) = default;
Case::Case(Case&& other) noexcept = default;
Case& Case::operator=(const Case& other) = default;
Case& Case::operator=(Case&& other) noexcept = default;

StageInputs::StageInputs() = default;
StageInputs::~StageInputs() = default;
StageInputs::StageInputs(const StageInputs& other) = default;
StageInputs::StageInputs(StageInputs&& other) noexcept = default;
StageInputs& StageInputs::operator=(const StageInputs& other) = default;
StageInputs& StageInputs::operator=(StageInputs&& other) noexcept = default;

namespace {

constexpr int kPlacesOnCurve = 16;

/// Tells where an expression of place is not above 0 on the curves that hold a
/// film: what can be known before there is one.
void check_on_curves(const Case& input, const films::FilmSystem& system,
                     const std::set<std::string>& curves,
                     const PlaceQuantity& from, const PlaceField& field,
                     const CaseValues& values) {
  const auto add_problem = [&](const std::string& found,
                               const std::string& curve) {
    values.problems().push_back(fmt::format(
        "{}: {} {} on curve '{}'{}; it must be above 0 on the whole film",
        place(input, from.quantity.line), from.quantity.key, found, curve,
        values.where(from.quantity)));
  };
  std::vector<double> places(kPlacesOnCurve);
  for (int k = 0; k < kPlacesOnCurve; ++k) {
    places[k] = static_cast<double>(k) / kPlacesOnCurve;
  }
  for (const curves::Curve& curve : system.curves) {
    if (!curves.contains(curve.name)) {
      continue;
    }
    for (const Vec3& at : curves::points_at(curve.shape, places)) {
      try {
        const double value = value_at(field, field.own(), at);
        if (!(value > 0.0)) {
          return add_problem(
              fmt::format("is {:.4g} at ({:.4g}, {:.4g}, {:.4g})", value,
                          at.x(), at.y(), at.z()),
              curve.name);
        }
      } catch (const ExpressionError& error) {
        return add_problem(fmt::format("has no value ({})", error.what()),
                           curve.name);
      }
    }
  }
}

films::PoleShape pole_of(const FieldEntry& field, const CaseValues& values) {
  switch (field.kind) {
    case FieldKind::Segment:
      return films::SegmentPole{values.at(field.from), values.at(field.to)};
    case FieldKind::Plane:
      return films::PlanePole{values.at(field.at), values.at(field.normal)};
    case FieldKind::Polyline: {
      films::PolylinePole pole;
      for (const QuantityVector& point : field.points) {
        pole.points.push_back(values.at(point));
      }
      return pole;
    }
    case FieldKind::Point:
    case FieldKind::Pressure:
      break;
  }
  return films::PointPole{values.at(field.at)};
}

/// Which of its numbers follow the design.
void mark_moves(const FieldEntry& field, const CaseValues& values,
                films::FieldSpec& spec) {
  const auto follows = [&](const auto& of) {
    return values.follows_design(of);
  };
  spec.moves =
      follows(field.strength) || follows(field.power) || follows(field.core);
  spec.place_moves =
      follows(field.at) || follows(field.normal) || follows(field.from) ||
      follows(field.to) ||
      std::any_of(field.points.begin(), field.points.end(), follows);
}

void add_field(const Case& input, const FieldEntry& field,
               const CaseValues& values, films::FilmSystem& system) {
  if (field.kind == FieldKind::Pressure) {
    system.pressures.push_back(
        {field.name, field.body, values.place_field(field.pressure)});
    return;
  }
  const std::size_t before = values.problems().size();
  const bool checked = !values.are_rates();
  films::FieldSpec spec{.name = field.name, .shape = pole_of(field, values)};
  mark_moves(field, values, spec);
  spec.strength = values.at(field.strength);
  spec.power = values.positive(field.power);
  spec.core = values.positive(field.core);
  if (field.body.empty()) {
    spec.per = films::PerArea{field.films};
  } else {
    spec.per = films::PerVolume{field.body};
  }
  for (const films::FilmSpec& film : system.films) {
    const bool acts = std::find(field.films.begin(), field.films.end(),
                                film.name) != field.films.end();
    if (checked && acts && !film.drop_shape.empty()) {
      values.problems().push_back(fmt::format(
          "{}: {} acts on the area of film '{}', whose tension depends on how "
          "it is turned (`drop`); give the pole a body in place of films",
          place(input, field.line), field.strength.key, film.name));
    } else if (checked && acts && !film.tension_field &&
               spec.strength >= film.tension) {
      values.problems().push_back(fmt::format(
          "{}: {} is {:g}, and film '{}' has a tension of {:g}; it would "
          "crumple on the pole: expected less, a larger core reaches as far",
          place(input, field.strength.line), field.strength.key, spec.strength,
          film.name, film.tension));
    }
  }
  if (checked && values.problems().size() == before) {
    try {
      energy::place_field(spec);
    } catch (const InvalidInput& error) {
      values.problems().push_back(
          fmt::format("{}: {}", place(input, field.line), error.what()));
    }
  }
  system.fields.push_back(std::move(spec));
}

/// Of each point: the share of the way from the first to the last, along
/// straight lines.
std::vector<Dual1> shares_of_way(const SpineEntry& spine,
                                 const CaseValues& values) {
  std::vector<Dual1> shares(1, Dual1(0.0));
  for (std::size_t k = 1; k < spine.points.size(); ++k) {
    Dual1 square(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Dual1 step =
          values.dual(spine.points[k][i]) - values.dual(spine.points[k - 1][i]);
      square = square + step * step;
    }
    // Points that coincide are refused with the spine.
    shares.push_back(shares.back() +
                     (square.value > 0.0 ? sqrt(square) : Dual1(0.0)));
  }
  const Dual1 whole = shares.back();
  for (Dual1& share : shares) {
    share = whole.value > 0.0 ? share / whole : Dual1(0.0);
  }
  return shares;
}

/// Of a radius that knows how far along the spine it is.
std::vector<double> radii_along(const Case& input, const SpineEntry& spine,
                                const CaseValues& values) {
  std::vector<double> radii;
  for (const Dual1& share : shares_of_way(spine, values)) {
    const std::array<double, 1> s = {share.value};
    if (values.are_rates()) {
      const std::array<double, 1> rate = {share.varies ? share.gradient[0]
                                                       : 0.0};
      radii.push_back(values.rate(spine.radii[0], s, rate));
      continue;
    }
    radii.push_back(values.at(spine.radii[0], s));
    if (!(radii.back() > 0.0)) {
      values.problems().push_back(fmt::format(
          "{}: {} is {:g} at s = {:g} of the spine; it must be above 0",
          place(input, spine.line), spine.radii[0].key, radii.back(),
          share.value));
    }
  }
  return radii;
}

void add_spine(const Case& input, const SpineEntry& spine,
               const CaseValues& values, films::FilmSystem& system) {
  films::SpineSpec spec{
      .name = spine.name, .body = spine.body, .smooth = spine.smooth};
  for (std::size_t k = 0; k < spine.points.size(); ++k) {
    spec.points.push_back(values.at(spine.points[k]));
    if (!spine.along) {
      spec.radii.push_back(
          spine.radii.empty()
              ? 0.0
              : values.positive(spine.radii[spine.radii.size() > 1 ? k : 0]));
    }
  }
  if (spine.along) {
    spec.radii = radii_along(input, spine, values);
  }
  spec.tension = values.positive(spine.tension);
  system.spines.push_back(std::move(spec));
}

std::shared_ptr<const films::StartFacets> start_of(const FilmEntry& film,
                                                   const CaseValues& values) {
  auto start = std::make_shared<films::StartFacets>();
  start->facets = film.facets;
  for (const QuantityVector& vertex : film.vertices) {
    start->points.push_back(values.at(vertex));
  }
  return start;
}

/// One of the film system's for each curve of a fillet.
void add_fillets(const FilletEntry& fillet, const CaseValues& values,
                 films::FilmSystem& system) {
  const double radius = values.at(
      fillet.radius, [](double r) { return r >= 0.0; }, "0 or above");
  for (const std::string& curve : fillet.curves) {
    system.fillets.push_back({fillet.name, curve, radius});
  }
}

/// Curves are cut as finely as they ask; those with fillets so that their arcs
/// have some facets.
void refine_curves(const Case& input, films::FilmSystem& system) {
  for (std::size_t k = 0; k < input.curves.size(); ++k) {
    if (const double pieces = input.curves[k].pieces; pieces > 0.0) {
      system.curves[k].fineness = std::min(1.0, pieces / input.resolution.fea);
    }
    system.curves[k].free = input.curves[k].free;
    system.curves[k].free_sides = input.curves[k].free_sides;
  }
  constexpr double kPiece = 1.0 / 3.0;  // of the radius: four to a quarter turn
  for (const films::FilletSpec& fillet : system.fillets) {
    for (curves::Curve& curve : system.curves) {
      const double wanted = kPiece * fillet.radius / input.resolution.fea;
      if (curve.name == fillet.curve && wanted > 0.0) {
        curve.fineness = std::min(curve.fineness, wanted);
      }
    }
  }
}

films::Spheroid spheroid_of(const Case& input, const SpheroidEntry& part,
                            const CaseValues& values) {
  const std::size_t before = values.problems().size();
  const films::Spheroid result{values.at(part.axis),
                               values.positive(part.along),
                               values.positive(part.across)};
  if (!values.are_rates() && values.problems().size() == before &&
      result.axis.isZero(0.0)) {
    values.problems().push_back(fmt::format(
        "{}: {}.axis is (0, 0, 0){}; expected a direction",
        place(input, part.line), part.key, values.where(part.axis)));
  }
  return result;
}

films::FilmSystem films_of(const Case& input, const CaseValues& values) {
  films::FilmSystem system;
  system.curves = curves_of(input, values);
  for (const FilmEntry& film : input.films) {
    system.films.push_back(film.spec);
    films::FilmSpec& spec = system.films.back();
    if (film.tension.of_place) {
      spec.tension_field = values.place_field(film.tension);
    } else {
      spec.tension = values.positive(film.tension.quantity);
    }
    for (const SpheroidEntry& part : film.drop) {
      spec.drop_shape.push_back(spheroid_of(input, part, values));
    }
    if (!film.facets.empty() && !values.are_rates()) {
      spec.start = start_of(film, values);
    }
  }
  system.keep_facets = input.resolution.keep_facets;
  system.pop = input.resolution.pop;
  for (const StepSolidEntry& solid : input.step_solids) {
    system.solids.push_back(solid.spec);
  }
  for (const CapEntry& cap : input.caps) {
    system.caps.push_back(cap.spec);
    if (cap.wetted) {
      system.caps.back().wall = wall_of(input, cap, values);
    }
  }
  for (const BodyEntry& body : input.bodies) {
    films::BodySpec spec{.name = body.name,
                         .enclosed_by = body.enclosed_by,
                         .is_void = body.material == kVoid};
    if (body.volume) {
      spec.volume = values.positive(*body.volume);
    }
    if (body.pressure) {
      spec.pressure = values.at(*body.pressure);
    }
    system.bodies.push_back(std::move(spec));
  }
  for (const FieldEntry& field : input.fields) {
    add_field(input, field, values, system);
  }
  for (const SpineEntry& spine : input.spines) {
    add_spine(input, spine, values, system);
  }
  for (const FilletEntry& fillet : input.fillets) {
    add_fillets(fillet, values, system);
  }
  if (!values.are_rates()) {
    refine_curves(input, system);
  }
  make_cells(input, system);
  return system;
}

std::set<std::string> curves_under(const Case& input,
                                   const std::vector<std::string>& films) {
  const std::set<std::string> under(films.begin(), films.end());
  std::set<std::string> curves;
  for (const FilmEntry& film : input.films) {
    if (under.contains(film.spec.name)) {
      curves.insert(film.spec.curves.begin(), film.spec.curves.end());
    }
  }
  return curves;
}

/// Shapes between rims have no values before their films are there: the field
/// with each at its least or at its largest coefficient.
PlaceField at_extreme(const PlaceField& field, bool largest) {
  PlaceField result = field;
  const auto first = std::ssize(field.names);
  std::vector<double> numbers(field.numbers.begin(),
                              field.numbers.begin() + first);
  Eigen::Index at = first;
  for (auto& shape : result.shapes) {
    const auto own = field.numbers.segment(at, shape->coefficients());
    at += own.size();
    if (walls::rim_splines_of(*shape) == nullptr) {
      numbers.insert(numbers.end(), own.begin(), own.end());
      continue;
    }
    shape = radial_functions({.points = {Vec3::Zero()}});  // 1 everywhere
    numbers.push_back(largest ? own.maxCoeff() : own.minCoeff());
  }
  result.numbers =
      Eigen::Map<const VectorX>(numbers.data(), std::ssize(numbers));
  return result;
}

/// Tells of shapes between rims that do not suit the wall's films. Has it any?
bool check_rim_shapes(const Case& input, const walls::WallSpec& wall,
                      const PlaceQuantity& from, const CaseValues& values) {
  const std::set<std::string> ends = curves_under(input, wall.films);
  bool found = false;
  for (const auto& shape : wall.thickness.shapes) {
    const walls::RimSplines* splines =
        shape != nullptr ? walls::rim_splines_of(*shape) : nullptr;
    if (splines == nullptr) {
      continue;
    }
    found = true;
    const std::string where = fmt::format(
        "{}: {}", place(input, from.quantity.line), from.quantity.key);
    for (const std::string& curve : {splines->first, splines->second}) {
      if (ends.count(curve) == 0) {
        values.problems().push_back(fmt::format(
            "{} has a shape between curves '{}' and '{}'; no film of walls.{} "
            "ends at '{}' (they end at {})",
            where, splines->first, splines->second, wall.name, curve,
            fmt::join(ends, ", ")));
      } else if (slides_at(input, curve)) {
        values.problems().push_back(fmt::format(
            "{} has a shape between curves '{}' and '{}'; the film only begins "
            "at '{}' and slides: take curves that hold it, or a shape of space",
            where, splines->first, splines->second, curve));
      }
    }
    if (splines->around > 1 && wall.films.size() > 1) {
      values.problems().push_back(fmt::format(
          "{} has a shape of {} coefficients around, and walls.{} {} films; "
          "expected one film, a tube between the two curves, or 1 around",
          where, splines->around, wall.name, wall.films.size()));
    }
  }
  return found;
}

/// Tells of curves of no plane at which a wall should be flush.
void check_flush(const Case& input, const WallEntry& wall,
                 const films::FilmSystem& system, const CaseValues& values) {
  for (const curves::Curve& curve : system.curves) {
    if (std::find(wall.flush.begin(), wall.flush.end(), curve.name) ==
        wall.flush.end()) {
      continue;
    }
    try {
      walls::flush_normal(curve);
    } catch (const InvalidInput& error) {
      values.problems().push_back(fmt::format("{}: walls.{}: {}",
                                              place(input, wall.line),
                                              wall.name, error.what()));
    }
  }
}

/// Tells of a thickness that cannot hold on its films.
void check_thickness(const Case& input, const EvaluatedCase& inputs,
                     const walls::WallSpec& wall, const PlaceQuantity& from,
                     const CaseValues& values) {
  const std::set<std::string> curves = curves_under(input, wall.films);
  const std::size_t before = values.problems().size();
  if (!check_rim_shapes(input, wall, from, values)) {
    check_on_curves(input, inputs.film_system, curves, from, wall.thickness,
                    values);
    return;
  }
  for (const bool largest : {false, true}) {
    if (values.problems().size() == before) {
      check_on_curves(input, inputs.film_system, curves, from,
                      at_extreme(wall.thickness, largest), values);
    }
  }
}

/// Tells of expressions of place that cannot hold on their films.
void check_places(const Case& input, const EvaluatedCase& inputs,
                  const CaseValues& values) {
  for (std::size_t k = 0; k < input.films.size(); ++k) {
    const films::FilmSpec& film = inputs.film_system.films[k];
    if (film.tension_field) {
      check_on_curves(input, inputs.film_system,
                      {film.curves.begin(), film.curves.end()},
                      input.films[k].tension, *film.tension_field, values);
    }
  }
  for (std::size_t k = 0; k < input.walls.size(); ++k) {
    check_flush(input, input.walls[k], inputs.film_system, values);
    check_thickness(input, inputs, inputs.walls[k], input.walls[k].thickness,
                    values);
  }
  for (std::size_t k = 0; k < input.shells.size(); ++k) {
    check_thickness(input, inputs, inputs.shells[k], input.shells[k].thickness,
                    values);
  }
}

/// Values, or rates, as `values` gives them.
template <class Inputs>
Inputs inputs_of(const Case& input, const CaseValues& values) {
  Inputs result;
  result.film_system = films_of(input, values);
  for (const WallEntry& wall : input.walls) {
    walls::WallSpec spec{.name = wall.name,
                         .films = wall.films,
                         .thickness = values.place_field(wall.thickness),
                         .side = wall.side,
                         .fillet = wall.fillet,
                         .flush = wall.flush,
                         .region = wall.region};
    result.walls.push_back(std::move(spec));
  }
  for (const ShellEntry& shell : input.shells) {
    result.shells.push_back({.name = shell.name,
                             .films = shell.films,
                             .thickness = values.place_field(shell.thickness),
                             .side = shell.side,
                             .fillet = {}});
  }
  for (const BodyEntry& body : solid_bodies(input)) {
    result.materials.push_back(material_of(
        input, input.materials[static_cast<std::size_t>(body.material)],
        values));
  }
  if (!input.shells.empty()) {  // of bodies there are none
    const auto is_solid = [](const BodyEntry& body) {
      return body.material != kVoid;
    };
    result.layer_angles.resize(static_cast<std::size_t>(
        std::count_if(input.bodies.begin(), input.bodies.end(), is_solid)));
  }
  for (const ShellEntry& shell : input.shells) {
    for (const LayerEntry& layer : shell.layers) {
      result.layer_angles.push_back(values.at(layer.angle));
    }
  }
  for (const LoadCaseEntry& entry : input.load_cases) {
    result.load_cases.push_back(load_case_of(entry, values));
  }
  for (const ResponseEntry& response : input.responses) {
    result.responses.push_back(response_of(input, response, values));
  }
  return result;
}

void throw_first(const std::vector<std::string>& problems) {
  if (!problems.empty()) {
    const std::size_t more = problems.size() - 1;
    throw InvalidInput(problems.front() +
                       (more > 0 ? fmt::format(" (and {} more)", more) : ""));
  }
}

}  // namespace

bool has_solids(const Case& input) {
  return std::any_of(
      input.bodies.begin(), input.bodies.end(),
      [](const BodyEntry& body) { return body.material != kVoid; });
}

std::vector<BodyEntry> solid_bodies(const Case& input) {
  std::vector<BodyEntry> solid;
  std::copy_if(input.bodies.begin(), input.bodies.end(),
               std::back_inserter(solid),
               [](const BodyEntry& body) { return body.material != kVoid; });
  const bool has_bodies = !solid.empty();
  for (const WallEntry& wall : input.walls) {
    if (!has_bodies && wall.region == static_cast<int>(solid.size()) &&
        wall.material != kVoid) {
      solid.push_back({.name = wall.name,
                       .enclosed_by = wall.films,
                       .material = wall.material,
                       .line = wall.line,
                       .enclosure_line = wall.line});
    }
  }
  for (const ShellEntry& shell : input.shells) {
    for (const LayerEntry& layer : shell.layers) {
      solid.push_back({.name = shell.name,
                       .enclosed_by = shell.films,
                       .volume = {},
                       .pressure = {},
                       .material = layer.material,
                       .line = shell.line,
                       .enclosure_line = shell.line});
    }
  }
  return solid;
}

namespace {

/// Those of the initial design, or where it has none those of `now`.
std::vector<curves::Curve> start_curves(const Case& input,
                                        const VectorX& design,
                                        const std::vector<curves::Curve>& now) {
  const VectorX initial = initial_design(input);
  if (design == initial) {
    return now;
  }
  std::vector<std::string> problems;
  std::vector<curves::Curve> first =
      curves_of(input, CaseValues(input, initial, problems));
  return problems.empty() ? first : now;
}

/// Where curves lie to each other, sides that they share, ends of lines.
/// `first`: those of the initial design.
void check_curves(const Case& input, const films::FilmSystem& system,
                  const std::vector<curves::Curve>& first,
                  const VectorX& design, const CaseValues& values) {
  const std::size_t before = values.problems().size();
  check_meetings(input, system, values);
  if (values.problems().size() == before) {
    check_nesting(input, system, first, design, values.problems());
  }
  check_sides(input, system, values);
  check_free_sides(input, system, values);
  check_join_ends(input, system, first, values.problems());
}

}  // namespace

EvaluatedCase evaluate(const Case& input, const VectorX& design,
                       std::vector<std::string>& problems) {
  const std::size_t before = problems.size();
  const CaseValues values(input, design, problems);
  if (problems.size() > before) {
    return {};  // what follows from a bad parameter is no news
  }
  auto result = inputs_of<EvaluatedCase>(input, values);
  result.design = design;
  result.fea_edge = input.resolution.fea;
  if (problems.size() == before) {
    // Said at the initial design, it is true of all with its curves.
    const films::FilmSystem& system = result.film_system;
    const std::vector<curves::Curve> first =
        start_curves(input, design, system.curves);
    if (design == initial_design(input) ||
        !have_equal_shapes(first, system.curves)) {
      check_curves(input, system, first, design, values);
    }
    check_places(input, result, values);
    check_on_walls(input, result.film_system, values);
    check_symmetry(input, result, values);
  }
  return result;
}

EvaluatedCase evaluate(const Case& input, const VectorX& design) {
  std::vector<std::string> problems;
  EvaluatedCase result = evaluate(input, design, problems);
  throw_first(problems);
  return result;
}

CaseRates rates(const Case& input, const VectorX& design, int variable) {
  std::vector<std::string> problems;
  const CaseValues values(input, design, problems, variable);
  auto result = inputs_of<CaseRates>(input, values);
  throw_first(problems);
  return result;
}

std::string place(const Case& input, SourceLine line) {
  if (line > 0) {
    return fmt::format("{}:{}", input.path, line);
  }
  return line == 0 ? input.path
                   : fmt::format(
                         "{}: --set {}", input.path,
                         input.overrides[static_cast<std::size_t>(-line - 1)]);
}

std::vector<std::pair<std::string, double>> parameter_values(
    const Case& input, const VectorX& design) {
  std::vector<std::string> problems;
  const CaseValues values(input, design, problems);
  std::vector<std::pair<std::string, double>> result;
  for (const Parameter& parameter : input.parameters) {
    result.emplace_back(parameter.name, values.at(parameter.value));
  }
  throw_first(problems);
  return result;
}

VectorX initial_design(const Case& input) {
  VectorX design(static_cast<Eigen::Index>(input.design.size()));
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    design[static_cast<Eigen::Index>(k)] = input.design[k].initial;
  }
  return design;
}

std::vector<std::string> design_names(const Case& input) {
  std::vector<std::string> names;
  for (const DesignVariable& variable : input.design) {
    names.push_back(variable.name);
  }
  return names;
}

std::vector<std::string> response_names(const Case& input) {
  std::vector<std::string> names;
  for (const ResponseEntry& response : input.responses) {
    names.push_back(response.name);
  }
  return names;
}

Dimension dimension_of(ResponseKind kind) { return row_of(kind).dimension; }

Measure measure_of(const ResponseEntry& response) {
  if (is_composed(response)) {
    const Measure& measure = response.value.measure;
    return measure.is_known() ? measure : Measure{};
  }
  if (response.kind == ResponseKind::CollapseMargin) {
    return Measure::of({.length = -3.0, .force = 1.0});
  }
  UnitPowers powers = powers_of(dimension_of(response.kind));
  if (response.weight) {
    if (response.weight->of_place) {
      return {};
    }
    // A plain number is a factor.
    const Measure& weight = response.weight->quantity.measure;
    powers.length += weight.powers.length;
    powers.force += weight.powers.force;
    powers.time += weight.powers.time;
  }
  return Measure::of(powers);
}

Dimension dimension_of(const Measure& measure) {
  for (int d = 1; d <= static_cast<int>(Dimension::Foundation); ++d) {
    const auto dimension = static_cast<Dimension>(d);
    if (measure.is_known() && dimension != Dimension::Angle &&
        dimension != Dimension::Rate && dimension != Dimension::Frequency &&
        powers_of(dimension) == measure.powers) {
      return dimension;
    }
  }
  return Dimension::None;
}

namespace {

/// Angles are numbers, so that a rate may be one of turning or not.
bool is_rate(const Measure& measure) {
  return measure.is_known() && measure.powers == powers_of(Dimension::Rate);
}

ShownUnit shown_of(const UnitSystem& units, const Measure& measure) {
  return is_rate(measure) ? ShownUnit{1.0, "1/s"}
                          : units.shown(dimension_of(measure));
}

/// The dimension of its kind; None where that says none, or beside a weight.
Dimension usual_dimension(const Case& input, int response) {
  const auto& entry = input.responses[static_cast<std::size_t>(response)];
  return entry.weight ? Dimension::None : dimension_of(entry.kind);
}

Measure measure_at(const Case& input, int response) {
  return measure_of(input.responses[static_cast<std::size_t>(response)]);
}

}  // namespace

ShownUnit shown_unit(const Case& input, int response) {
  const Dimension usual = usual_dimension(input, response);
  return usual == Dimension::None
             ? shown_of(input.units, measure_at(input, response))
             : input.units.shown(usual);
}

ShownUnit shown_unit(const Case& input, const DesignVariable& variable) {
  return shown_of(input.units, variable.measure);
}

std::string unit_of(const UnitSystem& units, const Measure& measure) {
  return is_rate(measure) ? "1/s" : units.unit_of(dimension_of(measure));
}

std::string response_unit(const Case& input, int response) {
  const Dimension usual = usual_dimension(input, response);
  return usual == Dimension::None
             ? unit_of(input.units, measure_at(input, response))
             : input.units.unit_of(usual);
}

}  // namespace meniscus::case_data
