#include "io/calculix_frd.h"

#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace meniscus::io {

namespace {

using FrdOut = std::back_insert_iterator<fmt::memory_buffer>;

constexpr double kFrdLargest = 9.9e99;  // exponents have two digits
constexpr double kFrdLeast = 1e-99;
constexpr int kFrdFirstSet = 100;

struct FrdLayout {
  const char* name;
  int components;
  std::vector<const char*> lines;
};

const FrdLayout& layout_of(FrdKind kind) {
  static const std::array<FrdLayout, 3> kLayouts = {
      {{"DISP",
        3,
        {" -4  DISP        4    1", " -5  D1          1    2    1    0",
         " -5  D2          1    2    2    0",
         " -5  D3          1    2    3    0",
         " -5  ALL         1    2    0    0    1ALL"}},
       {"FORC",
        3,
        {" -4  FORC        4    1", " -5  F1          1    2    1    0",
         " -5  F2          1    2    2    0",
         " -5  F3          1    2    3    0",
         " -5  ALL         1    2    0    0    1ALL"}},
       {"STRESS",
        6,
        {" -4  STRESS      6    1", " -5  SXX         1    4    1    1",
         " -5  SYY         1    4    2    2",
         " -5  SZZ         1    4    3    3",
         " -5  SXY         1    4    1    2",
         " -5  SYZ         1    4    2    3",
         " -5  SZX         1    4    3    1"}}}};
  return kLayouts[static_cast<std::size_t>(kind)];
}

/// Twelve characters.
std::string frd_number(double value) {
  if (std::abs(value) < kFrdLeast) {
    value = 0.0;
  }
  if (!(std::abs(value) <= kFrdLargest)) {
    value = std::copysign(kFrdLargest, value);
  }
  return fmt::format("{:12.5E}", value);
}

/// Twelve characters with as many digits as they hold.
std::string frd_value(double value) {
  constexpr int kWidth = 12;
  std::string text;
  for (int digits = kWidth - 2; digits > 4; --digits) {
    text = fmt::format("{:#.{}g}", value, digits);
    if (static_cast<int>(text.size()) < kWidth) {
      break;
    }
  }
  return fmt::format("{:>12}", text);
}

class FrdWriter {
 public:
  FrdWriter(const TetMesh& mesh, const FrdOptions& options)
      : mesh_(mesh), options_(options) {}

  std::string text(const std::vector<FrdResult>& results) {
    head();
    nodes();
    elements();
    for (std::size_t k = 0; k < results.size(); ++k) {
      for (const FrdField& field : results[k].fields) {
        block(results[k], static_cast<int>(k) + 1, field);
      }
    }
    add(" 9999\n");
    return fmt::to_string(buffer_);
  }

 private:
  void add(std::string_view line) {
    buffer_.append(line.data(), line.data() + line.size());
  }

  FrdOut out() { return std::back_inserter(buffer_); }

  void head() {
    add("    1C\n");
    fmt::format_to(out(), "    1UPGM               {}\n",
                   one_line(options_.notes.program));
    for (const std::string& line : comment_lines(options_.notes)) {
      fmt::format_to(out(), "    1UUSER              {}\n", line);
    }
    for (std::size_t r = 0; r < options_.materials.size(); ++r) {
      fmt::format_to(out(), "    1UMAT{:>5}{}\n", r + 1,
                     one_line(options_.materials[r]));
    }
  }

  int node_number(std::size_t node) const {
    return options_.node_numbers.empty() ? static_cast<int>(node) + 1
                                         : options_.node_numbers[node];
  }

  void nodes() {
    fmt::format_to(out(), "    2C{:>30}{:>38}\n", mesh_.nodes.size(), 1);
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
      fmt::format_to(out(), " -1{:>10}", node_number(i));
      for (const double x : mesh_.nodes[i]) {
        add(frd_number(x));
      }
      add("\n");
    }
    add(" -3\n");
  }

  void elements() {
    constexpr int kTet4 = 3;  // cgx's types of elements
    constexpr int kTet10 = 6;
    fmt::format_to(out(), "    3C{:>30}{:>38}\n", mesh_.element_count(), 1);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const auto at = static_cast<std::size_t>(e);
      const int number = options_.element_numbers.empty()
                             ? e + 1
                             : options_.element_numbers[at];
      fmt::format_to(out(), " -1{:>10}{:>5}{:>5}{:>5}\n -2", number,
                     mesh_.order == 1 ? kTet4 : kTet10, 0,
                     mesh_.element_region[at] + 1);
      for (const int node : mesh_.element(e)) {
        fmt::format_to(out(), "{:>10}",
                       node_number(static_cast<std::size_t>(node)));
      }
      add("\n");
    }
    add(" -3\n");
  }

  void block(const FrdResult& result, int number, const FrdField& field) {
    const FrdLayout& layout = layout_of(field.kind);
    constexpr std::array<int, 3> kAnalysis = {0, 2, 4};  // cgx's numbers
    const bool modal = result.analysis == FrdAnalysis::Frequency;
    fmt::format_to(out(), "    1PSTEP{:>26}{:>12}{:>12}\n", number, 1,
                   result.step);
    if (modal) {
      fmt::format_to(out(), "    1PMODE{:>26}\n", result.mode);
    }
    fmt::format_to(out(), "  100CL{:>5}{}{:>12}{:>22}{:>5}{:<10}{:>2}\n",
                   kFrdFirstSet + number, frd_value(result.value),
                   mesh_.nodes.size(),
                   kAnalysis[static_cast<std::size_t>(result.analysis)], number,
                   modal ? "MODAL" : "", 1);
    for (const char* line : layout.lines) {
      add(line);
      add("\n");
    }
    const auto width = static_cast<std::size_t>(layout.components);
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
      fmt::format_to(out(), " -1{:>10}", node_number(i));
      for (std::size_t k = 0; k < width; ++k) {
        add(frd_number(field.values[width * i + k]));
      }
      add("\n");
    }
    add(" -3\n");
  }

  const TetMesh& mesh_;
  const FrdOptions& options_;
  fmt::memory_buffer buffer_;
};

void check_frd(const std::filesystem::path& path, const TetMesh& mesh,
               const std::vector<FrdResult>& results,
               const FrdOptions& options) {
  const auto fits = [](std::size_t size, std::size_t expected) {
    return size == 0 || size == expected;
  };
  bool good = fits(options.node_numbers.size(), mesh.nodes.size()) &&
              fits(options.element_numbers.size(),
                   static_cast<std::size_t>(mesh.element_count()));
  for (const FrdResult& result : results) {
    for (const FrdField& field : result.fields) {
      good = good &&
             field.values.size() ==
                 static_cast<std::size_t>(layout_of(field.kind).components) *
                     mesh.nodes.size();
    }
  }
  if (!good) {
    throw InvalidInput(fmt::format(
        "numbers or fields for '{}' do not fit the mesh of {} nodes and {} "
        "elements",
        path.string(), mesh.nodes.size(), mesh.element_count()));
  }
}

}  // namespace

void write_frd(const std::filesystem::path& path, const TetMesh& mesh,
               const std::vector<FrdResult>& results,
               const FrdOptions& options) {
  check_frd(path, mesh, results, options);
  write_file(path, FrdWriter(mesh, options).text(results));
}

}  // namespace meniscus::io
