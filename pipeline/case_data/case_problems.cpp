#include "pipeline/case_data/case_problems.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/nearest_name.h"

namespace meniscus::case_data {

namespace {

constexpr std::size_t kMostProblems = 20;
constexpr std::size_t kMostKnown = 15;  // names listed in one message

/// Of a copy's name where nothing is counted.
std::string copies_advice(const std::vector<std::string>& known) {
  return "; braces count copies: give this table repeat = N, or write a "
         "copy's name" +
         (known.empty() ? "" : ", as '" + known.front() + "'");
}

}  // namespace

std::string advice(const std::string& name,
                   const std::vector<std::string>& known) {
  const std::string near = nearest_name(name, known);
  if (!near.empty()) {
    return "; did you mean '" + near + "'?";
  }
  if (known.empty()) {
    return "; none is defined";
  }
  const std::size_t shown = std::min(known.size(), kMostKnown);
  return fmt::format(
      "; there {} {}{}", known.size() == 1 ? "is" : "are",
      fmt::join(known.begin(),
                known.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
      shown < known.size() ? fmt::format(" and {} more", known.size() - shown)
                           : "");
}

std::string CaseProblems::with_location(SourceLine line,
                                        const std::string& message) const {
  if (line > 0) {
    return fmt::format("{}:{}: {}", path_, line, message);
  }
  return line == 0
             ? fmt::format("{}: {}", path_, message)
             : fmt::format("{}: --set {}: {}", path_,
                           overrides_[static_cast<std::size_t>(-line - 1)],
                           message);
}

void CaseProblems::add(SourceLine line, const std::string& message) {
  problems_.push_back({line, with_location(line, message)});
}

void CaseProblems::add_text(const std::string& message) {
  const auto same = [&](const Entry& e) { return e.text == message; };
  if (std::none_of(problems_.begin(), problems_.end(), same)) {
    problems_.push_back({0, message});
  }
}

void CaseProblems::warn(SourceLine line, const std::string& message) {
  Entry entry{line, with_location(line, "warning: " + message)};
  // What several bodies share is told once.
  if (std::none_of(warnings_.begin(), warnings_.end(), [&](const Entry& other) {
        return other.text == entry.text;
      })) {
    warnings_.push_back(std::move(entry));
  }
}

void CaseProblems::unknown(SourceLine line, const char* what,
                           const std::string& name,
                           const std::vector<std::string>& known) {
  const bool counts = name.find('{') != std::string::npos;
  add(line, fmt::format("there is no {} '{}'{}", what, name,
                        counts ? copies_advice(known) : advice(name, known)));
}

std::vector<std::string> CaseProblems::take() {
  std::stable_sort(
      problems_.begin(), problems_.end(),
      [](const Entry& a, const Entry& b) { return a.line < b.line; });
  std::vector<std::string> texts;
  for (const Entry& entry : problems_) {
    if (texts.size() == kMostProblems) {
      texts.push_back(fmt::format("... and {} more problems",
                                  problems_.size() - kMostProblems));
      break;
    }
    texts.push_back(entry.text);
  }
  return texts;
}

std::vector<std::string> CaseProblems::take_warnings() {
  std::stable_sort(
      warnings_.begin(), warnings_.end(),
      [](const Entry& a, const Entry& b) { return a.line < b.line; });
  std::vector<std::string> texts;
  for (const Entry& entry : warnings_) {
    texts.push_back(entry.text);
  }
  return texts;
}

}  // namespace meniscus::case_data
