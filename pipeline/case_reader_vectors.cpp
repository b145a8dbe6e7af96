#include <algorithm>

#include <fmt/format.h>

#include "pipeline/case_reader_fields.h"

namespace meniscus {

namespace {

constexpr std::int64_t kMostCount = 1000;

const toml::array* triple(const toml::node& node) {
  const toml::array* array = node.as_array();
  return array != nullptr && array->size() == 3 ? array : nullptr;
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

std::optional<QuantityVector> CaseTable::vector(const char* key) const {
  const toml::array* array = three(key, "[x, y, z]");
  if (array == nullptr) {
    return std::nullopt;
  }
  return components(*array, fmt::format("{}.{}", path_, key),
                    [&](const toml::node& item, const std::string& path) {
                      return read_quantity(*context_, item, dimension(key),
                                           path);
                    });
}

std::vector<QuantityVector> CaseTable::vectors(const char* key) const {
  std::vector<QuantityVector> result;
  if (!has(key)) {
    return result;
  }
  const toml::array* array = node(key)->as_array();
  const bool points =
      array != nullptr && !array->empty() &&
      std::all_of(array->begin(), array->end(), [](const toml::node& item) {
        return triple(item) != nullptr;
      });
  if (!points) {
    note(key, "points: [[x, y, z], [x, y, z], ...]");
    return result;
  }
  for (std::size_t p = 0; p < array->size(); ++p) {
    result.push_back(
        components(
            *triple((*array)[p]), fmt::format("{}.{}[{}]", path_, key, p),
            [&](const toml::node& item, const std::string& path) {
              return read_quantity(*context_, item, dimension(key), path);
            })
            .value_or(QuantityVector{}));
  }
  return result;
}

std::vector<int> CaseTable::counts(const char* key) const {
  std::vector<int> result;
  if (!has(key)) {
    return result;
  }
  const auto add = [&](const toml::node& item) {
    const auto value = item.value_exact<std::int64_t>();
    if (value && *value >= 1 && *value <= kMostCount) {
      result.push_back(static_cast<int>(*value));
    }
  };
  const toml::array* array = node(key)->as_array();
  const std::size_t wanted = array == nullptr ? 1 : array->size();
  if (array == nullptr) {
    add(*node(key));
  } else {
    for (const toml::node& item : *array) {
      add(item);
    }
  }
  if (result.size() != wanted || wanted < 1 || wanted > 3) {
    note(key, fmt::format("a whole number from 1 to {}, or two or three: "
                          "[8, 4]",
                          kMostCount));
    result.clear();
  }
  return result;
}

std::vector<PathPoint> CaseTable::path_points(const char* key) const {
  std::vector<PathPoint> result;
  if (!has(key)) {
    return result;
  }
  const auto coordinates = [](const toml::node& item) {
    const toml::table* table = item.as_table();
    const toml::node* through = table != nullptr && table->size() == 1
                                    ? table->get("through")
                                    : nullptr;
    return table == nullptr     ? triple(item)
           : through == nullptr ? nullptr
                                : triple(*through);
  };
  const toml::array* array = node(key)->as_array();
  if (array == nullptr || array->empty()) {
    note(key, "points: [[x, y, z], [x, y, z], ...]");
    return result;
  }
  for (std::size_t p = 0; p < array->size(); ++p) {
    const toml::node& item = (*array)[p];
    const std::string path = fmt::format("{}.{}[{}]", path_, key, p);
    const toml::array* three = coordinates(item);
    if (three == nullptr) {
      context_->problems.add(
          context_->line_of(item),
          fmt::format("{} is {}; expected a point [x, y, z], or in a polyline "
                      "{{ through = [x, y, z] }} for an arc",
                      path, described(item)));
      continue;
    }
    auto at = components(
        *three, path, [&](const toml::node& part, const std::string& name) {
          return read_quantity(*context_, part, dimension(key), name);
        });
    result.push_back(
        {std::move(at).value_or(QuantityVector{}), item.is_table()});
    result.back().at[0].line = context_->line_of(item);
  }
  return result;
}

std::optional<Vec3> CaseTable::constants_of(const toml::node& node,
                                            const char* key,
                                            const std::string& path) const {
  const toml::array* array = triple(node);
  if (array == nullptr) {
    return std::nullopt;
  }
  const auto values = components(
      *array, path, [&](const toml::node& item, const std::string& at) {
        return read_constant(*context_, item, dimension(key), at);
      });
  return values ? std::optional(Vec3(values->data())) : std::nullopt;
}

std::optional<Vec3> CaseTable::constant_vector(const char* key) const {
  if (three(key, "three constants") == nullptr) {
    return std::nullopt;
  }
  return constants_of(*node(key), key, fmt::format("{}.{}", path_, key));
}

std::optional<std::array<PlaceQuantity, 3>> CaseTable::place_vector(
    const char* key) const {
  const toml::array* array = three(key, "[x, y, z]");
  if (array == nullptr) {
    return std::nullopt;
  }
  return components(*array, fmt::format("{}.{}", path_, key),
                    [&](const toml::node& item, const std::string& path) {
                      return read_place_quantity(*context_, item,
                                                 dimension(key), path);
                    });
}

std::optional<LocalAxes> CaseTable::axes(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const toml::array* array = node(key)->as_array();
  LocalAxes axes;
  const std::size_t before = context_->problems.size();
  for (std::size_t k = 0; k < 2 && array != nullptr && array->size() == 2;
       ++k) {
    const auto v = constants_of(*array->get(k), key,
                                fmt::format("{}.{}[{}]", path_, key, k));
    if (!v) {
      array = nullptr;
    } else {
      (k == 0 ? axes.first : axes.second) = *v;
    }
  }
  if (array == nullptr || array->size() != 2 || !span_a_plane(axes)) {
    if (context_->problems.size() == before) {
      note(key, "two directions that span a plane: [[1, 0, 0], [0, 1, 0]]");
    }
    return std::nullopt;
  }
  return axes;
}

}  // namespace meniscus
