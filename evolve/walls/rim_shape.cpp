#include "evolve/walls/rim_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/harmonic.h"
#include "core/math/union_find.h"

namespace meniscus::walls {

namespace {

/// As splines about an axis, at height u and the same angle.
std::shared_ptr<const PlaceShape> splines_about_axis(const RimSplines& s) {
  return axis_splines({.along = s.along, .around = s.around});
}

/// Of no film yet.
class Unlaid : public PlaceShape {
 public:
  explicit Unlaid(RimSplines splines)
      : splines_(std::move(splines)), shape_(splines_about_axis(splines_)) {}

  const RimSplines& splines() const { return splines_; }
  int coefficients() const override { return shape_->coefficients(); }
  double spacing() const override { return shape_->spacing(); }

  PlaceJet jet(const Vec3& /*at*/,
               std::span<const double> /*c*/) const override {
    fail();
  }

  void add_transposed(const Vec3& /*at*/, double /*by_value*/,
                      const Vec3& /*by_gradient*/,
                      std::span<double> /*sum*/) const override {
    fail();
  }

 private:
  [[noreturn]] static void fail() {
    throw ExpressionError("a shape between rims has values on walls alone", 1);
  }

  RimSplines splines_;
  std::shared_ptr<const PlaceShape> shape_;
};

struct ByCoordinates {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }
};

/// Per film point its place on the cylinder of radius 1 and length 1.
using Places = std::map<Vec3, Vec3, ByCoordinates>;

class Laid : public PlaceShape {
 public:
  Laid(const RimSplines& splines, Places places)
      : shape_(splines_about_axis(splines)), places_(std::move(places)) {}

  int coefficients() const override { return shape_->coefficients(); }
  double spacing() const override { return shape_->spacing(); }

  PlaceJet jet(const Vec3& at, std::span<const double> c) const override {
    return {.value = shape_->jet(place(at), c).value};
  }

  void add_transposed(const Vec3& at, double by_value,
                      const Vec3& /*by_gradient*/,
                      std::span<double> sum) const override {
    shape_->add_transposed(place(at), by_value, Vec3::Zero(), sum);
  }

 private:
  const Vec3& place(const Vec3& at) const {
    const auto found = places_.find(at);
    if (found == places_.end()) {
      throw ExpressionError("no point of the wall's films is", 1);
    }
    return found->second;
  }

  std::shared_ptr<const PlaceShape> shape_;
  Places places_;
};

double wrapped(double turns) { return turns - std::round(turns); }

/// The films of one wall and where they end.
class Coordinates {
 public:
  Coordinates(const SurfaceMesh& mesh, std::vector<int> facets,
              const std::vector<WallRim>& rims, std::string where)
      : mesh_(mesh),
        facets_(std::move(facets)),
        rims_(rims),
        where_(std::move(where)),
        on_wall_(mesh.points.size(), 0) {
    for (const int f : facets_) {
      for (const int v : mesh_.facets[f]) {
        on_wall_[v] = 1;
      }
    }
  }

  Places places(const RimSplines& splines) const {
    const WallRim first = rim(splines.first);
    const WallRim second = rim(splines.second);
    check_reach(first, second);
    const Eigen::VectorXd u = heights(first, second);
    const Eigen::VectorXd turns = splines.around > 1
                                      ? angles(splines, first, second)
                                      : Eigen::VectorXd::Zero(u.size());
    Places result;
    for (Eigen::Index v = 0; v < u.size(); ++v) {
      if (on_wall_[v] != 0) {
        const double angle = 2.0 * std::numbers::pi * turns[v];
        result[mesh_.points[v]] =
            Vec3(std::cos(angle), std::sin(angle), std::clamp(u[v], 0.0, 1.0));
      }
    }
    return result;
  }

 private:
  /// The vertices of the wall's on a curve, in the order of their t.
  WallRim rim(const std::string& curve) const {
    std::vector<std::pair<double, int>> order;
    for (const WallRim& rim : rims_) {
      if (rim.name != curve) {
        continue;
      }
      if (rim.t.size() != rim.vertices.size()) {
        throw InvalidInput(
            fmt::format("{}: curve '{}' has {} points with {} parameters",
                        where_, curve, rim.vertices.size(), rim.t.size()));
      }
      for (std::size_t k = 0; k < rim.vertices.size(); ++k) {
        if (on_wall_[rim.vertices[k]] != 0) {
          order.emplace_back(rim.t[k], rim.vertices[k]);
        }
      }
    }
    if (order.empty()) {
      throw InvalidInput(
          fmt::format("{} do not end at curve '{}'", where_, curve));
    }
    std::sort(order.begin(), order.end());
    WallRim result{.name = curve, .vertices = {}, .t = {}};
    for (const auto& [t, v] : order) {
      result.vertices.push_back(v);
      result.t.push_back(t);
    }
    return result;
  }

  /// Each connected part of the films must end at both curves.
  void check_reach(const WallRim& first, const WallRim& second) const {
    UnionFind parts(mesh_.points.size());
    for (const int f : facets_) {
      const Triangle& t = mesh_.facets[f];
      parts.join(t[0], t[1]);
      parts.join(t[0], t[2]);
    }
    for (const WallRim& rim : {first, second}) {
      std::set<int> reached;
      for (const int v : rim.vertices) {
        reached.insert(parts.root(v));
      }
      for (const int f : facets_) {
        if (reached.count(parts.root(mesh_.facets[f][0])) == 0) {
          throw InvalidInput(fmt::format(
              "{} do not all reach curve '{}': give film '{}' a wall of its "
              "own",
              where_, rim.name, mesh_.labels[mesh_.facet_label[f]]));
        }
      }
    }
  }

  HarmonicProblem problem() const {
    const std::size_t count = mesh_.points.size();
    HarmonicProblem result{mesh_.points, mesh_.facets, facets_, {}, {}, {}};
    result.weights = HarmonicWeights::Exact;
    result.fixed.assign(count, 0);
    result.values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), 1);
    return result;
  }

  Eigen::VectorXd solve(const HarmonicProblem& problem) const {
    try {
      return harmonic(problem).col(0);
    } catch (const MeshError& error) {
      throw InvalidInput(fmt::format("{}: {}", where_, error.what()));
    }
  }

  Eigen::VectorXd heights(const WallRim& first, const WallRim& second) const {
    HarmonicProblem result = problem();
    for (const int v : first.vertices) {
      result.fixed[v] = 1;
    }
    for (const int v : second.vertices) {
      result.fixed[v] = 1;
      result.values(v, 0) = 1.0;
    }
    return solve(result);
  }

  /// Free at both rims and all others.
  Eigen::VectorXd angles(const RimSplines& splines, const WallRim& first,
                         const WallRim& second) const {
    for (const int f : facets_) {
      if (mesh_.facet_label[f] != mesh_.facet_label[facets_[0]]) {
        throw InvalidInput(fmt::format(
            "{} are several; a shape with more than one coefficient around is "
            "for a wall of one film",
            where_));
      }
    }
    HarmonicProblem result = problem();
    TubeCut cut = cut_tube(mesh_.facets, mesh_.points.size(), facets_,
                           first.vertices, second.vertices);
    result.offsets = std::move(cut.offsets);
    result.fixed[cut.path.front()] = 1;
    Eigen::VectorXd turns = solve(result);
    double gain = 0.0;
    const std::vector<int>& loop = first.vertices;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      gain += wrapped(turns[loop[(k + 1) % loop.size()]] - turns[loop[k]]);
    }
    if (std::abs(std::abs(gain) - 1.0) > 0.5) {
      throw InvalidInput(fmt::format(
          "{} make no tube from curve '{}' to '{}': no angle goes around",
          where_, first.name, second.name));
    }
    turns *= std::copysign(1.0, gain);
    const auto [before, after, share] = start_of(first, splines.zero);
    const double start =
        turns[before] + share * wrapped(turns[after] - turns[before]);
    return turns.array() - start;
  }

  /// Between two neighbours on the rim, and how far from the one to the other.
  struct Start {
    int before = 0;
    int after = 0;
    double share = 0.0;
  };

  Start start_of(const WallRim& rim, const std::optional<Vec3>& zero) const {
    const std::vector<int>& loop = rim.vertices;
    if (!zero) {  // t = 0, between the last point and the first
      const double before = 1.0 - rim.t.back();
      const double after = rim.t.front();
      return {loop.back(), loop.front(),
              after > 0.0 ? before / (before + after) : 1.0};
    }
    Vec3 middle = Vec3::Zero();
    for (const int v : loop) {
      middle += mesh_.points[v] / static_cast<double>(loop.size());
    }
    Vec3 normal = Vec3::Zero();
    const auto next = [&](std::size_t k) {
      return mesh_.points[loop[(k + 1) % loop.size()]] - middle;
    };
    for (std::size_t k = 0; k < loop.size(); ++k) {
      normal += (mesh_.points[loop[k]] - middle).cross(next(k));
    }
    const Vec3 across = normal.cross(*zero);  // a quarter of a turn further
    if (!(across.norm() > 1e-9 * normal.norm() * zero->norm())) {
      throw InvalidInput(
          fmt::format("{}: zero, ({:g}, {:g}, {:g}), has no length across "
                      "curve '{}'",
                      where_, zero->x(), zero->y(), zero->z(), rim.name));
    }
    // The rim passes the half plane of zero where it goes over to the side of
    // `across`; where several times, the farthest counts.
    Start result;
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const double from = across.dot(mesh_.points[loop[k]] - middle);
      const double to = across.dot(next(k));
      if (from > 0.0 || !(to > 0.0)) {
        continue;
      }
      const double share = from / (from - to);
      const Vec3 at = mesh_.points[loop[k]] - middle +
                      share * (next(k) - (mesh_.points[loop[k]] - middle));
      if (at.dot(*zero) > farthest) {
        farthest = at.dot(*zero);
        result = {loop[k], loop[(k + 1) % loop.size()], share};
      }
    }
    return result;
  }

  const SurfaceMesh& mesh_;
  std::vector<int> facets_;
  const std::vector<WallRim>& rims_;
  std::string where_;
  std::vector<char> on_wall_;
};

}  // namespace

std::shared_ptr<const PlaceShape> rim_splines(const RimSplines& splines) {
  if (splines.first == splines.second) {
    throw InvalidInput(
        fmt::format("from curve '{}' to itself; expected two", splines.first));
  }
  if (splines.zero && !(splines.zero->norm() > 0.0)) {
    throw InvalidInput("zero has no length; expected a direction");
  }
  return std::make_shared<Unlaid>(splines);
}

const RimSplines* rim_splines_of(const PlaceShape& shape) {
  const auto* unlaid = dynamic_cast<const Unlaid*>(&shape);
  return unlaid != nullptr ? &unlaid->splines() : nullptr;
}

std::vector<WallSpec> on_films(const std::vector<WallSpec>& walls,
                               const SurfaceMesh& mesh,
                               const std::vector<int>& wall,
                               const std::vector<WallRim>& rims) {
  std::vector<WallSpec> result = walls;
  for (std::size_t w = 0; w < result.size(); ++w) {
    for (std::shared_ptr<const PlaceShape>& shape :
         result[w].thickness.shapes) {
      const RimSplines* splines = rim_splines_of(*shape);
      if (splines == nullptr) {
        continue;
      }
      std::vector<int> facets;
      for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        if (wall[mesh.facet_label[f]] == static_cast<int>(w)) {
          facets.push_back(static_cast<int>(f));
        }
      }
      const Coordinates coordinates(
          mesh, std::move(facets), rims,
          fmt::format("walls.{}: thickness \"{}\": its films", result[w].name,
                      result[w].thickness.text.empty()
                          ? result[w].thickness.formula.text()
                          : result[w].thickness.text));
      shape = std::make_shared<Laid>(*splines, coordinates.places(*splines));
    }
  }
  return result;
}

}  // namespace meniscus::walls
