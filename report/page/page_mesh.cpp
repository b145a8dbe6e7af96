#include "report/page/page_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "report/page/packed_array.h"

namespace meniscus::page {

namespace {

/// Values of the kept items, in their order.
std::vector<double> chosen(const std::vector<double>& values,
                           const std::vector<int>& kept, int components) {
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> result;
  if (values.empty()) {
    return result;
  }
  result.reserve(kept.size() * width);
  for (const int id : kept) {
    const std::size_t from = static_cast<std::size_t>(id) * width;
    for (std::size_t c = 0; c < width; ++c) {
      result.push_back(values[from + c]);
    }
  }
  return result;
}

/// The mesh with the kept nodes only, numbered in that order.
void keep_nodes(PageMesh& mesh, const std::vector<int>& kept) {
  std::vector<int> id_of(mesh.nodes.size(), -1);
  Points nodes;
  nodes.reserve(kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    id_of[static_cast<std::size_t>(kept[k])] = static_cast<int>(k);
    nodes.push_back(mesh.nodes[static_cast<std::size_t>(kept[k])]);
  }
  mesh.nodes = std::move(nodes);
  const auto renumber = [&](auto& cells) {
    for (auto& cell : cells) {
      for (int& id : cell) {
        id = id_of[static_cast<std::size_t>(id)];
      }
    }
  };
  renumber(mesh.triangles);
  renumber(mesh.tets);
  mesh.displacement = chosen(mesh.displacement, kept, 3);
  mesh.von_mises = chosen(mesh.von_mises, kept, 1);
  mesh.energy_density = chosen(mesh.energy_density, kept, 1);
  mesh.stress_error = chosen(mesh.stress_error, kept, 1);
  for (auto& [name, values] : mesh.case_von_mises) {
    values = chosen(values, kept, 1);
  }
}

/// Nodes that triangles or elements name, ascending.
std::vector<int> used_nodes(const PageMesh& mesh) {
  std::vector<char> used(mesh.nodes.size(), 0);
  const auto mark = [&](const auto& cells) {
    for (const auto& cell : cells) {
      for (const int id : cell) {
        used[static_cast<std::size_t>(id)] = 1;
      }
    }
  };
  mark(mesh.triangles);
  mark(mesh.tets);
  std::vector<int> kept;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0) {
      kept.push_back(static_cast<int>(i));
    }
  }
  return kept;
}

}  // namespace

void keep_used_nodes(PageMesh& mesh) { keep_nodes(mesh, used_nodes(mesh)); }

PageMesh without_midsides(const PageMesh& mesh) {
  PageMesh result = mesh;
  if (!mesh.four_a_face) {
    return result;
  }
  result.four_a_face = false;
  result.triangles.clear();
  result.labels.clear();
  for (std::size_t t = 0; t + 3 < mesh.triangles.size(); t += 4) {
    result.triangles.push_back({mesh.triangles[t][0], mesh.triangles[t + 1][1],
                                mesh.triangles[t + 2][2]});
    result.labels.push_back(mesh.labels[t]);
  }
  keep_used_nodes(result);
  return result;
}

PageMesh without_inside(const PageMesh& mesh) {
  PageMesh result = mesh;
  result.tets.clear();
  keep_used_nodes(result);
  return result;
}

PageMesh clustered(const PageMesh& mesh, double cell) {
  PageMesh result = without_inside(mesh);
  std::map<std::array<long, 3>, int> first_in;
  std::vector<int> stands_for(result.nodes.size());
  for (std::size_t i = 0; i < result.nodes.size(); ++i) {
    std::array<long, 3> cube{};
    for (int c = 0; c < 3; ++c) {
      cube[static_cast<std::size_t>(c)] =
          std::lround(std::floor(result.nodes[i][c] / cell));
    }
    stands_for[i] =
        first_in.try_emplace(cube, static_cast<int>(i)).first->second;
  }
  std::vector<Triangle> triangles;
  std::vector<int> labels;
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    Triangle ids = result.triangles[t];
    for (int& id : ids) {
      id = stands_for[static_cast<std::size_t>(id)];
    }
    if (ids[0] != ids[1] && ids[1] != ids[2] && ids[2] != ids[0]) {
      triangles.push_back(ids);
      labels.push_back(result.labels[t]);
    }
  }
  result.triangles = std::move(triangles);
  result.labels = std::move(labels);
  result.four_a_face = false;
  keep_used_nodes(result);
  return result;
}

double page_bytes(const PageMesh& mesh) {
  constexpr double kBase64 = 4.0 / 3.0;
  const auto nodes = static_cast<double>(mesh.nodes.size());
  const double numbers =
      3.0 + static_cast<double>(mesh.case_von_mises.size()) +
      static_cast<double>(mesh.displacement.size() + mesh.von_mises.size() +
                          mesh.energy_density.size() +
                          mesh.stress_error.size()) /
          std::max(nodes, 1.0);
  const double id = mesh.nodes.size() > 65536 ? 4.0 : 2.0;
  return kBase64 *
         (2.0 * numbers * nodes +
          static_cast<double>(mesh.triangles.size()) * (3.0 * id + 1.0) +
          static_cast<double>(mesh.tets.size()) * 4.0 * id);
}

nlohmann::ordered_json to_json(const PageMesh& mesh) {
  const auto flat = [](const auto& cells) {
    std::vector<int> ids;
    for (const auto& cell : cells) {
      ids.insert(ids.end(), cell.begin(), cell.end());
    }
    return ids;
  };
  std::vector<double> nodes;
  nodes.reserve(3 * mesh.nodes.size());
  for (const Vec3& node : mesh.nodes) {
    nodes.insert(nodes.end(), node.data(), node.data() + 3);
  }
  nlohmann::ordered_json json = {{"nodes", pack_reals(nodes, 3)},
                                 {"triangles", pack_ids(flat(mesh.triangles))},
                                 {"labels", pack_ids(mesh.labels)},
                                 {"names", mesh.names},
                                 {"four_a_face", mesh.four_a_face},
                                 {"load_case", mesh.load_case}};
  if (!mesh.tets.empty()) {
    json["tets"] = pack_ids(flat(mesh.tets));
  }
  if (!mesh.displacement.empty()) {
    json["displacement"] = pack_reals(mesh.displacement, 3);
  }
  const auto add = [&](const std::string& name,
                       const std::vector<double>& values) {
    if (!values.empty()) {
      json["fields"][name] = pack_reals(values, 1);
    }
  };
  json["fields"] = nlohmann::ordered_json::object();
  add("von_mises", mesh.von_mises);
  add("energy_density", mesh.energy_density);
  add("stress_error", mesh.stress_error);
  for (const auto& [name, values] : mesh.case_von_mises) {
    add("von_mises:" + name, values);
  }
  return json;
}

}  // namespace meniscus::page
