#include "pipeline/shells/shell_advice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/curve.h"
#include "pipeline/shells/film_normals.h"
#include "pipeline/shells/shell_checks.h"

namespace meniscus::shells {

namespace {

constexpr double kThick = 0.2;  // of the radius: beyond, terms of t / R squared
                                // count
constexpr double kFlat = 0.1;   // of the edge: elements like needles
constexpr int kCurvePoints = 64;
constexpr double kPlane = 1e-6;  // of the size: a film between such curves is
                                 // flat

const curves::Curve* curve_named(const films::FilmSystem& system,
                                 const std::string& name) {
  for (const curves::Curve& curve : system.curves) {
    if (curve.name == name) {
      return &curve;
    }
  }
  return nullptr;
}

std::vector<const curves::Curve*> curves_of(const films::FilmSystem& system,
                                            const std::string& film) {
  std::vector<const curves::Curve*> found;
  for (const films::FilmSpec& spec : system.films) {
    for (const std::string& name : spec.curves) {
      const curves::Curve* curve = curve_named(system, name);
      if (spec.name == film && curve != nullptr) {
        found.push_back(curve);
      }
    }
  }
  return found;
}

std::vector<double> parameters() {
  std::vector<double> t;
  t.reserve(kCurvePoints);
  for (int k = 0; k < kCurvePoints; ++k) {
    t.push_back(static_cast<double>(k) / kCurvePoints);
  }
  return t;
}

Points curve_points(const films::FilmSystem& system, const std::string& film) {
  Points points;
  for (const curves::Curve* curve : curves_of(system, film)) {
    const Points own = curves::points_at(curve->shape, parameters());
    points.insert(points.end(), own.begin(), own.end());
  }
  return points;
}

struct ThicknessAt {
  double value = 0.0;
  Vec3 place = Vec3::Zero();
};

/// The least, of points where it has a value: shapes of rims have them only on
/// a frozen film.
std::optional<ThicknessAt> thinnest(const PlaceField& thickness,
                                    const Points& points) {
  std::optional<ThicknessAt> least;
  for (const Vec3& at : points) {
    try {
      const double value = value_at(thickness, thickness.own(), at);
      if (!least || value < least->value) {
        least = ThicknessAt{value, at};
      }
    } catch (const ExpressionError&) {
      continue;
    }
  }
  return least;
}

std::string at_text(const ThicknessAt& at, const UnitSystem& units) {
  return fmt::format("{:.4g} {} thick at ({:.4g}, {:.4g}, {:.4g})", at.value,
                     units.length, at.place.x(), at.place.y(), at.place.z());
}

/// Could its walls be shells as they stand?
bool shells_can(const case_data::Case& input) {
  case_data::Case other = input;
  other.walls.clear();
  for (const case_data::WallEntry& wall : input.walls) {
    if (wall.material == case_data::kVoid) {
      return false;  // nothing is analysed
    }
    other.shells.push_back({wall.name, wall.films, wall.thickness, wall.side,
                            wall.material, wall.line});
  }
  case_data::CaseProblems problems(input.path, {});
  check_shells(other, problems);
  return problems.empty();
}

/// The smallest radius of a film's curves, where it is not flat.
struct CurveRadius {
  double radius = std::numeric_limits<double>::infinity();
  std::string curve;
  Vec3 place = Vec3::Zero();
};

bool is_flat(const Points& points) {
  if (points.size() < 3) {
    return true;
  }
  Vec3 normal = Vec3::Zero();
  const Vec3& first = points.front();
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Vec3 n = (points[i - 1] - first).cross(points[i] - first);
    normal = n.norm() > normal.norm() ? n : normal;
  }
  const double limit = kPlane * bounding_diagonal(points);
  return normal.isZero(0.0) ||
         std::all_of(points.begin(), points.end(), [&](const Vec3& at) {
           return std::abs((at - first).dot(normal.normalized())) < limit;
         });
}

CurveRadius smallest_radius(const films::FilmSystem& system,
                            const std::string& film) {
  CurveRadius least;
  if (is_flat(curve_points(system, film))) {
    return least;
  }
  for (const curves::Curve* curve : curves_of(system, film)) {
    try {
      for (const double t : parameters()) {
        const curves::CurveJet jet = curves::jet_at(curve->shape, t);
        const double bend = jet.first.cross(jet.second).norm();
        const double radius =
            std::pow(jet.first.norm(), 3) / std::max(bend, 1e-300);
        if (radius < least.radius) {
          least = {radius, curve->name, jet.point};
        }
      }
    } catch (const InvalidInput&) {
      continue;  // corners have no radius
    }
  }
  return least;
}

/// Where the film bends the most beside its thickness: facets off its rims, by
/// the normals at their corners (Rusinkiewicz 2004).
struct Bend {
  double share = 0.0;      // of the radius, what the wall is thick
  double thickness = 0.0;  // [length]
  Vec3 place = Vec3::Zero();
};

double curvature_of(const std::array<Vec3, 3>& x,
                    const std::array<Vec3, 3>& n) {
  const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  const Vec3 e1 = (x[1] - x[0]).normalized();
  const Vec3 e2 = normal.cross(e1);
  Eigen::Matrix2d edges;
  Eigen::Matrix2d turns;
  for (int k = 0; k < 2; ++k) {
    const Vec3 edge = x[k + 1] - x[0];
    const Vec3 turn = n[k + 1] - n[0];
    edges.col(k) << edge.dot(e1), edge.dot(e2);
    turns.col(k) << turn.dot(e1), turn.dot(e2);
  }
  const double size = edges.determinant();
  Eigen::Matrix2d inverse;
  inverse << edges(1, 1), -edges(0, 1), -edges(1, 0), edges(0, 0);
  const Eigen::Matrix2d S = turns * inverse / size;
  const double mean = 0.5 * (S(0, 0) + S(1, 1));
  const double off = 0.5 * (S(0, 1) + S(1, 0));
  const double half = 0.5 * (S(0, 0) - S(1, 1));
  return std::abs(mean) + std::hypot(half, off);
}

std::set<int> nodes_of_rims(const ShellPart& part) {
  std::set<int> nodes;
  for (const auto& [name, rim] : part.rims) {
    for (const std::array<int, 3>& edge : rim) {
      nodes.insert(edge.begin(), edge.end());
    }
  }
  return nodes;
}

/// Of each shell.
std::vector<Bend> most_bent(const ShellPart& part) {
  const std::set<int> rims = nodes_of_rims(part);
  std::map<int, std::map<int, Vec3>> normals;  // by label
  std::vector<Bend> most(part.sections.size());
  for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
    const std::array<int, 6>& facet = part.mesh.facets[f];
    if (std::any_of(facet.begin(), facet.begin() + 3,
                    [&](int node) { return rims.contains(node); })) {
      continue;
    }
    const int label = part.skin.face_label[f];
    if (!normals.contains(label)) {
      normals[label] = film_normals(part, label);
    }
    std::array<Vec3, 3> x;
    std::array<Vec3, 3> n;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = part.mesh.nodes[facet[k]];
      n[k] = normals[label].at(facet[k]);
    }
    const double thickness = part.mesh.thickness[f].mean();
    const double share = thickness * curvature_of(x, n);
    Bend& own = most[static_cast<std::size_t>(part.mesh.section[f])];
    if (share > own.share) {
      own = {share, thickness, (x[0] + x[1] + x[2]) / 3.0};
    }
  }
  return most;
}

}  // namespace

std::vector<std::string> thin_wall_advice(
    const case_data::Case& input, const case_data::EvaluatedCase& inputs,
    const std::map<std::string, Points>& films) {
  std::vector<std::string> advice;
  if (input.walls.empty() || !shells_can(input)) {
    return advice;
  }
  const double edge = inputs.fea_edge;
  for (std::size_t w = 0; w < input.walls.size(); ++w) {
    const case_data::WallEntry& wall = input.walls[w];
    Points points;
    for (const std::string& film : wall.films) {
      const auto at = films.find(film);
      const Points own = at != films.end()
                             ? at->second
                             : curve_points(inputs.film_system, film);
      points.insert(points.end(), own.begin(), own.end());
    }
    const std::optional<ThicknessAt> least =
        thinnest(inputs.walls[w].thickness, points);
    if (!least || least->value >= edge) {
      continue;
    }
    advice.push_back(fmt::format(
        "{}: walls.{} is {}, and elements have edges of {:.4g} {} "
        "(resolution.fea): {}; [shells.{}] in place of [walls.{}] needs no "
        "elements through it (all walls of the case together)",
        case_data::place(input, wall.line), wall.name,
        at_text(*least, input.units), edge, input.units.length,
        least->value < kFlat * edge
            ? fmt::format("they are {:.0f} times as long as the wall is thick",
                          edge / least->value)
            : "one element through it, which reads stress too low",
        wall.name, wall.name));
  }
  return advice;
}

std::vector<std::string> thick_shell_advice(
    const case_data::Case& input, const case_data::EvaluatedCase& inputs) {
  std::vector<std::string> advice;
  for (std::size_t s = 0; s < input.shells.size(); ++s) {
    const case_data::ShellEntry& shell = input.shells[s];
    for (const std::string& film : shell.films) {
      const CurveRadius least = smallest_radius(inputs.film_system, film);
      if (!std::isfinite(least.radius)) {
        continue;
      }
      const std::optional<ThicknessAt> at =
          thinnest(inputs.shells[s].thickness, {least.place});
      if (at && at->value > kThick * least.radius) {
        advice.push_back(fmt::format(
            "{}: shells.{} is {}, where curve '{}' bends with a radius of "
            "{:.4g} {}: {:.2g} of it, if film '{}' bends along; above a fifth "
            "[walls.{}], as a solid, says more",
            case_data::place(input, shell.line), shell.name,
            at_text(*at, input.units), least.curve, least.radius,
            input.units.length, at->value / least.radius, film, shell.name));
      }
    }
  }
  return advice;
}

std::vector<std::string> thick_shell_warnings(const case_data::Case& input,
                                              const ShellPart& part) {
  std::vector<std::string> warnings;
  const std::vector<Bend> bends = most_bent(part);
  for (std::size_t s = 0; s < input.shells.size(); ++s) {
    const Bend& most = bends[s];
    if (most.share > kThick) {
      warnings.push_back(fmt::format(
          "shells.{} is {}, where its film bends with a radius of {:.4g} {}: "
          "{:.2g} of it; above a fifth [walls.{}], as a solid, says more",
          input.shells[s].name,
          at_text({most.thickness, most.place}, input.units),
          most.thickness / most.share, input.units.length, most.share,
          input.shells[s].name));
    }
  }
  return warnings;
}

std::vector<std::string> shell_advice(const case_data::Case& input) {
  std::vector<std::string> problems;
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input), problems);
  if (!problems.empty()) {
    return {};
  }
  std::vector<std::string> advice = thin_wall_advice(input, inputs);
  for (std::string& more : thick_shell_advice(input, inputs)) {
    advice.push_back(std::move(more));
  }
  return advice;
}

}  // namespace meniscus::shells
