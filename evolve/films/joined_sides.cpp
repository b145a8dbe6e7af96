#include "evolve/films/joined_sides.h"

#include <algorithm>
#include <limits>
#include <map>
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

std::map<std::string, int> curve_numbers(const FilmSystem& system) {
  std::map<std::string, int> numbers;
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    numbers.emplace(system.curves[c].name, static_cast<int>(c));
  }
  return numbers;
}

/// Films and solids by the curve that they end at.
std::vector<std::set<std::string>> users_of_curves(const FilmSystem& system) {
  const std::map<std::string, int> numbers = curve_numbers(system);
  std::vector<std::set<std::string>> users(system.curves.size());
  const auto add = [&](const std::vector<std::string>& names,
                       const std::string& user) {
    for (const std::string& name : names) {
      const auto curve = numbers.find(name);
      if (curve != numbers.end()) {
        users[static_cast<std::size_t>(curve->second)].insert(user);
      }
    }
  };
  for (const FilmSpec& film : system.films) {
    add(film.curves, film.name);
  }
  for (const CapSpec& cap : system.caps) {
    add(cap.curves(), cap.name);
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

/// A curve lies within it.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0.0;  // [length]
};

/// Of points along a curve: between two neighbors it leaves them by no more
/// than half of what chord they have, and of what all chords are short of its
/// length.
Ball ball_about(const curves::CurveShape& shape) {
  constexpr int kPoints = 48;
  std::vector<double> t(kPoints);
  for (int k = 0; k < kPoints; ++k) {
    t[k] = static_cast<double>(k) / kPoints;
  }
  const Points points = curves::points_at(shape, t);
  Ball ball;
  double chords = 0.0;
  double longest = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const double chord = (points[(k + 1) % kPoints] - points[k]).norm();
    chords += chord;
    longest = std::max(longest, chord);
    ball.center += points[k] / kPoints;
  }
  for (const Vec3& point : points) {
    ball.radius = std::max(ball.radius, (point - ball.center).norm());
  }
  const double left = std::max(curves::length_of(shape) - chords, 0.0);
  ball.radius += 0.5 * (longest + left);
  return ball;
}

/// Where films' lines may end.
class EndFinder {
 public:
  explicit EndFinder(const FilmSystem& system)
      : system_(system),
        numbers_(curve_numbers(system)),
        balls_(system.curves.size()) {
    for (std::size_t f = 0; f < system.films.size(); ++f) {
      films_.emplace(system.films[f].name, f);
    }
  }

  JoinEnd nearest(int film, const Vec3& place, bool held) {
    struct Candidate {
      double at_least = 0.0;  // away
      int curve = 0;
    };
    std::vector<Candidate> candidates;
    for (const auto& [c, there] : joined_films_at(film)) {
      if (held || (there > 1 && !system_.curves[c].free)) {
        const Ball& ball = ball_of(c);
        candidates.push_back(
            {std::max((ball.center - place).norm() - ball.radius, 0.0), c});
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) {
                       return a.at_least < b.at_least;
                     });
    JoinEnd end{.film = film,
                .place = place,
                .held = held,
                .distance = std::numeric_limits<double>::infinity()};
    for (const Candidate& candidate : candidates) {
      if (candidate.at_least > end.distance) {
        break;
      }
      const int c = candidate.curve;
      const curves::Curve& curve = system_.curves[c];
      const double t = nearest_place(curve, place);
      const double off = (curves::point_at(curve.shape, t) - place).norm();
      if (off < end.distance || (off == end.distance && c < end.curve)) {
        end.curve = c;
        end.t = t;
        end.distance = off;
        end.meets = off <= join_reach(curve);
      }
    }
    return end;
  }

 private:
  /// By curve: how many of the films that `film` joins end there.
  const std::map<int, int>& joined_films_at(int film) {
    const auto [known, is_new] = counts_.try_emplace(film);
    if (is_new) {
      const std::vector<std::string>& joins = system_.films[film].joins;
      for (const std::string& name :
           std::set<std::string>(joins.begin(), joins.end())) {
        const auto other = films_.find(name);
        if (other == films_.end()) {
          continue;
        }
        const auto& ends = system_.films[other->second].curves;
        for (const std::string& curve :
             std::set<std::string>(ends.begin(), ends.end())) {
          const auto number = numbers_.find(curve);
          if (number != numbers_.end()) {
            ++known->second[number->second];
          }
        }
      }
    }
    return known->second;
  }

  const Ball& ball_of(int curve) {
    std::optional<Ball>& known = balls_[curve];
    if (!known) {
      known = ball_about(system_.curves[curve].shape);
    }
    return *known;
  }

  const FilmSystem& system_;
  std::map<std::string, int> numbers_;
  std::map<std::string, std::size_t> films_;
  std::map<int, std::map<int, int>> counts_;  // by film
  std::vector<std::optional<Ball>> balls_;
};

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
  EndFinder finder(system);
  for (const JoinedSide& side : joined) {
    const std::vector<CurveSide> sides =
        sides_of(system.curves[side.curve].shape);
    const auto n = static_cast<int>(sides.size());
    for (int k = side.side; k >= 0 && k <= side.side + 1; ++k) {
      const int corner = k % n;
      const bool held =
          !free.is_free(side.curve, static_cast<double>(corner) / n);
      const JoinEnd end = finder.nearest(
          side.film, sides[static_cast<std::size_t>(corner)].from, held);
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
  const auto films_at = [&](int curve) {
    std::vector<const FilmSpec*> films;
    for (const FilmSpec& film : system.films) {
      if (has(film.curves, system.curves[curve].name)) {
        films.push_back(&film);
      }
    }
    return films;
  };
  const std::vector<const FilmSpec*> others = films_at(b);
  for (const FilmSpec* one : films_at(a)) {
    for (const FilmSpec* other : others) {
      if (has(one->joins, other->name) || has(other->joins, one->name) ||
          (!one->joins.empty() && !other->joins.empty())) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace meniscus::films
