#include "pipeline/reader/family_members.h"

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/case_data/study_kinds.h"
#include "pipeline/members/member_file.h"

namespace meniscus::reader {

namespace {

/// A member's problem at the member's own place.
std::string with_location(const case_data::Case& family,
                          const case_data::MemberEntry& member,
                          const std::string& problem) {
  std::string what = problem;
  for (const std::string& override : member.overrides) {
    const std::string before =
        fmt::format("{}: --set {}: ", family.path, override);
    if (problem.starts_with(before)) {
      what = fmt::format("{}: {}", override, problem.substr(before.size()));
    }
  }
  return fmt::format("{}: member '{}': {}", member.place, member.name, what);
}

}  // namespace

CaseReading read_family_member(const case_data::Case& family,
                               const case_data::MemberEntry& member) {
  std::vector<std::string> overrides = family.overrides;
  overrides.insert(overrides.end(), member.overrides.begin(),
                   member.overrides.end());
  // Last, so that a member is never a family itself.
  overrides.push_back(
      fmt::format("study.kind={}", case_data::row_of(family.study.kind).name));
  CaseReading reading =
      read_case_text(family.text, family.path, overrides, family.files);
  for (std::string& problem : reading.problems) {
    problem = with_location(family, member, problem);
  }
  if (reading.input) {
    reading.input->title += ": " + member.name;
  }
  return reading;
}

std::vector<std::string> member_problems(const case_data::Case& family) {
  std::vector<std::string> problems;
  std::size_t more = 0;
  for (const case_data::MemberEntry& member : family.study.members) {
    for (std::string& problem : read_family_member(family, member).problems) {
      if (problems.size() < members::kMostProblems) {
        problems.push_back(std::move(problem));
      } else {
        ++more;
      }
    }
  }
  if (more > 0) {
    problems.push_back(fmt::format("... and {} more problems", more));
  }
  return problems;
}

std::vector<case_data::Case> family_cases(const case_data::Case& family) {
  std::vector<case_data::Case> cases;
  cases.reserve(family.study.members.size());
  for (const case_data::MemberEntry& member : family.study.members) {
    CaseReading reading = read_family_member(family, member);
    if (!reading.input) {
      throw InvalidInput(fmt::format("{}", fmt::join(reading.problems, "\n")));
    }
    cases.push_back(*std::move(reading.input));
  }
  return cases;
}

VectorX member_numbers(const case_data::Case& member) {
  std::vector<double> numbers;
  for (const auto& [name, value] :
       case_data::parameter_values(member, case_data::initial_design(member))) {
    numbers.push_back(value);
  }
  for (const case_data::DesignVariable& variable : member.design) {
    numbers.insert(numbers.end(),
                   {variable.initial, variable.lower, variable.upper});
  }
  return Eigen::Map<const VectorX>(numbers.data(), std::ssize(numbers));
}

}  // namespace meniscus::reader
