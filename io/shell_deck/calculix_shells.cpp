#include "io/shell_deck/calculix_shells.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/calculix_material.h"
#include "io/calculix_names.h"
#include "io/file_notes.h"
#include "io/shell_deck/calculix_shell_held.h"

namespace meniscus::shell_deck {

namespace {

constexpr double kOneThickness = 1e-9;  // relative, of rounding

template <class Row>
std::vector<std::string> names_of(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  names.reserve(rows.size());
  for (const Row& row : rows) {
    names.push_back(row.name);
  }
  return io::deck_names(names);
}

/// Means over a node's facets.
struct NodeWalls {
  Points normals;    // unit vectors
  Points to_middle;  // from the node to the middle of the wall [length]
};

NodeWalls walls_of(const ShellDeck& deck) {
  NodeWalls walls;
  walls.normals.assign(deck.nodes.size(), Vec3::Zero());
  walls.to_middle.assign(deck.nodes.size(), Vec3::Zero());
  std::vector<double> count(deck.nodes.size(), 0.0);
  for (std::size_t f = 0; f < deck.facets.size(); ++f) {
    const std::array<int, 6>& facet = deck.facets[f];
    const Vec3& a = deck.nodes[facet[0]];
    const Vec3 normal =
        (deck.nodes[facet[1]] - a).cross(deck.nodes[facet[2]] - a).normalized();
    const double offset = deck.sections[deck.section[f]].offset;
    const std::array<double, 6>& thickness = deck.thickness[f];
    for (std::size_t i = 0; i < facet.size(); ++i) {
      walls.normals[facet[i]] += normal;
      walls.to_middle[facet[i]] += offset * thickness[i] * normal;
      count[facet[i]] += 1.0;
    }
  }
  for (std::size_t n = 0; n < count.size(); ++n) {
    walls.normals[n].normalize();
    walls.to_middle[n] /= std::max(count[n], 1.0);
  }
  return walls;
}

class ShellWriter {
 public:
  explicit ShellWriter(const ShellDeck& deck)
      : deck_(deck),
        set_names_(names_of(deck.sets)),
        walls_(walls_of(deck)),
        held_(held_shell_nodes(deck, walls_.normals)) {
    for (const auto& nodes : held_) {
      for (const auto& [node, held] : nodes) {
        if (held.frame) {
          turned_.emplace(node, *held.frame);
        }
      }
    }
    find_turned();
    for (std::size_t s = 0; s < deck.sections.size(); ++s) {
      even_.push_back(even_thickness(deck, static_cast<int>(s)));
    }
  }

  std::string text() {
    head();
    nodes();
    elements();
    sets();
    axes();
    sections();
    nodal_thickness();
    if (is_heated(deck_)) {
      add("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n");
    }
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      write_step(deck_.steps[s], held_[s]);
    }
    return fmt::to_string(buffer_);
  }

 private:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(out(), format, std::forward<Arguments>(arguments)...);
  }
  io::Out out() { return std::back_inserter(buffer_); }

  /// Nodes that moments about the middle of the wall act on, but those that are
  /// held.
  void find_turned() {
    const auto is_held = [&](int node) {
      return std::any_of(held_.begin(), held_.end(), [node](const auto& step) {
        return step.contains(node);
      });
    };
    for (const DeckShellStep& step : deck_.steps) {
      for (Eigen::Index n = 0; n < step.nodal_forces.size() / 6; ++n) {
        const auto node = static_cast<int>(n);
        if (!moment_on(step, node).isZero(0.0) && !is_held(node)) {
          has_moment_.insert(node);
          // CalculiX takes moments about two axes in a wall, none about its
          // normal.
          const Vec3& normal = walls_.normals[node];
          turned_.emplace(node, wall_frame(normal.unitOrthogonal(), normal));
        }
      }
    }
  }

  void head() {
    for (const std::string& comment : deck_.comments) {
      add("** {}\n", io::one_line(comment));
    }
    for (std::size_t k = 0; k < set_names_.size(); ++k) {
      add("** surface '{}' is NSET {}\n", io::one_line(deck_.sets[k].name),
          set_names_[k]);
    }
    for (std::size_t s = 0; s < deck_.sections.size(); ++s) {
      const DeckShellSection& section = deck_.sections[s];
      add("** shell '{}' is ELSET SHELL_{}, of '{}'\n",
          io::one_line(section.name), s,
          io::one_line(section.plies.front().material.name));
      if (section.offset != 0.0) {
        add("** its wall lies on one side of the nodes: CalculiX holds and "
            "prints its middle\n");
      }
    }
  }

  void nodes() {
    add("*NODE, NSET=NALL\n");
    for (std::size_t i = 0; i < deck_.nodes.size(); ++i) {
      const Vec3& x = deck_.nodes[i];
      add("{}, {:.12e}, {:.12e}, {:.12e}\n", i + 1, x.x(), x.y(), x.z());
    }
  }

  void elements() {
    for (std::size_t s = 0; s < deck_.sections.size(); ++s) {
      add("*ELEMENT, TYPE=S6, ELSET=SHELL_{}\n", s);
      for (std::size_t f = 0; f < deck_.facets.size(); ++f) {
        if (deck_.section[f] == static_cast<int>(s)) {
          add("{}", f + 1);
          for (const int node : deck_.facets[f]) {
            add(", {}", node + 1);
          }
          add("\n");
        }
      }
    }
    add("*ELSET, ELSET=EALL\n");
    for (std::size_t s = 0; s < deck_.sections.size(); ++s) {
      add("SHELL_{}\n", s);
    }
  }

  void sets() {
    for (std::size_t k = 0; k < set_names_.size(); ++k) {
      add("*NSET, NSET={}\n", set_names_[k]);
      io::write_ids(out(), deck_.sets[k].nodes);
    }
  }

  void axes() {
    std::vector<std::pair<Mat3, std::vector<int>>> frames;
    for (const auto& [node, axes] : turned_) {
      auto at = frames.begin();
      while (at != frames.end() && at->first != axes) {
        ++at;
      }
      if (at == frames.end()) {
        at = frames.insert(at, {axes, {}});
      }
      at->second.push_back(node);
    }
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const auto& [Q, nodes] = frames[k];
      add("*NSET, NSET=AXES_{}\n", k);
      io::write_ids(out(), nodes);
      add("*TRANSFORM, NSET=AXES_{}, TYPE=R\n"
          "{:.12e}, {:.12e}, {:.12e}, {:.12e}, {:.12e}, {:.12e}\n",
          k, Q(0, 0), Q(1, 0), Q(2, 0), Q(0, 1), Q(1, 1), Q(2, 1));
    }
  }

  void sections() {
    for (std::size_t s = 0; s < deck_.sections.size(); ++s) {
      const DeckShellSection& section = deck_.sections[s];
      if (!is_plain(section)) {
        throw InvalidInput(fmt::format(
            "shell '{}' is orthotropic or of layers, which a deck of CalculiX "
            "has none for on six-node shells of any shape; write the deck of "
            "Nastran (bdf)",
            section.name));
      }
      const std::string material = fmt::format("MATERIAL_{}", s);
      add("{}", io::constants_text(section.plies.front().material, material));
      // OFFSET is of the nodes over the middle.
      add("*SHELL SECTION, ELSET=SHELL_{}, MATERIAL={}, OFFSET={:g}{}\n{:.12e}"
          "\n",
          s, material, 0.0 - section.offset,
          even_[s] ? "" : ", NODAL THICKNESS", even_[s].value_or(1.0));
    }
  }

  void nodal_thickness() {
    std::map<int, double> at;
    for (std::size_t f = 0; f < deck_.facets.size(); ++f) {
      if (even_[deck_.section[f]]) {
        continue;
      }
      const std::array<double, 6>& thickness = deck_.thickness[f];
      for (std::size_t i = 0; i < thickness.size(); ++i) {
        const int node = deck_.facets[f][i];
        const double first = at.emplace(node, thickness[i]).first->second;
        if (std::abs(first - thickness[i]) > kOneThickness * first) {
          throw InvalidInput(fmt::format(
              "shells of thicknesses {:g} and {:g} meet at ({:.4g}, {:.4g}, "
              "{:.4g}), and both follow the place; a deck of CalculiX has one "
              "thickness a node: give one of them a single number",
              first, thickness[i], deck_.nodes[node].x(), deck_.nodes[node].y(),
              deck_.nodes[node].z()));
        }
      }
    }
    if (!at.empty()) {
      add("*NODAL THICKNESS\n");
    }
    for (const auto& [node, thickness] : at) {
      add("{}, {:.12e}\n", node + 1, thickness);
    }
  }

  void write_step(const DeckShellStep& step,
                  const std::map<int, HeldShellNode>& held) {
    add("** load case '{}'\n*STEP\n*STATIC, SOLVER=SPOOLES\n",
        io::one_line(step.name));
    write_boundary(step, held);
    if (is_heated(deck_)) {
      add("*TEMPERATURE, OP=NEW\n");
      if (step.nodal_temperatures.size() == 0) {
        add("NALL, {:.12e}\n", step.temperature_change);
      }
      for (int n = 0; n < step.nodal_temperatures.size(); ++n) {
        add("{}, {:.12e}\n", n + 1, step.temperature_at(n));
      }
    }
    // Both cards in every step: without them the last step's loads stay.
    add("*CLOAD, OP=NEW\n");
    forces(step);
    add("*DLOAD, OP=NEW\n");
    body_loads(step);
    for (const DeckFacetPressure& load : step.pressures) {
      add("{}, P, {:.12e}\n", load.facet + 1, load.pressure);
    }
    add("*NODE FILE\nU, RF\n*EL FILE\nS\n"
        "*NODE PRINT, NSET=NALL, GLOBAL=YES\nU\n*END STEP\n");
  }

  /// Only where it differs from the step before: CalculiX loses what holds
  /// rotations where a later step holds the same ones anew.
  void write_boundary(const DeckShellStep& step,
                      const std::map<int, HeldShellNode>& held) {
    const std::size_t begin = buffer_.size();
    add("*BOUNDARY, OP=NEW\n");
    for (const auto& [node, own] : held) {
      std::optional<Mat3> frame;
      if (const auto at = turned_.find(node); at != turned_.end()) {
        frame = at->second;
      }
      const std::array<double, 6> values = held_values(step, node, frame);
      for (std::size_t c = 0; c < own.fixed.size(); ++c) {
        if (own.fixed[c]) {
          add("{}, {}, {}", node + 1, c + 1, c + 1);
          if (values[c] != 0.0) {
            add(", {:.12e}", values[c]);
          }
          add("\n");
        }
      }
    }
    const std::string own(buffer_.data() + begin, buffer_.size() - begin);
    if (own == boundary_) {
      buffer_.resize(begin);
    }
    boundary_ = own;
  }

  /// About the middle of the wall.
  Vec3 moment_on(const DeckShellStep& step, int node) const {
    const Eigen::Index first = Eigen::Index{6} * node;
    const Vec3 force = step.nodal_forces.segment<3>(first);
    return step.nodal_forces.segment<3>(first + 3) +
           force.cross(walls_.to_middle[node]);
  }

  /// Along the node's own axes where it has them.
  void forces(const DeckShellStep& step) {
    for (Eigen::Index n = 0; n < step.nodal_forces.size() / 6; ++n) {
      const auto node = static_cast<int>(n);
      Vec3 force = step.nodal_forces.segment<3>(6 * n);
      Vec3 moment = moment_on(step, node);
      if (const auto own = turned_.find(node); own != turned_.end()) {
        force = own->second.transpose() * force;
        moment = own->second.transpose() * moment;
      }
      add_components(node, 1, force, 3);
      if (has_moment_.contains(node)) {
        add_components(node, 4, moment, 2);
      }
    }
  }

  void add_components(int node, int first, const Vec3& values, int count) {
    for (int c = 0; c < count; ++c) {
      if (values[c] != 0.0) {
        add("{}, {}, {:.12e}\n", node + 1, first + c, values[c]);
      }
    }
  }

  void body_loads(const DeckShellStep& step) {
    if (!step.gravity.isZero(0.0)) {
      const double size = step.gravity.norm();
      const Vec3 d = step.gravity / size;
      add("EALL, GRAV, {:.12e}, {:.12e}, {:.12e}, {:.12e}\n", size, d.x(),
          d.y(), d.z());
    }
    if (step.spin) {
      const Vec3& p = step.spin->point;
      const Vec3 a = step.spin->axis.normalized();
      add("EALL, CENTRIF, {:.12e}, {:.12e}, {:.12e}, {:.12e}, {:.12e}, "
          "{:.12e}, {:.12e}\n",
          step.spin->rate * step.spin->rate, p.x(), p.y(), p.z(), a.x(), a.y(),
          a.z());
    }
  }

  const ShellDeck& deck_;
  std::vector<std::string> set_names_;
  NodeWalls walls_;
  std::vector<std::map<int, HeldShellNode>> held_;  // per step
  std::string boundary_;                            // the last step's
  std::map<int, Mat3> turned_;               // nodes with a frame of their own
  std::set<int> has_moment_;                 // nodes that moments act on
  std::vector<std::optional<double>> even_;  // per section: its one thickness
  fmt::memory_buffer buffer_;
};

}  // namespace

std::string calculix_shell_deck(const ShellDeck& deck) {
  check_shell_deck(deck);
  if (!deck.rigid.empty()) {
    throw InvalidInput(fmt::format(
        "'{}' moves as a rigid body; CalculiX couples no rotations of shells' "
        "nodes to one: write the deck of Nastran (bdf)",
        deck.rigid.front().name));
  }
  return ShellWriter(deck).text();
}

void write_calculix_shells(const std::filesystem::path& path,
                           const ShellDeck& deck) {
  write_file(path, calculix_shell_deck(deck));
}

}  // namespace meniscus::shell_deck
