#include "io/calculix_inp.h"

#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/calculix_material.h"
#include "io/calculix_names.h"
#include "io/calculix_pins.h"
#include "io/calculix_springs.h"
#include "io/file_notes.h"

namespace meniscus::io {

namespace {

class DeckWriter {
 public:
  DeckWriter(const TetMesh& mesh, const CalculixDeck& deck)
      : mesh_(mesh), deck_(deck), names_(deck_names(mesh.labels)) {
    std::vector<std::string> materials;
    for (const DeckMaterial& material : deck.materials) {
      materials.push_back(material.name);
    }
    material_names_ = deck_names(materials);
  }

  std::string text() {
    check_deck(mesh_, deck_);
    head();
    nodes();
    elements();
    surfaces();
    supported_sets();
    all_elements();
    materials();
    equations();
    add(springs_text(mesh_, deck_.springs));
    add(pins_text(mesh_, deck_));
    if (heated()) {  // steps give changes
      fmt::format_to(out(),
                     "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n");
    }
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      step(deck_.steps[s], s);
    }
    return fmt::to_string(buffer_);
  }

 private:
  Out out() { return std::back_inserter(buffer_); }
  void add(const std::string& text) {
    buffer_.append(text.data(), text.data() + text.size());
  }

  void head() {
    for (const std::string& comment : deck_.comments) {
      fmt::format_to(out(), "** {}\n", one_line(comment));
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      fmt::format_to(out(), "** surface '{}' is NSET {}\n",
                     one_line(mesh_.labels[i]), names_[i]);
    }
    for (std::size_t i = 0; i < material_names_.size(); ++i) {
      fmt::format_to(out(), "** region {} is of '{}', MATERIAL {}\n", i,
                     one_line(deck_.materials[i].name), material_names_[i]);
    }
  }

  void nodes() {
    // CalculiX reads 20 characters of a number: not more digits than these.
    fmt::format_to(out(), "*NODE, NSET=NALL\n");
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
      const Vec3& x = mesh_.nodes[i];
      fmt::format_to(out(), "{}, {:.12e}, {:.12e}, {:.12e}\n", i + 1, x.x(),
                     x.y(), x.z());
    }
  }

  void elements() {
    const char* type = mesh_.order == 1 ? "C3D4" : "C3D10";
    for (std::size_t r = 0; r < deck_.materials.size(); ++r) {
      fmt::format_to(out(), "*ELEMENT, TYPE={}, ELSET=REGION_{}\n", type, r);
      for (int e = 0; e < mesh_.element_count(); ++e) {
        if (mesh_.element_region[static_cast<std::size_t>(e)] !=
            static_cast<int>(r)) {
          continue;
        }
        fmt::format_to(out(), "{}", e + 1);
        for (const int node : mesh_.element(e)) {
          fmt::format_to(out(), ", {}", node + 1);
        }
        fmt::format_to(out(), "\n");
      }
    }
  }

  void surfaces() {
    for (std::size_t s = 0; s < names_.size(); ++s) {
      const std::vector<int> ids =
          deck_surface_nodes(mesh_, static_cast<int>(s));
      if (!ids.empty()) {
        fmt::format_to(out(), "*NSET, NSET={}\n", names_[s]);
        write_ids(out(), ids);
      }
    }
  }

  void materials() {
    for (std::size_t r = 0; r < deck_.materials.size(); ++r) {
      add(material_text(deck_.materials[r], material_names_[r], r));
    }
  }

  bool heated() const {
    return std::any_of(
        deck_.steps.begin(), deck_.steps.end(),
        [](const DeckStep& s) { return s.temperature_change.size() != 0; });
  }

  void all_elements() {
    fmt::format_to(out(), "*ELSET, ELSET=EALL\n");
    for (std::size_t r = 0; r < deck_.materials.size(); ++r) {
      fmt::format_to(out(), "REGION_{}\n", r);
    }
  }

  void equations() {
    for (const DeckEquation& equation : deck_.equations) {
      const Vec3& c = equation.coefficients;
      const int terms = static_cast<int>((c.array() != 0.0).count());
      fmt::format_to(out(), "*EQUATION\n{}\n", terms);
      const char* separator = "";
      for (int k = 0; k < 3; ++k) {
        const int dof = (equation.dependent + k) % 3;
        if (c[dof] != 0.0) {
          fmt::format_to(out(), "{}{}, {}, {:.12e}", separator,
                         equation.node + 1, dof + 1, c[dof]);
          separator = ", ";
        }
      }
      fmt::format_to(out(), "\n");
    }
  }

  /// Sets belong to the model: CalculiX takes none after the first step.
  void supported_sets() {
    for (std::size_t s = 0; s < deck_.steps.size(); ++s) {
      std::set<int> nodes;
      for (const DeckSupport& support : deck_.steps[s].supports) {
        const std::vector<int> ids =
            supported_nodes(mesh_, support, deck_.steps[s]);
        nodes.insert(ids.begin(), ids.end());
      }
      fmt::format_to(out(), "*NSET, NSET={}\n", supported_name(s));
      write_ids(out(), {nodes.begin(), nodes.end()});
    }
  }

  void boundary(const DeckStep& step) {
    fmt::format_to(out(), "*BOUNDARY, OP=NEW\n");
    for (const DeckSupport& support : step.supports) {
      std::vector<std::string> targets;
      if (support.surface.empty()) {
        for (const int node : support.nodes) {
          targets.push_back(std::to_string(node + 1));
        }
      } else {
        const int id = surface_of_step(mesh_, support.surface, step);
        targets.push_back(names_[static_cast<std::size_t>(id)]);
      }
      const std::array<bool, 3> fixed = {support.fix_x, support.fix_y,
                                         support.fix_z};
      for (const std::string& target : targets) {
        for (std::size_t c = 0; c < 3; ++c) {
          if (fixed[c]) {
            const double at =
                support.displacement[static_cast<Eigen::Index>(c)];
            fmt::format_to(out(), "{}, {}, {}{}\n", target, c + 1, c + 1,
                           at != 0.0 ? fmt::format(", {:.12e}", at) : "");
          }
        }
      }
    }
  }

  void forces(const DeckStep& step) {
    // Both cards in every step: without them the last step's loads stay.
    fmt::format_to(out(), "*CLOAD, OP=NEW\n");
    if (step.nodal_forces.size() != 0) {
      for (Eigen::Index i = 0; i < step.nodal_forces.size(); ++i) {
        if (step.nodal_forces[i] != 0.0) {
          fmt::format_to(out(), "{}, {}, {:.12e}\n", i / 3 + 1, i % 3 + 1,
                         step.nodal_forces[i]);
        }
      }
    }
    fmt::format_to(out(), "*DLOAD, OP=NEW\n");
    body_loads(step);
    for (const DeckPressure& load : step.pressures) {
      const int id = surface_of_step(mesh_, load.surface, step);
      for (int f = 0; f < mesh_.face_count(); ++f) {
        if (mesh_.face_label[static_cast<std::size_t>(f)] == id) {
          fmt::format_to(out(), "{}, P{}, {:.12e}\n",
                         mesh_.face_element[static_cast<std::size_t>(f)] + 1,
                         calculix_face(corner_off_face(mesh_, f)),
                         load.pressure);
        }
      }
    }
  }

  void body_loads(const DeckStep& step) {
    if (!step.gravity.isZero(0.0)) {
      const double size = step.gravity.norm();
      const Vec3 d = step.gravity / size;
      fmt::format_to(out(), "EALL, GRAV, {:.12e}, {:.12e}, {:.12e}, {:.12e}\n",
                     size, d.x(), d.y(), d.z());
    }
    if (step.spin) {
      const Vec3& p = step.spin->point;
      const Vec3 a = step.spin->axis.normalized();
      fmt::format_to(
          out(),
          "EALL, CENTRIF, {:.12e}, {:.12e}, {:.12e}, {:.12e}, {:.12e}, "
          "{:.12e}, {:.12e}\n",
          step.spin->rate * step.spin->rate, p.x(), p.y(), p.z(), a.x(), a.y(),
          a.z());
    }
  }

  void temperatures(const DeckStep& step) {
    if (!heated()) {
      return;
    }
    fmt::format_to(out(), "*TEMPERATURE, OP=NEW\n");
    if (step.temperature_change.size() == 0) {
      fmt::format_to(out(), "NALL, 0.\n");
    }
    for (Eigen::Index i = 0; i < step.temperature_change.size(); ++i) {
      fmt::format_to(out(), "{}, {:.12e}\n", i + 1, step.temperature_change[i]);
    }
  }

  void step(const DeckStep& step, std::size_t number) {
    fmt::format_to(out(), "** load case '{}'\n*STEP\n*STATIC, SOLVER={}\n",
                   one_line(step.name), deck_.solver);
    boundary(step);
    add(springs_boundary_text(deck_.springs, number));
    add(pins_boundary_text(mesh_, deck_, step));
    forces(step);
    temperatures(step);
    if (deck_.output == DeckOutput::Viewer ||
        deck_.output == DeckOutput::Both) {
      fmt::format_to(out(), "*NODE FILE\nU, RF\n*EL FILE\nS\n");
    }
    if (deck_.output == DeckOutput::Print || deck_.output == DeckOutput::Both) {
      fmt::format_to(out(),
                     "*NODE PRINT, NSET=NALL\nU\n"
                     "*NODE PRINT, NSET={}, TOTALS=ONLY\nRF\n"
                     "*EL PRINT, ELSET=EALL, GLOBAL=YES\nS\n",
                     supported_name(number));
    }
    fmt::format_to(out(), "*END STEP\n");
  }

  static std::string supported_name(std::size_t step) {
    return fmt::format("SUPPORTED_{}", step + 1);
  }

  const TetMesh& mesh_;
  const CalculixDeck& deck_;
  std::vector<std::string> names_, material_names_;
  fmt::memory_buffer buffer_;
};

}  // namespace

int calculix_face(int opposite_corner) {
  constexpr std::array<int, 4> kFace = {3, 4, 2, 1};
  return kFace.at(static_cast<std::size_t>(opposite_corner));
}

std::string calculix_deck(const TetMesh& mesh, const CalculixDeck& deck) {
  return DeckWriter(mesh, deck).text();
}

void write_calculix_inp(const std::filesystem::path& path, const TetMesh& mesh,
                        const CalculixDeck& deck) {
  write_file(path, calculix_deck(mesh, deck));
}

}  // namespace meniscus::io
