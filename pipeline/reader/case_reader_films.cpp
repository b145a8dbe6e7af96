/// Films and solids: from curves, facets in the case, and files.
#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"
#include "pipeline/reader/facet_file.h"

namespace meniscus {

namespace {

std::vector<std::string> curve_names(const Case& result) {
  std::vector<std::string> names;
  for (const CurveEntry& curve : result.curves) {
    names.push_back(curve.name);
  }
  return names;
}

struct FilmNeeds {
  FilmKind kind;
  std::size_t least;
  std::size_t most;
  const char* text;
};

const std::map<std::string, KindKeys>& film_kinds() {
  static const std::map<std::string, KindKeys> kinds = {
      {"branch", {{"curves"}, {"tension"}}},
      {"loft", {{"curves"}, {"tension"}}},
      {"disk", {{"curves"}, {"tension"}}},
      {"facets", {{"vertices", "facets"}, {"curves", "within", "tension"}}},
      {"file",
       {{"file"}, {"curves", "surface", "scale", "within", "tension"}}}};
  return kinds;
}

const std::map<std::string, KindKeys>& solid_kinds() {
  static const std::map<std::string, KindKeys> kinds = {
      {"cap", {{"curve"}, {"holes"}}},
      {"ring", {{"curve", "inner"}, {}}},
      {"sides", {{"curves"}, {}}},
      {"file", {{"file"}, {"curves", "surface", "scale", "within"}}}};
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
                 const std::string& kind, std::size_t count) {
  static const std::map<std::string, FilmNeeds> needs = {
      {"branch",
       {FilmKind::Branch, 2, std::size_t(-1), "a branch needs two or more"}},
      {"loft", {FilmKind::Loft, 2, 2, "a loft needs two"}},
      {"disk", {FilmKind::Disk, 1, 1, "a disk needs one"}}};
  const auto at = needs.find(kind);
  if (at != needs.end() && count > 0 &&
      (count < at->second.least || count > at->second.most)) {
    context.problems.add(
        table.line("curves"),
        fmt::format("{} names {} curve{}; {}", table.path(), count,
                    count == 1 ? "" : "s", at->second.text));
  }
}

/// The facets of a file that films or solids start from; null with a problem
/// noted.
std::shared_ptr<const StartFacets> read_start(CaseContext& context,
                                              const CaseTable& table,
                                              Case& result) {
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

FilmKind film_kind_of(const std::string& kind) {
  return kind == "branch" ? FilmKind::Branch
         : kind == "loft" ? FilmKind::Loft
         : kind == "disk" ? FilmKind::Disk
                          : FilmKind::Facets;
}

FilmEntry read_film(CaseContext& context, const CaseTable& table,
                    const std::vector<std::string>& known, Case& result) {
  FilmEntry film{.line = table.line()};
  film.spec.name = table.name();
  film.spec.curves = table.names("curves");
  if (const auto kind = table.choice("kind")) {
    table.check_kind(*kind, film_kinds().at(*kind));
    film.spec.kind = film_kind_of(*kind);
    check_count(context, table, *kind, film.spec.curves.size());
    if (*kind == "facets") {
      film.vertices = table.vectors("vertices");
      film.facets = table.facets("facets", std::ssize(film.vertices));
    } else if (*kind == "file") {
      film.spec.start = read_start(context, table, result);
    }
    film.spec.within = read_within(context, table);
  }
  check_curves(context, table, known, film.spec.curves);
  film.tension = table.place_quantity("tension").value_or(
      PlaceQuantity{{.expression = Expression(1.0),
                     .line = table.line(),
                     .key = table.path() + ".tension"}});
  if (film.tension.of_place) {
    require_frozen(context, film.tension.quantity, "a tension of x, y, z");
  }
  return film;
}

const CurveEntry* polygon_named(const Case& input, const std::string& name) {
  for (const CurveEntry& curve : input.curves) {
    if (curve.name == name) {
      return curve.kind == CurveKind::Polygon && !curve.points.empty()
                 ? &curve
                 : nullptr;
    }
  }
  return nullptr;
}

/// A polygon NAME/k between each two sides, across which the solid lies.
void read_sides(CaseContext& context, const CaseTable& table,
                const std::vector<std::string>& known, Case& result,
                CapSpec& spec) {
  const std::vector<std::string> curves = table.names("curves");
  if (curves.empty()) {
    return;  // told already
  }
  check_curves(context, table, known, curves);
  const bool two = curves.size() == 2 && curves[0] != curves[1];
  const CurveEntry* low = two ? polygon_named(result, curves[0]) : nullptr;
  const CurveEntry* high = two ? polygon_named(result, curves[1]) : nullptr;
  if (low == nullptr || high == nullptr ||
      low->points.size() != high->points.size()) {
    context.problems.add(
        table.line("curves"),
        fmt::format("{}.curves: found [{}]; expected two curves of kind "
                    "polygon with as many points, in the same order",
                    table.path(), fmt::join(curves, ", ")));
    return;
  }
  const std::vector<PathPoint> a = low->points;
  const std::vector<PathPoint> b = high->points;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::size_t next = (k + 1) % a.size();
    CurveEntry face{.name = fmt::format("{}/{}", table.name(), k + 1),
                    .kind = CurveKind::Polygon,
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
               const std::vector<std::string>& known, CapSpec& spec) {
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

CapEntry read_solid(CaseContext& context, const CaseTable& table,
                    const std::vector<std::string>& known, Case& result) {
  CapEntry cap{.spec = {.name = table.name(), .curve = ""},
               .line = table.line()};
  const auto kind = table.choice("kind");
  if (!kind) {
    return cap;
  }
  table.check_kind(*kind, solid_kinds().at(*kind));
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
  }
  return cap;
}

}  // namespace

void read_films(CaseContext& context, const toml::table& root, Case& result) {
  const std::vector<std::string> known = curve_names(result);
  for (const CaseTable& table : named_tables(context, root, "films")) {
    result.films.push_back(read_film(context, table, known, result));
  }
}

void read_solids(CaseContext& context, const toml::table& root, Case& result) {
  const std::vector<std::string> known = curve_names(result);
  for (const CaseTable& table : named_tables(context, root, "solids")) {
    CapEntry cap = read_solid(context, table, known, result);
    for (const FilmEntry& film : result.films) {
      if (film.spec.name == cap.spec.name) {
        context.problems.add(
            table.line(), fmt::format("'{}' is both a film and a solid; rename "
                                      "one, or loads could not tell them apart",
                                      cap.spec.name));
      }
    }
    result.caps.push_back(std::move(cap));
  }
}

}  // namespace meniscus
