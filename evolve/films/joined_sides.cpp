#include "evolve/films/joined_sides.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "evolve/films/shared_sides.h"

namespace meniscus::films {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Films and solids by the curve that they end at.
std::vector<std::set<std::string>> users_of_curves(const FilmSystem& system) {
  std::vector<std::set<std::string>> users(system.curves.size());
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    for (const FilmSpec& film : system.films) {
      if (has(film.curves, system.curves[c].name)) {
        users[c].insert(film.name);
      }
    }
    for (const CapSpec& cap : system.caps) {
      if (has(cap.curves(), system.curves[c].name)) {
        users[c].insert(cap.name);
      }
    }
  }
  return users;
}

}  // namespace

std::vector<JoinedSide> joined_sides(const FilmSystem& system) {
  const bool any =
      std::any_of(system.films.begin(), system.films.end(),
                  [](const FilmSpec& film) { return !film.joins.empty(); });
  if (!any) {
    return {};
  }
  const auto users = users_of_curves(system);
  std::set<std::pair<int, int>> shared;  // with a curve of another surface
  for (const SharedSide& side : shared_sides(system.curves)) {
    if (!users[side.first_curve].empty() && !users[side.second_curve].empty()) {
      shared.insert({side.first_curve, side.first_side});
      shared.insert({side.second_curve, side.second_side});
    }
  }
  std::vector<JoinedSide> result;
  for (std::size_t f = 0; f < system.films.size(); ++f) {
    const FilmSpec& film = system.films[f];
    for (std::size_t c = 0; c < system.curves.size() && !film.joins.empty();
         ++c) {
      const curves::Curve& curve = system.curves[c];
      if (!has(film.curves, curve.name) || users[c].size() != 1) {
        continue;
      }
      const auto sides = static_cast<int>(sides_of(curve.shape).size());
      for (int k = 0; k < sides; ++k) {
        if ((curve.free || std::count(curve.free_sides.begin(),
                                      curve.free_sides.end(), k) > 0) &&
            shared.count({static_cast<int>(c), k}) == 0) {
          result.push_back({static_cast<int>(f), static_cast<int>(c), k});
        }
      }
      if (sides == 0 && curve.free) {
        result.push_back({static_cast<int>(f), static_cast<int>(c), -1});
      }
    }
  }
  return result;
}

bool may_meet(const FilmSystem& system, int a, int b) {
  for (const FilmSpec& one : system.films) {
    for (const FilmSpec& other : system.films) {
      const std::string& first = system.curves[a].name;
      const std::string& second = system.curves[b].name;
      const bool apart =
          (has(one.curves, first) && has(other.curves, second)) ||
          (has(one.curves, second) && has(other.curves, first));
      if (apart && (has(one.joins, other.name) ||
                    (!one.joins.empty() && !other.joins.empty()))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace meniscus::films
