#include "evolve/frozen/film_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/geometry/edge_key.h"
#include "core/heed_stop.h"
#include "core/timer.h"
#include "evolve/energy/fields.h"
#include "evolve/energy/pole_field.h"
#include "evolve/energy/tension_field.h"
#include "evolve/films/rim_grading.h"
#include "evolve/films/solid_facets.h"
#include "evolve/frozen/film_model_impl.h"
#include "evolve/frozen/line_gaps.h"
#include "evolve/groom/rough_films.h"
#include "evolve/groom/slivers.h"
#include "evolve/settle/equilibrium.h"
#include "evolve/settle/find_equilibrium.h"
#include "evolve/settle/settle_pops.h"
#include "evolve/spines/spine_poles.h"
#include "evolve/start/start_complex.h"
#include "evolve/start/start_edge.h"
#include "evolve/start/wetted_faces.h"

namespace meniscus::frozen {

namespace {

/// Steps from the reference to a design: first in one, then in parts, which
/// are fixed so that the film depends on the design alone.
constexpr std::array<int, 2> kParts = {1, 4};
/// One step that needs more iterations than this is checked against parts:
/// the film may have slid to another equilibrium.
constexpr int kManyIterations = 15;
constexpr double kOtherStart = 0.8;  // x edge, of other first facets
// A design without a film is looked for on the way to it by so many halvings;
// a width of a film's lines, x that of the reference, below which they are
// taken to run together there.
constexpr int kHalvings = 6;
constexpr double kRunTogether = 0.25;

films::FilmTargets blend(const films::FilmTargets& from,
                         const films::FilmTargets& to, double t) {
  films::FilmTargets result = to;
  const auto mix = [t](double a, double b) { return a + t * (b - a); };
  for (std::size_t s = 0; s < to.tension.size(); ++s) {
    result.tension[s] = mix(from.tension[s], to.tension[s]);
  }
  for (std::size_t q = 0; q < to.numbers.size(); ++q) {
    result.numbers[q] = from.numbers[q] + t * (to.numbers[q] - from.numbers[q]);
  }
  for (std::size_t b = 0; b < to.bodies.size(); ++b) {
    if (to.bodies[b].volume && from.bodies[b].volume) {
      result.bodies[b].volume =
          mix(*from.bodies[b].volume, *to.bodies[b].volume);
    }
    if (to.bodies[b].pressure || from.bodies[b].pressure) {
      result.bodies[b].pressure = mix(from.bodies[b].pressure.value_or(0.0),
                                      to.bodies[b].pressure.value_or(0.0));
    }
  }
  return result;
}

/// Films meet a wall at an angle between 0 and pi where its energy lies between
/// theirs, to either side of 0 (Young).
void check_wetting(const films::FilmSystem& system, const films::CapSpec& cap) {
  const std::vector<std::string> curves = cap.curves();
  for (const films::FilmSpec& film : system.films) {
    const bool ends = std::any_of(
        film.curves.begin(), film.curves.end(), [&](const std::string& name) {
          return std::find(curves.begin(), curves.end(), name) != curves.end();
        });
    if (ends && !film.tension_field &&
        !(std::abs(cap.wall->tension) < film.tension)) {
      throw InvalidInput(fmt::format(
          "the wall of '{}' has {} of energy per area where film '{}' has {}; "
          "a film meets a wall whose energy is less than its own, to either "
          "side of 0",
          cap.name, cap.wall->tension, film.name, film.tension));
    }
  }
}

/// Throws InvalidInput for numbers that no liquid can follow.
void check_numbers(const films::FilmSystem& system) {
  for (const films::FilmSpec& film : system.films) {
    if (!(film.tension > 0.0) || !std::isfinite(film.tension)) {
      throw InvalidInput(
          fmt::format("the tension of film '{}' must be above 0, found {}",
                      film.name, film.tension));
    }
    if (const std::string wrong = films::what_is_wrong(film.drop_shape);
        !wrong.empty()) {
      throw InvalidInput(fmt::format("film '{}': {}", film.name, wrong));
    }
  }
  for (const films::CapSpec& cap : system.caps) {
    if (cap.wall) {
      check_wetting(system, cap);
    }
  }
  for (const films::BodySpec& body : system.bodies) {
    const double volume = body.volume.value_or(1.0);
    if (!(volume > 0.0) || !std::isfinite(volume)) {
      throw InvalidInput(
          fmt::format("the volume of body '{}' must be above 0, found {}",
                      body.name, volume));
    }
    if (!std::isfinite(body.pressure.value_or(0.0))) {
      throw InvalidInput(
          fmt::format("the pressure of body '{}' must be finite, found {}",
                      body.name, *body.pressure));
    }
  }
}

bool is_of_film(const Failure& failure) {
  return failure.kind == FailureKind::FilmNotFound ||
         failure.kind == FailureKind::FilmPinched ||
         failure.kind == FailureKind::FilmUnstable;
}

std::string no_value(const ExpressionError& error) {
  return fmt::format(
      "a field, or a tension (it must be above 0), has no value where the film "
      "went: {}",
      error.what());
}

}  // namespace

films::FilmTargets FilmModel::Impl::targets_of_system(
    const films::FilmSystem& system) const {
  films::FilmTargets result = targets;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    if (complex.surfaces[s].wetted) {
      result.tension[s] = wall_of(system, static_cast<int>(s)).tension;
    }
    if (!complex.surfaces[s].liquid) {
      continue;
    }
    const auto film =
        std::find_if(system.films.begin(), system.films.end(),
                     [&](const films::FilmSpec& f) {
                       return f.name == complex.surfaces[s].numbers_of();
                     });
    if (film == system.films.end()) {
      throw InvalidInput(
          fmt::format("the design has no film '{}', which its model has",
                      complex.surfaces[s].name));
    }
    const std::optional<PlaceField>& field = complex.surfaces[s].tension_field;
    if (film->tension_field.has_value() != field.has_value() ||
        (field && !is_same_but_numbers(*film->tension_field, *field)) ||
        film->drop_shape.size() != complex.surfaces[s].drop_shape.size()) {
      throw InvalidInput(fmt::format(
          "the design changes the tension field of film '{}'; it belongs to "
          "the frozen model: freeze another one",
          film->name));
    }
    result.numbers[complex.quantities.size() + s] =
        films::tension_numbers(*film);
    if (!field) {
      result.tension[s] = film->tension * films::mean_support(film->drop_shape);
    }
  }
  check_fields(system);
  for (std::size_t q = 0; q < complex.quantities.size(); ++q) {
    result.numbers[q] =
        complex.quantities[q].kind == films::FilmQuantity::Kind::BodyPoles
            ? energy::pole_numbers(poles_of(system, q))
            : scalar_numbers(system, q);
  }
  for (films::ComplexBody& body : result.bodies) {
    const auto spec = std::find_if(
        system.bodies.begin(), system.bodies.end(),
        [&](const films::BodySpec& b) { return b.name == body.name; });
    if (spec == system.bodies.end() ||
        spec->volume.has_value() != body.volume.has_value()) {
      throw InvalidInput(
          fmt::format("the design must give body '{}' a {}, as its model does",
                      body.name, body.volume ? "volume" : "pressure"));
    }
    body.volume = spec->volume;
    body.pressure = spec->pressure;
  }
  return result;
}

/// The wall that a design gives to a wetted face: in the place that it has.
const films::FilmWall& FilmModel::Impl::wall_of(const films::FilmSystem& system,
                                                int surface) const {
  const films::ComplexSurface& face = complex.surfaces[surface];
  const auto cap = std::find_if(
      system.caps.begin(), system.caps.end(),
      [&](const films::CapSpec& c) { return c.name == face.name; });
  const auto stays = [&](const films::FilmWall& wall) {
    const std::optional<films::BentWall> bent = wall.bent();
    const films::LevelSet& own =
        complex.level_sets[complex.constraint_sets[face.constraints].front()];
    return bent && own.bent
               ? films::is_same(*bent, *own.bent)
               : start::formula_of(wall).text() == own.formula.text();
  };
  if (cap == system.caps.end() || !cap->wall || !stays(*cap->wall)) {
    throw InvalidInput(fmt::format(
        "the design moves the wall of '{}'; its place belongs to the frozen "
        "model: freeze another one",
        face.name));
  }
  return *cap->wall;
}

/// The fields of the design are those that were frozen, but for their numbers.
void FilmModel::Impl::check_fields(const films::FilmSystem& system) const {
  std::vector<PlaceField> fields;
  for (const films::FieldSpec& field : system.fields) {
    fields.push_back(energy::place_field(field));
  }
  for (const films::PressureSpec& spec : system.pressures) {
    fields.push_back(spec.pressure);
  }
  // Poles of spines come after them.
  const auto poles =
      std::find_if(complex.quantities.begin(), complex.quantities.end(),
                   [](const films::FilmQuantity& q) {
                     return q.kind == films::FilmQuantity::Kind::BodyPoles;
                   });
  const bool same = std::equal(
      fields.begin(), fields.end(), complex.quantities.begin(), poles,
      [](const PlaceField& field, const films::FilmQuantity& quantity) {
        return is_same_but_numbers(field, quantity.scalar);
      });
  if (!same) {
    throw InvalidInput(
        "the design changes the field energies; they belong to the frozen "
        "model: freeze another one");
  }
}

/// Those of the scalar of a quantity that is no spines', or their rates.
VectorX FilmModel::Impl::scalar_numbers(const films::FilmSystem& system,
                                        std::size_t quantity) {
  const std::size_t poles = system.fields.size();
  return quantity < poles ? energy::field_numbers(system.fields[quantity])
                          : system.pressures[quantity - poles].pressure.numbers;
}

std::vector<films::Pole> FilmModel::Impl::poles_of(
    const films::FilmSystem& system, std::size_t quantity) const {
  return spines::poles_of(complex.spines, complex.quantities[quantity].body,
                          system.spines);
}

void FilmModel::Impl::sample_spines(const films::FilmSystem& system,
                                    films::FilmComplex& complex) {
  spines::sample_again(system.spines, complex.spines);
  for (films::FilmQuantity& quantity : complex.quantities) {
    if (quantity.kind == films::FilmQuantity::Kind::BodyPoles) {
      quantity.poles =
          spines::poles_of(complex.spines, quantity.body, system.spines);
    }
  }
}

std::vector<curves::Curve> FilmModel::Impl::curves_of_system(
    const films::FilmSystem& system) const {
  std::vector<curves::Curve> result;
  for (const curves::Curve& curve : complex.curves) {
    const auto same = std::find_if(
        system.curves.begin(), system.curves.end(),
        [&](const curves::Curve& c) { return c.name == curve.name; });
    if (same == system.curves.end() ||
        same->shape.index() != curve.shape.index()) {
      throw InvalidInput(fmt::format(
          "the design has no curve '{}' of its model's kind", curve.name));
    }
    curves::validate(*same);
    result.push_back(*same);
  }
  return result;
}

EdgeMiddles FilmModel::Impl::middles(std::size_t count) const {
  EdgeMiddles result;
  const auto first = static_cast<int>(meshed.points.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto [a, b] = parents[k];
    result[edge_key(a, b)] = first + static_cast<int>(k);
  }
  return result;
}

std::vector<char> FilmModel::Impl::straight() const {
  std::vector<char> result;
  for (const films::ComplexVertex& vertex : complex.vertices) {
    result.push_back(vertex.kind == films::VertexKind::InCap ? 1 : 0);
  }
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const auto& wetted = complex.surfaces[complex.mesh.facet_label[f]].wetted;
    for (const int v : complex.mesh.facets[f]) {
      result[v] = wetted && wetted->bent ? 0 : result[v];
    }
  }
  return result;
}

void FilmModel::Impl::find_reference(const films::FilmSystem& initial,
                                     const FilmModelOptions& options,
                                     const settle::SettleOptions& settle) {
  if (initial.films.empty()) {
    build_rigid(initial, options);
    return;
  }
  if (options.start != nullptr && !initial.keep_facets) {
    films::FilmComplex start = *options.start;
    sample_spines(initial, start);
    settle_reference(start, options.edge, 0, initial, options, settle);
    return;
  }
  const int halvings =
      options.at_rest ? 0 : start::start_halvings(initial, options.edge);
  find_reference_from(std::ldexp(options.edge, halvings), halvings, initial,
                      options, settle);
  const auto tears = [this] {
    return reference.failure &&
           reference.failure->kind != FailureKind::FilmUnstable;
  };
  if (!tears() || initial.keep_facets || options.at_rest) {
    return;
  }
  // Coarse facets may fold where rims are not much larger than they, and any
  // by bad luck: once more without them, and from others.
  const films::FilmComplex first = complex;
  const films::FilmComplex first_meshed = meshed_complex;
  const std::vector<Edge> first_parents = parents;
  const std::size_t first_near = near_parents;
  const settle::FilmState failed = reference;
  const double first_edge = start_edge;
  for (const double factor : {1.0, kOtherStart}) {
    if (halvings == 0 && factor == 1.0) {
      continue;  // that was the first
    }
    find_reference_from(factor * options.edge, 0, initial, options, settle);
    if (!tears()) {
      return;
    }
  }
  complex = first;
  meshed = first_meshed.mesh;
  meshed_complex = first_meshed;
  parents = first_parents;
  near_parents = first_near;
  reference = failed;
  start_edge = first_edge;
  energy.reset();
}

void FilmModel::Impl::find_reference_from(double edge, int halvings,
                                          const films::FilmSystem& initial,
                                          const FilmModelOptions& options,
                                          const settle::SettleOptions& settle) {
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  monitor.progress({"film", "building the start", 0.0});
  settle_reference(start::build_start(initial, edge), edge, halvings, initial,
                   options, settle);
}

void FilmModel::Impl::settle_reference(const films::FilmComplex& first,
                                       double edge, int halvings,
                                       const films::FilmSystem& initial,
                                       const FilmModelOptions& options,
                                       const settle::SettleOptions& settle) {
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  start_edge = edge;
  const bool wets = start::has_wetted_faces(first);
  complex = start::open_wetted_faces(first);
  parents.clear();
  near_parents = 0;
  refinements = 0;
  energy.reset();
  monitor.progress({"film", "settling the raw start", 0.1});
  settle::FindOptions find{
      .edge = options.edge, .halvings = halvings, .settle = settle};
  if (initial.keep_facets) {
    find.edge.reset();
    find.refinements = halvings;
  }
  if (options.at_rest) {
    settle_level(settle);
  } else {
    reference = settle::find_equilibrium(complex, find);
    if (initial.pop) {
      reference = settle::settle_pops(complex, std::move(reference), find);
    }
  }
  if (wets && !reference.failure) {
    start::close_wetted_faces(complex, options.edge);
    reference.points = complex.mesh.points;
    energy.reset();
  }
  meshed = complex.mesh;
  meshed_complex = complex;
  refine_and_settle(options.refinements, !initial.keep_facets, settle);
}

void FilmModel::Impl::settle_level(const settle::SettleOptions& settle) {
  energy.emplace(complex);
  reference =
      settle::settle_past_saddles(*energy, complex, energy::targets_of(complex),
                                  complex.mesh.points, settle);
  complex.mesh.points = reference.points;
}

void FilmModel::Impl::refine_and_settle(int levels, bool may_groom,
                                        const settle::SettleOptions& settle) {
  Monitor& monitor =
      settle.monitor != nullptr ? *settle.monitor : silent_monitor();
  for (int level = 0; level < levels; ++level) {
    monitor.progress({"film", fmt::format("refinement {}", level + 1), 0.6});
    refine_once(level);
    if (reference.failure) {
      continue;
    }
    const films::FilmComplex refined = complex;
    settle_level(settle);
    // Refined folds settle as saddles, or not at all.
    if (may_groom && reference.failure) {
      complex = refined;
      if (groom::even_out(complex, groom::EvenOut::KeepEdges)) {
        settle_level(settle);
      }
    }
    // Where the coarser film was far from this one, new vertices came to it
    // aslant: slivers, whose modes are wrong at any length of edge.
    if (may_groom && !reference.failure && groom::spread_slivers(complex)) {
      settle_level(settle);
    }
  }
}

/// Once the reference is at rest.
void FilmModel::Impl::lead_lines(const films::FilmSystem& initial) {
  if (carry->lines().empty() || reference.failure) {
    return;
  }
  AtRest film = at_rest(reference, initial);
  lead = std::make_unique<const LineLead>(
      *energy, std::move(film.targets), std::move(film.base),
      std::move(film.paths), reference.points, reference.heights,
      std::move(film.pressure), carry->lines());
}

Points FilmModel::Impl::base_at(const Points& rim_moves,
                                const films::FilmTargets& goal,
                                double fraction) const {
  if (!lead) {
    return carry->at(rim_moves, fraction);
  }
  FilmAdjoint::Rates to_goal = lead->differences(goal);
  to_goal.base = carry->rates_over_lines(rim_moves);
  Points moves = lead->moves(to_goal);
  flat(moves) += flat(rim_moves);
  return carry->at(moves, fraction);
}

settle::FilmState FilmModel::Impl::settle_on_the_way(
    const Points& moves, const films::FilmTargets& goal, double t,
    const VectorX& heights, const settle::SettleOptions& options) const {
  const Points base = base_at(moves, goal, t);
  return settle::settle_along(
      *energy, complex, t < 1.0 ? blend(targets, goal, t) : goal, base,
      energy->space().directions(base), heights, usual_neck, options);
}

std::optional<Failure> FilmModel::Impl::lines_that_meet(
    const Points& moves, const films::FilmTargets& goal,
    const settle::SettleOptions& options) const {
  double stands = 0.0;  // of the way
  double fails = 1.0;
  settle::FilmState last = reference;
  const LineGaps gaps(complex);
  NarrowFilm narrow = gaps.narrowest(reference.points);
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double t = 0.5 * (stands + fails);
    settle::FilmState state =
        settle_on_the_way(moves, goal, t, last.heights, options);
    if (state.failure) {
      fails = t;
    } else {
      stands = t;
      last = std::move(state);
      narrow = gaps.narrowest(last.points);
    }
  }
  if (narrow.ratio > kRunTogether) {
    return std::nullopt;
  }
  const bool whole = narrow.how == NarrowFilm::How::Whole;
  const char* what = whole ? "film '{}' shrinks away"
                     : narrow.how == NarrowFilm::How::AtItsRim
                         ? "the line at which film '{}' ends runs into its rim"
                         : "two lines of film '{}' run together";
  return Failure{
      FailureKind::FilmRejoins,
      fmt::format("{} at ({:.4g}, {:.4g}, {:.4g}): {:.3g} of the way from the "
                  "model's design {} {:.3g}, of {:.3g} there; beyond, films "
                  "join in another way, as those of a model frozen there",
                  fmt::format(fmt::runtime(what), narrow.film),
                  narrow.place.x(), narrow.place.y(), narrow.place.z(), stands,
                  whole ? "the root of its area is" : "they are apart by",
                  narrow.width, narrow.usual)};
}

settle::FilmState FilmModel::Impl::settle_in_parts(
    const Points& moves, const films::FilmTargets& goal, int parts,
    const settle::SettleOptions& options) const {
  if (energy->unknowns() == 0) {
    return rigid_state(carry->at(moves, 1.0), goal);
  }
  settle::FilmState state;
  int iterations = 0;
  try {
    for (int part = 1; part <= parts && !state.failure; ++part) {
      state = settle_on_the_way(moves, goal, static_cast<double>(part) / parts,
                                state.heights, options);
      iterations += state.report.iterations;
    }
    if (!state.failure) {
      energy::tensions_at(complex, goal,
                          state.points);  // throws where one is not above 0
    }
  } catch (const ExpressionError& error) {
    state = reference;
    state.failure = Failure{FailureKind::NotANumber, no_value(error)};
  } catch (const InvalidInput& error) {
    state.failure = Failure{FailureKind::NotANumber, error.what()};
  }
  if (!state.points.empty()) {
    try {
      carry->follow(state.points);
    } catch (const MeshError& error) {
      state.points = reference.points;
      if (!state.failure) {
        state.failure = Failure{FailureKind::SurfaceInvalid, error.what()};
      }
    }
  }
  if (state.failure) {
    state.report.verdict = state.failure->message;
  }
  state.report.iterations = iterations;
  return state;
}

FilmModel::FilmModel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmModel::FilmModel(FilmModel&&) noexcept = default;
FilmModel& FilmModel::operator=(FilmModel&&) noexcept = default;
FilmModel::~FilmModel() = default;

FilmModel FilmModel::freeze(const films::FilmSystem& initial,
                            const FilmModelOptions& options) {
  const Heeding heeding(options.monitor);
  if (!(options.edge > 0.0) || !std::isfinite(options.edge)) {
    throw InvalidInput(fmt::format(
        "the film's edge length must be above 0, found {}", options.edge));
  }
  if (options.refinements < 0 || options.refinements > 6) {
    throw InvalidInput(
        fmt::format("the film's refinements must be 0 to 6, found {}",
                    options.refinements));
  }
  check_numbers(initial);
  // The reference film: its topology and mesh are kept for all designs.
  const Timer timer;
  auto impl = std::make_unique<Impl>();
  settle::SettleOptions settle{.monitor = options.monitor};
  try {
    impl->find_reference(initial, options, settle);
  } catch (const ExpressionError& error) {
    throw InvalidInput(no_value(error));
  }
  FilmModel model = finish(std::move(impl), initial, settle);
  model.impl_->reference.report.seconds = timer.seconds();
  return model;
}

FilmModel FilmModel::refined(const settle::FilmState& state,
                             const films::FilmSystem& system,
                             Monitor* monitor) const {
  const Heeding heeding(monitor);
  const Timer timer;
  const settle::SettleOptions settle{.monitor = monitor};
  auto impl = std::make_unique<Impl>();
  impl->complex = complex_at(state, system);
  Impl::sample_spines(system, impl->complex);
  impl->meshed = impl->complex.mesh;
  impl->meshed_complex = impl->complex;
  impl->reference = state;
  impl->start_edge = impl_->start_edge;
  impl->refine_and_settle(1, !system.keep_facets, settle);
  FilmModel model = finish(std::move(impl), system, settle);
  model.impl_->margin_scale = impl_->margin_scale;
  model.impl_->reference.report.seconds = timer.seconds();
  return model;
}

/// From a found reference to a model that can be used.
FilmModel FilmModel::finish(std::unique_ptr<Impl> impl,
                            const films::FilmSystem& initial,
                            const settle::SettleOptions& settle) {
  // The solid's surface as constant weights of film vertices: corners at
  // vertices of one level, mid-sides on the next finer one.
  std::vector<int> corner(impl->meshed.points.size());
  std::iota(corner.begin(), corner.end(), 0);
  SurfaceMesh topology = impl->meshed;
  topology.points.clear();
  impl->regions = films::regions_of(initial.bodies);
  films::keep_solids(impl->complex, impl->regions, topology);
  films::drop_unused(topology, corner);
  impl->nodes =
      surface_nodes(std::move(topology), std::move(corner),
                    impl->middles(impl->near_parents), impl->straight());
  if (impl->reference.failure || !impl->energy) {
    impl->energy.emplace(impl->complex);
  }
  impl->targets = energy::targets_of(impl->complex);
  FilmModel model(std::move(impl));
  // Settled once more along carried directions, so that the reference is what
  // the frozen model gives at the initial design.
  if (!model.impl_->reference.failure) {
    model.impl_->carry.emplace(
        model.impl_->complex,
        lines_of(model.impl_->complex, model.impl_->energy->space()),
        model.impl_->energy->vertex_order());
    model.impl_->usual_neck = model.impl_->reference.report.smallest_neck;
    model.impl_->reference = model.settle(initial, settle);
    model.impl_->reference_goal = model.impl_->targets_of_system(initial);
    model.impl_->lead_lines(initial);
  } else if (model.impl_->reference.points.size() !=
             model.impl_->complex.mesh.points.size()) {
    model.impl_->reference.points = model.impl_->complex.mesh.points;
    model.impl_->reference.heights =
        VectorX::Zero(model.impl_->energy->unknowns());
  }
  model.impl_->margin_scale =
      std::abs(model.impl_->reference.report.min_eigenvalue);
  return model;
}

const settle::FilmState& FilmModel::reference() const {
  return impl_->reference;
}
double FilmModel::start_edge() const { return impl_->start_edge; }

settle::FilmState FilmModel::settle(
    const films::FilmSystem& system,
    const settle::SettleOptions& options) const {
  const Timer timer;
  check_numbers(system);
  if (!impl_->carry) {
    throw InvalidInput(
        "this film model cannot be used: no film was found at its initial "
        "design (" +
        impl_->reference.report.verdict + ")");
  }
  const films::FilmTargets goal = impl_->targets_of_system(system);
  const Points moves = impl_->carry->rim_moves(impl_->curves_of_system(system));
  const bool moved = std::any_of(moves.begin(), moves.end(),
                                 [](const Vec3& m) { return !m.isZero(0.0); });
  if (!moved && impl_->reference_goal == goal && !impl_->reference.failure) {
    settle::FilmState state = impl_->reference;
    state.report.seconds = timer.seconds();
    return state;
  }
  settle::FilmState state;
  int iterations = 0;
  for (const int parts : kParts) {
    settle::FilmState found =
        impl_->settle_in_parts(moves, goal, parts, options);
    iterations += found.report.iterations;
    if (parts == kParts.front() || !found.failure) {
      state = std::move(found);
    }
    if (!state.failure && iterations <= kManyIterations) {
      break;
    }
  }
  if (state.failure && !impl_->carry->lines().empty() &&
      is_of_film(*state.failure)) {
    if (std::optional<Failure> meeting =
            impl_->lines_that_meet(moves, goal, options)) {
      state.failure = std::move(meeting);
      state.report.verdict = state.failure->message;
    }
  }
  if (moved && state.failure &&
      state.failure->kind == FailureKind::FilmNotFound) {
    state.failure->message +=
        "; a model frozen nearer to this design may reach further";
    state.report.verdict = state.failure->message;
  }
  state.report.iterations = iterations;
  state.report.seconds = timer.seconds();
  return state;
}

QuadraticSurface FilmModel::surface(const Points& points) const {
  return impl_->nodes.at(points);
}

void FilmModel::split_facets(const std::vector<char>& marked) {
  impl_->nodes = meniscus::split_facets(impl_->nodes, marked,
                                        impl_->middles(impl_->near_parents),
                                        impl_->straight());
}

SurfaceMesh FilmModel::fine_mesh(const Points& points) const {
  SurfaceMesh mesh = impl_->complex.mesh;
  mesh.points = points;
  return mesh;
}

SurfaceMesh FilmModel::solids(const Points& points) const {
  SurfaceMesh mesh = fine_mesh(points);
  films::keep_solids(impl_->complex, impl_->regions, mesh);
  return mesh;
}

SurfaceMesh FilmModel::boundary(const Points& points) const {
  SurfaceMesh mesh = solids(points);
  films::drop_interfaces(mesh);
  return mesh;
}

SurfaceMesh FilmModel::meshed_facets() const {
  SurfaceMesh mesh = impl_->meshed;
  mesh.points.clear();
  return mesh;
}

EdgeMiddles FilmModel::middles() const {
  return impl_->middles(impl_->parents.size());
}

int FilmModel::refinements() const { return impl_->refinements; }

std::vector<int> FilmModel::rim(const std::string& curve) const {
  std::vector<int> result;
  for (std::size_t v = 0; v < impl_->complex.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = impl_->complex.vertices[v];
    if (vertex.kind == films::VertexKind::OnCurve &&
        impl_->complex.curves[vertex.curve].name == curve) {
      result.push_back(static_cast<int>(v));
    }
  }
  return result;
}

std::vector<double> FilmModel::rim_parameters(const std::string& curve) const {
  std::vector<double> result;
  for (const int v : rim(curve)) {
    result.push_back(impl_->complex.vertices[v].t);
  }
  return result;
}

SlidingPlanes FilmModel::sliding_planes() const {
  const films::FilmComplex& complex = impl_->complex;
  SlidingPlanes result;
  result.at.resize(complex.vertices.size());
  std::vector<int> plane_of(complex.level_sets.size(), -1);
  for (const films::ComplexSurface& surface : complex.surfaces) {
    if (!surface.wetted || surface.wetted->bent || surface.constraints < 0) {
      continue;
    }
    const int level = complex.constraint_sets[surface.constraints].front();
    if (plane_of[level] < 0) {
      plane_of[level] = static_cast<int>(result.planes.size());
      result.planes.push_back(
          {complex.level_sets[level].name, surface.wetted->normal});
    }
  }
  const auto stays = [&](int v, int set) {
    for (const int level : complex.constraint_sets[set]) {
      std::vector<int>& at = result.at[v];
      if (plane_of[level] >= 0 &&
          std::find(at.begin(), at.end(), plane_of[level]) == at.end()) {
        at.push_back(plane_of[level]);
      }
    }
  };
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].constraints >= 0) {
      stays(static_cast<int>(v), complex.vertices[v].constraints);
    }
  }
  for (const films::ComplexEdge& mark : complex.edges) {
    if (mark.constraints >= 0) {
      stays(mark.a, mark.constraints);
      stays(mark.b, mark.constraints);
    }
  }
  return result;
}

films::FilmComplex FilmModel::Impl::at_design(
    films::FilmComplex at, const settle::FilmState& state,
    const films::FilmSystem& system) const {
  if (state.failure) {
    throw InvalidInput("there is no film: " + state.failure->message);
  }
  if (state.points.size() != complex.mesh.points.size()) {
    throw InvalidInput("the film's state is not of this model");
  }
  // A level's vertices come before those of its refinements.
  std::copy_n(state.points.begin(), at.mesh.points.size(),
              at.mesh.points.begin());
  at.curves = curves_of_system(system);
  const films::FilmTargets goal = targets_of_system(system);
  for (std::size_t s = 0; s < at.surfaces.size(); ++s) {
    if (at.surfaces[s].drop_shape.empty()) {  // else among its numbers
      at.surfaces[s].tension = goal.tension[s];
    }
    films::set_tension_numbers(goal.numbers[at.quantities.size() + s],
                               at.surfaces[s]);
  }
  for (std::size_t b = 0; b < at.bodies.size(); ++b) {
    at.bodies[b].volume = goal.bodies[b].volume;
    at.bodies[b].pressure = goal.bodies[b].pressure;
  }
  for (std::size_t q = 0; q < at.quantities.size(); ++q) {
    if (at.quantities[q].kind == films::FilmQuantity::Kind::BodyPoles) {
      at.quantities[q].poles = poles_of(system, q);
    } else {
      at.quantities[q].scalar.numbers = goal.numbers[q];
    }
  }
  return at;
}

films::FilmComplex FilmModel::complex_at(
    const settle::FilmState& state, const films::FilmSystem& system) const {
  return impl_->at_design(impl_->complex, state, system);
}

films::FilmComplex FilmModel::meshed_at(const settle::FilmState& state,
                                        const films::FilmSystem& system) const {
  return impl_->at_design(impl_->meshed_complex, state, system);
}

}  // namespace meniscus::frozen
