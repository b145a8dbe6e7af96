#include "io/gmsh_msh.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <tuple>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/body_surfaces.h"

namespace meniscus::io {

namespace {

constexpr int kSurface = 2;
constexpr int kVolume = 3;
// Gmsh's element types by order 1 and 2.
constexpr std::array<int, 2> kTriangle = {2, 9};
constexpr std::array<int, 2> kTetrahedron = {4, 11};
/// Gmsh has mid-sides (23) and (13) the other way round.
constexpr std::array<int, 10> kOrder = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

/// Faces of one label between the same two regions.
struct SurfaceEntity {
  int label = 0;
  int behind = 0;
  int front = -1;
  std::vector<int> faces;
  std::vector<int> nodes;  // that lie on no entity before this one
};

struct VolumeEntity {
  std::vector<int> elements;
  std::vector<int> nodes;
};

class MshWriter {
 public:
  MshWriter(const TetMesh& mesh, const MshOptions& options)
      : mesh_(mesh), options_(options) {}

  std::string text() {
    collect();
    give_nodes();
    head();
    names();
    entities();
    nodes();
    elements();
    for (const MshField& field : options_.fields) {
      values(field);
    }
    return fmt::to_string(buffer_);
  }

 private:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(buffer_), format,
                   std::forward<Arguments>(arguments)...);
  }

  int region(int element) const {
    return element < 0
               ? -1
               : mesh_.element_region[static_cast<std::size_t>(element)];
  }

  void collect() {
    std::map<std::tuple<int, int, int>, std::vector<int>> faces;
    for (int f = 0; f < mesh_.face_count(); ++f) {
      const auto at = static_cast<std::size_t>(f);
      const int behind =
          mesh_.face_element.empty() ? -1 : region(mesh_.face_element[at]);
      const int front =
          mesh_.face_front.empty() ? -1 : region(mesh_.face_front[at]);
      faces[{mesh_.face_label[at], behind, front}].push_back(f);
    }
    for (auto& [key, list] : faces) {
      const auto [label, behind, front] = key;
      surfaces_.push_back({label, behind, front, std::move(list), {}});
    }
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const auto r = static_cast<std::size_t>(region(e));
      if (r >= volumes_.size()) {
        volumes_.resize(r + 1);
      }
      volumes_[r].elements.push_back(e);
    }
  }

  /// A node belongs to the first entity that it is on, surfaces first.
  void give_nodes() {
    std::vector<char> given(mesh_.nodes.size(), 0);
    const auto give = [&](std::span<const int> of, std::vector<int>& to) {
      for (const int node : of) {
        char& flag = given[static_cast<std::size_t>(node)];
        if (flag == 0) {
          flag = 1;
          to.push_back(node);
        }
      }
    };
    for (SurfaceEntity& surface : surfaces_) {
      for (const int f : surface.faces) {
        give(mesh_.face(f), surface.nodes);
      }
    }
    for (VolumeEntity& volume : volumes_) {
      for (const int e : volume.elements) {
        give(mesh_.element(e), volume.nodes);
      }
    }
  }

  void head() {
    add("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n");
    for (const std::string& line : comment_lines(options_.notes)) {
      add("{}\n", line);
    }
    add("$EndComments\n");
  }

  static std::string quoted(std::string name) {
    std::replace(name.begin(), name.end(), '"', '\'');
    return one_line(std::move(name));
  }

  void names() {
    std::vector<char> used(mesh_.labels.size(), 0);
    for (const SurfaceEntity& surface : surfaces_) {
      used[static_cast<std::size_t>(surface.label)] = 1;
    }
    add("$PhysicalNames\n{}\n",
        std::count(used.begin(), used.end(), 1) +
            static_cast<std::ptrdiff_t>(volumes_.size()));
    for (std::size_t k = 0; k < used.size(); ++k) {
      if (used[k] != 0) {
        add("{} {} \"{}\"\n", kSurface, k + 1, quoted(mesh_.labels[k]));
      }
    }
    for (std::size_t r = 0; r < volumes_.size(); ++r) {
      add("{} {} \"{}\"\n", kVolume, r + 1,
          quoted(body_name(options_.regions, r)));
    }
    add("$EndPhysicalNames\n");
  }

  template <class Cells>
  void box(const std::vector<int>& cells, const Cells& nodes_of) {
    Eigen::AlignedBox3d box;
    for (const int cell : cells) {
      for (const int node : nodes_of(cell)) {
        box.extend(mesh_.nodes[static_cast<std::size_t>(node)]);
      }
    }
    add("{} {} {} {} {} {}", box.min().x(), box.min().y(), box.min().z(),
        box.max().x(), box.max().y(), box.max().z());
  }

  void entities() {
    add("$Entities\n0 0 {} {}\n", surfaces_.size(), volumes_.size());
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      add("{} ", s + 1);
      box(surfaces_[s].faces, [&](int f) { return mesh_.face(f); });
      add(" 1 {} 0\n", surfaces_[s].label + 1);
    }
    for (std::size_t r = 0; r < volumes_.size(); ++r) {
      add("{} ", r + 1);
      box(volumes_[r].elements, [&](int e) { return mesh_.element(e); });
      std::vector<std::string> bounds;
      for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        if (surfaces_[s].behind == static_cast<int>(r)) {
          bounds.push_back(std::to_string(s + 1));
        } else if (surfaces_[s].front == static_cast<int>(r)) {
          bounds.push_back(fmt::format("-{}", s + 1));
        }
      }
      add(" 1 {} {}{}{}\n", r + 1, bounds.size(), bounds.empty() ? "" : " ",
          fmt::join(bounds, " "));
    }
    add("$EndEntities\n");
  }

  void node_block(int dimension, std::size_t tag,
                  const std::vector<int>& nodes) {
    add("{} {} 0 {}\n", dimension, tag, nodes.size());
    for (const int node : nodes) {
      add("{}\n", node + 1);
    }
    for (const int node : nodes) {
      const Vec3& x = mesh_.nodes[static_cast<std::size_t>(node)];
      add("{} {} {}\n", x.x(), x.y(), x.z());
    }
  }

  void nodes() {
    const std::size_t count = mesh_.nodes.size();
    add("$Nodes\n{} {} 1 {}\n", surfaces_.size() + volumes_.size(), count,
        count);
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      node_block(kSurface, s + 1, surfaces_[s].nodes);
    }
    for (std::size_t r = 0; r < volumes_.size(); ++r) {
      node_block(kVolume, r + 1, volumes_[r].nodes);
    }
    add("$EndNodes\n");
  }

  void elements() {
    const int count = mesh_.element_count() + mesh_.face_count();
    const auto order = static_cast<std::size_t>(mesh_.order - 1);
    add("$Elements\n{} {} 1 {}\n", surfaces_.size() + volumes_.size(), count,
        count);
    for (std::size_t r = 0; r < volumes_.size(); ++r) {
      add("{} {} {} {}\n", kVolume, r + 1, kTetrahedron.at(order),
          volumes_[r].elements.size());
      for (const int e : volumes_[r].elements) {
        const auto element = mesh_.element(e);
        add("{}", e + 1);
        for (std::size_t k = 0; k < element.size(); ++k) {
          add(" {}", element[static_cast<std::size_t>(kOrder.at(k))] + 1);
        }
        add("\n");
      }
    }
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      add("{} {} {} {}\n", kSurface, s + 1, kTriangle.at(order),
          surfaces_[s].faces.size());
      for (const int f : surfaces_[s].faces) {
        add("{}", mesh_.element_count() + f + 1);
        for (const int node : mesh_.face(f)) {
          add(" {}", node + 1);
        }
        add("\n");
      }
    }
    add("$EndElements\n");
  }

  void values(const MshField& field) {
    const auto size = static_cast<std::size_t>(field.components);
    if ((size != 1 && size != 3) ||
        field.values.size() != size * mesh_.nodes.size()) {
      throw InvalidInput(fmt::format(
          "field '{}' has {} values of {} components for {} nodes", field.name,
          field.values.size(), size, mesh_.nodes.size()));
    }
    add("$NodeData\n1\n\"{}\"\n1\n0\n3\n0\n{}\n{}\n", quoted(field.name), size,
        mesh_.nodes.size());
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      add("{}", n + 1);
      for (std::size_t k = 0; k < size; ++k) {
        add(" {}", field.values[n * size + k]);
      }
      add("\n");
    }
    add("$EndNodeData\n");
  }

  const TetMesh& mesh_;
  const MshOptions& options_;
  std::vector<SurfaceEntity> surfaces_;
  std::vector<VolumeEntity> volumes_;
  fmt::memory_buffer buffer_;
};

}  // namespace

void write_msh(const std::filesystem::path& path, const TetMesh& mesh,
               const MshOptions& options) {
  write_file(path, MshWriter(mesh, options).text());
}

}  // namespace meniscus::io
