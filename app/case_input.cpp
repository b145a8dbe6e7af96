#include "app/case_input.h"

#include <cstdio>
#include <span>

#include <fmt/format.h>

#include "app/signals.h"
#include "core/error.h"
#include "core/math/expression.h"
#include "pipeline/store/stored_case.h"

namespace meniscus::app {

namespace {

std::vector<std::string> start_overrides(const CommonArguments& common,
                                         const case_data::Case& input) {
  try {
    return store::answer_as_overrides(common.from, input);
  } catch (const IoError& error) {
    throw InvalidInput(fmt::format("--from {}: {}", common.from, error.what()));
  }
}

/// With the answer of `common.from` as the start, but for what --set says: of
/// two overrides of a name the later counts.
reader::CaseReading read_case(const std::string& path,
                              const CommonArguments& common) {
  reader::CaseReading reading = reader::read_case_file(path, common.overrides);
  if (common.from.empty() || !reading.input) {
    return reading;
  }
  std::vector<std::string> overrides = start_overrides(common, *reading.input);
  overrides.insert(overrides.end(), common.overrides.begin(),
                   common.overrides.end());
  return reader::read_case_file(path, overrides);
}

}  // namespace

reader::CaseReading read_and_report_case(const std::string& path,
                                         const CommonArguments& common) {
  reader::CaseReading reading = read_case(path, common);
  for (const std::string& problem : reading.problems) {
    std::fprintf(stderr, "%s\n", problem.c_str());
  }
  if (!common.quiet) {
    for (const std::string& warning : reading.warnings) {
      std::fprintf(stderr, "%s\n", warning.c_str());
    }
  }
  return reading;
}

std::filesystem::path results_folder(const case_data::Case& input,
                                     const std::string& out) {
  return out.empty() ? std::filesystem::path("results") / input.name
                     : std::filesystem::path(out);
}

std::filesystem::path folder_without_run(const std::string& name,
                                         const std::string& out,
                                         const std::string& ending) {
  namespace fs = std::filesystem;
  const auto holds_run = [](const fs::path& folder) {
    return fs::exists(folder / "study.sqlite") ||
           fs::exists(folder / "family.csv");
  };
  const fs::path usual = fs::path("results") / name;
  if (out.empty()) {
    return holds_run(usual) ? fs::path(usual.string() + ending) : usual;
  }
  if (holds_run(out)) {
    throw IoError(fmt::format(
        "{} holds a run: what is of another design would stand beside its "
        "figures; name another folder by --out",
        out));
  }
  return out;
}

std::pair<std::string, std::string> named_text(const std::string& option,
                                               const std::string& text,
                                               const char* expected) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0) {
    throw InvalidInput(
        fmt::format("{} {}: expected {}", option, text, expected));
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

std::pair<std::string, double> named_number(const std::string& option,
                                            const std::string& text) {
  const auto [name, value] = named_text(option, text, "NAME=VALUE");
  try {
    return {name,
            Expression::parse(value, {}).evaluate(std::span<const double>())};
  } catch (const ExpressionError& error) {
    throw InvalidInput(fmt::format("{} {}: {}", option, text, error.what()));
  }
}

TerminalMonitorOptions monitor_options(const CommonArguments& common) {
  return {.style = common.quiet ? MonitorStyle::Quiet : MonitorStyle::Automatic,
          .log_file = common.log,
          .stop = [] { return stop_signal() != 0; }};
}

}  // namespace meniscus::app
