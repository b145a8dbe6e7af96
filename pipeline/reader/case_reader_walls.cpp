#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

const std::vector<case_data::Named<walls::WallSide>>& wall_sides() {
  static const std::vector<case_data::Named<walls::WallSide>> sides = {
      {"both", walls::WallSide::Both},
      {"inside", walls::WallSide::Inside},
      {"outside", walls::WallSide::Outside}};
  return sides;
}

/// Films that the table's `films` names, each once.
std::vector<std::string> wall_films(CaseContext& context,
                                    const CaseTable& table,
                                    const case_data::Case& result,
                                    std::map<std::string, std::string>& taken) {
  const std::vector<std::string> known = case_data::film_names(result);
  std::vector<std::string> films;
  for (const std::string& film : table.names("films")) {
    const auto at = taken.find(film);
    if (std::find(known.begin(), known.end(), film) == known.end()) {
      context.problems.unknown(table.line("films"), "film", film, known);
    } else if (at != taken.end()) {
      context.problems.add(
          table.line("films"),
          fmt::format("{}.films names '{}', of which '{}' is made already; a "
                      "film has one wall",
                      table.path(), film, at->second));
    } else {
      taken[film] = table.name();
      films.push_back(film);
    }
  }
  return films;
}

bool joins(const case_data::Case& input, const case_data::WallEntry& wall,
           const case_data::WallEntry& other) {
  const auto is_of = [](const case_data::WallEntry& w,
                        const std::string& film) {
    return std::find(w.films.begin(), w.films.end(), film) != w.films.end();
  };
  return std::any_of(input.films.begin(), input.films.end(),
                     [&](const case_data::FilmEntry& film) {
                       const std::vector<std::string>& joined = film.spec.joins;
                       return is_of(wall, film.spec.name) &&
                              std::any_of(joined.begin(), joined.end(),
                                          [&](const std::string& name) {
                                            return is_of(other, name);
                                          });
                     });
}

bool meet(const case_data::Case& input, const case_data::WallEntry& a,
          const case_data::WallEntry& b, const case_data::CurvePairs& sharing) {
  const std::vector<std::string> there = case_data::curves_of_wall(input, b);
  const std::vector<std::string> here = case_data::curves_of_wall(input, a);
  return joins(input, a, b) || joins(input, b, a) ||
         std::any_of(here.begin(), here.end(), [&](const std::string& one) {
           return std::any_of(
               there.begin(), there.end(), [&](const std::string& other) {
                 return one == other || sharing.contains({one, other});
               });
         });
}

/// Walls whose films share a curve or a side of one, or of which one joins the
/// other, become one body, numbered by its first.
void find_regions(CaseContext& context, case_data::Case& result) {
  std::vector<case_data::WallEntry>& walls = result.walls;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    walls[k].region = static_cast<int>(k);
  }
  const case_data::CurvePairs& sharing = result.sharing_sides;
  for (bool changed = true; changed;) {
    changed = false;
    for (case_data::WallEntry& a : walls) {
      for (const case_data::WallEntry& b : walls) {
        if (b.region < a.region && meet(result, a, b, sharing)) {
          a.region = b.region;
          changed = true;
        }
      }
    }
  }
  std::map<int, int> number;
  std::map<int, const case_data::WallEntry*> first;
  for (case_data::WallEntry& wall : walls) {
    wall.region =
        number.try_emplace(wall.region, static_cast<int>(number.size()))
            .first->second;
    const case_data::WallEntry& other =
        *first.try_emplace(wall.region, &wall).first->second;
    if (other.material != wall.material) {
      context.problems.add(
          wall.line,
          fmt::format("walls.{} and walls.{} meet and so are one body, but "
                      "their materials differ; give both the same",
                      other.name, wall.name));
    }
  }
}

/// kVoid without the key, and where there is no such material.
int material_of(CaseContext& context, const CaseTable& table,
                const case_data::Case& result) {
  const auto wanted = table.text("material");
  if (!wanted) {
    return case_data::kVoid;
  }
  std::vector<std::string> known;
  for (const case_data::MaterialEntry& material : result.materials) {
    if (material.name == *wanted) {
      return static_cast<int>(known.size());
    }
    known.push_back(material.name);
  }
  context.problems.unknown(table.line("material"), "material", *wanted, known);
  return case_data::kVoid;
}

std::vector<std::string> flush_curves(CaseContext& context,
                                      const CaseTable& table,
                                      const case_data::Case& result) {
  std::vector<std::string> known;
  for (const case_data::CurveEntry& curve : result.curves) {
    known.push_back(curve.name);
  }
  const std::vector<std::string> wanted = table.names("flush");
  for (const std::string& curve : wanted) {
    if (std::find(known.begin(), known.end(), curve) == known.end()) {
      context.problems.unknown(table.line("flush"), "curve", curve, known);
    }
  }
  return wanted;
}

}  // namespace

TableSpec wall_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "walls",
      true,
      TableNeed::Optional,
      "Films made solid by thickness. `meniscus evolve` reports the largest "
      "safe one and writes the closed surface",
      {{"films", K::Names, D::None, true,
        "the film, or several; where they share a curve they are joined"},
       {"thickness", K::Field, D::Length, true,
        "above 0; the film takes it along: of x, y, z where the frozen film "
        "is"},
       {"material", K::Name, D::None, false,
        "of the wall; a run needs it, and walls that meet have one"},
       {"fillet", K::Constant, D::Length, false,
        "radius where three or more films meet, 0: sharp; half the thickness "
        "when left out"},
       {"flush", K::Names, D::None, false,
        "planar curves in whose plane the wall ends, as feet on a floor; at "
        "others it ends square to its films"},
       {"side", K::Choice, D::None, false,
        "where the material lies: both sides of the film, all of it inside "
        "(towards the middle of the film's curves) or outside; both when left "
        "out",
        case_data::choices_of(wall_sides())}}};
}

void read_walls(CaseContext& context, const toml::table& root,
                case_data::Case& result) {
  std::map<std::string, std::string> taken;
  for (const CaseTable& table : named_tables(context, root, "walls")) {
    case_data::WallEntry wall{.name = table.name(), .line = table.line()};
    wall.films = wall_films(context, table, result, taken);
    wall.thickness =
        table.place_quantity("thickness").value_or(case_data::PlaceQuantity{});
    wall.side = case_data::row_named(wall_sides(),
                                     table.choice("side").value_or("both"))
                    .value;
    wall.fillet = table.constant("fillet");
    if (wall.fillet && !(*wall.fillet >= 0.0)) {
      context.problems.add(table.line("fillet"),
                           fmt::format("{}.fillet is {:g}; it must not be "
                                       "below 0",
                                       table.path(), *wall.fillet));
    }
    wall.flush = flush_curves(context, table, result);
    wall.material = material_of(context, table, result);
    result.walls.push_back(std::move(wall));
  }
  find_regions(context, result);
}

TableSpec shell_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "shells",
      true,
      TableNeed::Optional,
      "Films analysed as shells, on their own facets: for thicknesses well "
      "below the films' size",
      {{"films", K::Names, D::None, true,
        "the film, or several; where they share a curve they are joined"},
       {"thickness", K::Field, D::Length, true,
        "above 0; the film takes it along: of x, y, z where the frozen film "
        "is"},
       {"material", K::Name, D::None, false,
        "of the whole thickness; or layers. Axis 1 of an orthotropic one lies "
        "along its projection on the film, axis 3 along the normal to the "
        "outside"},
       {"layers", K::Layers, D::None, false,
        "what the thickness is made of, from the inside to the outside"},
       {"direction", K::ConstantVector, std::nullopt, false,
        "angles of layers count from its projection on the film, which must "
        "have one everywhere; axis 1 of their materials when left out"},
       {"side", K::Choice, D::None, false,
        "where the material lies: both sides of the film, all of it inside "
        "(towards the middle of the film's curves) or outside; both when left "
        "out",
        case_data::choices_of(wall_sides())}}};
}

TableSpec layer_table() {
  using D = Dimension;
  using K = KeyType;
  return {"layer",
          false,
          TableNeed::Optional,
          "A layer of a shell",
          {{"material", K::Name, D::None, true,
            "of an orthotropic one axis 3 is the normal to the outside"},
           {"share", K::Constant, D::None, false,
            "of the thickness, in parts of the sum of all shares, above 0; 1 "
            "when left out"},
           {"angle", K::Quantity, D::Angle, false,
            "of an orthotropic material: of its axis 1 from the direction, "
            "about the normal to the outside; 0 when left out"}}};
}

namespace {

/// Of `material`, or of `layers`.
std::vector<case_data::LayerEntry> read_layers(CaseContext& context,
                                               const CaseTable& table,
                                               const case_data::Case& result) {
  std::vector<case_data::LayerEntry> layers;
  if (table.has("material") == table.has("layers")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has {} of 'material' and 'layers'; expected one: "
                    "material = what its whole thickness is, or layers = a "
                    "list of them",
                    table.path(), table.has("material") ? "both" : "none"));
  }
  const auto add = [&](const CaseTable& of, case_data::LayerEntry layer) {
    layer.material = std::max(0, material_of(context, of, result));
    layer.line = of.line();
    layers.push_back(std::move(layer));
  };
  for (const CaseTable& part : table.tables("layers", "layer")) {
    add(part, {.share = constant_above(context, part, "share", 0.0, 1.0),
               .angle = part.quantity_or_zero("angle")});
  }
  if (layers.empty()) {
    add(table, {});
  }
  return layers;
}

/// Angles count from one direction.
void check_direction(CaseContext& context, const CaseTable& table,
                     const case_data::ShellEntry& shell,
                     const case_data::Case& result) {
  if (shell.direction) {
    if (shell.direction->isZero(0.0)) {
      context.problems.add(table.line("direction"),
                           fmt::format("{}.direction is 0, which is none; "
                                       "give it a length",
                                       table.path()));
    }
    return;
  }
  const case_data::MaterialEntry* first = nullptr;
  for (const case_data::LayerEntry& layer : shell.layers) {
    const auto k = static_cast<std::size_t>(layer.material);
    if (k >= result.materials.size() || !result.materials[k].orthotropic) {
      continue;
    }
    const case_data::MaterialEntry& own = result.materials[k];
    if (first != nullptr &&
        own.orthotropic->axes.first != first->orthotropic->axes.first) {
      context.problems.add(
          layer.line,
          fmt::format("{} has layers of '{}' and '{}', whose axes 1 differ; "
                      "give it the direction that its angles count from",
                      table.path(), first->name, own.name));
      return;
    }
    first = &own;
  }
}

}  // namespace

void read_shells(CaseContext& context, const toml::table& root,
                 case_data::Case& result) {
  std::map<std::string, std::string> taken;
  for (const CaseTable& table : named_tables(context, root, "shells")) {
    case_data::ShellEntry shell{.name = table.name(), .line = table.line()};
    shell.films = wall_films(context, table, result, taken);
    shell.thickness =
        table.place_quantity("thickness").value_or(case_data::PlaceQuantity{});
    shell.side = case_data::row_named(wall_sides(),
                                      table.choice("side").value_or("both"))
                     .value;
    shell.layers = read_layers(context, table, result);
    shell.direction = table.constant_vector("direction");
    check_direction(context, table, shell, result);
    result.shells.push_back(std::move(shell));
  }
}

namespace {

/// Curves at which films end, by all their names: what lies on another curve
/// is that one.
std::map<std::string, std::string> curves_of_films(
    const case_data::Case& result) {
  std::map<std::string, std::string> kept;
  for (const case_data::FilmEntry& film : result.films) {
    for (const std::string& curve : film.spec.curves) {
      kept[curve] = curve;
    }
  }
  for (const case_data::MergedCurves& merged : result.merged) {
    const std::string& name =
        result.curves[static_cast<std::size_t>(merged.kept)].name;
    if (kept.count(name) != 0) {
      kept[result.curves[static_cast<std::size_t>(merged.dropped)].name] = name;
    }
  }
  return kept;
}

/// The STEP solid whose edge the curve is; null for others.
const case_data::StepSolidEntry* step_solid_at(const case_data::Case& result,
                                               const std::string& curve) {
  for (const case_data::StepSolidEntry& solid : result.step_solids) {
    const auto& rims = solid.spec.rims;
    if (std::any_of(rims.begin(), rims.end(),
                    [&](const auto& rim) { return rim.curve == curve; })) {
      return &solid;
    }
  }
  return nullptr;
}

/// The face on which the film at this curve slides; empty: none.
std::string wetted_at(const case_data::Case& result, const std::string& curve) {
  for (const case_data::CapEntry& cap : result.caps) {
    const std::vector<std::string> curves = cap.spec.curves();
    if (cap.wetted &&
        std::find(curves.begin(), curves.end(), curve) != curves.end()) {
      return cap.spec.name;
    }
  }
  return "";
}

class FilletReader {
 public:
  FilletReader(CaseContext& context, case_data::Case& result)
      : context_(context), result_(result), kept_(curves_of_films(result)) {}

  void read(const CaseTable& table) {
    case_data::FilletEntry fillet{.name = table.name(),
                                  .curves = {},
                                  .radius = table.quantity_or_zero("radius"),
                                  .line = table.line()};
    for (const std::string& curve : table.names("curves")) {
      const auto at = kept_.find(curve);
      if (at == kept_.end()) {
        unknown(table, curve);
      } else if (is_new(table, at->second)) {
        fillet.curves.push_back(at->second);
      }
    }
    if (!result_.walls.empty()) {
      add(table, table.line(),
          "stands beside walls, whose films are rounded by the fillet of "
          "[walls]; take one of the two out");
    }
    result_.fillets.push_back(std::move(fillet));
  }

 private:
  void add(const CaseTable& table, case_data::SourceLine line,
           const std::string& text) {
    context_.problems.add(line, table.path() + " " + text);
  }

  void unknown(const CaseTable& table, const std::string& curve) {
    std::vector<std::string> known;
    known.reserve(kept_.size());
    for (const auto& [name, kept] : kept_) {
      known.push_back(name);
    }
    context_.problems.unknown(table.line("curves"), "curve of a film", curve,
                              known);
  }

  bool is_new(const CaseTable& table, const std::string& curve) {
    const case_data::SourceLine line = table.line("curves");
    if (const auto [first, is_first] = taken_.emplace(curve, table.name());
        !is_first) {
      add(table, line,
          fmt::format("rounds curve '{}', which fillets.{} does already; a "
                      "curve has one radius",
                      curve, first->second));
      return false;
    }
    if (const auto* solid = step_solid_at(result_, curve)) {
      add(table, line,
          fmt::format("rounds curve '{}', an edge of the STEP solid '{}', "
                      "whose faces stay as they are; round other curves, or "
                      "model the fillet in the file",
                      curve, solid->spec.name));
      return false;
    }
    if (const std::string face = wetted_at(result_, curve); !face.empty()) {
      add(table, line,
          fmt::format("rounds curve '{}', from which the film slides on '{}' "
                      "to its contact angle; round curves that hold films",
                      curve, face));
      return false;
    }
    return true;
  }

  CaseContext& context_;
  case_data::Case& result_;
  std::map<std::string, std::string> kept_;
  std::map<std::string, std::string> taken_;  // by which fillet
};

}  // namespace

TableSpec fillet_table() {
  using D = Dimension;
  using K = KeyType;
  return {"fillets",
          true,
          TableNeed::Optional,
          "Corners along curves where films meet solids or each other, rounded",
          {{"curves", K::Names, D::None, true,
            "of films: each where a film and one other surface of the part "
            "meet"},
           {"radius", K::Quantity, D::Length, true,
            "of the ball that rolls along; 0: sharp"}}};
}

void read_fillets(CaseContext& context, const toml::table& root,
                  case_data::Case& result) {
  FilletReader reader(context, result);
  for (const CaseTable& table : named_tables(context, root, "fillets")) {
    reader.read(table);
  }
}

}  // namespace meniscus::reader
