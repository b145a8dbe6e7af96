#include "pipeline/results/calculix_export.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/loads/body_loads.h"
#include "fea/loads/loads.h"
#include "fea/loads/support.h"
#include "fea/supports/enforced.h"
#include "fea/supports/pins.h"
#include "fea/supports/springs.h"
#include "fea/supports/supports.h"

namespace meniscus::results {

namespace {

constexpr double kNothing = 1e-12;  // a coefficient that rounding left

bool along_axes(const loads::LoadCase& load_case) {
  return load_case.held_nodes.empty() && load_case.pins.empty() &&
         std::all_of(load_case.supports.begin(), load_case.supports.end(),
                     [](const loads::Support& s) {
                       return s.kind == loads::SupportKind::Components &&
                              !s.axes;
                     });
}

/// Rows of the held directions, each solved for a component of its own: that
/// component has coefficient 1, and 0 in all other rows.
std::vector<io::DeckEquation> solved_rows(int node, const Mat3& projector) {
  Mat3 rows = Mat3::Identity() - projector;
  std::vector<io::DeckEquation> result;
  for (int k = 0; k < 3; ++k) {
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    if (rows.bottomRows(3 - k).cwiseAbs().maxCoeff(&row, &column) < kNothing) {
      break;
    }
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, column);
    for (int r = 0; r < 3; ++r) {
      if (r != k) {
        rows.row(r) -= (rows(r, column) * rows.row(k)).eval();
      }
    }
    result.push_back({node, Vec3::Zero(), static_cast<int>(column)});
  }
  for (std::size_t k = 0; k < result.size(); ++k) {
    const Vec3 row = rows.row(static_cast<Eigen::Index>(k));
    result[k].coefficients = row.unaryExpr(
        [](double x) { return std::abs(x) > kNothing ? x : 0.0; });
  }
  return result;
}

/// Supports of nodes held along the axes; equations for the others.
struct HeldNodes {
  std::vector<io::DeckSupport> supports;
  std::vector<io::DeckEquation> equations;
};

bool is_along_axis(const io::DeckEquation& row) {
  return (row.coefficients.array() != 0.0).count() == 1;
}

/// Decks have no equation with a right-hand side: where a component beside it
/// is held at a place `u`, a multiple of that takes it up. False where none is.
bool make_homogeneous(const std::array<bool, 3>& fix, const Vec3& u,
                      io::DeckEquation& row) {
  const double right = row.coefficients.dot(u);
  if (std::abs(right) <= kNothing * u.norm()) {
    return true;
  }
  for (std::size_t k = 0; k < fix.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (fix[k] && std::abs(u[at]) > kNothing * u.norm()) {
      row.coefficients[at] -= right / u[at];
      return true;
    }
  }
  return false;
}

HeldNodes held_nodes(const TetMesh& mesh, const loads::LoadCase& load_case) {
  const solver::NodeFreedom freedom =
      supports::node_freedom(mesh, supports::held_directions(mesh, load_case));
  const VectorX enforced = supports::enforced_displacement(mesh, load_case);
  HeldNodes result;
  using Held = std::pair<std::array<bool, 3>, std::array<double, 3>>;
  std::map<Held, std::vector<int>> fixed;
  for (std::size_t h = 0; h < freedom.held.size(); ++h) {
    std::array<bool, 3> fix{};
    std::array<double, 3> at{};
    const Vec3 u = enforced.size() == 0
                       ? Vec3(Vec3::Zero())
                       : Vec3(enforced.segment<3>(3L * freedom.held[h]));
    const std::vector<io::DeckEquation> rows =
        solved_rows(freedom.held[h], freedom.projector[h]);
    for (const io::DeckEquation& row : rows) {
      if (is_along_axis(row)) {
        fix[row.dependent] = true;
        at[row.dependent] = u[row.dependent];
      }
    }
    for (io::DeckEquation row : rows) {
      if (!is_along_axis(row) && !make_homogeneous(fix, u, row)) {
        throw InvalidInput(fmt::format(
            "load case '{}' enforces a displacement along an oblique "
            "direction, which decks do not hold; export a case whose supports "
            "with a displacement are along x, y, z",
            load_case.name));
      }
      if (!is_along_axis(row)) {
        result.equations.push_back(row);
      }
    }
    if (fix[0] || fix[1] || fix[2]) {
      fixed[{fix, at}].push_back(freedom.held[h]);
    }
  }
  for (const auto& [held, nodes] : fixed) {
    const auto& [fix, at] = held;
    result.supports.push_back(
        {"", nodes, fix[0], fix[1], fix[2], {at[0], at[1], at[2]}});
  }
  return result;
}

bool same(const std::vector<io::DeckEquation>& a,
          const std::vector<io::DeckEquation>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const io::DeckEquation& x, const io::DeckEquation& y) {
                      return x.node == y.node && x.dependent == y.dependent &&
                             x.coefficients == y.coefficients;
                    });
}

/// What the deck has no card for goes into nodal forces.
void add_loads(const loads::LoadCase& load_case, const TetMesh& mesh,
               io::DeckStep& step) {
  loads::LoadCase rest{.name = load_case.name};
  rest.nodal = load_case.nodal;
  rest.forces = load_case.forces;
  rest.tractions = load_case.tractions;
  rest.remote_loads = load_case.remote_loads;
  rest.bearings = load_case.bearings;
  for (const loads::SurfacePressure& p : load_case.pressures) {
    if (p.field) {
      rest.pressures.push_back(p);
    } else {
      step.pressures.push_back({p.surface, p.pressure});
    }
  }
  if (!rest.forces.empty() || !rest.tractions.empty() ||
      !rest.remote_loads.empty() || !rest.bearings.empty() ||
      !rest.pressures.empty() || rest.nodal.size() != 0) {
    step.nodal_forces = loads::nodal_forces(mesh, rest);
  }
  step.gravity = load_case.gravity;
  if (load_case.spin) {
    step.spin = io::DeckSpin{load_case.spin->point, load_case.spin->axis,
                             load_case.spin->rate};
  }
  step.temperature_change = loads::temperature_change(mesh, load_case);
}

/// The springs of load case `step`, together with those of an earlier one that
/// stands on the same beds.
void add_springs(const std::vector<loads::LoadCase>& load_cases,
                 std::size_t step, const TetMesh& mesh,
                 io::CalculixDeck& deck) {
  const loads::LoadCase& load_case = load_cases[step];
  if (load_case.springs.empty() && load_case.node_springs.empty()) {
    return;
  }
  const auto number = static_cast<int>(step);
  const auto same_beds =
      std::find_if(load_cases.begin(), load_cases.begin() + number,
                   [&](const loads::LoadCase& c) {
                     return c.springs == load_case.springs &&
                            c.node_springs == load_case.node_springs;
                   });
  const auto earlier = static_cast<int>(same_beds - load_cases.begin());
  if (earlier < number) {
    for (io::DeckSprings& set : deck.springs) {
      if (set.steps.front() == earlier) {
        set.steps.push_back(number);
      }
    }
    return;
  }
  for (supports::SpringSet& set : supports::spring_sets(mesh, load_case)) {
    io::DeckSprings springs{.stiffness = set.stiffness, .steps = {number}};
    for (supports::SpringSet::Spring& spring : set.springs) {
      springs.springs.push_back(
          {std::move(spring.nodes), std::move(spring.coefficients)});
    }
    deck.springs.push_back(std::move(springs));
  }
}

/// Same nodes; and the same frame where both hold the pin.
bool same_pins(const std::vector<io::DeckPin>& a,
               const std::vector<supports::PinFrame>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const io::DeckPin& x, const supports::PinFrame& y) {
        return x.nodes == y.nodes &&
               (y.is_free() || (x.point == y.point && x.axes == y.axes));
      });
}

/// The pins of all load cases, each in the frame that holds it.
std::vector<io::DeckPin> pins_of(const std::vector<loads::LoadCase>& load_cases,
                                 const TetMesh& mesh) {
  std::vector<io::DeckPin> pins;
  for (std::size_t c = 0; c < load_cases.size(); ++c) {
    const std::vector<supports::PinFrame> frames =
        supports::pin_frames(mesh, load_cases[c]);
    for (std::size_t p = 0; p < frames.size(); ++p) {
      const supports::PinFrame& frame = frames[p];
      if (c == 0) {
        pins.push_back({frame.nodes, frame.point, frame.axes});
      } else if (p < pins.size() && !frame.is_free() &&
                 supports::pin_frames(mesh, load_cases[0])[p].is_free()) {
        pins[p].point = frame.point;
        pins[p].axes = frame.axes;
      }
    }
  }
  return pins;
}

void add_pins(const loads::LoadCase& load_case, const TetMesh& mesh,
              const io::CalculixDeck& deck, io::DeckStep& step) {
  const std::vector<supports::PinFrame> frames =
      supports::pin_frames(mesh, load_case);
  if (!same_pins(deck.pins, frames)) {
    throw InvalidInput(fmt::format(
        "load case '{}' has other rigid pins than the load cases beside it, or "
        "holds them at another point; a deck has one set of them for all its "
        "steps: export a case with one of these load cases",
        load_case.name));
  }
  for (std::size_t p = 0; p < frames.size(); ++p) {
    io::DeckPinSupport& held = step.pins.emplace_back();
    held.fixed = frames[p].fixed;
    for (int k = 0; k < 6; ++k) {
      held.value[static_cast<std::size_t>(k)] =
          frames[p].fixed[static_cast<std::size_t>(k)]
              ? supports::pin_value(load_case.pins[p], k)
              : 0.0;
    }
  }
}

}  // namespace

io::DeckMaterial deck_material_of(const element::Material& m) {
  io::DeckMaterial result{.name = m.name,
                          .youngs_modulus = m.youngs_modulus,
                          .poisson_ratio = m.poisson_ratio,
                          .density = m.density};
  result.thermal_expansion = m.thermal_expansion;
  if (m.orthotropic) {
    const element::Orthotropic& o = *m.orthotropic;
    result.orthotropic =
        io::DeckOrthotropic{o.youngs_moduli, o.poisson_ratios, o.shear_moduli,
                            o.axes.first, o.axes.second};
  }
  return result;
}

io::CalculixDeck calculix_deck_of(
    const std::vector<element::Material>& materials,
    const std::vector<loads::LoadCase>& load_cases, const TetMesh& mesh) {
  io::CalculixDeck deck;
  for (const element::Material& m : materials) {
    deck.materials.push_back(deck_material_of(m));
  }
  deck.pins = pins_of(load_cases, mesh);
  for (const loads::LoadCase& load_case : load_cases) {
    io::DeckStep step{.name = load_case.name};
    std::vector<io::DeckEquation> equations;
    if (along_axes(load_case)) {
      for (const loads::Support& s : load_case.supports) {
        step.supports.push_back(
            {.surface = s.surface,
             .fix_x = s.fix_x,
             .fix_y = s.fix_y,
             .fix_z = s.fix_z,
             .displacement = loads::value_of(s.displacement)});
      }
    } else {
      HeldNodes held = held_nodes(mesh, load_case);
      step.supports = std::move(held.supports);
      equations = std::move(held.equations);
    }
    if (!deck.steps.empty() && !same(equations, deck.equations)) {
      throw InvalidInput(fmt::format(
          "load case '{}' is held along other oblique directions than '{}'; a "
          "deck has one set of equations for all its steps: export a case with "
          "one of them",
          load_case.name, deck.steps.front().name));
    }
    deck.equations = std::move(equations);
    add_loads(load_case, mesh, step);
    add_pins(load_case, mesh, deck, step);
    add_springs(load_cases, deck.steps.size(), mesh, deck);
    deck.steps.push_back(std::move(step));
  }
  return deck;
}

io::CalculixDeck calculix_deck_of(const case_data::Case& input,
                                  const case_data::EvaluatedCase& inputs,
                                  const TetMesh& mesh) {
  // Without those that only show a load from any direction: of its unit loads
  // any follows.
  const auto solved = static_cast<std::ptrdiff_t>(input.load_cases.size());
  io::CalculixDeck deck = calculix_deck_of(
      inputs.materials,
      {inputs.load_cases.begin(), inputs.load_cases.begin() + solved}, mesh);
  deck.comments = {"case: " + input.title, "units: " + input.units.name};
  return deck;
}

}  // namespace meniscus::results
