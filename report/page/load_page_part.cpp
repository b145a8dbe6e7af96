#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "report/page/page_mesh.h"
#include "report/page/vtk_input.h"

namespace meniscus::page {

namespace fs = std::filesystem;

namespace {

constexpr int kTetCorners = 4;
constexpr int kTetNodes = 10;
constexpr int kFacetNodes = 6;  // of shells

const std::vector<double>* find_array(
    const std::map<std::string, std::vector<double>>& arrays, const char* name,
    std::size_t size) {
  const auto at = arrays.find(name);
  return at == arrays.end() || at->second.size() != size ? nullptr
                                                         : &at->second;
}

std::string text_of(const VtkInput& input, const char* name) {
  const auto at = input.texts.find(name);
  return at == input.texts.end() || at->second.empty() ? "" : at->second[0];
}

/// Numbers of nodes in an order that lets places be found.
class NodeFinder {
 public:
  explicit NodeFinder(const Points& points)
      : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
      return less(points_[static_cast<std::size_t>(a)],
                  points_[static_cast<std::size_t>(b)]);
    });
  }

  /// The node at exactly that place, or -1.
  int at(const Vec3& point) const {
    const auto found = std::lower_bound(
        order_.begin(), order_.end(), point, [&](int a, const Vec3& p) {
          return less(points_[static_cast<std::size_t>(a)], p);
        });
    return found != order_.end() &&
                   points_[static_cast<std::size_t>(*found)] == point
               ? *found
               : -1;
  }

 private:
  static bool less(const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(),
                                        b.data() + 3);
  }
  const Points& points_;
  std::vector<int> order_;
};

/// Surface names and labels, and triangles by the file's own points.
void read_triangles(const VtkInput& surface, const fs::path& path,
                    PageMesh& mesh) {
  const std::size_t count = surface.cells.size() / 3;
  const auto* labels = find_array(surface.cell_data, "surface", count);
  const auto names = surface.texts.find("surface_names");
  if (surface.cell_size != 3 || labels == nullptr ||
      names == surface.texts.end()) {
    refuse_file(path, "holds no triangles of named surfaces");
  }
  mesh.names = names->second;
  mesh.load_case = text_of(surface, "load_case");
  for (std::size_t t = 0; t < count; ++t) {
    mesh.triangles.push_back({surface.cells[3 * t], surface.cells[3 * t + 1],
                              surface.cells[3 * t + 2]});
    const int label = static_cast<int>((*labels)[t]);
    if (label < 0 || label >= static_cast<int>(mesh.names.size())) {
      refuse_file(path, fmt::format("has a triangle of surface {}", label));
    }
    mesh.labels.push_back(label);
  }
  mesh.four_a_face = count > 0 && count % 4 == 0;
  for (std::size_t t = 0; t + 3 < count && mesh.four_a_face; t += 4) {
    const Triangle& middle = mesh.triangles[t + 3];
    mesh.four_a_face = mesh.triangles[t][1] == middle[0] &&
                       mesh.triangles[t + 1][2] == middle[1] &&
                       mesh.triangles[t][2] == middle[2];
  }
}

void copy_node_fields(const VtkInput& input, PageMesh& mesh) {
  const std::size_t count = input.points.size();
  if (const auto* u = find_array(input.point_data, "displacement", 3 * count)) {
    mesh.displacement = *u;
  }
  if (const auto* s = find_array(input.point_data, "von_mises", count)) {
    mesh.von_mises = *s;
  }
  const std::string prefix = "von_mises_";
  for (const auto& [name, values] : input.point_data) {
    if (name.starts_with(prefix) && values.size() == count) {
      mesh.case_von_mises.emplace_back(name.substr(prefix.size()), values);
    }
  }
}

/// Adds elements' values to their nodes and divides by how many came.
class NodeMeans {
 public:
  explicit NodeMeans(std::size_t nodes)
      : sums_(nodes, 0.0), counts_(nodes, 0) {}
  void add(int node, double value) {
    sums_[static_cast<std::size_t>(node)] += value;
    ++counts_[static_cast<std::size_t>(node)];
  }
  std::vector<double> take() {
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      sums_[n] = counts_[n] > 0 ? sums_[n] / counts_[n]
                                : std::numeric_limits<double>::quiet_NaN();
    }
    return std::move(sums_);
  }

 private:
  std::vector<double> sums_;
  std::vector<int> counts_;
};

double modulus_of(const element::Material& material) {
  return material.orthotropic ? material.orthotropic->youngs_moduli.maxCoeff()
                              : material.youngs_modulus;
}

double volume_of(const VtkInput& part, const int* ids) {
  const auto corner = [&](int k) {
    return part.points[static_cast<std::size_t>(ids[k])];
  };
  return (corner(1) - corner(0))
             .cross(corner(2) - corner(0))
             .dot(corner(3) - corner(0)) /
         6.0;
}

/// Energy density and stress error at the nodes of part.vtu.
void find_energies(const VtkInput& part,
                   const std::vector<element::Material>& materials,
                   PageMesh& mesh) {
  const auto size = static_cast<std::size_t>(part.cell_size);
  const std::size_t elements = part.cells.size() / size;
  const auto* region = find_array(part.cell_data, "region", elements);
  const auto* error = find_array(part.cell_data, "energy_error", elements);
  const auto* stress =
      find_array(part.point_data, "stress", 6 * part.points.size());
  if (region == nullptr || error == nullptr || stress == nullptr) {
    return;
  }
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  NodeMeans density(part.points.size());
  NodeMeans errors(part.points.size());
  for (std::size_t e = 0; e < elements; ++e) {
    const auto r = static_cast<std::size_t>((*region)[e]);
    if ((*region)[e] < 0.0 || r >= materials.size()) {
      return;  // of another case
    }
    const int* ids = part.cells.data() + e * size;
    const double volume = volume_of(part, ids);
    const double wrong =
        volume > 0.0
            ? (*error)[e] * std::sqrt(modulus_of(materials[r]) / volume)
            : 0.0;
    for (std::size_t k = 0; k < size; ++k) {
      element::Stress s;
      std::copy_n(stress->begin() + 6 * static_cast<std::ptrdiff_t>(ids[k]), 6,
                  s.begin());
      density.add(ids[k], 0.5 * element::complementary_product(s, s, laws[r]));
      errors.add(ids[k], wrong);
    }
  }
  mesh.energy_density = density.take();
  mesh.stress_error = errors.take();
}

/// A part without inside, or whose inside is not there.
void add_surface(const VtkInput& surface, PageMesh& mesh) {
  mesh.nodes = surface.points;
  copy_node_fields(surface, mesh);
}

/// The surface's triangles, elements and fields by part.vtu's nodes.
void add_inside(const VtkInput& surface, const fs::path& path,
                const std::vector<element::Material>& materials,
                PageMesh& mesh) {
  const VtkInput part = read_vtk(path, {"point_stress"});
  if (part.cell_size == kFacetNodes) {
    add_surface(surface, mesh);
    return;
  }
  if (part.cell_size != kTetCorners && part.cell_size != kTetNodes) {
    refuse_file(path, "holds no tetrahedra");
  }
  const NodeFinder finder(part.points);
  std::vector<int> node_of(surface.points.size());
  for (std::size_t i = 0; i < node_of.size(); ++i) {
    node_of[i] = finder.at(surface.points[i]);
    if (node_of[i] < 0) {
      refuse_file(path, "is of another part than the surface beside it");
    }
  }
  for (Triangle& triangle : mesh.triangles) {
    for (int& id : triangle) {
      id = node_of[static_cast<std::size_t>(id)];
    }
  }
  const auto size = static_cast<std::size_t>(part.cell_size);
  for (std::size_t c = 0; c < part.cells.size(); c += size) {
    mesh.tets.push_back({part.cells[c], part.cells[c + 1], part.cells[c + 2],
                         part.cells[c + 3]});
  }
  mesh.nodes = part.points;
  copy_node_fields(part, mesh);
  if (!materials.empty()) {
    find_energies(part, materials, mesh);
  }
  keep_used_nodes(mesh);
}

}  // namespace

PageMesh load_page_part(const fs::path& surface_path, const fs::path& part_path,
                        const std::vector<element::Material>& materials) {
  const VtkInput surface = read_vtk(surface_path);
  PageMesh mesh;
  read_triangles(surface, surface_path, mesh);
  std::error_code ignored;
  if (fs::is_regular_file(part_path, ignored)) {
    add_inside(surface, part_path, materials, mesh);
  } else {
    add_surface(surface, mesh);
  }
  return mesh;
}

}  // namespace meniscus::page
