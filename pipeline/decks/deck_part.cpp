#include "pipeline/decks/deck_part.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/tet_element.h"
#include "fea/loads/face_pressures.h"
#include "fea/loads/loads.h"
#include "fea/supports/restraints.h"

namespace meniscus::decks {

namespace {

/// What the work throws for input, with its place in the deck before it.
void at_place(const std::string& place, const std::function<void()>& work) {
  try {
    work();
  } catch (const InvalidInput& error) {
    throw InvalidInput(place + ": " + error.what());
  } catch (const SolverError& error) {
    throw InvalidInput(place + ": " + error.what());
  }
}

element::Material deck_material(const io::DeckMaterial& m) {
  element::Material material{.name = m.name,
                             .youngs_modulus = m.youngs_modulus,
                             .poisson_ratio = m.poisson_ratio,
                             .density = m.density};
  material.thermal_expansion = m.thermal_expansion;
  if (m.orthotropic) {
    const io::DeckOrthotropic& o = *m.orthotropic;
    material.orthotropic = element::Orthotropic{o.youngs_moduli,
                                                o.poisson_ratios,
                                                o.shear_moduli,
                                                {o.axis_1, o.axis_2}};
  }
  return material;
}

template <int Nodes>
void check_elements(const deck::ReadDeck& deck) {
  element::TetGradients<Nodes> gradients;
  std::array<Vec3, Nodes> x;
  for (int e = 0; e < deck.mesh.element_count(); ++e) {
    const auto ids = deck.mesh.element(e);
    for (std::size_t a = 0; a < ids.size(); ++a) {
      x[a] = deck.mesh.nodes[static_cast<std::size_t>(ids[a])];
    }
    element::tet_gradients<Nodes>(x, gradients);
    for (const double volume : gradients.volume) {
      if (!(volume > 0.0)) {
        throw InvalidInput(fmt::format(
            "{}: element {} is turned inside out where its mid-side nodes bend "
            "it: its Jacobian determinant is not positive; are the nodes in "
            "CalculiX's order, and the edges short enough for the curve?",
            deck.place_of_element(e),
            deck.element_numbers[static_cast<std::size_t>(e)]));
      }
    }
  }
}

/// The mesh of some of its elements, with all nodes.
TetMesh only_elements(const TetMesh& mesh, const std::vector<int>& elements) {
  TetMesh part;
  part.order = mesh.order;
  part.nodes = mesh.nodes;
  part.corner_count = mesh.corner_count;
  for (const int e : elements) {
    const auto ids = mesh.element(e);
    part.elements.insert(part.elements.end(), ids.begin(), ids.end());
    part.element_region.push_back(
        mesh.element_region[static_cast<std::size_t>(e)]);
  }
  return part;
}

void hold(const deck::ReadStep& step, loads::LoadCase& load_case) {
  for (const deck::ReadHold& held : step.holds) {
    load_case.held_nodes.push_back(
        {held.node, held.direction, held.displacement});
  }
  for (const deck::ReadSpring& spring : step.springs) {
    load_case.node_springs.push_back(
        {spring.stiffness, spring.nodes, spring.coefficients});
  }
}

/// Loads as nodal forces, but for temperatures, which strain.
void load(const deck::ReadStep& step, const TetMesh& mesh,
          const std::vector<element::Material>& materials,
          loads::LoadCase& load_case) {
  std::vector<loads::FacePressure> pressures;
  for (const deck::ReadPressure& p : step.pressures) {
    pressures.push_back({p.element, p.opposite_corner, p.pressure});
  }
  VectorX forces = loads::face_pressure_forces(mesh, pressures);
  if (step.nodal_forces.size() != 0) {
    forces += step.nodal_forces;
  }
  for (const deck::ReadBodyLoad& body : step.body_loads) {
    loads::LoadCase acts{.name = step.name};
    acts.gravity = body.gravity;
    if (body.spin) {
      acts.spin =
          loads::Spin{body.spin->point, body.spin->axis, body.spin->rate};
    }
    forces += loads::nodal_forces(only_elements(mesh, body.elements), acts,
                                  materials);
  }
  load_case.nodal = std::move(forces);
  if (step.temperature_change.size() != 0) {
    load_case.temperature.emplace().nodal = step.temperature_change;
  }
}

loads::LoadCase load_case_of(const deck::ReadStep& step, const TetMesh& mesh,
                             const std::vector<element::Material>& materials) {
  loads::LoadCase load_case{.name = step.name};
  hold(step, load_case);
  if (step.procedure == deck::DeckProcedure::Frequency) {
    return load_case;
  }
  at_place(step.place, [&] {
    load(step, mesh, materials, load_case);
    if (!loads::enforces(load_case) &&
        loads::nodal_forces(mesh, load_case, materials).isZero(0.0)) {
      throw InvalidInput(fmt::format(
          "step '{}' has no load that acts; give one by *CLOAD, *DLOAD or "
          "*DSLOAD, or enforce a displacement by *BOUNDARY",
          step.name));
    }
    supports::check_restraints(mesh, load_case);
  });
  return load_case;
}

void check_density(const deck::ReadStep& step,
                   const std::vector<element::Material>& materials) {
  for (const element::Material& material : materials) {
    if (material.density == 0.0) {
      throw InvalidInput(fmt::format(
          "{}: frequencies need a mass; give material '{}' a *DENSITY",
          step.place, material.name));
    }
  }
}

}  // namespace

bool is_deck(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending == ".inp";
}

DeckPart make_deck_part(deck::ReadDeck deck) {
  DeckPart part{.deck = std::move(deck), .materials = {}, .load_cases = {}};
  const deck::ReadDeck& read = part.deck;
  for (std::size_t r = 0; r < read.materials.size(); ++r) {
    part.materials.push_back(deck_material(read.materials[r]));
    at_place(read.material_places[r],
             [&] { element::check_material(part.materials.back()); });
  }
  if (read.mesh.order == 1) {
    check_elements<4>(read);
  } else {
    check_elements<10>(read);
  }
  for (const deck::ReadStep& step : read.steps) {
    if (step.procedure == deck::DeckProcedure::Frequency) {
      check_density(step, part.materials);
    }
    part.load_cases.push_back(load_case_of(step, read.mesh, part.materials));
  }
  return part;
}

DeckPart read_deck_part(const std::filesystem::path& path) {
  return make_deck_part(deck::read_deck(path));
}

}  // namespace meniscus::decks
