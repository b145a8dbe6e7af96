#include "pipeline/reader/case_reader.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/files/content_hash.h"
#include "pipeline/reader/case_reader_content.h"
#include "pipeline/reader/case_reader_overrides.h"
#include "pipeline/reader/case_reader_tables.h"
#include "pipeline/reader/family_members.h"
#include "pipeline/shells/shell_checks.h"

namespace meniscus::reader {

namespace {

constexpr std::size_t kLargestFile = 4U << 20U;  // byte; cases are kilobytes

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

void read_content(const std::string& text, case_data::CaseProblems& problems,
                  case_data::Case& result) {
  if (is_blank(text)) {
    problems.add(0,
                 "the file is empty; `meniscus new NAME` writes a case to "
                 "start from");
    return;
  }
  if (const int line = line_of_deep_key(text)) {
    problems.add(line,
                 "a key of more than 30 dotted parts; no key has so many");
    return;
  }
  try {
    toml::table root = toml::parse(std::string_view(text));
    OverriddenNodes overridden =
        apply_overrides(root, result.overrides, problems);
    let_parameters_scatter(root, overridden);
    read_tables(root, overridden, problems, result);
    const bool is_read = problems.empty();
    if (is_read) {
      case_data::fix_curves(result);
    }
    case_data::check_case(result, problems);
    if (is_read) {
      shells::check_shells(result, problems);
    }
    std::string files;
    for (const case_data::CaseFile& file : result.files) {
      files += fmt::format("file {}:{}", file.text.size(), file.text);
    }
    result.hash = files::content_hash(canonical_text(root) + files);
    result.answer_hash =
        files::content_hash(canonical_answer_text(root) + files);
  } catch (const toml::parse_error& error) {
    const std::string_view reason = error.description();
    // What it says of a line's end within a string.
    const bool unclosed = reason.find("parsing string") != reason.npos &&
                          reason.find("control char") != reason.npos;
    problems.add(static_cast<int>(error.source().begin.line),
                 fmt::format("this is not TOML: {} (column {}){}", reason,
                             error.source().begin.column,
                             unclosed ? "; is a closing quote missing?" : ""));
  }
}

}  // namespace

CaseReading read_case_text(const std::string& text, const std::string& path,
                           const std::vector<std::string>& overrides,
                           std::vector<case_data::CaseFile> files) {
  case_data::Case result;
  result.files = std::move(files);
  result.path = path;
  result.name = case_data::case_name(path);
  result.text = text;
  result.overrides = overrides;
  case_data::CaseProblems problems(path, overrides);
  read_content(text, problems, result);
  CaseReading reading;
  reading.problems = problems.take();
  reading.warnings = problems.take_warnings();
  if (reading.problems.empty()) {
    reading.problems = member_problems(result);
  }
  if (reading.problems.empty()) {
    reading.input = std::move(result);
  }
  return reading;
}

CaseReading read_case_file(const std::string& path,
                           const std::vector<std::string>& overrides) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& what) {
    CaseReading reading;
    reading.problems.push_back(fmt::format("{}: {}", path, what));
    return reading;
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    return refuse("this is a folder; name the case file in it (case.toml)");
  }
  if (!fs::exists(status)) {
    return refuse("there is no such file");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return refuse("cannot be read: no permission");
  }
  std::string text(kLargestFile + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) {
    return refuse("cannot be read: the device reports an error");
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kLargestFile) {
    return refuse(
        fmt::format("larger than {} MB: not a case file", kLargestFile >> 20U));
  }
  return read_case_text(text, path, overrides);
}

case_data::Case read_case(const std::string& path,
                          const std::vector<std::string>& overrides) {
  CaseReading reading = read_case_file(path, overrides);
  if (!reading.input) {
    throw InvalidInput(fmt::format("{}", fmt::join(reading.problems, "\n")));
  }
  return *std::move(reading.input);
}

}  // namespace meniscus::reader
