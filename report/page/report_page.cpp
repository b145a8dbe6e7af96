#include "report/page/report_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/files/named_values.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/store/stored_case.h"
#include "report/page/page_case.h"
#include "report/page/page_evolved.h"
#include "report/page/page_film.h"
#include "report/page/page_mesh.h"
#include "report/page/page_template.h"

namespace meniscus::page {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr int kPageVersion = 1;
constexpr double kMargin = 3e5;       // for texts, tables and rounding [byte]
constexpr double kFrameShare = 0.35;  // of the room, for earlier designs

bool has_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Json read_json(const fs::path& path) {
  Json json = parse_json(read_file(path));
  if (!json.is_object() || !json.contains("schema_version")) {
    throw InvalidInput(fmt::format(
        "'{}' is damaged or none of this program's; run the case again",
        path.string()));
  }
  return json;
}

/// A page's room for geometry and what had to go for it.
class Room {
 public:
  explicit Room(double bytes) : left_(bytes) {}
  double left() const { return left_; }
  void take(double bytes) { left_ = std::max(0.0, left_ - bytes); }

 private:
  double left_;
};

double bytes_of_json(const Json& json) {
  return static_cast<double>(json_line(json).size());
}

/// The mesh thinned out until it takes at most `bytes`; what was done to it in
/// `note`, for the page.
PageMesh fit(PageMesh mesh, double bytes, std::string& note) {
  if (page_bytes(mesh) <= bytes) {
    return mesh;
  }
  if (mesh.four_a_face) {
    mesh = without_midsides(mesh);
    note = "To keep this file small, curved element faces are drawn flat.";
  }
  if (page_bytes(mesh) > bytes && !mesh.tets.empty()) {
    mesh = without_inside(mesh);
    note =
        "To keep this file small, the elements inside are left out: a section "
        "shows a hollow shell. part.vtu has them all.";
  }
  Vec3 low = mesh.nodes.empty() ? Vec3::Zero() : mesh.nodes.front();
  Vec3 high = low;
  for (const Vec3& node : mesh.nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  constexpr double kFinest = 400.0;  // cells along the diagonal, at first
  constexpr double kCoarser = 1.25;
  double cell = (high - low).norm() / kFinest;
  while (page_bytes(mesh) > bytes && cell > 0.0 && !mesh.triangles.empty()) {
    mesh = clustered(mesh, cell);
    note =
        "To keep this file small, the surface is thinned out and the elements "
        "inside are left out. part_surface.vtp and part.vtu have them all.";
    cell *= kCoarser;
  }
  return mesh;
}

/// One run in a folder, as far as the page needs it.
struct StoredRun {
  case_data::Case input;
  std::vector<store::EvaluationRecord> records;
  VectorX design;
  std::vector<element::Material> materials;
};

std::optional<StoredRun> stored_run(const fs::path& folder, const Json& result,
                                    std::vector<std::string>& notes) {
  if (!has_file(folder / "study.sqlite")) {
    notes.emplace_back(
        "The study's database is not in the folder: the case, sensitivities "
        "and boundary curves are missing here.");
    return std::nullopt;
  }
  const store::StudyStore store = store::StudyStore::read(folder.string());
  StoredRun run{.input = store::restore_case(store.meta()),
                .records = store.all(),
                .design = {},
                .materials = {}};
  run.design = case_data::initial_design(run.input);
  for (std::size_t k = 0;
       result.contains("parameters") && k < run.input.design.size(); ++k) {
    const Json* value =
        files::find_named(result["parameters"], run.input.design[k].name);
    if (value != nullptr && value->is_number()) {
      run.design[static_cast<Eigen::Index>(k)] = value->get<double>();
    }
  }
  run.materials = case_data::evaluate(run.input, run.design).materials;
  return run;
}

/// Adds `parts` with one mesh when the run has one.
void add_part(const fs::path& folder, const std::string& name,
              const std::vector<element::Material>& materials, double bytes,
              Json& page) {
  if (!has_file(folder / "part_surface.vtp")) {
    return;
  }
  std::string note;
  const PageMesh mesh = fit(load_page_part(folder / "part_surface.vtp",
                                           folder / "part.vtu", materials),
                            bytes, note);
  Json part = {{"name", name}, {"mesh", to_json(mesh)}};
  if (!note.empty()) {
    part["note"] = note;
  }
  page["parts"].push_back(std::move(part));
}

void add_films(const fs::path& folder, const std::vector<std::string>& solids,
               Room& room, Json& page) {
  if (has_file(folder / "film.vtp")) {
    page["film"] = page_film(folder / "film.vtp", solids);
    room.take(bytes_of_json(page["film"]));
  }
  if (has_file(folder / "findings.vtp")) {
    page["findings"] = page_findings(folder);
    room.take(bytes_of_json(page["findings"]));
  }
  const std::vector<PageFrame> frames = page_frames(folder);
  if (!frames.empty()) {
    page["frames"] = frames_json(folder, frames, kFrameShare * room.left());
    room.take(bytes_of_json(page["frames"]));
  }
}

/// Where the curves were at each frame's design.
void add_frame_curves(const StoredRun& run, Json& frames) {
  for (Json& frame : frames["frames"]) {
    for (const store::EvaluationRecord& record : run.records) {
      if (record.number == frame["evaluation"].get<int>()) {
        frame["curves"] = Json::array();
        for (Json& curve : page_curves(run.input, record.inputs)) {
          frame["curves"].push_back(std::move(curve["points"]));
        }
      }
    }
  }
}

void add_run(const fs::path& folder, Room room, Json& page) {
  std::vector<std::string> notes;
  const auto run = stored_run(folder, page["result"], notes);
  std::vector<std::string> solids;
  if (run) {
    solids = case_data::solids_of_whole(run->input);
    page["case"] = page_case(run->input);
    page["curves"] = page_curves(run->input, run->design);
    case_data::EvaluatedCase inputs =
        case_data::evaluate(run->input, run->design);
    forward::add_worst_cases(run->input, page["result"], inputs);
    page["loads"] = page_loads(run->input, inputs);
    page["gradients"] = page_gradients(run->input, run->records, run->design);
  }
  if (has_file(folder / "history.csv")) {
    page["history"] = read_file(folder / "history.csv");
    room.take(bytes_of_json(page["history"]));
  }
  add_films(folder, solids, room, page);
  if (run && page.contains("frames")) {
    add_frame_curves(*run, page["frames"]);
  }
  add_part(folder, page["result"].value("case", ""),
           run ? run->materials : std::vector<element::Material>{}, room.left(),
           page);
  page["notes"] = notes;
}

void add_family(const fs::path& folder, const Room& room, Json& page) {
  const Json& members = page["result"]["members"];
  const double each = room.left() / static_cast<double>(std::max<std::size_t>(
                                        1, members.size()));
  bool first = true;
  for (const Json& member : members) {
    const fs::path relative = member.value("folder", "");
    const fs::path place = folder / relative;
    if (first && has_file(place / "study.sqlite")) {
      const store::StudyStore store = store::StudyStore::read(place.string());
      page["case"] = page_case(store::restore_case(store.meta()));
      first = false;
    }
    const std::size_t before = page["parts"].size();
    // Side by side each is small: its surface is enough.
    if (has_file(place / "part_surface.vtp")) {
      std::string note;
      const PageMesh mesh =
          fit(load_page_part(place / "part_surface.vtp", {}, {}), each, note);
      page["parts"].push_back(
          {{"name", member.value("name", "")}, {"mesh", to_json(mesh)}});
      if (has_file(place / "report.html")) {
        page["parts"][before]["link"] = (relative / "report.html").string();
      }
    }
  }
}

void add_comparison(const fs::path& folder, const Room& room, Json& page) {
  const Json& parts = page["comparison"]["parts"];
  for (const Json& part : parts) {
    const std::string file = part.value("surface", "");
    if (file.empty() || !has_file(folder / file)) {
      continue;
    }
    std::string note;
    const PageMesh mesh =
        fit(load_page_part(folder / fs::path(file).filename(), {}, {}),
            room.left() / static_cast<double>(parts.size()), note);
    Json shown = {{"name", part.value("name", "")}, {"mesh", to_json(mesh)}};
    if (!note.empty()) {
      shown["note"] = note;
    }
    page["parts"].push_back(std::move(shown));
  }
}

/// What `meniscus evolve` left.
void add_film_alone(const fs::path& folder, Room room, Json& page) {
  const Json film = read_json(folder / "film.json");
  add_evolved(film, page);
  add_films(folder, film.at("solids").get<std::vector<std::string>>(), room,
            page);
  // Those of a run that was in the folder before are not its way to rest.
  if (page.contains("frames") &&
      page["frames"]["stored"].get<std::size_t>() != page["captions"].size()) {
    page.erase("frames");
  }
  page["notes"] = Json::array();
}

/// All that the page shows (report/web/src/data.ts).
Json page_data(const fs::path& folder, const ReportOptions& options) {
  Json page = {{"format", kPageVersion},
               {"kind", "run"},
               {"folder", fs::absolute(folder).filename().string()},
               {"versions", options.versions},
               {"parts", Json::array()}};
  const Room room(kMostPageBytes - kMargin -
                  static_cast<double>(page_template().size()));
  if (has_file(folder / "result.json")) {
    page["result"] = read_json(folder / "result.json");
    if (page["result"].contains("members")) {
      page["kind"] = "family";
      add_family(folder, room, page);
    } else {
      add_run(folder, room, page);
    }
  } else if (has_file(folder / "compare.json")) {
    page["kind"] = "comparison";
    page["comparison"] = read_json(folder / "compare.json");
    add_comparison(folder, room, page);
  } else if (has_file(folder / "film.json")) {
    page["kind"] = "film";
    add_film_alone(folder, room, page);
  } else {
    throw InvalidInput(fmt::format(
        "'{}' holds no result.json, compare.json or film.json: give the folder "
        "of a finished run, family, comparison or film{}",
        folder.string(),
        has_file(folder / "study.sqlite")
            ? "; the run in it has not ended, go on with --resume"
            : ""));
  }
  return page;
}

/// JSON that can stand in a page: no "</script>", no "<!--".
std::string safe_text(const Json& page) {
  const std::string json = json_line(page);
  std::string text;
  text.reserve(json.size() + json.size() / 100);
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> write_report(const fs::path& folder,
                                      const ReportOptions& options) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw InvalidInput(fmt::format("there is no folder '{}'", folder.string()));
  }
  std::string data;
  try {
    data = safe_text(page_data(folder, options));
  } catch (const Json::exception& error) {
    throw InvalidInput(fmt::format(
        "the results in '{}' are damaged or none of this program's: {}",
        folder.string(), error.what()));
  }
  const std::string_view page = page_template();
  if (page.empty()) {
    return {
        "no report page: npm was missing when this program was built (Debian "
        "packages nodejs and npm)"};
  }
  const std::size_t at = page.find(kPageDataMark);
  std::string text;
  text.reserve(page.size() + data.size());
  text += page.substr(0, at);
  text += data;
  text += page.substr(at + kPageDataMark.size());
  write_file(folder / "report.html", text);
  return {};
}

void write_report_or_warn(const fs::path& folder, const ReportOptions& options,
                          Monitor* monitor,
                          const std::function<void(const std::string&)>& warn) {
  const auto tell = [&](const std::string& warning) {
    if (warn) {
      warn(warning);
    }
  };
  try {
    (monitor != nullptr ? *monitor : silent_monitor())
        .progress({.stage = "output", .detail = "writing the report page"});
    for (const std::string& warning : write_report(folder, options)) {
      tell(warning);
    }
  } catch (const Error& error) {
    tell(std::string("no report page: ") + error.what());
  }
}

}  // namespace meniscus::page
