#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/store/study_store.h"
#include "pipeline/study/ordered_jobs.h"
#include "python/array_view.h"
#include "python/bindings.h"
#include "python/call.h"
#include "report/output/folder_run.h"

namespace meniscus::python {

namespace {

/// The evaluations of a study, from its database.
struct StudyTable {
  store::StudyMeta meta;
  std::vector<store::EvaluationRecord> records;
  std::vector<std::string> design_names, response_names;
  std::vector<double> designs, responses;  // by row; NaN: failed
  std::vector<double> answer;
  case_data::Case input;
};

StudyTable read_table(const std::string& folder) {
  const store::StudyStore store = store::StudyStore::read(folder);
  StudyTable table{.meta = store.meta(), .records = store.all()};
  table.input = store::restore_case(table.meta);
  table.design_names = case_data::design_names(table.input);
  table.response_names = case_data::response_names(table.input);
  const auto nothing = std::numeric_limits<double>::quiet_NaN();
  for (const store::EvaluationRecord& record : table.records) {
    table.designs.insert(table.designs.end(), record.inputs.begin(),
                         record.inputs.end());
    for (std::size_t k = 0; k < table.response_names.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      table.responses.push_back(
          at < record.responses.size() ? record.responses[at] : nothing);
    }
  }
  const bool some = std::any_of(table.records.begin(), table.records.end(),
                                [](const store::EvaluationRecord& record) {
                                  return !record.failure &&
                                         store::is_study_model(record.model);
                                });
  if (some) {
    const VectorX answer =
        store::answer_of_run(table.input, table.records, folder);
    table.answer.assign(answer.begin(), answer.end());
  }
  return table;
}

py::array rows_of(const py::object& self, std::vector<double> StudyTable::*rows,
                  std::vector<std::string> StudyTable::*names) {
  const auto& table = self.cast<const StudyTable&>();
  return view((table.*rows).data(),
              {static_cast<py::ssize_t>(table.records.size()),
               static_cast<py::ssize_t>((table.*names).size())},
              self);
}

template <class Value, class Get>
std::vector<Value> column(const StudyTable& table, const Get& get) {
  std::vector<Value> values;
  values.reserve(table.records.size());
  for (const store::EvaluationRecord& record : table.records) {
    values.push_back(get(record));
  }
  return values;
}

void bind_columns(py::class_<StudyTable>& type) {
  type.def_property_readonly(
          "designs",
          [](const py::object& self) {
            return rows_of(self, &StudyTable::designs,
                           &StudyTable::design_names);
          },
          "The design of each evaluation, float64 (evaluations, design "
          "variables); a read-only view.")
      .def_property_readonly(
          "responses",
          [](const py::object& self) {
            return rows_of(self, &StudyTable::responses,
                           &StudyTable::response_names);
          },
          "The responses of each evaluation, NaN where it failed, float64 "
          "(evaluations, responses); a read-only view.")
      .def_property_readonly(
          "failures",
          [](const StudyTable& self) {
            return column<std::optional<Failure>>(
                self,
                [](const store::EvaluationRecord& r) { return r.failure; });
          },
          "Per evaluation why it failed (Failure), or None.")
      .def_property_readonly(
          "phases",
          [](const StudyTable& self) {
            return column<std::string>(self,
                                       [](const store::EvaluationRecord& r) {
                                         return store::purpose_of(r);
                                       });
          },
          "Per evaluation what it was for: 'start', 'step', 'difference', ...")
      .def_readonly("design_names", &StudyTable::design_names,
                    "Columns of `designs`.")
      .def_readonly("response_names", &StudyTable::response_names,
                    "Columns of `responses`.")
      .def(
          "__len__", [](const StudyTable& self) { return self.records.size(); },
          "Number of evaluations.");
}

/// What ended it early passes on, once the folder's result.json tells of it.
void run_into_folder(const case_data::Case& input,
                     const output::FolderRunOptions& options,
                     Monitor& monitor) {
  const output::FolderRunListener listener{
      .monitor = &monitor,
      .page_warning =
          [&](const std::string& warning) {
            monitor.log(Severity::Warning, warning);
          },
      .stop_reason = [] { return std::string("stopped on request"); }};
  if (input.study.members.empty()) {
    const output::FolderRunResult end =
        output::FolderRun(input, options).run(listener);
    if (end.error) {
      std::rethrow_exception(end.error);
    }
    return;
  }
  output::prepare_run_folder(input, options.folder);
  const results::FamilyResult result =
      output::run_family_into_folder(input, options, listener);
  if (result.status == study::RunStatus::Interrupted) {
    throw Interrupted(result.message);
  }
  output::write_family_pages(result, options, listener);
}

void run_study_in(const ReadCase& input, output::FolderRunOptions options,
                  const py::object& progress) {
  if (options.jobs < 1 || options.jobs > study::kMostJobs) {
    throw InvalidInput(fmt::format("jobs: found {}, expected 1 to {}",
                                   options.jobs, study::kMostJobs));
  }
  if (!std::isfinite(options.time_limit) || options.time_limit < 0.0) {
    throw InvalidInput(
        fmt::format("time_limit: found {}, expected seconds above 0, or None",
                    options.time_limit));
  }
  options.program_version = MENISCUS_VERSION;
  options.page_versions = "meniscus " MENISCUS_VERSION ", from Python";
  options.threads = thread_count();
  options.warnings = input.warnings;
  options.resume_hint = "resume";
  options.pictures_when_late = true;
  Call call(progress);
  call.run([&] { run_into_folder(*input.input, options, call); });
}

}  // namespace

void bind_study(py::module_& module) {
  py::class_<StudyTable> table(module, "Evaluations",
                               "The evaluations of a study, from its "
                               "database, in their order.");
  bind_columns(table);
  table.def_property_readonly(
      "_answer", [](const StudyTable& self) { return self.answer; },
      "The design of the study's answer; empty without one.");
  table.def_property_readonly(
      "_case",
      [](const StudyTable& self) {
        return ReadCase{std::make_shared<const case_data::Case>(self.input),
                        {}};
      },
      "The case as the study keeps it.");
  module.def("_read_study", &read_table, py::arg("folder"),
             "The evaluations in FOLDER/study.sqlite; may be running.");
  module.def(
      "_run_study",
      [](const ReadCase& input, const std::string& folder, bool resume,
         int jobs, double time_limit, bool estimate_errors, bool pictures,
         bool frames, bool report, const py::object& progress) {
        run_study_in(input,
                     {.folder = folder,
                      .resume = resume,
                      .jobs = jobs,
                      .time_limit = time_limit,
                      .estimate_errors = estimate_errors,
                      .pictures = pictures,
                      .frames = frames,
                      .report = report},
                     progress);
      },
      py::arg("case"), py::arg("folder"), py::arg("resume"), py::arg("jobs"),
      py::arg("time_limit"), py::arg("estimate_errors"), py::arg("pictures"),
      py::arg("frames"), py::arg("report"), py::arg("progress"),
      "Runs the case's study into a folder.");
}

}  // namespace meniscus::python
