/// Films and solids: from curves, facets in the case, and files.
#include <algorithm>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"
#include "pipeline/reader/facet_file.h"

namespace meniscus::reader {

namespace {

std::vector<std::string> curve_names(const case_data::Case& result) {
  std::vector<std::string> names;
  for (const case_data::CurveEntry& curve : result.curves) {
    names.push_back(curve.name);
  }
  return names;
}

constexpr double kRightAngle = std::numbers::pi / 2.0;

struct FilmRow {
  const char* name;
  films::FilmKind kind;
  case_data::KindKeys keys;
  std::string_view doc;
  // Curves that it names, where their number is not free:
  std::size_t least = 0;
  std::size_t most = std::size_t(-1);
  const char* needs = "";
};

const std::vector<FilmRow>& film_kinds() {
  static const std::vector<FilmRow> kinds = {
      {"branch",
       films::FilmKind::Branch,
       {{"curves"}, {"tension", "drop"}},
       "convex hull of any number of curves less their caps",
       2,
       std::size_t(-1),
       "a branch needs two or more"},
      {"loft",
       films::FilmKind::Loft,
       {{"curves"}, {"joins", "tension", "drop"}},
       "band between two",
       2,
       2,
       "a loft needs two"},
      {"disk",
       films::FilmKind::Disk,
       {{"curves"}, {"joins", "tension", "drop"}},
       "across the first, around the others, which lie within it as seen along "
       "it",
       1,
       std::size_t(-1),
       "a disk needs one or more"},
      {"spines",
       films::FilmKind::Spines,
       {{}, {"curves", "tension", "drop"}},
       "around the spines of its body, one of which ends at each curve"},
      {"facets",
       films::FilmKind::Facets,
       {{"vertices", "facets"}, {"curves", "within", "tension", "drop"}},
       "given here"},
      {"file",
       films::FilmKind::Facets,
       {{"file"}, {"curves", "surface", "scale", "within", "tension", "drop"}},
       "facets of an STL, OBJ or Surface Evolver file"}};
  return kinds;
}

struct SolidRow {
  const char* name;
  case_data::KindKeys keys;
  std::string_view doc;
};

/// Faces, then features, which are made of such.
std::vector<SolidRow> with_features(std::vector<SolidRow> rows) {
  for (const FeatureRow& row : feature_kinds()) {
    rows.push_back({row.name, row.keys, row.doc});
  }
  return rows;
}

const std::vector<SolidRow>& solid_kinds() {
  static const std::vector<SolidRow> kinds = with_features(
      {{"cap", {{"curve"}, {"holes"}}, "flat disk across a planar curve"},
       {"ring",
        {{"curve", "inner"}, {}},
        "band between two curves, flat where they lie in one plane"},
       {"wetted",
        {{"curve"},
         {"wall", "at", "normal", "axis", "radius", "half_angle", "file",
          "face", "holes", "contact_angle"}},
        "the face that a body wets on a wall: the film that begins at its "
        "curve ends there and slides"},
       {"sides",
        {{"curves"}, {}},
        "the plane faces between the sides of two polygons"},
       {"file",
        {{"file"}, {"curves", "surface", "scale", "within"}},
        "facets of an STL, OBJ or Surface Evolver file, which stay as they "
        "are"},
       {"step",
        {{"file"}, {"rims", "open", "rotate", "axis", "about", "move"}},
        "a solid of a STEP file, its faces exact: NAME/FACE by their names or "
        "face_1, face_2, ..."}});
  return kinds;
}

void check_curves(CaseContext& context, const CaseTable& table,
                  const std::vector<std::string>& known,
                  const std::vector<std::string>& curves) {
  std::set<std::string> seen;
  for (const std::string& curve : curves) {
    if (std::find(known.begin(), known.end(), curve) == known.end()) {
      context.problems.unknown(table.line("curves"), "curve", curve, known);
    } else if (!seen.insert(curve).second) {
      context.problems.add(table.line("curves"),
                           fmt::format("{} names curve '{}' twice; name each "
                                       "once",
                                       table.path(), curve));
    }
  }
}

void check_count(CaseContext& context, const CaseTable& table,
                 const FilmRow& row, std::size_t count) {
  if (count > 0 && (count < row.least || count > row.most)) {
    context.problems.add(table.line("curves"),
                         fmt::format("{} names {} curve{}; {}", table.path(),
                                     count, count == 1 ? "" : "s", row.needs));
  }
}

/// The facets of a file that films or solids start from; null with a problem
/// noted.
std::shared_ptr<const films::StartFacets> read_start(CaseContext& context,
                                                     const CaseTable& table,
                                                     case_data::Case& result) {
  const auto path = table.text("file");
  if (!path) {
    return nullptr;
  }
  const std::string surface = table.text("surface").value_or("");
  const double scale = table.constant("scale").value_or(1.0);
  if (!(scale > 0.0)) {
    context.problems.add(
        table.line("scale"),
        fmt::format("{}.scale is {:g}; expected a factor above 0", table.path(),
                    scale));
    return nullptr;
  }
  try {
    return start_from_file(result, *path, surface, scale);
  } catch (const Error& error) {
    context.problems.add(table.line(surface.empty() ? "file" : "surface"),
                         fmt::format("{}: {}", table.path(), error.what()));
    return nullptr;
  }
}

/// How far rims may lie off their curves; what is left out is set once the
/// edge length is known.
double read_within(CaseContext& context, const CaseTable& table) {
  const auto within = table.constant("within");
  if (within && !(*within > 0.0)) {
    context.problems.add(
        table.line("within"),
        fmt::format("{}.within is {:g}; expected a length above 0",
                    table.path(), *within));
  }
  return within.value_or(0.0);
}

/// The shape of a film's free drops.
std::vector<case_data::SpheroidEntry> read_drop(const CaseTable& table) {
  std::vector<case_data::SpheroidEntry> result;
  for (const CaseTable& part : table.tables("drop", "drop")) {
    result.push_back(
        {.axis = part.vector_or_zero("axis"),
         .along = part.quantity_or_zero("along"),
         .across = part.quantity_or_zero("across"),
         .line = part.line(),
         .key = fmt::format("{}[{}]", part.path(), result.size())});
  }
  return result;
}

case_data::FilmEntry read_film(CaseContext& context, const CaseTable& table,
                               const std::vector<std::string>& known,
                               case_data::Case& result) {
  case_data::FilmEntry film{.line = table.line()};
  film.spec.name = table.name();
  film.spec.curves = table.names("curves");
  if (const auto kind = table.choice("kind")) {
    const FilmRow& row = case_data::row_named(film_kinds(), *kind);
    table.check_kind(*kind, row.keys);
    film.spec.kind = row.kind;
    check_count(context, table, row, film.spec.curves.size());
    if (*kind == "facets") {
      film.vertices = table.vectors("vertices");
      film.facets = table.facets("facets", std::ssize(film.vertices));
    } else if (*kind == "file") {
      film.spec.start = read_start(context, table, result);
    }
    film.spec.within = read_within(context, table);
  }
  check_curves(context, table, known, film.spec.curves);
  film.spec.joins = table.names("joins");
  film.tension = table.place_quantity("tension").value_or(
      case_data::PlaceQuantity{{.expression = Expression(1.0),
                                .line = table.line(),
                                .key = table.path() + ".tension"}});
  require_space(context, result, film.tension);
  film.drop = read_drop(table);
  return film;
}

const case_data::CurveEntry* polygon_named(const case_data::Case& input,
                                           const std::string& name) {
  for (const case_data::CurveEntry& curve : input.curves) {
    if (curve.name == name) {
      return curve.kind == case_data::CurveKind::Polygon &&
                     !curve.points.empty()
                 ? &curve
                 : nullptr;
    }
  }
  return nullptr;
}

/// A polygon NAME/k between each two sides, across which the solid lies.
void read_sides(CaseContext& context, const CaseTable& table,
                const std::vector<std::string>& known, case_data::Case& result,
                films::CapSpec& spec) {
  const std::vector<std::string> curves = table.names("curves");
  if (curves.empty()) {
    return;  // told already
  }
  check_curves(context, table, known, curves);
  const bool two = curves.size() == 2 && curves[0] != curves[1];
  const case_data::CurveEntry* low =
      two ? polygon_named(result, curves[0]) : nullptr;
  const case_data::CurveEntry* high =
      two ? polygon_named(result, curves[1]) : nullptr;
  if (low == nullptr || high == nullptr ||
      low->points.size() != high->points.size()) {
    context.problems.add(
        table.line("curves"),
        fmt::format("{}.curves: found [{}]; expected two curves of kind "
                    "polygon with as many points, in the same order",
                    table.path(), fmt::join(curves, ", ")));
    return;
  }
  const std::vector<case_data::PathPoint> a = low->points;
  const std::vector<case_data::PathPoint> b = high->points;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::size_t next = (k + 1) % a.size();
    case_data::CurveEntry face{
        .name = fmt::format("{}/{}", table.name(), k + 1),
        .kind = case_data::CurveKind::Polygon,
        .line = table.line()};
    face.points = {a[k], a[next], b[next], b[k]};
    spec.more.push_back(face.name);
    result.curves.push_back(std::move(face));
  }
  spec.curve = spec.more.front();
  spec.more.erase(spec.more.begin());
}

/// The curves of a cap or ring.
void read_rims(CaseContext& context, const CaseTable& table,
               const std::vector<std::string>& known, films::CapSpec& spec) {
  const auto check = [&](const char* key, const std::string& curve) {
    if (std::find(known.begin(), known.end(), curve) == known.end()) {
      context.problems.unknown(table.line(key), "curve", curve, known);
    }
  };
  const auto read_curve = [&](const char* key) -> std::string {
    const auto curve = table.text(key);
    if (curve) {
      check(key, *curve);
    }
    return curve.value_or("");
  };
  spec.curve = read_curve("curve");
  spec.inner = read_curve("inner");
  if (!spec.inner.empty() && spec.inner == spec.curve) {
    context.problems.add(
        table.line("inner"),
        fmt::format("{} has the curve '{}' on both sides; a ring needs two",
                    table.path(), spec.curve));
  }
  spec.more = table.names("holes");
  std::set<std::string> seen = {spec.curve};
  for (const std::string& hole : spec.more) {
    check("holes", hole);
    if (!seen.insert(hole).second) {
      context.problems.add(table.line("holes"),
                           fmt::format("{} names curve '{}' twice; name each "
                                       "once",
                                       table.path(), hole));
    }
  }
}

/// A kind of wall and the keys that say where it is; without `kind` the face
/// says it.
struct WallRow {
  const char* name;
  std::optional<films::WallKind> kind;
  std::vector<const char*> keys;
  std::string_view doc;
};

const std::vector<WallRow>& wall_kinds() {
  static const std::vector<WallRow> kinds = {
      {"plane",
       films::WallKind::Plane,
       {"at", "normal"},
       "across normal, through at"},
      {"cylinder",
       films::WallKind::Cylinder,
       {"at", "axis", "radius"},
       "about axis, through at"},
      {"sphere", films::WallKind::Sphere, {"at", "radius"}, "about at"},
      {"cone",
       films::WallKind::Cone,
       {"at", "axis", "half_angle"},
       "its apex at, opening along axis"},
      {"step",
       std::nullopt,
       {"file", "face"},
       "a face of a STEP file, which is one of these"}};
  return kinds;
}

/// Says which of the keys of walls this one has to have, and has not to.
void check_wall_keys(CaseContext& context, const CaseTable& table,
                     const WallRow& row) {
  for (const char* key :
       {"at", "normal", "axis", "radius", "half_angle", "file", "face"}) {
    const bool wanted =
        std::find_if(row.keys.begin(), row.keys.end(), [&](const char* k) {
          return std::string_view(k) == key;
        }) != row.keys.end();
    if (wanted != table.has(key)) {
      const std::string wall =
          row.kind ? fmt::format("a {}", row.name) : "the face of a STEP file";
      context.problems.add(
          wanted ? table.line() : table.line(key),
          wanted
              ? fmt::format("{} has no '{}'; its wall is {}, which needs {}",
                            table.path(), key, wall, fmt::join(row.keys, ", "))
              : fmt::format("{}.{} is of other walls than {}, which has {}; "
                            "leave it out",
                            table.path(), key, wall,
                            fmt::join(row.keys, ", ")));
    }
  }
}

/// The wall that a face of a STEP file lies on.
case_data::WettedWall wall_of_face(CaseContext& context, const CaseTable& table,
                                   case_data::Case& result) {
  case_data::WettedWall wall;
  const auto number = [&](double value) {
    return case_data::Quantity{.expression = Expression(value),
                               .line = table.line("face"),
                               .key = table.path() + ".face"};
  };
  const auto vector = [&](const Vec3& v) {
    return case_data::QuantityVector{number(v.x()), number(v.y()),
                                     number(v.z())};
  };
  const films::FilmWall face =
      read_wall_face(context, table, result).value_or(films::FilmWall{});
  wall.kind = face.kind;
  wall.at = vector(face.at);
  wall.normal = vector(face.normal);
  if (face.kind == films::WallKind::Cylinder ||
      face.kind == films::WallKind::Sphere) {
    wall.radius = number(face.radius);
  }
  if (face.kind == films::WallKind::Cone) {
    wall.half_angle = number(face.half_angle);
  }
  return wall;
}

/// Where films slide on a wall, which belongs to the frozen model.
case_data::WettedWall read_wetted(CaseContext& context, const CaseTable& table,
                                  case_data::Case& result) {
  const std::optional<std::string> kind = table.choice("wall");
  const WallRow& row =
      case_data::row_named(wall_kinds(), kind.value_or("plane"));
  if (kind || !table.has("wall")) {
    check_wall_keys(context, table, row);
  }
  case_data::WettedWall wall;
  if (row.kind) {
    const bool plane = row.kind == films::WallKind::Plane;
    wall = {.kind = *row.kind,
            .at = table.vector_or_zero("at"),
            .normal = table.vector_or_zero(plane ? "normal" : "axis"),
            .radius = table.quantity("radius"),
            .half_angle = table.quantity("half_angle"),
            .contact_angle = {}};
  } else {
    wall = wall_of_face(context, table, result);
  }
  wall.contact_angle = table.quantity("contact_angle")
                           .value_or(case_data::Quantity{
                               .expression = Expression(kRightAngle),
                               .line = table.line(),
                               .key = table.path() + ".contact_angle"});
  for (const case_data::QuantityVector& vector : {wall.at, wall.normal}) {
    for (const case_data::Quantity& quantity : vector) {
      require_frozen(context, quantity, "a wall's place");
    }
  }
  for (const std::optional<case_data::Quantity>& size :
       {wall.radius, wall.half_angle}) {
    if (size) {
      require_frozen(context, *size, "a wall's size");
    }
  }
  return wall;
}

case_data::CapEntry read_solid(CaseContext& context, const CaseTable& table,
                               const std::vector<std::string>& known,
                               case_data::Case& result) {
  case_data::CapEntry cap{.spec = {.name = table.name(), .curve = ""},
                          .line = table.line()};
  const auto kind = table.choice("kind");
  if (!kind) {
    return cap;
  }
  table.check_kind(*kind, case_data::row_named(solid_kinds(), *kind).keys);
  if (*kind == "file") {
    cap.is_file = true;
    cap.spec.rims = table.names("curves");
    check_curves(context, table, known, cap.spec.rims);
    cap.spec.start = read_start(context, table, result);
    cap.spec.within = read_within(context, table);
  } else if (*kind == "sides") {
    read_sides(context, table, known, result, cap.spec);
  } else {
    read_rims(context, table, known, cap.spec);
    if (*kind == "wetted") {
      cap.wetted = read_wetted(context, table, result);
    }
  }
  return cap;
}

}  // namespace

TableSpec film_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "films",
      true,
      TableNeed::Optional,
      "A liquid film between curves",
      {{"kind", K::Choice, D::None, true,
        "how the liquid starts: " +
            case_data::meanings_of(film_kinds(), {" (", ")", ", "}),
        case_data::choices_of(film_kinds())},
       {"curves", K::Names, D::None, false,
        "the curves that hold it; of facets and file those that its rims lie "
        "on, none where it is closed"},
       {"joins", K::Names, D::None, false,
        "of loft and disk: films that it ends on along the free sides of its "
        "curves, wherever the line comes to rest"},
       {"tension", K::Field, D::Tension, false,
        "energy per area of the film, above 0; 1 when left out"},
       {"drop", K::Spheroids, D::None, false,
        "makes the tension depend on how the film is turned: spheroids whose "
        "sum (Minkowski's) is the shape of its free drops; a sphere of radius "
        "1 when left out"},
       {"vertices", K::Vectors, D::Length, false,
        "of facets: where its corners are at first"},
       {"facets", K::Facets, D::None, false,
        "of facets: three or more numbers of vertices each, from 0, all the "
        "same way around"},
       {"file", K::Text, D::None, false,
        "of file: .stl, .obj or .fe, relative to the case file"},
       {"surface", K::Name, D::None, false,
        "of file: one of its surfaces (STL solid, OBJ group; film_1, film_2, "
        "... of a datafile); all when left out"},
       {"scale", K::Constant, D::None, false,
        "of file: what its lengths are multiplied by; 1 when left out"},
       {"within", K::Constant, D::Length, false,
        "of facets and file: how far rims may lie off their curves; a quarter "
        "of resolution.fea when left out"}}};
}

TableSpec drop_table() {
  using D = Dimension;
  using K = KeyType;
  return {"drop",
          false,
          TableNeed::Optional,
          "A spheroid: long ones round edges along their axis, flat ones make "
          "faces across it",
          {{"axis", K::Vector, D::None, true, "its direction, of any length"},
           {"along", K::Quantity, D::None, true,
            "half its length along the axis, above 0"},
           {"across", K::Quantity, D::None, true,
            "its radius about the axis, above 0"}}};
}

TableSpec solid_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "solids",
      true,
      TableNeed::Optional,
      "A solid surface, named so that loads find it",
      {{"kind", K::Choice, D::None, true, case_data::meanings_of(solid_kinds()),
        case_data::choices_of(solid_kinds()), "plate|pad|faces"},
       {"curve", K::Name, D::None, false,
        "of cap, ring: its rim; of wetted: where the film begins, on the wall, "
        "or within 0.15 of its size of one that is bent; or a polygon with a "
        "side on each of several planes; it holds nothing"},
       {"inner", K::Name, D::None, false, "of ring: the rim of its hole"},
       {"holes", K::Names, D::None, false,
        "of cap: curves in its plane that it leaves open; of wetted likewise, "
        "where films begin"},
       {"curves", K::Names, D::None, false,
        "of sides: two polygons of as many corners; of file: those that its "
        "rims lie on; of flange: those in its top face that films grow from"},
       {"file", K::Text, D::None, false,
        "of file: as of films; of step, and of wetted with that wall: .step or "
        ".stp"},
       {"face", K::Text, D::None, false,
        "of wetted on a face of a STEP file: its name there, or face_1, "
        "face_2, ..., a plane, cylinder, sphere or cone"},
       {"surface", K::Name, D::None, false, "of file: as of films"},
       {"scale", K::Constant, D::None, false, "of file: as of films"},
       {"within", K::Constant, D::Length, false, "of file: as of films"},
       {"at", K::Vector, D::Length, false,
        "of boss: the middle of its seat; of flange: of its top face; of lug: "
        "of its bore; of block: its own; of wetted: a point of the plane or of "
        "a cylinder's axis, a sphere's center, a cone's apex; the same for "
        "every design"},
       {"wall", K::Choice, D::None, false,
        "of wetted: " + case_data::meanings_of(wall_kinds()) +
            "; plane when left out",
        case_data::choices_of(wall_kinds())},
       {"normal", K::Vector, std::nullopt, false,
        "of wetted: of a plane wall, either way, any length but 0; the same "
        "for "
        "every design"},
       {"half_angle", K::Quantity, D::Angle, false,
        "of wetted: of a cone, between its axis and its lines; the same for "
        "every design"},
       {"contact_angle", K::Quantity, D::Angle, false,
        "of wetted: between film and wall, in the body, above 0 and below 180 "
        "deg; 90 deg when left out. The wetted area has the energy -tension "
        "cos(contact_angle) per area (Young)"},
       {"axis", K::Vector, std::nullopt, false,
        "of boss, flange: out of seat or top face; of lug: of its bore; of "
        "block: to its top, z when left out; of step: what it is turned about; "
        "of wetted: of a cylinder, or of a cone from its apex into it; any "
        "length but 0"},
       {"rotate", K::Quantity, D::None, false,
        "of step: by so much, right-handed about axis through about"},
       {"about", K::Vector, D::Length, false,
        "of step: [0, 0, 0] when left out"},
       {"move", K::Vector, D::Length, false, "of step: and then by so much"},
       {"across", K::Vector, std::nullopt, false,
        "of flange: direction of its width; of block: to its right; x when "
        "left out"},
       {"foot", K::Vector, std::nullopt, false,
        "of lug: direction from the bore to the foot, made normal to axis"},
       {"radius", K::Quantity, D::Length, false,
        "of boss: at the seat; of lug: of its round end; of flange: a round "
        "one's; of wetted: of cylinder or sphere"},
       {"base_radius", K::Quantity, D::Length, false,
        "of boss: at the base; radius when left out"},
       {"height", K::Quantity, D::Length, false,
        "of boss: from the base to the seat"},
       {"bore", K::Quantity, D::Length, false,
        "of boss, lug: the bore's radius; of boss none when left out"},
       {"depth", K::Quantity, D::Length, false,
        "of boss: of a bore that does not go through"},
       {"chamfer", K::Quantity, D::Length, false,
        "of boss: of the bore's edge at the seat, at 45 degrees"},
       {"rims", K::Rims, D::Length, false,
        "of boss: where films begin: [\"base\"], when left out, where the "
        "liquid takes over, or two, of \"base\", \"seat\" and heights "
        "above the base, between which it goes around; curves NAME/base, "
        "NAME/seat, NAME/rim_1, NAME/rim_2. Of step: closed edges by name or "
        "number, or several that close; curves NAME/EDGE or NAME/edge_7, by "
        "the first edge"},
       {"thickness", K::Quantity, D::Length, false, "of flange, lug"},
       {"width", K::Quantity, D::Length, false,
        "of flange: along across; of lug: of its foot, twice radius when left "
        "out"},
       {"length", K::Quantity, D::Length, false,
        "of flange: at right angles to its width; of lug: from the bore's "
        "middle to the foot"},
       {"corner_radius", K::Quantity, D::Length, false,
        "of flange: sharp when left out"},
       {"hole_centers", K::Vectors, D::Length, false,
        "of flange: anywhere on the holes' axes"},
       {"hole_radius", K::Quantity, D::Length, false,
        "of flange: of its holes"},
       {"size", K::Vector, D::Length, false,
        "of block: along across, at right angles to both, and along axis"},
       {"open", K::NamesOrNumbers, D::None, false,
        "of block: faces that it does not have; films end at the curves of "
        "these names; of step: faces left out, by name or number"}}};
}

void read_films(CaseContext& context, const toml::table& root,
                case_data::Case& result) {
  const std::vector<std::string> known = curve_names(result);
  for (const CaseTable& table : named_tables(context, root, "films")) {
    result.films.push_back(read_film(context, table, known, result));
  }
}

void read_solids(CaseContext& context, const std::vector<CaseTable>& solids,
                 case_data::Case& result) {
  const std::vector<std::string> known = curve_names(result);
  for (const CaseTable& table : solids) {
    for (const case_data::FilmEntry& film : result.films) {
      if (film.spec.name == table.name()) {
        context.problems.add(
            table.line(), fmt::format("'{}' is both a film and a solid; rename "
                                      "one, or loads could not tell them apart",
                                      table.name()));
      }
    }
    if (is_feature(table)) {
      add_feature_faces(table.name(), result);
    } else if (is_step_solid(table)) {
      table.check_kind("step",
                       case_data::row_named(solid_kinds(), "step").keys);
      add_step_faces(table.name(), result);
    } else {
      result.caps.push_back(read_solid(context, table, known, result));
    }
  }
}

}  // namespace meniscus::reader
