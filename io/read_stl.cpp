#include "io/read_stl.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/geometry/outlier.h"
#include "io/stl.h"

namespace meniscus::io {

namespace {

constexpr std::size_t kHeadBytes = 84;  // of a binary file

class StlReader {
 public:
  StlReader(const std::string& text, const std::string& path)
      : text_(text), path_(path) {}

  SurfaceMesh read();

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InvalidInput(fmt::format("{}:{}: {}", path_, line_, what));
  }
  void skip_space(bool over_lines);
  std::string word();
  std::string rest_of_line();
  void expect(const char* wanted);
  double number();
  void solid();
  void facet();
  int point();
  int known(const std::array<double, 3>& x);
  void add_facet(int a, int b, int c);
  void refuse_outlier() const;
  SurfaceMesh binary();

  const std::string& text_;
  const std::string& path_;
  std::size_t at_ = 0;
  int line_ = 1;  // in a binary file: the facet
  bool is_binary_ = false;
  SurfaceMesh mesh_;
  std::map<std::array<double, 3>, int> known_;
  std::vector<int> first_;  // of each point: its line, in binary its facet
};

void StlReader::skip_space(bool over_lines) {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    const bool space = c == ' ' || c == '\t' || c == '\r';
    if (!space && !(c == '\n' && over_lines)) {
      return;
    }
    line_ += c == '\n' ? 1 : 0;
    ++at_;
  }
}

std::string StlReader::word() {
  skip_space(true);
  const std::size_t end =
      std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
  std::string found = text_.substr(at_, end - at_);
  at_ = end;
  return found;
}

std::string StlReader::rest_of_line() {
  skip_space(false);
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  std::string found = text_.substr(at_, end - at_);
  at_ = end;
  const std::size_t last = found.find_last_not_of(" \t\r");
  return last == std::string::npos ? "" : found.substr(0, last + 1);
}

void StlReader::expect(const char* wanted) {
  const std::string found = word();
  if (found != wanted) {
    refuse(fmt::format("found '{}'; expected '{}' of an ASCII STL file",
                       found.substr(0, 40), wanted));
  }
}

double StlReader::number() {
  const std::string found = word();
  const char* begin = found.data() + (found.starts_with('+') ? 1 : 0);
  const char* end = found.data() + found.size();
  double value = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    refuse(
        fmt::format("found '{}'; expected a coordinate", found.substr(0, 40)));
  }
  return value + 0.0;  // -0 is 0
}

int StlReader::point() {
  expect("vertex");
  std::array<double, 3> x{};
  for (double& coordinate : x) {
    coordinate = number();
  }
  return known(x);
}

int StlReader::known(const std::array<double, 3>& x) {
  const auto [entry, is_new] =
      known_.emplace(x, static_cast<int>(mesh_.points.size()));
  if (is_new) {
    mesh_.points.emplace_back(x[0], x[1], x[2]);
    first_.push_back(line_);
  }
  return entry->second;
}

/// Facets to a point far away would be cut into more than any machine holds.
void StlReader::refuse_outlier() const {
  const auto outlier = find_outlier(mesh_.points);
  if (outlier) {
    throw InvalidInput(
        fmt::format("{}:{}{}: {}", path_, is_binary_ ? "facet " : "",
                    first_[static_cast<std::size_t>(outlier->point)],
                    outlier_text(*outlier, mesh_.points)));
  }
}

/// After "facet".
void StlReader::facet() {
  expect("normal");
  for (int k = 0; k < 3; ++k) {
    word();  // some programs write nan
  }
  expect("outer");
  expect("loop");
  const int a = point();
  const int b = point();
  const int c = point();
  expect("endloop");
  expect("endfacet");
  add_facet(a, b, c);
}

void StlReader::add_facet(int a, int b, int c) {
  if (a != b && b != c && c != a) {
    mesh_.facets.push_back({a, b, c});
    mesh_.facet_label.push_back(static_cast<int>(mesh_.labels.size()) - 1);
  }
}

SurfaceMesh StlReader::binary() {
  mesh_.labels = {"unnamed"};
  is_binary_ = true;
  line_ = 0;
  for (std::size_t at = kHeadBytes; at < text_.size(); at += kStlFacetBytes) {
    std::array<float, 9> raw{};
    std::memcpy(raw.data(), text_.data() + at + 3 * sizeof(float), sizeof raw);
    std::array<int, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> x{};
      for (std::size_t i = 0; i < 3; ++i) {
        x[i] = raw[3 * k + i] + 0.0;  // -0 is 0
        if (!std::isfinite(x[i])) {
          throw InvalidInput(fmt::format(
              "{}: facet {} of the binary STL file has a coordinate that is "
              "not finite",
              path_, (at - kHeadBytes) / kStlFacetBytes));
        }
      }
      corner[k] = known(x);
    }
    add_facet(corner[0], corner[1], corner[2]);
    ++line_;
  }
  refuse_outlier();
  return std::move(mesh_);
}

/// The size that the facet count of a binary file asks for; 0: too short.
std::size_t binary_size(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() < kHeadBytes) {
    return 0;
  }
  std::memcpy(&count, bytes.data() + kHeadBytes - sizeof count, sizeof count);
  return kHeadBytes + kStlFacetBytes * count;
}

/// After "solid".
void StlReader::solid() {
  const std::string name = rest_of_line();
  if (name.empty()) {
    refuse("a solid without a name; write `solid NAME`, one for each face");
  }
  if (mesh_.label_of(name) >= 0) {
    refuse(fmt::format("a second solid '{}'; name each face once", name));
  }
  mesh_.labels.push_back(name);
  for (std::string next = word(); next != "endsolid"; next = word()) {
    if (next != "facet") {
      refuse(
          fmt::format("found '{}' in solid '{}'; expected 'facet' or "
                      "'endsolid'",
                      next.substr(0, 40), name));
    }
    facet();
  }
  rest_of_line();
}

SurfaceMesh StlReader::read() {
  const std::size_t size = binary_size(text_);
  if (size > kHeadBytes && size == text_.size()) {
    return binary();
  }
  if (text_.find('\0') != std::string::npos) {
    throw InvalidInput(fmt::format(
        "{}: neither an ASCII STL file nor a whole binary one: {} bytes, found "
        "{}",
        path_,
        size == 0 ? "at least 84" : fmt::format("its facets need {}", size),
        text_.size()));
  }
  for (std::string next = word(); !next.empty(); next = word()) {
    if (next != "solid") {
      refuse(
          fmt::format("found '{}'; expected 'solid NAME' of an ASCII STL "
                      "file",
                      next.substr(0, 40)));
    }
    solid();
  }
  if (mesh_.facets.empty()) {
    refuse("the file has no facets");
  }
  refuse_outlier();
  return std::move(mesh_);
}

}  // namespace

SurfaceMesh read_stl_text(const std::string& text, const std::string& path) {
  return StlReader(text, path).read();
}

SurfaceMesh read_stl(const std::filesystem::path& path) {
  return read_stl_text(read_file(path), path.string());
}

}  // namespace meniscus::io
