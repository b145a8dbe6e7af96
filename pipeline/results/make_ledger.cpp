#include "pipeline/results/make_ledger.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json.h"
#include "evolve/start/start_complex.h"
#include "pipeline/results/calculix_export.h"
#include "pipeline/results/results.h"

namespace meniscus::results {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kPoint = sizeof(Vec3);
constexpr double kFacet = sizeof(Triangle) + sizeof(int);
double area_of(const SurfaceMesh& mesh) {
  double twice = 0.0;
  for (const Triangle& t : mesh.facets) {
    const Vec3& a = mesh.points[static_cast<std::size_t>(t[0])];
    const Vec3& b = mesh.points[static_cast<std::size_t>(t[1])];
    const Vec3& c = mesh.points[static_cast<std::size_t>(t[2])];
    twice += (b - a).cross(c - a).norm();
  }
  return 0.5 * twice;
}

study::LedgerAmount amount_of(const SurfaceMesh& mesh) {
  const auto facets = static_cast<double>(mesh.facets.size());
  return {.elements = facets,
          .area = area_of(mesh),
          .bytes = kPoint * static_cast<double>(mesh.points.size()) +
                   kFacet * facets};
}

/// With the mid-sides that make its facets curved.
study::LedgerAmount amount_of(const QuadraticSurface& surface) {
  study::LedgerAmount amount = amount_of(surface.base);
  amount.bytes += kPoint * static_cast<double>(surface.mid.size());
  return amount;
}

/// `area`: of the surface that it fills.
study::LedgerAmount amount_of(const TetMesh& mesh,
                              const std::optional<double>& area) {
  return {.elements = static_cast<double>(mesh.element_count()),
          .area = area,
          .bytes = kPoint * static_cast<double>(mesh.nodes.size()) +
                   sizeof(int) *
                       static_cast<double>(
                           mesh.elements.size() + mesh.element_region.size() +
                           mesh.faces.size() + mesh.face_label.size())};
}

double bytes_of(const equations::ElasticSolution& solution) {
  double numbers = 0.0;
  for (const auto* vectors : {&solution.displacements, &solution.reactions}) {
    for (const VectorX& vector : *vectors) {
      numbers += static_cast<double>(vector.size());
    }
  }
  return sizeof(double) * numbers;
}

/// Of no work at all: it was done elsewhere, or by what does not count.
std::optional<double> counted(double operations) {
  return operations > 0.0 ? std::optional(operations) : std::nullopt;
}

/// Of the facets with one label, and the points that they use.
study::LedgerAmount amount_of(const SurfaceMesh& mesh,
                              const std::string& label) {
  SurfaceMesh part{.points = mesh.points,
                   .facets = {},
                   .facet_label = {},
                   .labels = mesh.labels};
  std::vector<char> used(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.labels[static_cast<std::size_t>(mesh.facet_label[f])] == label) {
      part.facets.push_back(mesh.facets[f]);
      for (const int v : mesh.facets[f]) {
        used[static_cast<std::size_t>(v)] = 1;
      }
    }
  }
  study::LedgerAmount amount = amount_of(part);
  amount.bytes -=
      kPoint * static_cast<double>(std::count(used.begin(), used.end(), 0));
  return amount;
}

/// The stages start and film of each film and face, which are not timed apart.
void add_surfaces(const SurfaceMesh& start, const SurfaceMesh& film,
                  std::vector<study::LedgerStage>& stages) {
  for (const std::string& label : film.labels) {
    stages.push_back({"film: " + label,
                      amount_of(start, label),
                      amount_of(film, label),
                      {},
                      {}});
  }
}

/// Empty where films of the answer's curves cannot start by themselves: the
/// model's began at another design.
SurfaceMesh start_surface(const forward::EvaluationFields& fields) {
  SurfaceMesh surface;
  what_prevents([&] {
    surface =
        start::build_start(fields.inputs.film_system, fields.start_edge).mesh;
  });
  return surface;
}

/// The files of a run that hold the part, and the deck as it would be exported
/// where it was not.
std::vector<study::FileBytes> files_of(const case_data::Case& input,
                                       const forward::EvaluationFields& fields,
                                       const fs::path& folder,
                                       const std::vector<fs::path>& exported) {
  std::vector<std::string> names = mesh_names(input);
  for (const fs::path& file : exported) {
    const std::string name = file.filename().string();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  }
  std::vector<study::FileBytes> files;
  for (const std::string& name : names) {
    std::error_code code;
    const auto bytes = fs::file_size(folder / name, code);
    if (!code) {
      files.push_back({name, static_cast<double>(bytes), true});
    }
  }
  const std::string deck_name =
      fmt::format("part_{:g}.inp", input.resolution.fea);
  if (fields.shell || std::any_of(files.begin(), files.end(),
                                  [&](const study::FileBytes& file) {
                                    return file.name == deck_name;
                                  })) {
    return files;
  }
  try {
    const io::CalculixDeck deck =
        calculix_deck_of(input, fields.inputs, fields.mesh);
    files.push_back(
        {deck_name,
         static_cast<double>(io::calculix_deck(fields.mesh, deck).size()),
         false});
  } catch (const InvalidInput&) {
    // A case that no deck can say has none.
  }
  return files;
}

}  // namespace

study::Ledger make_ledger(const case_data::Case& input,
                          const study::RunResult& result,
                          const forward::EvaluationFields& fields,
                          const fs::path& folder,
                          const std::vector<fs::path>& exported) {
  const forward::Evaluation& best = *result.best;
  const forward::Evaluation& frozen = result.frozen;
  study::Ledger ledger;
  ledger.input_bytes = static_cast<double>(input.text.size());
  ledger.files = files_of(input, fields, folder, exported);
  const study::LedgerAmount curves = {
      .elements = static_cast<double>(input.curves.size()),
      .area = {},
      .bytes = ledger.input_bytes};
  const SurfaceMesh raw = start_surface(fields);
  const study::LedgerAmount start = amount_of(raw);
  const study::LedgerAmount film = amount_of(fields.film);
  const study::LedgerAmount surface = amount_of(fields.surface);
  const study::LedgerAmount mesh = amount_of(fields.mesh, surface.area);
  study::LedgerAmount solved = mesh;
  solved.bytes = bytes_of(fields.solution);
  study::LedgerAmount files = solved;
  files.bytes = 0.0;
  for (const study::FileBytes& file : ledger.files) {
    files.bytes += file.written ? file.bytes : 0.0;
  }
  ledger.stages = {
      {"start", curves, start, counted(frozen.operations.film),
       frozen.seconds.film},
      {"film", start, film, counted(best.operations.film), best.seconds.film},
      {"surface", film, surface, {}, {}},
      {"filling", surface, mesh, counted(frozen.operations.mesh),
       frozen.seconds.mesh},
      {"motion", mesh, mesh, counted(best.operations.mesh), best.seconds.mesh},
      {"elasticity", mesh, solved, counted(best.operations.fea),
       best.seconds.fea},
      {"files", solved, files, {}, result.output_seconds}};
  add_surfaces(raw, fields.film, ledger.stages);
  return ledger;
}

void note_file(const fs::path& folder, const fs::path& file,
               const std::string& name) {
  const fs::path result = folder / "result.json";
  std::error_code code;
  const auto bytes = static_cast<double>(fs::file_size(file, code));
  if (code || !fs::exists(result, code)) {
    return;
  }
  const bool inside = fs::equivalent(
      file.parent_path().empty() ? fs::path(".") : file.parent_path(), folder,
      code);
  const Json entry = {{"name", inside ? file.filename().string() : name},
                      {"bytes", bytes},
                      {"written", inside}};
  try {
    Json json = require_json(read_file(result));
    Json& files = json.at("ledger").at("files");
    const auto same = std::find_if(
        files.begin(), files.end(),
        [&](auto& other) { return other.at("name") == entry["name"]; });
    if (same != files.end()) {
      *same = entry;
    } else {
      files.push_back(entry);
    }
    write_file(result, json_text(json, 2) + "\n");
  } catch (const Json::exception&) {
    return;  // of another version
  } catch (const IoError&) {
    return;  // of somebody else's
  }
}

}  // namespace meniscus::results
