#include <algorithm>

#include <fmt/format.h>

#include "pipeline/reader/case_reader_fields.h"

namespace meniscus::reader {

namespace {

const toml::array* triple(const toml::node& node) {
  const toml::array* array = node.as_array();
  return array != nullptr && array->size() == 3 ? array : nullptr;
}

/// A point of a list: [x, y, z], { through = [x, y, z] } or
/// { at = [x, y, z], repeat = n }; no `three` when it is none of them.
struct PointNode {
  const toml::array* three = nullptr;
  bool repeated = false;
};

PointNode point_node(const toml::node& item) {
  const toml::table* table = item.as_table();
  if (table == nullptr) {
    return {triple(item), false};
  }
  const bool repeated = table->size() == 2 && table->contains("repeat");
  const toml::node* at = repeated             ? table->get("at")
                         : table->size() == 1 ? table->get("through")
                                              : nullptr;
  return {at == nullptr ? nullptr : triple(*at), repeated};
}

/// read(item, path) of each component; all are read, so that all are reported.
template <class Read>
auto components(const toml::array& array, const std::string& path,
                const Read& read) {
  using Component = typename decltype(read(array[0], path))::value_type;
  std::array<Component, 3> result;
  bool good = true;
  for (std::size_t k = 0; k < 3; ++k) {
    auto component = read(array[k], fmt::format("{}[{}]", path, "xyz"[k]));
    good = good && component.has_value();
    result[k] = std::move(component).value_or(Component{});
  }
  return good ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace

const toml::array* CaseTable::three(const char* key, const char* wanted) const {
  if (!has(key)) {
    return nullptr;
  }
  const toml::array* array = triple(*node(key));
  if (array == nullptr) {
    note(key, wanted);
  }
  return array;
}

std::optional<case_data::QuantityVector> CaseTable::vector(
    const char* key) const {
  const toml::array* array = three(key, "[x, y, z]");
  if (array == nullptr) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  const std::string whole = fmt::format("{}.{}", path_, key);
  auto result = components(
      *array, whole, [&](const toml::node& item, const std::string& path) {
        return read_quantity(*context_, item, dimension(key), path);
      });
  if (result) {
    require_alike(
        {(*result)[0].measure, (*result)[1].measure, (*result)[2].measure},
        *array, whole);
  }
  return result;
}

void CaseTable::require_alike(const std::array<Measure, 3>& measures,
                              const toml::node& node,
                              const std::string& path) const {
  const Measure* first = nullptr;
  for (const Measure& measure : measures) {
    if (!measure.is_known()) {
      continue;
    }
    if (first != nullptr && !(first->powers == measure.powers)) {
      context_->problems.add(
          context_->line_of(node),
          fmt::format("{} has {} beside {}; components are of one dimension",
                      path, described(first->powers),
                      described(measure.powers)));
      return;
    }
    first = &measure;
  }
}

std::vector<case_data::QuantityVector> CaseTable::vectors(
    const char* key) const {
  std::vector<case_data::QuantityVector> result;
  for (case_data::PathPoint& point : path_points(key)) {
    if (point.through) {
      context_->problems.add(
          point.at[0].line,
          fmt::format("{}.{}: only a polyline knows 'through'; expected a "
                      "point [x, y, z]",
                      path_, key));
    }
    result.push_back(std::move(point.at));
  }
  return result;
}

std::vector<Triangle> CaseTable::facets(const char* key,
                                        std::ptrdiff_t vertices) const {
  std::vector<Triangle> result;
  if (!has(key)) {
    return result;
  }
  const toml::array* array = node(key)->as_array();
  for (std::size_t f = 0; array != nullptr && f < array->size(); ++f) {
    const toml::node& item = (*array)[f];
    const toml::array* corners = item.as_array();
    std::vector<int> found;
    for (std::size_t k = 0; corners != nullptr && k < corners->size(); ++k) {
      const auto v = (*corners)[k].value_exact<std::int64_t>();
      if (v && *v >= 0 && *v < vertices) {
        found.push_back(static_cast<int>(*v));
      }
    }
    if (corners == nullptr || found.size() < 3 ||
        found.size() != corners->size()) {
      context_->problems.add(
          context_->line_of(item),
          fmt::format("{}.{}[{}]: expected three or more numbers of vertices, "
                      "from 0 to {}: [0, 1, 2]",
                      path_, key, f, vertices - 1));
      continue;
    }
    for (std::size_t k = 2; k < found.size(); ++k) {
      result.push_back({found[0], found[k - 1], found[k]});
    }
  }
  if (array == nullptr || array->empty()) {
    note(key, "facets: [[0, 1, 2], [0, 2, 3], ...]");
  }
  return result;
}

std::vector<case_data::PathPoint> CaseTable::path_points(
    const char* key) const {
  std::vector<case_data::PathPoint> result;
  if (!has(key)) {
    return result;
  }
  const toml::array* array = node(key)->as_array();
  if (array == nullptr || array->empty()) {
    note(key, "points: [[x, y, z], [x, y, z], ...]");
    return result;
  }
  for (std::size_t p = 0; p < array->size(); ++p) {
    const toml::node& item = (*array)[p];
    const std::string path = fmt::format("{}.{}[{}]", path_, key, p);
    const PointNode point = point_node(item);
    if (point.three == nullptr) {
      context_->problems.add(
          context_->line_of(item),
          fmt::format(
              "{} is {}; expected a point [x, y, z], {{ at = [x, y, z], "
              "repeat = n }} for several, or in a polyline {{ through = "
              "[x, y, z] }} for an arc",
              path, described(item)));
      continue;
    }
    const std::vector<std::vector<int>> copies =
        point.repeated ? copies_in(key, *item.as_table())
                       : std::vector<std::vector<int>>{indices_};
    for (const std::vector<int>& indices : copies) {
      const IndexScope scope(*context_, indices);
      auto at = components(
          *point.three, path,
          [&](const toml::node& part, const std::string& name) {
            return read_quantity(*context_, part, dimension(key), name);
          });
      result.push_back({std::move(at).value_or(case_data::QuantityVector{}),
                        item.is_table() && !point.repeated});
      result.back().at[0].line = context_->line_of(item);
    }
  }
  return result;
}

std::optional<Vec3> CaseTable::constants_of(const toml::node& node,
                                            std::optional<Dimension> dimension,
                                            const std::string& path) const {
  const toml::array* array = triple(node);
  if (array == nullptr) {
    return std::nullopt;
  }
  const auto values = components(
      *array, path, [&](const toml::node& item, const std::string& at) {
        return read_measured(*context_, item, dimension, at);
      });
  if (!values) {
    return std::nullopt;
  }
  const auto& [x, y, z] = *values;
  require_alike({x.measure, y.measure, z.measure}, node, path);
  return Vec3(x.value, y.value, z.value);
}

std::optional<Vec3> CaseTable::constant_vector(const char* key) const {
  if (three(key, "three constants") == nullptr) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  return constants_of(*node(key), dimension(key),
                      fmt::format("{}.{}", path_, key));
}

std::optional<Vec3> CaseTable::constant_vector(const char* key,
                                               Dimension dimension) const {
  if (three(key, "three constants") == nullptr) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  return constants_of(*node(key), dimension, fmt::format("{}.{}", path_, key));
}

std::optional<std::array<case_data::PlaceQuantity, 3>> CaseTable::place_vector(
    const char* key) const {
  const toml::array* array = three(key, "[x, y, z]");
  if (array == nullptr) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  return components(*array, fmt::format("{}.{}", path_, key),
                    [&](const toml::node& item, const std::string& path) {
                      return read_place_quantity(*context_, item,
                                                 dimension(key), path);
                    });
}

std::optional<element::LocalAxes> CaseTable::axes(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const toml::array* array = node(key)->as_array();
  element::LocalAxes axes;
  const IndexScope scope(*context_, indices_);
  const std::size_t before = context_->problems.size();
  for (std::size_t k = 0; k < 2 && array != nullptr && array->size() == 2;
       ++k) {
    const auto v = constants_of(*array->get(k), dimension(key),
                                fmt::format("{}.{}[{}]", path_, key, k));
    if (!v) {
      array = nullptr;
    } else {
      (k == 0 ? axes.first : axes.second) = *v;
    }
  }
  if (array == nullptr || array->size() != 2 || !element::span_a_plane(axes)) {
    if (context_->problems.size() == before) {
      note(key, "two directions that span a plane: [[1, 0, 0], [0, 1, 0]]");
    }
    return std::nullopt;
  }
  return axes;
}

}  // namespace meniscus::reader
