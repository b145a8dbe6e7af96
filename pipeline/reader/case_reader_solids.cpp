/// Solids of kind "step": from the file to faces, rims and their curves.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cad/step/step_solid.h"
#include "core/error.h"
#include "core/geometry/exact_points.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

/// The solid's text, from the case or from the file.
const std::string* solid_text(CaseContext& context, const CaseTable& table,
                              const std::string& path,
                              case_data::Case& result) {
  const std::string key = path + "#solid";
  for (const case_data::CaseFile& file : result.files) {
    if (file.path == key) {
      return &file.text;
    }
  }
  const auto place = std::filesystem::path(result.path).parent_path() / path;
  if (!std::filesystem::is_regular_file(place)) {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file: there is no file '{}'; expected a STEP file, its "
                    "path relative to the case",
                    table.path(), place.string()));
    return nullptr;
  }
  try {
    const std::string unit = context.units.unit_of(Dimension::Length);
    result.files.push_back(
        {key, exact_shape_text(step::read_step_solid(place, unit))});
    return &result.files.back().text;
  } catch (const Error& error) {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file: {}", table.path(), error.what()));
  }
  return nullptr;
}

/// The loops of the key `rims`, each of edges by name or number.
std::vector<std::vector<std::string>> read_loops(CaseContext& context,
                                                 const CaseTable& table) {
  std::vector<std::vector<std::string>> loops;
  const toml::node* node = table.node("rims");
  if (node == nullptr) {
    return loops;
  }
  const auto add = [](const toml::node& item, std::vector<std::string>& loop) {
    if (const auto* name = item.as_string()) {
      loop.push_back(name->get());
    } else if (const auto number = item.value_exact<std::int64_t>()) {
      loop.push_back(fmt::format("{}", *number));
    } else {
      return false;
    }
    return true;
  };
  const toml::array* list = node->as_array();
  bool good = list != nullptr && !list->empty();
  for (std::size_t k = 0; good && k < list->size(); ++k) {
    std::vector<std::string>& loop = loops.emplace_back();
    const toml::node& item = *list->get(k);
    const toml::array* edges = item.as_array();
    good = edges == nullptr ? add(item, loop) : !edges->empty();
    for (std::size_t e = 0; good && edges != nullptr && e < edges->size();
         ++e) {
      good = add(*edges->get(e), loop);
    }
  }
  if (!good) {
    context.problems.add(
        table.line("rims"),
        fmt::format("{}.rims: found {}; expected loops of edges by name or "
                    "number, each a closed edge or several that close: [7, "
                    "[3, 4]]",
                    table.path(), described(*node)));
    loops.clear();
  }
  return loops;
}

/// Of an edge or a face, by its name in the file or its number, from 1; -1: it
/// is not there.
template <class Part>
int index_named(const std::vector<Part>& parts, const std::string& name) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].name == name) {
      return static_cast<int>(k);
    }
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (fmt::format("{}", k + 1) == name) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

/// How the solid is moved, as an entry of a copy; none where it stays.
using MotionEntry = std::optional<case_data::CurveEntry>;

MotionEntry read_moves(CaseContext& context, const CaseTable& table) {
  if (!table.has("rotate") && !table.has("move") && !table.has("axis") &&
      !table.has("about")) {
    return std::nullopt;
  }
  case_data::CurveEntry copy{.kind = case_data::CurveKind::Copy};
  const case_data::Quantity one{
      .expression = Expression(1.0), .line = table.line(), .key = table.path()};
  copy.copy.scale = {one, one, one};
  read_motion(context, table, copy);
  return copy;
}

/// The curve as it lies in the file, and where the solid is moved its copy
/// there, which has its name.
void add_curve(const MotionEntry& motion, case_data::CurveEntry curve,
               case_data::Case& result) {
  if (!motion) {
    result.curves.push_back(std::move(curve));
    return;
  }
  case_data::CurveEntry copy = *motion;
  copy.name = curve.name;
  copy.line = curve.line;
  curve.name += " in its file";
  copy.copy.of = static_cast<int>(result.curves.size());
  result.curves.push_back(std::move(curve));
  result.curves.push_back(std::move(copy));
}

void add_frame(const CaseTable& table, const MotionEntry& motion,
               case_data::StepSolidEntry& solid, case_data::Case& result) {
  if (!motion) {
    return;
  }
  solid.spec.frame = table.name() + "/frame";
  case_data::CurveEntry frame{.name = solid.spec.frame,
                              .kind = case_data::CurveKind::Polygon,
                              .line = table.line()};
  frame.fixed_points = frame_points(*solid.spec.shape);
  add_curve(motion, std::move(frame), result);
}

bool ends_at(const ExactFace& face, const std::vector<int>& edges) {
  for (const auto& loop : face.loops) {
    for (const ExactUse& use : loop) {
      if (std::count(edges.begin(), edges.end(), use.edge) != 0) {
        return true;
      }
    }
  }
  return false;
}

void read_rim(CaseContext& context, const CaseTable& table,
              const std::string& path, const std::vector<std::string>& edges,
              const MotionEntry& motion, case_data::StepSolidEntry& solid,
              case_data::Case& result) {
  films::SolidSpec::Rim rim;
  for (const std::string& edge : edges) {
    rim.edges.push_back(index_named(solid.spec.shape->edges, edge));
  }
  case_data::CurveEntry curve{.line = table.line("rims")};
  if (!read_step_loop(context, table, path, edges, "rims", result, curve)) {
    return;  // told, also of edges that are not there
  }
  for (const int edge : rim.edges) {
    if (std::none_of(solid.spec.shape->faces.begin(),
                     solid.spec.shape->faces.end(),
                     [&](const ExactFace& f) { return ends_at(f, {edge}); })) {
      context.problems.add(
          table.line("rims"),
          fmt::format("{}.rims: edge {} is of no face of the solid but a line "
                      "beside it in the file; name one where faces meet",
                      table.path(), edge + 1));
      return;
    }
  }
  const bool by_number =
      edges.front() == fmt::format("{}", rim.edges.front() + 1);
  curve.name = fmt::format("{}/{}{}", table.name(), by_number ? "edge_" : "",
                           edges.front());
  rim.curve = curve.name;
  for (const films::SolidSpec::Rim& other : solid.spec.rims) {
    for (const int edge : rim.edges) {
      if (std::count(other.edges.begin(), other.edges.end(), edge) != 0) {
        context.problems.add(
            table.line("rims"),
            fmt::format("{}.rims: edge {} is of two rims, '{}' and '{}'; films "
                        "end at one curve each",
                        table.path(), edge + 1, other.curve, rim.curve));
        return;
      }
    }
  }
  solid.spec.rims.push_back(std::move(rim));
  add_curve(motion, std::move(curve), result);
}

/// "face_7: plane about (1, 2, 3)".
std::string face_text(const ExactShape& shape, const ExactFace& face) {
  static constexpr const char* kKinds[] = {"plane",  "cylinder", "cone",
                                           "sphere", "torus",    "splines"};
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (const auto& loop : face.loops) {
    for (const ExactUse& use : loop) {
      const ExactEdge& edge = shape.edges[use.edge];
      for (const double share : {0.25, 0.75}) {
        sum +=
            point_on(edge.curve, edge.first + share * (edge.last - edge.first));
        count += 1.0;
      }
    }
  }
  const Vec3 middle = sum / std::max(count, 1.0);
  return fmt::format("{}: {} about ({:.5g}, {:.5g}, {:.5g})", face.name,
                     kKinds[face.surface.index()], middle[0], middle[1],
                     middle[2]);
}

void refuse_face(CaseContext& context, const CaseTable& table,
                 const ExactShape& shape, const char* key,
                 const std::string& face) {
  constexpr std::size_t kNamesShown = 24;
  std::vector<std::string> known;
  for (const ExactFace& other : shape.faces) {
    if (known.size() == kNamesShown) {
      known.emplace_back("...");
      break;
    }
    known.push_back(face_text(shape, other));
  }
  context.problems.add(
      table.line(key),
      fmt::format("{}.{}: there is no face '{}'; its {} faces, by name or "
                  "number: {}",
                  table.path(), key, face, shape.faces.size(),
                  fmt::join(known, "; ")));
}

void read_open(CaseContext& context, const CaseTable& table,
               case_data::StepSolidEntry& solid) {
  const std::vector<ExactFace>& faces = solid.spec.shape->faces;
  std::set<int> open;
  for (const std::string& name : table.names_or_numbers("open")) {
    const int face = index_named(faces, name);
    if (face < 0) {
      refuse_face(context, table, *solid.spec.shape, "open", name);
    }
    open.insert(face);
  }
  for (int k = 0; k < static_cast<int>(faces.size()); ++k) {
    if (!open.contains(k)) {
      solid.faces.push_back(k);
    }
  }
}

}  // namespace

bool is_step_solid(const CaseTable& table) {
  const toml::node* kind = table.node("kind");
  return kind != nullptr && kind->value<std::string>() == "step";
}

void read_step_solids(CaseContext& context,
                      const std::vector<CaseTable>& solids,
                      case_data::Case& result) {
  for (const CaseTable& table : solids) {
    const auto path = is_step_solid(table) ? table.text("file") : std::nullopt;
    const std::string* text =
        path ? solid_text(context, table, *path, result) : nullptr;
    if (text == nullptr) {
      continue;
    }
    case_data::StepSolidEntry solid{.line = table.line()};
    solid.spec.name = table.name();
    try {
      solid.spec.shape =
          std::make_shared<const ExactShape>(read_exact_shape_text(*text));
    } catch (const InvalidInput& error) {
      context.problems.add(table.line("file"), error.what());
      continue;
    }
    const MotionEntry motion = read_moves(context, table);
    add_frame(table, motion, solid, result);
    for (const auto& edges : read_loops(context, table)) {
      read_rim(context, table, *path, edges, motion, solid, result);
    }
    read_open(context, table, solid);
    result.step_solids.push_back(std::move(solid));
  }
}

std::optional<films::FilmWall> read_wall_face(CaseContext& context,
                                              const CaseTable& table,
                                              case_data::Case& result) {
  const auto path = table.text("file");
  const auto name = table.text("face");
  const std::string* text =
      path && name ? solid_text(context, table, *path, result) : nullptr;
  if (text == nullptr) {
    return std::nullopt;
  }
  ExactShape shape;
  try {
    shape = read_exact_shape_text(*text);
  } catch (const InvalidInput& error) {
    context.problems.add(table.line("file"), error.what());
    return std::nullopt;
  }
  const int found = index_named(shape.faces, *name);
  if (found < 0) {
    refuse_face(context, table, shape, "face", *name);
    return std::nullopt;
  }
  const ExactFace* face = &shape.faces[static_cast<std::size_t>(found)];
  if (const auto* plane = std::get_if<ExactPlane>(&face->surface)) {
    return films::FilmWall{.at = plane->frame.origin, .normal = plane->frame.z};
  }
  if (const auto* round = std::get_if<ExactCylinder>(&face->surface)) {
    return films::FilmWall{.at = round->frame.origin,
                           .normal = round->frame.z,
                           .kind = films::WallKind::Cylinder,
                           .radius = round->radius};
  }
  if (const auto* ball = std::get_if<ExactSphere>(&face->surface)) {
    return films::FilmWall{.at = ball->frame.origin,
                           .kind = films::WallKind::Sphere,
                           .radius = ball->radius};
  }
  if (const auto* cone = std::get_if<ExactCone>(&face->surface)) {
    const double rise = cone->radius / std::tan(cone->angle);
    const bool widens = cone->angle > 0.0;
    return films::FilmWall{
        .at = cone->frame.origin - rise * cone->frame.z,
        .normal = widens ? cone->frame.z : Vec3(-cone->frame.z),
        .kind = films::WallKind::Cone,
        .half_angle = std::abs(cone->angle)};
  }
  context.problems.add(
      table.line("face"),
      fmt::format("{}.face: films slide on planes, cylinders, spheres and "
                  "cones, and this is {}",
                  table.path(), face_text(shape, *face)));
  return std::nullopt;
}

void add_step_faces(const std::string& name, case_data::Case& result) {
  for (std::size_t s = 0; s < result.step_solids.size(); ++s) {
    const case_data::StepSolidEntry& solid = result.step_solids[s];
    if (solid.spec.name != name) {
      continue;
    }
    for (const int face : solid.faces) {
      case_data::CapEntry cap{.spec = {.name = "", .curve = ""},
                              .is_file = true,
                              .line = solid.line};
      cap.spec.name = case_data::face_name(solid, face);
      cap.spec.solid = static_cast<int>(s);
      cap.spec.face = face;
      for (const films::SolidSpec::Rim& rim : solid.spec.rims) {
        if (ends_at(solid.spec.shape->faces[face], rim.edges)) {
          cap.spec.rims.push_back(rim.curve);
        }
      }
      result.caps.push_back(std::move(cap));
    }
  }
}

}  // namespace meniscus::reader
