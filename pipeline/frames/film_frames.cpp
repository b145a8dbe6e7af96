#include "pipeline/frames/film_frames.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/vtk_files.h"
#include "optimize/problem.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/store/refreeze.h"

namespace meniscus::frames {

namespace {

namespace fs = std::filesystem;

/// Whether a study that searches prefers one record to another.
class Preference {
 public:
  explicit Preference(const case_data::StudyEntry& study) : study_(study) {}

  bool searches() const {
    return study_.kind == case_data::StudyKind::Match ||
           study_.kind == case_data::StudyKind::Minimize;
  }
  bool better(const store::EvaluationRecord& a,
              const store::EvaluationRecord& b) const {
    if (study_.kind == case_data::StudyKind::Match) {
      return a.mismatch && (!b.mismatch || *a.mismatch < *b.mismatch);
    }
    return store::is_better(store::merit_of(study_, a.responses),
                            store::merit_of(study_, b.responses));
  }

 private:
  const case_data::StudyEntry& study_;
};

/// The designs that no other beats in both objectives, as far as they are
/// known without the optimizer's own verdict.
bool beaten(const case_data::StudyEntry& study,
            const store::EvaluationRecord& record,
            const std::vector<store::EvaluationRecord>& records) {
  const auto value = [&](const store::EvaluationRecord& r, int response) {
    return r.responses[response];
  };
  const int first = *study.objective;
  const int second = *study.second;
  return std::any_of(
      records.begin(), records.end(),
      [&](const store::EvaluationRecord& other) {
        return !other.failure && store::is_study_model(other.model) &&
               store::merit_of(study, other.responses).feasible() &&
               value(other, first) <= value(record, first) &&
               value(other, second) <= value(record, second) &&
               (value(other, first) < value(record, first) ||
                value(other, second) < value(record, second));
      });
}

/// Every design that has a film and a reason to be shown.
std::vector<KeptDesign> candidates(
    const case_data::Case& input,
    const std::vector<store::EvaluationRecord>& records, const VectorX& best) {
  const Preference preference(input.study);
  const bool front = input.study.kind == case_data::StudyKind::Pareto;
  std::vector<KeptDesign> kept;
  const store::EvaluationRecord* incumbent = nullptr;
  bool best_found = false;
  for (const store::EvaluationRecord& record : records) {
    const bool again =
        std::any_of(kept.begin(), kept.end(), [&](const KeptDesign& other) {
          return other.record->inputs == record.inputs;  // on another mesh
        });
    if (record.failure || again || !store::is_study_model(record.model)) {
      continue;
    }
    const bool neighbour =
        record.phase ==
        optimize::name_of(optimize::EvaluationPhase::Difference);
    const bool is_best = !best_found && record.inputs == best;
    best_found = best_found || is_best;
    bool wanted = incumbent == nullptr;
    const char* why = wanted ? "start" : "better";
    if (!wanted && !neighbour) {
      if (preference.searches()) {
        wanted = preference.better(record, *incumbent);
      } else if (front) {
        wanted = store::merit_of(input.study, record.responses).feasible() &&
                 !beaten(input.study, record, records);
      } else {
        wanted = true;
        why = "looked at";
      }
    }
    if (wanted && (incumbent == nullptr || preference.searches())) {
      incumbent = &record;
    }
    if (wanted || is_best) {
      kept.push_back({&record, is_best ? "best" : why});
    }
  }
  return kept;
}

/// `most` of `count`, first and last among them.
std::set<int> evenly(int count, int most) {
  std::set<int> chosen;
  for (int k = 0; k < most; ++k) {
    chosen.insert(static_cast<int>(
        std::lround(static_cast<double>(k) * (count - 1) / (most - 1))));
  }
  return chosen;
}

io::Field numbers(const char* name, const VectorX& values) {
  return {.name = name, .values = {values.begin(), values.end()}};
}

bool is_frame(const fs::path& path) {
  const std::string name = path.filename().string();
  return (path.extension() == ".vtp" || path.extension() == ".png") &&
         name.starts_with("film_");
}

/// How far each point is from where it is in the first frame.
io::Field moved(const UnitSystem& units, const Points& points,
                const Points& start) {
  io::Field field{.name = "moved", .unit = units.length, .components = 3};
  field.values.reserve(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 by = points[i] - start[i];
    field.values.insert(field.values.end(), by.begin(), by.end());
  }
  return field;
}

io::MeshFields frame_fields(const case_data::Case& input,
                            const forward::FilmFrame& frame,
                            const Points& start) {
  io::MeshFields fields;
  if (frame.surface.points.size() == start.size()) {
    fields.points = {moved(input.units, frame.surface.points, start)};
  }
  fields.notes = {{"title", input.title},
                  {"length_unit", input.units.length},
                  {"kept", frame.kept}};
  fields.lists = {{"design_names", case_data::design_names(input)},
                  {"response_names", case_data::response_names(input)}};
  fields.numbers = {
      numbers("evaluation", VectorX::Constant(1, frame.evaluation)),
      numbers("design", frame.design), numbers("responses", frame.responses)};
  return fields;
}

}  // namespace

std::vector<KeptDesign> kept_designs(
    const case_data::Case& input,
    const std::vector<store::EvaluationRecord>& records, const VectorX& best,
    int most) {
  const std::vector<KeptDesign> all = candidates(input, records, best);
  const auto count = static_cast<int>(all.size());
  if (count <= most) {
    return all;
  }
  std::set<int> chosen = evenly(count, most);
  const auto at = std::find_if(all.begin(), all.end(), [](const KeptDesign& d) {
    return std::string(d.why) == "best";
  });
  if (at != all.end() &&
      chosen.insert(static_cast<int>(at - all.begin())).second) {
    // In the place of the nearest one, but not of the start.
    const auto here = chosen.find(static_cast<int>(at - all.begin()));
    const auto next = std::next(here);
    chosen.erase(next != chosen.end() ? next : std::prev(here));
  }
  std::vector<KeptDesign> result;
  result.reserve(chosen.size());
  for (const int k : chosen) {
    result.push_back(all[static_cast<std::size_t>(k)]);
  }
  return result;
}

std::vector<forward::FilmFrame> film_frames(
    const case_data::Case& input, const forward::ForwardModel& model,
    const std::vector<KeptDesign>& designs, Monitor& monitor) {
  std::vector<forward::FilmFrame> frames;
  frames.reserve(designs.size());
  for (const KeptDesign& design : designs) {
    throw_if_stopped(monitor, "films of the history");
    const store::EvaluationRecord& record = *design.record;
    monitor.progress(
        {.stage = "frames",
         .detail = fmt::format("film of evaluation {}", record.number),
         .fraction = static_cast<double>(frames.size()) /
                     static_cast<double>(designs.size())});
    const case_data::EvaluatedCase numbers =
        case_data::evaluate(input, record.inputs);
    const settle::FilmState film = model.film().settle(numbers.film_system);
    if (!film.failure) {
      frames.push_back({.evaluation = record.number,
                        .kept = design.why,
                        .design = record.inputs,
                        .responses = record.responses,
                        .surface = model.surface(numbers, film.points).base});
    }
  }
  return frames;
}

void write_frames(const case_data::Case& input,
                  const std::vector<forward::FilmFrame>& frames,
                  const fs::path& folder) {
  remove_frames(folder);
  if (frames.empty()) {
    return;
  }
  make_folder(folder / "frames");
  std::string sets;
  for (const forward::FilmFrame& frame : frames) {
    const std::string name = frame_name(frame.evaluation);
    io::write_vtp(folder / "frames" / name, frame.surface,
                  frame_fields(input, frame, frames.front().surface.points));
    sets += fmt::format(
        "    <DataSet timestep=\"{}\" group=\"\" part=\"0\" "
        "file=\"frames/{}\"/>\n",
        frame.evaluation, name);
  }
  write_file(folder / "frames.pvd",
             "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"Collection\" version=\"0.1\" "
             "byte_order=\"LittleEndian\">\n  <Collection>\n" +
                 sets + "  </Collection>\n</VTKFile>\n");
}

std::string frame_name(int evaluation) {
  return fmt::format("film_{:04d}.vtp", evaluation);
}

std::string frame_caption(const case_data::Case& input,
                          const forward::FilmFrame& frame) {
  constexpr std::size_t kMostDesigns = 3;
  constexpr int kMostResponses = 3;
  std::vector<std::string> parts;
  const std::vector<case_data::DesignRow> rows = case_data::design_rows(input);
  for (std::size_t r = 0; rows.size() <= kMostDesigns && r < rows.size(); ++r) {
    parts.push_back(rows[r].name + " = " +
                    case_data::row_text(input, rows[r], frame.design, 4));
  }
  const auto add = [&](int k) {
    parts.push_back(
        input.responses[static_cast<std::size_t>(k)].name + " = " +
        case_data::shown_unit(input, k).text(frame.responses[k], 4));
  };
  const int first = input.study.objective.value_or(-1);
  if (first >= 0) {
    add(first);
  }
  const auto count = static_cast<int>(frame.responses.size());
  for (int k = 0; k < std::min(count, kMostResponses); ++k) {
    if (k != first) {
      add(k);
    }
  }
  return fmt::format("evaluation {} ({}): {}", frame.evaluation, frame.kept,
                     fmt::join(parts, ", "));
}

void remove_frames(const fs::path& folder) {
  std::error_code code;
  fs::remove(folder / "frames.pvd", code);
  const fs::path frames = folder / "frames";
  if (!fs::is_directory(frames, code)) {
    return;
  }
  remove_leftovers(frames);
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(frames, code)) {
    if (is_frame(entry.path())) {
      old.push_back(entry.path());
    }
  }
  for (const fs::path& path : old) {
    fs::remove(path, code);
  }
  fs::remove(frames, code);  // only when empty
}

}  // namespace meniscus::frames
