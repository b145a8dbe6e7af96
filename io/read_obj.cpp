#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/geometry/outlier.h"
#include "io/obj.h"

namespace meniscus::io {

namespace {

constexpr std::size_t kShown = 40;  // characters of what was found

/// Statements that say nothing about the shape.
const std::set<std::string_view>& left_out() {
  static const std::set<std::string_view> words = {
      "vt", "vn", "vp", "s", "l", "p", "mtllib", "usemtl", "mg"};
  return words;
}

class Reader {
 public:
  Reader(const std::string& text, const std::string& path)
      : text_(text), path_(path) {}

  SurfaceMesh read() {
    while (at_ < text_.size()) {
      statement(next_line());
    }
    line_ = std::max(line_, 1);
    if (mesh_.facets.empty()) {
      refuse("the file has no faces; expected an OBJ file with 'f' lines");
    }
    refuse_outlier();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InvalidInput(fmt::format("{}:{}: {}", path_, line_, what));
  }

  /// Facets to a point far away would be cut into more than any machine holds.
  void refuse_outlier() {
    Points used;
    std::vector<int> lines;
    std::vector<char> seen(mesh_.points.size(), 0);
    for (const Triangle& facet : mesh_.facets) {
      for (const int v : facet) {
        const auto at = static_cast<std::size_t>(v);
        if (seen[at] == 0) {
          seen[at] = 1;
          used.push_back(mesh_.points[at]);
          lines.push_back(first_[at]);
        }
      }
    }
    if (const auto outlier = find_outlier(used)) {
      line_ = lines[static_cast<std::size_t>(outlier->point)];
      refuse(outlier_text(*outlier, used));
    }
  }

  /// With '\' at its end a line goes on in the next one.
  std::string next_line() {
    std::string line;
    bool goes_on = true;
    while (goes_on && at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string part = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++line_;
      if (part.ends_with('\r')) {
        part.pop_back();
      }
      goes_on = part.ends_with('\\');
      if (goes_on) {
        part.back() = ' ';
      }
      line += part;
    }
    return line.substr(0, line.find('#'));
  }

  static std::vector<std::string_view> words_of(std::string_view line) {
    constexpr const char* kSpace = " \t";
    std::vector<std::string_view> words;
    std::size_t at = line.find_first_not_of(kSpace);
    while (at != std::string_view::npos) {
      const std::size_t end =
          std::min(line.find_first_of(kSpace, at), line.size());
      words.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(kSpace, end);
    }
    return words;
  }

  void statement(const std::string& line) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || left_out().contains(words[0])) {
      return;
    }
    if (words[0] == "v") {
      vertex(words);
    } else if (words[0] == "f") {
      face(words);
    } else if (words[0] == "g" || words[0] == "o") {
      const bool group = words[0] == "g";
      (group ? group_ : object_) = words.size() > 1 ? words[1] : "";
      if (!group) {
        group_.clear();
      }
    } else {
      refuse(
          fmt::format("found '{}'; expected a statement of an OBJ file (v, "
                      "f, g, o, ...)",
                      words[0].substr(0, kShown)));
    }
  }

  double coordinate(std::string_view word) const {
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) {
      refuse(fmt::format("found '{}'; expected a coordinate",
                         word.substr(0, kShown)));
    }
    return value + 0.0;  // -0 is 0
  }

  void vertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      refuse(fmt::format("a vertex with {} numbers; expected 3 coordinates",
                         words.size() - 1));
    }
    const std::array<double, 3> x = {coordinate(words[1]), coordinate(words[2]),
                                     coordinate(words[3])};
    const auto [entry, is_new] =
        known_.emplace(x, static_cast<int>(mesh_.points.size()));
    if (is_new) {
      mesh_.points.emplace_back(x[0], x[1], x[2]);
      first_.push_back(line_);
    }
    vertices_.push_back(entry->second);
  }

  /// "7", "7/1", "7//3", "-1": the last vertex so far.
  int corner(std::string_view word) const {
    const std::string_view number = word.substr(0, word.find('/'));
    const char* end = number.data() + number.size();
    int id = 0;
    const auto [stop, error] = std::from_chars(number.data(), end, id);
    const int count = static_cast<int>(vertices_.size());
    const int index = id < 0 ? count + id : id - 1;
    if (error != std::errc() || stop != end || index < 0 || index >= count) {
      refuse(
          fmt::format("found '{}'; expected one of the {} vertices before "
                      "this line",
                      word.substr(0, kShown), count));
    }
    return vertices_[static_cast<std::size_t>(index)];
  }

  int label() {
    const std::string name = !group_.empty()    ? group_
                             : !object_.empty() ? object_
                                                : "unnamed";
    const auto [entry, is_new] =
        labels_.emplace(name, static_cast<int>(mesh_.labels.size()));
    if (is_new) {
      mesh_.labels.push_back(name);
    }
    return entry->second;
  }

  void face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      refuse(fmt::format("a face with {} corners; expected 3 or more",
                         words.size() - 1));
    }
    const int own = label();
    const int a = corner(words[1]);
    int b = corner(words[2]);
    for (std::size_t k = 3; k < words.size(); ++k) {
      const int c = corner(words[k]);
      if (a != b && b != c && c != a) {
        mesh_.facets.push_back({a, b, c});
        mesh_.facet_label.push_back(own);
      }
      b = c;
    }
  }

  const std::string& text_;
  const std::string& path_;
  std::size_t at_ = 0;
  int line_ = 0;
  SurfaceMesh mesh_;
  std::string group_;
  std::string object_;
  std::vector<int> vertices_;  // of the file: points
  std::map<std::array<double, 3>, int> known_;
  std::vector<int> first_;  // of each point: its line
  std::map<std::string, int> labels_;
};

}  // namespace

SurfaceMesh read_obj_text(const std::string& text, const std::string& path) {
  return Reader(text, path).read();
}

SurfaceMesh read_obj(const std::filesystem::path& path) {
  return read_obj_text(read_file(path), path.string());
}

}  // namespace meniscus::io
