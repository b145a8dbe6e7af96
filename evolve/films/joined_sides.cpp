#include "evolve/films/joined_sides.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "evolve/curves/curve_place.h"
#include "evolve/films/edge_marks.h"
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

/// The parameter of the nearest corner of a curve within reach, else of its
/// nearest place.
double nearest_place(const curves::Curve& curve, const Vec3& place) {
  double least = join_reach(curve);
  std::optional<double> nearest;
  for (const double corner : curves::corner_parameters(curve.shape)) {
    const double off = (curves::point_at(curve.shape, corner) - place).norm();
    if (off <= least) {
      least = off;
      nearest = corner;
    }
  }
  return nearest ? *nearest : nearest_parameter(curve.shape, place, 0.0);
}

/// How many of the films that `film` joins end at a curve.
int joined_films_at(const FilmSystem& system, int film,
                    const std::string& curve) {
  const std::vector<std::string>& joins =
      system.films[static_cast<std::size_t>(film)].joins;
  return static_cast<int>(std::count_if(
      system.films.begin(), system.films.end(), [&](const FilmSpec& other) {
        return has(joins, other.name) && has(other.curves, curve);
      }));
}

JoinEnd nearest_end(const FilmSystem& system, int film, const Vec3& place,
                    bool held) {
  JoinEnd end{.film = film,
              .place = place,
              .held = held,
              .distance = std::numeric_limits<double>::infinity()};
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    const curves::Curve& curve = system.curves[c];
    const int there = joined_films_at(system, film, curve.name);
    if (held ? there == 0 : there < 2 || curve.free) {
      continue;
    }
    const double t = nearest_place(curve, place);
    const double off = (curves::point_at(curve.shape, t) - place).norm();
    if (off < end.distance) {
      end.curve = static_cast<int>(c);
      end.t = t;
      end.distance = off;
      end.meets = off <= join_reach(curve);
    }
  }
  return end;
}

}  // namespace

double join_reach(const curves::Curve& curve) {
  return 1e-4 * curves::length_of(curve.shape);
}

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

std::vector<JoinEnd> join_ends(const FilmSystem& system) {
  std::vector<JoinEnd> ends;
  const std::vector<JoinedSide> joined = joined_sides(system);
  if (joined.empty()) {
    return ends;
  }
  const FreePlaces free(system.curves,
                        std::vector<char>(system.curves.size(), 1));
  for (const JoinedSide& side : joined) {
    const std::vector<CurveSide> sides =
        sides_of(system.curves[side.curve].shape);
    const auto n = static_cast<int>(sides.size());
    for (int k = side.side; k >= 0 && k <= side.side + 1; ++k) {
      const int corner = k % n;
      const bool held =
          !free.is_free(side.curve, static_cast<double>(corner) / n);
      const JoinEnd end =
          nearest_end(system, side.film,
                      sides[static_cast<std::size_t>(corner)].from, held);
      if (held || end.curve >= 0) {
        ends.push_back(end);
      }
    }
  }
  return ends;
}

std::vector<int> joining_order(const std::vector<FilmSpec>& films) {
  std::set<std::string> missing;
  for (const FilmSpec& film : films) {
    if (!film.joins.empty()) {
      missing.insert(film.name);
    }
  }
  std::vector<int> order;
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t f = 0; f < films.size(); ++f) {
      const bool ready = std::none_of(
          films[f].joins.begin(), films[f].joins.end(),
          [&](const auto& name) { return missing.count(name) > 0; });
      if (ready && missing.erase(films[f].name) > 0) {
        order.push_back(static_cast<int>(f));
        grows = true;
      }
    }
  }
  return order;
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
