#include "io/nastran_bdf.h"

#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/nastran_fields.h"
#include "io/nastran_material.h"

namespace meniscus::io {

namespace {

constexpr int kMostIds = 99'999'999;  // of 8 characters
constexpr int kEquations = 1;         // MPC set

/// Set numbers of subcase k, counted from 1.
constexpr int load_set(int k) { return 10 * k; }
constexpr int force_set(int k) { return 10 * k + 1; }
constexpr int weight_set(int k) { return 10 * k + 2; }
constexpr int spin_set(int k) { return 10 * k + 3; }
constexpr int heat_set(int k) { return 10 * k + 4; }

std::string id(int number) { return std::to_string(number); }

/// Of a step: what its LOAD card puts together.
Fields parts_of_load(const DeckStep& step, int k) {
  Fields sets;
  if (!step.pressures.empty() ||
      (step.nodal_forces.size() != 0 && !step.nodal_forces.isZero(0.0))) {
    sets.push_back(id(force_set(k)));
  }
  if (!step.gravity.isZero(0.0)) {
    sets.push_back(id(weight_set(k)));
  }
  if (step.spin) {
    sets.push_back(id(spin_set(k)));
  }
  return sets;
}

class BulkWriter {
 public:
  BulkWriter(const TetMesh& mesh, const AnalysisDeck& deck)
      : mesh_(mesh),
        deck_(deck),
        next_point_(static_cast<int>(mesh.nodes.size()) + 1),
        next_element_(mesh.element_count() + 1) {}

  std::string text() {
    check_deck(mesh_, deck_);
    if (mesh_.nodes.size() > kMostIds || mesh_.element_count() > kMostIds) {
      throw InvalidInput(fmt::format(
          "Nastran numbers at most {} nodes and elements", kMostIds));
    }
    case_control();
    text_ += "BEGIN BULK\nPARAM   POST    -1\n";
    text_ += short_card("GRDSET", {"", "", "", "", "", "", "456"});
    grid();
    elements();
    for (std::size_t r = 0; r < deck_.materials.size(); ++r) {
      text_ += nastran_material(deck_.materials[r], static_cast<int>(r) + 1);
    }
    equations();
    springs();
    pins();
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      step(deck_.steps[s], static_cast<int>(s) + 1);
    }
    text_ += "ENDDATA\n";
    return std::move(text_);
  }

 private:
  bool heated() const {
    return std::any_of(
        deck_.steps.begin(), deck_.steps.end(),
        [](const DeckStep& s) { return s.temperature_change.size() != 0; });
  }

  void comment(const std::string& line) {
    text_ += "$ " + plain_text(line) + "\n";
  }

  void case_control() {
    for (const std::string& line : deck_.comments) {
      comment(line);
    }
    text_ += "SOL 101\nCEND\n";
    for (const std::string& line : deck_.comments) {
      if (line.starts_with("case: ")) {
        text_ += "TITLE = " + plain_text(line.substr(6)) + "\n";
      }
    }
    text_ += "ECHO = NONE\n";
    for (std::size_t k = 0; k < mesh_.labels.size(); ++k) {
      std::vector<int> nodes = deck_surface_nodes(mesh_, static_cast<int>(k));
      if (!nodes.empty()) {
        for (int& node : nodes) {
          ++node;
        }
        comment(fmt::format("SET {} is the nodes of surface '{}'", k + 1,
                            mesh_.labels[k]));
        text_ += case_set(static_cast<int>(k) + 1, nodes);
      }
    }
    text_ += "DISPLACEMENT = ALL\nSPCFORCES = ALL\nSTRESS(CORNER) = ALL\n";
    if (!deck_.equations.empty() || !deck_.springs.empty()) {
      text_ += fmt::format("MPC = {}\n", kEquations);
    }
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      subcase(deck_.steps[s], static_cast<int>(s) + 1);
    }
  }

  void subcase(const DeckStep& step, int k) {
    text_ += fmt::format("SUBCASE {}\n  SUBTITLE = {}\n  SPC = {}\n", k,
                         plain_text(step.name), k);
    if (!parts_of_load(step, k).empty()) {
      text_ += fmt::format("  LOAD = {}\n", load_set(k));
    }
    if (heated()) {
      text_ += fmt::format("  TEMPERATURE(LOAD) = {}\n", heat_set(k));
    }
  }

  void grid_point(int number, const Vec3& x, const std::string& held) {
    Fields fields = {id(number), ""};
    for (int i = 0; i < 3; ++i) {
      fields.push_back(nastran_real(x[i]));
    }
    fields.insert(fields.end(), {"", held});
    text_ += long_card("GRID", fields);
  }

  void grid() {
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      grid_point(static_cast<int>(n) + 1, mesh_.nodes[n], "");
    }
  }

  void elements() {
    for (int e = 0; e < mesh_.element_count(); ++e) {
      Fields fields = {
          id(e + 1), id(mesh_.element_region[static_cast<std::size_t>(e)] + 1)};
      for (const int node : mesh_.element(e)) {
        fields.push_back(id(node + 1));
      }
      text_ += short_card("CTETRA", fields);
    }
  }

  struct Term {
    int point = 0;      // number in the file
    int component = 0;  // 1 to 3; 0 of scalar points
    double factor = 0.0;
  };

  /// The first term is the dependent one.
  void equation(const std::vector<Term>& terms) {
    Fields fields = {id(kEquations)};
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (k > 0 && k % 2 == 0) {
        fields.insert(fields.end(), {"", ""});  // between pairs of lines
      }
      fields.insert(fields.end(), {id(terms[k].point), id(terms[k].component),
                                   nastran_real(terms[k].factor)});
    }
    text_ += long_card("MPC", fields);
  }

  void equations() {
    for (const DeckEquation& e : deck_.equations) {
      std::vector<Term> terms;
      for (int k = 0; k < 3; ++k) {
        const int component = (e.dependent + k) % 3;
        if (e.coefficients[component] != 0.0) {
          terms.push_back(
              {e.node + 1, component + 1, e.coefficients[component]});
        }
      }
      equation(terms);
    }
  }

  /// What a spring feels, d = g + sum c . u, with its ground g; both scalar
  /// points, the spring holds d.
  void springs() {
    for (const DeckSprings& set : deck_.springs) {
      std::vector<int>& grounds = grounds_.emplace_back();
      for (const DeckSprings::Spring& spring : set.springs) {
        const int felt = next_point_++;
        const int ground = next_point_++;
        grounds.push_back(ground);
        text_ += short_card("SPOINT", {id(felt), id(ground)});
        text_ += long_card("CELAS2", {id(next_element_++),
                                      nastran_real(set.stiffness), id(felt)});
        std::vector<Term> terms = {{felt, 0, -1.0}, {ground, 0, 1.0}};
        for (std::size_t a = 0; a < spring.nodes.size(); ++a) {
          for (int k = 0; k < 3; ++k) {
            if (const double c = spring.coefficients[a][k]; c != 0.0) {
              terms.push_back({spring.nodes[a] + 1, k + 1, c});
            }
          }
        }
        equation(terms);
      }
    }
  }

  /// A grid point whose six components move along the pin's axes, and the
  /// nodes that follow it.
  void pins() {
    for (const DeckPin& pin : deck_.pins) {
      const int point = next_point_++;
      pins_.push_back(point);
      const int system = static_cast<int>(pins_.size());
      Fields frame = {id(system), "0"};
      const std::array<Vec3, 3> corners = {
          pin.point, pin.point + pin.axes.col(2), pin.point + pin.axes.col(0)};
      for (const Vec3& x : corners) {
        for (int i = 0; i < 3; ++i) {
          frame.push_back(nastran_real(x[i]));
        }
      }
      text_ += long_card("CORD2R", frame);
      Fields fields = {id(point), "0"};
      for (int i = 0; i < 3; ++i) {
        fields.push_back(nastran_real(pin.point[i]));
      }
      fields.insert(fields.end(), {id(system), "0"});  // 0: GRDSET is not meant
      text_ += long_card("GRID", fields);
      Fields body = {id(next_element_++), id(point), "123"};
      for (const int node : pin.nodes) {
        body.push_back(id(node + 1));
      }
      text_ += short_card("RBE2", body);
    }
  }

  void step(const DeckStep& step, int k) {
    comment(fmt::format("load case '{}'", step.name));
    supports(step, k);
    const Fields sets = parts_of_load(step, k);
    if (!sets.empty()) {
      Fields load = {id(load_set(k)), "1."};
      for (const std::string& set : sets) {
        load.insert(load.end(), {"1.", set});
      }
      text_ += short_card("LOAD", load);
    }
    forces(step, k);
    body_loads(step, k);
    if (heated()) {
      text_ += short_card("TEMPD", {id(heat_set(k)), "0."});
    }
    for (Eigen::Index n = 0; n < step.temperature_change.size(); ++n) {
      text_ += long_card("TEMP", {id(heat_set(k)), id(static_cast<int>(n) + 1),
                                  nastran_real(step.temperature_change[n])});
    }
  }

  void supports(const DeckStep& step, int k) {
    for (const DeckSupport& support : step.supports) {
      const Vec3& at = support.displacement;
      const std::string components =
          std::string(support.fix_x && at.x() == 0.0 ? "1" : "") +
          (support.fix_y && at.y() == 0.0 ? "2" : "") +
          (support.fix_z && at.z() == 0.0 ? "3" : "");
      Fields fields = {id(k), components};
      for (const int node : supported_nodes(mesh_, support, step)) {
        fields.push_back(id(node + 1));
      }
      if (!components.empty()) {
        text_ += short_card("SPC1", fields);
      }
      moved(support, step, k);
    }
    for (std::size_t p = 0; p < step.pins.size(); ++p) {
      for (std::size_t m = 0; m < 6; ++m) {
        if (step.pins[p].fixed[m]) {
          text_ += long_card("SPC",
                             {id(k), id(pins_[p]), id(static_cast<int>(m) + 1),
                              nastran_real(step.pins[p].value[m])});
        }
      }
    }
    // A ground that is not held follows, and its spring pulls with nothing.
    for (std::size_t s = 0; s < deck_.springs.size(); ++s) {
      if (acts_in(deck_.springs[s], static_cast<std::size_t>(k - 1))) {
        Fields fields = {id(k), "0"};
        for (const int ground : grounds_[s]) {
          fields.push_back(id(ground));
        }
        text_ += short_card("SPC1", fields);
      }
    }
  }

  /// Components that are held elsewhere than at 0.
  void moved(const DeckSupport& support, const DeckStep& step, int k) {
    const std::array<bool, 3> fix = {support.fix_x, support.fix_y,
                                     support.fix_z};
    for (int c = 0; c < 3; ++c) {
      if (!fix[static_cast<std::size_t>(c)] || support.displacement[c] == 0.0) {
        continue;
      }
      for (const int node : supported_nodes(mesh_, support, step)) {
        text_ += long_card("SPC", {id(k), id(node + 1), id(c + 1),
                                   nastran_real(support.displacement[c])});
      }
    }
  }

  void forces(const DeckStep& step, int k) {
    const std::string set = id(force_set(k));
    for (Eigen::Index n = 0; n < step.nodal_forces.size() / 3; ++n) {
      const Vec3 f = step.nodal_forces.segment<3>(3 * n);
      if (!f.isZero(0.0)) {
        text_ += long_card("FORCE", {set, id(static_cast<int>(n) + 1), "0",
                                     "1.", nastran_real(f.x()),
                                     nastran_real(f.y()), nastran_real(f.z())});
      }
    }
    for (const DeckPressure& load : step.pressures) {
      const int label = surface_of_step(mesh_, load.surface, step);
      for (int f = 0; f < mesh_.face_count(); ++f) {
        if (mesh_.face_label[static_cast<std::size_t>(f)] != label) {
          continue;
        }
        // The face of a CTETRA is told by a corner on it and the one off it.
        const int e = mesh_.face_element[static_cast<std::size_t>(f)];
        const int off = mesh_.element(
            e)[static_cast<std::size_t>(corner_off_face(mesh_, f))];
        text_ += long_card(
            "PLOAD4", {set, id(e + 1), nastran_real(load.pressure), "", "", "",
                       id(mesh_.face(f)[0] + 1), id(off + 1)});
      }
    }
  }

  void body_loads(const DeckStep& step, int k) {
    if (!step.gravity.isZero(0.0)) {
      const double size = step.gravity.norm();
      const Vec3 d = step.gravity / size;
      text_ += long_card("GRAV", {id(weight_set(k)), "0", nastran_real(size),
                                  nastran_real(d.x()), nastran_real(d.y()),
                                  nastran_real(d.z())});
    }
    if (step.spin) {
      const int point = next_point_++;
      grid_point(point, step.spin->point, "123456");
      const Vec3 a = step.spin->axis.normalized();
      const double turns = step.spin->rate / (2.0 * std::numbers::pi);
      text_ +=
          long_card("RFORCE", {id(spin_set(k)), id(point), "0",
                               nastran_real(turns), nastran_real(a.x()),
                               nastran_real(a.y()), nastran_real(a.z()), "1"});
    }
  }

  const TetMesh& mesh_;
  const AnalysisDeck& deck_;
  int next_point_;
  int next_element_;
  std::vector<std::vector<int>> grounds_;  // of each set of springs
  std::vector<int> pins_;                  // their grid points
  std::string text_;
};

}  // namespace

std::string nastran_bdf(const TetMesh& mesh, const AnalysisDeck& deck) {
  return BulkWriter(mesh, deck).text();
}

void write_nastran_bdf(const std::filesystem::path& path, const TetMesh& mesh,
                       const AnalysisDeck& deck) {
  write_file(path, nastran_bdf(mesh, deck));
}

}  // namespace meniscus::io
