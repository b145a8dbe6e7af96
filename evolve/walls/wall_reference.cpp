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
    const std::vector<SheetFacets> cut = cut_into_sheets(topology_, films_);
    for (const SheetFacets& sheet : cut) {
      offset(sheet, apart_from(sheet, cut));
    }
    const WallSheets sheets = sheets_of(cut);
    join(sheets);
    round(sheets);
    return std::move(result_);
  }

 private:
  int wall_of(int f) const { return films_.wall[topology_.facets[f].label]; }

  /// The facets of a sheet, with a vertex for each fan of them: each pair of
  /// wall points.
  struct CutMesh {
    SurfaceMesh mesh;
    std::vector<int> vertex;  // of the film
    std::array<std::vector<int>, 2> points;
  };
  CutMesh cut_mesh(const SheetFacets& sheet) const {
    CutMesh cut;
    cut.mesh.labels = films_.mesh.labels;
    std::map<std::array<int, 2>, int> id;
    for (std::size_t i = 0; i < sheet.facets.size(); ++i) {
      const WallFacet& facet = topology_.facets[sheet.facets[i]];
      Triangle t;
      for (int k = 0; k < 3; ++k) {
        std::array<int, 2> points = {facet.front[k], facet.back[k]};
        if (sheet.flipped[i] != 0) {
          std::swap(points[0], points[1]);
        }
        const auto [at, is_new] =
            id.try_emplace(points, static_cast<int>(cut.vertex.size()));
        if (is_new) {
          cut.mesh.points.push_back(films_.mesh.points[facet.film[k]]);
          cut.vertex.push_back(facet.film[k]);
          cut.points[0].push_back(points[0]);
          cut.points[1].push_back(points[1]);
        }
        t[k] = at->second;
      }
      if (sheet.flipped[i] != 0) {
        std::swap(t[1], t[2]);
      }
      cut.mesh.facets.push_back(t);
      cut.mesh.facet_label.push_back(facet.label);
    }
    return cut;
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
    const int wall = wall_of(facets.facets[0]);
    const WallSide side = walls_[wall].side;
    const CutMesh cut = cut_mesh(facets);
    Sheet sheet = make_sheet(cut.mesh);
    std::array<std::vector<int>, 2> points;
    for (int& v : sheet.origin) {
      points[0].push_back(cut.points[0][v]);
      points[1].push_back(cut.points[1][v]);
      v = cut.vertex[v];
    }
    std::vector<double> asked;
    asked.reserve(sheet.origin.size());
    for (const int v : sheet.origin) {
      asked.push_back(asked_.at(wall, v));
    }
    const std::vector<Jet> jets = fit_jets(sheet);
    ThickenOptions options;
    options.side = side;
    const SheetEnds ends = ends_of(sheet, jets, films_.planes);
    OffsetSides sides =
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
    note(walls_[wall].region, sides, safe);
    for (std::size_t v = 0; v < sheet.origin.size(); ++v) {
      const Vec3& x = sheet.film.points[v];
      set(points[0][v], {wall, sides.front[v] - x});
      set(points[1][v], {wall, sides.back[v] - x});
    }
    offset_.push_back({std::move(sheet), std::move(sides), std::move(points)});
  }

  void set(int point, const WallMove& move) {
    std::vector<WallMove>& moves = result_.moves[point];
    if (topology_.junction[topology_.points[point].vertex] == 0 &&
        moves.empty()) {
      moves.push_back(move);
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
  struct SheetSide {
    int wall = 0;
    Vec3 normals = Vec3::Zero();  // by the facets' angles at the corner
    double offset = 0.0;          // [length]
  };

  /// Per wall point the sides that look into its sector, one for each fan: by
  /// the wall point behind and the sheet.
  using Corners = std::map<int, std::map<std::array<int, 2>, SheetSide>>;

  void add_corner(const WallSheets& sheets, int f, int k, Corners& corners) {
    const WallFacet& facet = topology_.facets[f];
    const int v = facet.film[k];
    const int wall = films_.wall[facet.label];
    const Points& x = films_.mesh.points;
    const Vec3 a = x[facet.film[(k + 1) % 3]] - x[v];
    const Vec3 b = x[facet.film[(k + 2) % 3]] - x[v];
    const Vec3 area = a.cross(b);
    const double angle = std::atan2(area.norm(), a.dot(b));
    const WallShares part = shares(walls_[wall].side);
    for (const bool front : {true, false}) {
      const int point = front ? facet.front[k] : facet.back[k];
      const int behind = front ? facet.back[k] : facet.front[k];
      const bool sheet_front = front != (sheets.flipped[f] != 0);
      SheetSide& side = corners[point][{behind, sheets.of[f]}];
      side.wall = wall;
      side.normals += (front ? angle : -angle) * area.normalized();
      side.offset = (sheet_front ? part.front : part.back) * asked_.at(wall, v);
    }
  }

  void join(const WallSheets& sheets) {
    Corners corners;
    for (std::size_t f = 0; f < topology_.facets.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        if (topology_.junction[topology_.facets[f].film[k]] != 0) {
          add_corner(sheets, static_cast<int>(f), k, corners);
        }
      }
    }
    for (const auto& [point, sides] : corners) {
      const Mat3 along = films_.planes.along(topology_.points[point].vertex)
                             .value_or(Mat3::Identity());
      std::vector<OffsetPlane> planes;
      std::vector<int> walls;
      for (const auto& [key, side] : sides) {
        planes.push_back({along * side.normals.normalized(), side.offset});
        walls.push_back(side.wall);
      }
      const OffsetCorner corner = offset_corner(planes);
      for (std::size_t i = 0; i < planes.size(); ++i) {
        if (corner.on[i] != 0) {
          add_move(
              {walls[i], corner.inverse * planes[i].normal * planes[i].offset},
              result_.moves[point]);
        }
      }
    }
  }

  WallSheets sheets_of(const std::vector<SheetFacets>& cut) {
    WallSheets sheets{.offset = std::move(offset_),
                      .of = std::vector<int>(topology_.facets.size(), 0),
                      .flipped = std::vector<char>(topology_.facets.size(), 0)};
    for (std::size_t s = 0; s < cut.size(); ++s) {
      for (std::size_t i = 0; i < cut[s].facets.size(); ++i) {
        sheets.of[cut[s].facets[i]] = static_cast<int>(s);
        sheets.flipped[cut[s].facets[i]] = cut[s].flipped[i];
      }
    }
    return sheets;
  }

  void round(const WallSheets& sheets) {
    const std::vector<std::vector<WallMove>> added = fillet_moves(
        {topology_, films_, sheets, walls_,
         [&](int wall, int v) { return asked_.at(wall, v); }, result_.moves});
    for (std::size_t p = 0; p < added.size(); ++p) {
      const int v = topology_.points[p].vertex;
      const Mat3 along = (v < 0 ? std::nullopt : films_.planes.along(v))
                             .value_or(Mat3::Identity());
      for (const WallMove& move : added[p]) {
        add_move({move.wall, along * move.by}, result_.moves[p]);
      }
    }
  }

  const WallTopology& topology_;
  const WallFilms& films_;
  const std::vector<WallSpec>& walls_;
  SafePlaces places_;
  Asked asked_;
  WallReference result_;
  std::vector<OffsetSheet> offset_;
};

}  // namespace

WallReference wall_reference(const WallTopology& topology,
                             const WallFilms& films,
                             const std::vector<WallSpec>& walls,
                             SafePlaces places) {
  return Reference(topology, films, walls, places).find();
}

}  // namespace meniscus::walls
