#include "io/shell_deck/nastran_shells.h"

#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/nastran_bdf.h"
#include "io/nastran_fields.h"
#include "io/nastran_material.h"

namespace meniscus::shell_deck {

namespace {

std::string number(int value) { return std::to_string(value); }

/// Set numbers of subcase k, counted from 1.
constexpr int sum_set(int k) { return 10 * k; }
constexpr int node_set(int k) { return 10 * k + 1; }
constexpr int gravity_set(int k) { return 10 * k + 2; }
constexpr int turning_set(int k) { return 10 * k + 3; }
constexpr int heat_set(int k) { return 10 * k + 4; }

/// What the LOAD card of a step puts together.
io::Fields sets_of_load(const DeckShellStep& step, int k) {
  io::Fields sets;
  if (!step.pressures.empty() ||
      (step.nodal_forces.size() != 0 && !step.nodal_forces.isZero(0.0))) {
    sets.push_back(number(node_set(k)));
  }
  if (!step.gravity.isZero(0.0)) {
    sets.push_back(number(gravity_set(k)));
  }
  if (step.spin) {
    sets.push_back(number(turning_set(k)));
  }
  return sets;
}

void append_vector(const Vec3& x, io::Fields& fields) {
  for (int i = 0; i < 3; ++i) {
    fields.push_back(io::nastran_real(x[i]));
  }
}

class ShellBulk {
 public:
  explicit ShellBulk(const ShellDeck& deck)
      : deck_(deck),
        turned_(turned_nodes(deck)),
        next_point_(static_cast<int>(deck.nodes.size()) + 1) {}

  std::string text() {
    case_control();
    text_ += "BEGIN BULK\nPARAM   POST    -1\n";
    frames();
    grid();
    sections();
    elements();
    rigid_bodies();
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      write_step(deck_.steps[s], static_cast<int>(s) + 1);
    }
    text_ += "ENDDATA\n";
    return std::move(text_);
  }

 private:
  void comment(const std::string& line) {
    text_ += "$ " + io::plain_text(line) + "\n";
  }

  void case_control() {
    for (const std::string& line : deck_.comments) {
      comment(line);
    }
    text_ += "SOL 101\nCEND\n";
    for (const std::string& line : deck_.comments) {
      if (line.starts_with("case: ")) {
        text_ += "TITLE = " + io::plain_text(line.substr(6)) + "\n";
      }
    }
    text_ += "ECHO = NONE\n";
    for (std::size_t k = 0; k < deck_.sets.size(); ++k) {
      std::vector<int> nodes = deck_.sets[k].nodes;
      for (int& node : nodes) {
        ++node;
      }
      comment(fmt::format("SET {} is the nodes of surface '{}'", k + 1,
                          deck_.sets[k].name));
      text_ += io::case_set(static_cast<int>(k) + 1, nodes);
    }
    text_ += "DISPLACEMENT = ALL\nSPCFORCES = ALL\nSTRESS(CORNER) = ALL\n";
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      const int k = static_cast<int>(s) + 1;
      text_ += fmt::format("SUBCASE {}\n  SUBTITLE = {}\n  SPC = {}\n", k,
                           io::plain_text(deck_.steps[s].name), k);
      if (!sets_of_load(deck_.steps[s], k).empty()) {
        text_ += fmt::format("  LOAD = {}\n", sum_set(k));
      }
      if (is_heated(deck_)) {
        text_ += fmt::format("  TEMPERATURE(LOAD) = {}\n", heat_set(k));
      }
    }
  }

  void frames() {
    for (const auto& [node, axes] : turned_) {
      std::size_t k = 0;
      while (k < frames_.size() && frames_[k] != axes) {
        ++k;
      }
      if (k == frames_.size()) {
        frames_.push_back(axes);
        io::Fields fields = {number(static_cast<int>(k) + 1), "0"};
        append_vector(Vec3::Zero(), fields);
        append_vector(axes.col(2), fields);
        append_vector(axes.col(0), fields);
        text_ += io::long_card("CORD2R", fields);
      }
      frame_of_[node] = static_cast<int>(k) + 1;
    }
  }

  void grid() {
    for (std::size_t n = 0; n < deck_.nodes.size(); ++n) {
      io::Fields fields = {number(static_cast<int>(n) + 1), ""};
      append_vector(deck_.nodes[n], fields);
      if (const auto at = frame_of_.find(static_cast<int>(n));
          at != frame_of_.end()) {
        fields.push_back(number(at->second));
      }
      text_ += io::long_card("GRID", fields);
    }
  }

  void sections() {
    int material = 0;
    for (std::size_t s = 0; s < deck_.sections.size(); ++s) {
      const DeckShellSection& section = deck_.sections[s];
      const std::string id = number(static_cast<int>(s) + 1);
      even_.push_back(even_thickness(deck_, static_cast<int>(s)));
      comment(fmt::format("shell '{}', of '{}'", section.name,
                          section.plies.front().material.name));
      if (is_plain(section)) {
        const std::string own = number(++material);
        text_ += io::long_card(
            "PSHELL", {id, own, even_[s] ? io::nastran_real(*even_[s]) : "",
                       own, "", own});
        text_ += io::isotropic_card(section.plies.front().material, material);
      } else {
        layers(static_cast<int>(s), material);
      }
    }
  }

  /// PCOMP, a material each ply, and the axes that angles count from.
  void layers(int s, int& material) {
    const DeckShellSection& section = deck_.sections[s];
    if (!even_[s]) {
      throw InvalidInput(fmt::format(
          "shell '{}' is orthotropic or of layers, and its thickness follows "
          "the place; a deck of Nastran has one thickness a ply: give it a "
          "single number",
          section.name));
    }
    const double t = *even_[s];
    io::Fields fields = {number(s + 1),
                         io::nastran_real((section.offset - 0.5) * t)};
    fields.resize(8);
    std::string materials;
    for (const DeckPly& ply : section.plies) {
      fields.insert(
          fields.end(),
          {number(++material), io::nastran_real(ply.share * t),
           io::nastran_real(ply.angle * 180.0 / std::numbers::pi), "YES"});
      materials += io::ply_card(ply.material, material);
    }
    text_ += io::long_card("PCOMP", fields) + materials;
    if (section.direction) {
      const int frame = static_cast<int>(frames_.size()) + 1 + s;
      io::Fields axes = {number(frame), "0"};
      append_vector(Vec3::Zero(), axes);
      append_vector(section.direction->unitOrthogonal(), axes);
      append_vector(section.direction->normalized(), axes);
      text_ += io::long_card("CORD2R", axes);
    }
  }

  /// G1 to G6, THETA or the axes it counts from, ZOFFS, T1 to T3.
  void elements() {
    for (std::size_t f = 0; f < deck_.facets.size(); ++f) {
      const int s = deck_.section[f];
      const DeckShellSection& section = deck_.sections[s];
      io::Fields fields = {number(static_cast<int>(f) + 1), number(s + 1)};
      for (const int node : deck_.facets[f]) {
        fields.push_back(number(node + 1));
      }
      if (!is_plain(section)) {
        if (section.direction) {
          fields.push_back(number(static_cast<int>(frames_.size()) + 1 + s));
        }
        text_ += io::long_card("CTRIA6", fields);
        continue;
      }
      const Vec3 t(deck_.thickness[f].data());
      const double offset = section.offset * t.mean();
      fields.insert(fields.end(),
                    {"", offset != 0.0 ? io::nastran_real(offset) : ""});
      if (!even_[s]) {
        append_vector(t, fields);
      }
      text_ += io::long_card("CTRIA6", fields);
    }
  }

  void rigid_bodies() {
    auto next = static_cast<int>(deck_.facets.size());
    for (const DeckRigidBody& body : deck_.rigid) {
      comment(fmt::format("'{}' moves as a rigid body", body.name));
      io::Fields fields = {number(++next), number(body.point + 1), "123456"};
      for (const int node : body.nodes) {
        fields.push_back(number(node + 1));
      }
      text_ += io::short_card("RBE2", fields);
    }
  }

  void write_step(const DeckShellStep& step, int k) {
    comment(fmt::format("load case '{}'", step.name));
    for (const DeckShellSupport& support : step.supports) {
      std::string components;
      for (std::size_t c = 0; c < support.fixed.size(); ++c) {
        components += support.fixed[c] ? number(static_cast<int>(c) + 1) : "";
      }
      io::Fields fields = {number(k), components};
      for (const int node : support.nodes) {
        if (!enforced(step, support, node, k)) {
          fields.push_back(number(node + 1));
        }
      }
      if (!components.empty() && fields.size() > 2) {
        text_ += io::short_card("SPC1", fields);
      }
    }
    if (is_heated(deck_)) {
      // Every node: a default is one for all subcases to some readers.
      for (std::size_t n = 0; n < deck_.nodes.size(); ++n) {
        text_ += io::long_card(
            "TEMP",
            {number(heat_set(k)), number(static_cast<int>(n) + 1),
             io::nastran_real(step.temperature_at(static_cast<int>(n)))});
      }
    }
    const io::Fields sets = sets_of_load(step, k);
    if (!sets.empty()) {
      io::Fields load = {number(sum_set(k)), "1."};
      for (const std::string& set : sets) {
        load.insert(load.end(), {"1.", set});
      }
      text_ += io::short_card("LOAD", load);
    }
    for (Eigen::Index n = 0; n < step.nodal_forces.size() / 6; ++n) {
      const auto node = static_cast<int>(n);
      nodal(k, node, "FORCE", step.nodal_forces.segment<3>(6 * n));
      nodal(k, node, "MOMENT", step.nodal_forces.segment<3>(6 * n + 3));
    }
    for (const DeckFacetPressure& load : step.pressures) {
      text_ +=
          io::long_card("PLOAD4", {number(node_set(k)), number(load.facet + 1),
                                   io::nastran_real(load.pressure)});
    }
    body_loads(step, k);
  }

  /// A card for each component of a node that is held at other than 0.
  bool enforced(const DeckShellStep& step, const DeckShellSupport& support,
                int node, int k) {
    std::optional<Mat3> frame;
    if (const auto at = turned_.find(node); at != turned_.end()) {
      frame = at->second;
    }
    const std::array<double, 6> values = held_values(step, node, frame);
    bool any = false;
    for (std::size_t c = 0; c < values.size(); ++c) {
      any = any || (support.fixed[c] && values[c] != 0.0);
    }
    for (std::size_t c = 0; any && c < values.size(); ++c) {
      if (support.fixed[c]) {
        text_ += io::long_card("SPC", {number(k), number(node + 1),
                                       number(static_cast<int>(c) + 1),
                                       io::nastran_real(values[c])});
      }
    }
    return any;
  }

  void nodal(int k, int node, const char* card, const Vec3& value) {
    if (!value.isZero(0.0)) {
      io::Fields fields = {number(node_set(k)), number(node + 1), "0", "1."};
      append_vector(value, fields);
      text_ += io::long_card(card, fields);
    }
  }

  void body_loads(const DeckShellStep& step, int k) {
    if (!step.gravity.isZero(0.0)) {
      const double size = step.gravity.norm();
      io::Fields fields = {number(gravity_set(k)), "0", io::nastran_real(size)};
      append_vector(step.gravity / size, fields);
      text_ += io::long_card("GRAV", fields);
    }
    if (step.spin) {
      const int point = next_point_++;
      io::Fields at = {number(point), ""};
      append_vector(step.spin->point, at);
      at.insert(at.end(), {"", "123456"});
      text_ += io::long_card("GRID", at);
      io::Fields fields = {
          number(turning_set(k)), number(point), "0",
          io::nastran_real(step.spin->rate / (2.0 * std::numbers::pi))};
      append_vector(step.spin->axis.normalized(), fields);
      fields.emplace_back("1");
      text_ += io::long_card("RFORCE", fields);
    }
  }

  const ShellDeck& deck_;
  std::map<int, Mat3> turned_;
  std::vector<Mat3> frames_;     // number k + 1
  std::map<int, int> frame_of_;  // of the turned nodes
  std::vector<std::optional<double>> even_;
  int next_point_;
  std::string text_;
};

}  // namespace

std::string nastran_shell_bdf(const ShellDeck& deck) {
  check_shell_deck(deck);
  return ShellBulk(deck).text();
}

void write_nastran_shells(const std::filesystem::path& path,
                          const ShellDeck& deck) {
  write_file(path, nastran_shell_bdf(deck));
}

}  // namespace meniscus::shell_deck
