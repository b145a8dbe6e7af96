#include <algorithm>

#include <fmt/format.h>

#include "pipeline/case_reader_fields.h"

namespace meniscus {

std::optional<QuantityVector> CaseTable::vector(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const toml::array* array = node(key)->as_array();
  if (array == nullptr || array->size() != 3) {
    note(key, "[x, y, z]");
    return std::nullopt;
  }
  QuantityVector result;
  bool good = true;
  for (std::size_t k = 0; k < 3; ++k) {
    auto component =
        read_quantity(*context_, *array->get(k), dimension(key),
                      fmt::format("{}.{}[{}]", path_, key, "xyz"[k]));
    good = good && component.has_value();
    result[k] = std::move(component).value_or(Quantity{});
  }
  return good ? std::optional(result) : std::nullopt;
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
        return item.is_array() && item.as_array()->size() == 3;
      });
  if (!points) {
    note(key, "points: [[x, y, z], [x, y, z], ...]");
    return result;
  }
  for (std::size_t p = 0; p < array->size(); ++p) {
    QuantityVector point;
    for (std::size_t k = 0; k < 3; ++k) {
      point[k] =
          read_quantity(*context_, *array->get(p)->as_array()->get(k),
                        dimension(key),
                        fmt::format("{}.{}[{}][{}]", path_, key, p, "xyz"[k]))
              .value_or(Quantity{});
    }
    result.push_back(std::move(point));
  }
  return result;
}

std::optional<Vec3> CaseTable::constants_of(const toml::node& node,
                                            const char* key,
                                            const std::string& path) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 3) {
    return std::nullopt;
  }
  Vec3 result;
  bool good = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = read_constant(*context_, *array->get(k), dimension(key),
                                     fmt::format("{}[{}]", path, "xyz"[k]));
    good = good && value.has_value();
    result[static_cast<Eigen::Index>(k)] = value.value_or(0.0);
  }
  return good ? std::optional(result) : std::nullopt;
}

std::optional<Vec3> CaseTable::constant_vector(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const toml::array* array = node(key)->as_array();
  if (array == nullptr || array->size() != 3) {
    note(key, "three constants");
    return std::nullopt;
  }
  return constants_of(*node(key), key, fmt::format("{}.{}", path_, key));
}

std::optional<std::array<PlaceQuantity, 3>> CaseTable::place_vector(
    const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const toml::array* array = node(key)->as_array();
  if (array == nullptr || array->size() != 3) {
    note(key, "[x, y, z]");
    return std::nullopt;
  }
  std::array<PlaceQuantity, 3> result;
  bool good = true;
  for (std::size_t k = 0; k < 3; ++k) {
    auto component =
        read_place_quantity(*context_, *array->get(k), dimension(key),
                            fmt::format("{}.{}[{}]", path_, key, "xyz"[k]));
    good = good && component.has_value();
    result[k] = std::move(component).value_or(PlaceQuantity{});
  }
  return good ? std::optional(result) : std::nullopt;
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
