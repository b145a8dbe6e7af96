#include "evolve/walls/wall_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/walls/wall_fillet.h"
#include "evolve/walls/wall_offset.h"
#include "evolve/walls/wall_sheets.h"

namespace meniscus::walls {

namespace {

std::string text_of(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

/// Thickness of each wall at a film vertex, computed once.
class Asked {
 public:
  Asked(const Points& points, const std::vector<WallSpec>& walls)
      : points_(points), walls_(walls), known_(walls.size()) {}

  double at(int wall, int v) {
    const auto [found, is_new] = known_[wall].try_emplace(v, 0.0);
    if (is_new) {
      found->second = evaluate(wall, v);
    }
    return found->second;
  }

 private:
  double evaluate(int wall, int v) const {
    return thickness_at(walls_[wall], walls_[wall].thickness.own(), points_[v]);
  }

  const Points& points_;
  const std::vector<WallSpec>& walls_;
  std::vector<std::map<int, double>> known_;
};

}  // namespace

double thickness_at(const WallSpec& wall, Numbers numbers, const Vec3& p) {
  const std::string& text = wall.thickness.text.empty()
                                ? wall.thickness.formula.text()
                                : wall.thickness.text;
  double t = 0.0;
  try {
    t = value_at(wall.thickness, numbers, p);
  } catch (const ExpressionError& error) {
    throw InvalidInput(fmt::format("walls.{}: thickness \"{}\": {}", wall.name,
                                   text, error.what()));
  }
  if (!(t > 0.0) || !std::isfinite(t)) {
    throw InvalidInput(fmt::format(
        "walls.{}: thickness \"{}\" is {} at {}; it must be above 0 and finite "
        "on the whole film",
        wall.name, text, t, text_of(p)));
  }
  return t;
}

namespace {

class Reference {
 public:
  Reference(const WallTopology& topology, const WallFilms& films,
            const std::vector<WallSpec>& walls, SafePlaces places)
      : topology_(topology),
        films_(films),
        walls_(walls),
        places_(places),
        asked_(films.mesh.points, walls) {}

  WallReference find() {
    const int regions =
        1 + *std::max_element(films_.region.begin(), films_.region.end());
    result_.moves.resize(topology_.points.size());
    result_.thinnest.resize(regions);
    result_.thickest.resize(regions);
    result_.safe.resize(regions);
    result_.corrections.assign(regions, 0);
    if (places_ == SafePlaces::Everywhere) {
      result_.safe_at.assign(films_.mesh.points.size(),
                             std::numeric_limits<double>::infinity());
    }
    const std::vector<SheetFacets> sheets = cut_into_sheets(topology_, films_);
    for (const SheetFacets& sheet : sheets) {
      offset(sheet, apart_from(sheet, sheets));
    }
    join();
    round(sheets);
    return std::move(result_);
  }

 private:
  int wall_of(int f) const { return films_.wall[topology_.facets[f].label]; }

  SurfaceMesh mesh_of(const SheetFacets& sheet) const {
    SurfaceMesh mesh;
    mesh.points = films_.mesh.points;
    mesh.labels = films_.mesh.labels;
    for (std::size_t i = 0; i < sheet.facets.size(); ++i) {
      const WallFacet& facet = topology_.facets[sheet.facets[i]];
      Triangle t = facet.film;
      if (sheet.flipped[i] != 0) {
        std::swap(t[1], t[2]);
      }
      mesh.facets.push_back(t);
      mesh.facet_label.push_back(facet.label);
    }
    return mesh;
  }

  WallSide side_of(const SheetFacets& facets) const {
    const WallSpec& first = walls_[wall_of(facets.facets[0])];
    for (const int f : facets.facets) {
      const WallSpec& other = walls_[wall_of(f)];
      if (other.side != first.side) {
        throw InvalidInput(fmt::format(
            "walls.{} and walls.{} join at an edge, but their material lies on "
            "different sides; give both the same side",
            first.name, other.name));
      }
    }
    return first.side;
  }

  /// Per film vertex of a sheet: the walls there.
  std::map<int, std::set<int>> walls_at(const SheetFacets& sheet) const {
    std::map<int, std::set<int>> result;
    for (const int f : sheet.facets) {
      for (const int v : topology_.facets[f].film) {
        result[v].insert(wall_of(f));
      }
    }
    return result;
  }

  /// The facets of sheets that share no point with this one.
  SurfaceMesh apart_from(const SheetFacets& sheet,
                         const std::vector<SheetFacets>& sheets) const {
    std::vector<char> own(films_.mesh.points.size(), 0);
    for (const int f : sheet.facets) {
      for (const int v : topology_.facets[f].film) {
        own[v] = 1;
      }
    }
    SurfaceMesh others;
    for (const SheetFacets& other : sheets) {
      const bool touches =
          std::any_of(other.facets.begin(), other.facets.end(), [&](int f) {
            const Triangle& t = topology_.facets[f].film;
            return own[t[0]] != 0 || own[t[1]] != 0 || own[t[2]] != 0;
          });
      for (const int f : touches ? std::vector<int>() : other.facets) {
        others.facets.push_back(topology_.facets[f].film);
      }
    }
    if (!others.facets.empty()) {
      others.points = films_.mesh.points;
    }
    return others;
  }

  void offset(const SheetFacets& facets, const SurfaceMesh& others) {
    const WallSide side = side_of(facets);
    const Sheet sheet = make_sheet(mesh_of(facets));
    const std::map<int, std::set<int>> walls = walls_at(facets);
    std::vector<double> asked;
    for (const int v : sheet.origin) {
      double sum = 0.0;
      for (const int w : walls.at(v)) {
        sum += asked_.at(w, v);
      }
      asked.push_back(sum / static_cast<double>(walls.at(v).size()));
    }
    const std::vector<Jet> jets = fit_jets(sheet);
    ThickenOptions options;
    options.side = side;
    const SheetEnds ends = ends_of(sheet, jets, films_.planes);
    const OffsetSides sides =
        offset_sides(sheet, offset_directions(sheet, jets, asked, ends), asked,
                     options, ends);
    std::vector<double> safe_at;
    SafeThickness safe = safe_thickness(
        sheet, jets, asked, side,
        {.others = &others,
         .at_each = places_ == SafePlaces::Everywhere ? &safe_at : nullptr});
    for (std::size_t i = 0; i < safe_at.size(); ++i) {
      double& at = result_.safe_at[sheet.origin[i]];
      at = std::min(at, safe_at[i]);
    }
    note(walls_[wall_of(facets.facets[0])].region, sides, safe);
    std::vector<int> local(films_.mesh.points.size(), -1);
    for (std::size_t i = 0; i < sheet.origin.size(); ++i) {
      local[sheet.origin[i]] = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < facets.facets.size(); ++i) {
      const WallFacet& facet = topology_.facets[facets.facets[i]];
      const bool flipped = facets.flipped[i] != 0;
      for (int k = 0; k < 3; ++k) {
        const int v = facet.film[k];
        const int at = local[v];
        const Vec3& x = films_.mesh.points[v];
        const Vec3 front = sides.front[at] - x;
        const Vec3 back = sides.back[at] - x;
        set(facet.front[k], v, walls.at(v), asked[at], flipped ? back : front);
        set(facet.back[k], v, walls.at(v), asked[at], flipped ? front : back);
      }
    }
  }

  void set(int point, int v, const std::set<int>& walls, double asked,
           const Vec3& by) {
    std::vector<WallMove>& moves = result_.moves[point];
    if (topology_.junction[v] != 0 || !moves.empty()) {
      return;
    }
    for (const int w : walls) {
      const double part =
          asked_.at(w, v) / (asked * static_cast<double>(walls.size()));
      moves.push_back({w, part * by});
    }
  }

  void note(int region, const OffsetSides& sides, SafeThickness& safe) {
    const auto ratio = [](const MeasuredThickness& t) {
      return t.asked > 0.0 ? t.value / t.asked : 1.0;
    };
    MeasuredThickness& thinnest = result_.thinnest[region];
    if (thinnest.asked == 0.0 || ratio(sides.thinnest) < ratio(thinnest)) {
      thinnest = sides.thinnest;
    }
    MeasuredThickness& thickest = result_.thickest[region];
    if (thickest.asked == 0.0 || ratio(sides.thickest) > ratio(thickest)) {
      thickest = sides.thickest;
    }
    SafeThickness& least = result_.safe[region];
    if (least.message.empty() ||
        safe.value * least.asked < least.value * safe.asked) {
      least = std::move(safe);
    }
    result_.corrections[region] =
        std::max(result_.corrections[region], sides.corrections);
  }

  // --- junctions --------------------------------------------------------
  struct Sector {
    int vertex = -1;
    Mat3 matrix = Mat3::Zero();
    std::map<int, Vec3> right;  // per wall
  };

  void add_corner(const WallFacet& facet, int k, bool front,
                  std::map<int, Sector>& sectors) {
    const int v = facet.film[k];
    const int wall = films_.wall[facet.label];
    if (walls_[wall].side != WallSide::Both) {
      throw InvalidInput(fmt::format(
          "walls.{} lies on one side of its films, which meet others in a "
          "junction near {}; use side = \"both\" there",
          walls_[wall].name, text_of(films_.mesh.points[v])));
    }
    const Points& x = films_.mesh.points;
    const Vec3 a = x[facet.film[(k + 1) % 3]] - x[v];
    const Vec3 b = x[facet.film[(k + 2) % 3]] - x[v];
    const Vec3 area = a.cross(b);
    const Vec3 normal = (front ? 1.0 : -1.0) * area.normalized();
    const double angle = std::atan2(area.norm(), a.dot(b));
    Sector& sector = sectors[front ? facet.front[k] : facet.back[k]];
    sector.vertex = v;
    sector.matrix += angle * normal * normal.transpose();
    const Vec3 right = 0.5 * asked_.at(wall, v) * angle * normal;
    sector.right.try_emplace(wall, Vec3::Zero()).first->second += right;
  }

  void join() {
    std::map<int, Sector> sectors;  // per wall point
    for (const WallFacet& facet : topology_.facets) {
      for (int k = 0; k < 3; ++k) {
        if (topology_.junction[facet.film[k]] != 0) {
          add_corner(facet, k, true, sectors);
          add_corner(facet, k, false, sectors);
        }
      }
    }
    for (const auto& [point, sector] : sectors) {
      const Mat3 along =
          films_.planes.along(sector.vertex).value_or(Mat3::Identity());
      const Mat3 inverse = mitre_inverse(along * sector.matrix * along) * along;
      for (const auto& [wall, right] : sector.right) {
        result_.moves[point].push_back({wall, inverse * right});
      }
    }
  }

  void round(const std::vector<SheetFacets>& cut) {
    WallSheets sheets{.count = static_cast<int>(cut.size()),
                      .of = std::vector<int>(topology_.facets.size(), 0),
                      .flipped = std::vector<char>(topology_.facets.size(), 0)};
    for (std::size_t s = 0; s < cut.size(); ++s) {
      for (std::size_t i = 0; i < cut[s].facets.size(); ++i) {
        sheets.of[cut[s].facets[i]] = static_cast<int>(s);
        sheets.flipped[cut[s].facets[i]] = cut[s].flipped[i];
      }
    }
    const Points added =
        fillet_moves({topology_, films_, sheets, walls_,
                      [&](int wall, int v) { return asked_.at(wall, v); }});
    for (std::size_t p = 0; p < added.size(); ++p) {
      std::vector<WallMove>& moves = result_.moves[p];
      const int v = topology_.points[p].vertex;
      const auto along = v < 0 ? std::nullopt : films_.planes.along(v);
      for (WallMove& move : moves) {
        const Vec3 by = added[p] / static_cast<double>(moves.size());
        move.by += along ? Vec3(*along * by) : by;
      }
    }
  }

  const WallTopology& topology_;
  const WallFilms& films_;
  const std::vector<WallSpec>& walls_;
  SafePlaces places_;
  Asked asked_;
  WallReference result_;
};

}  // namespace

WallReference wall_reference(const WallTopology& topology,
                             const WallFilms& films,
                             const std::vector<WallSpec>& walls,
                             SafePlaces places) {
  return Reference(topology, films, walls, places).find();
}

}  // namespace meniscus::walls
