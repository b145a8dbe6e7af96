#include "pipeline/case_data/case_symmetry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "evolve/films/shared_sides.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_wetted.h"

namespace meniscus::case_data {

namespace {

constexpr std::size_t kMostPlanes = 3;
constexpr double kRightAngles = 1e-9;  // cosine of directions given as numbers
constexpr double kQuarterTurn = std::numbers::pi / 2.0;

bool names(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

QuantityVector constants(const Vec3& vector, const char* key, SourceLine line) {
  QuantityVector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = {.expression = Expression(vector[static_cast<Eigen::Index>(k)]),
                 .line = line,
                 .key = fmt::format("symmetry.planes.{}[{}]", key, "xyz"[k])};
  }
  return result;
}

std::string plane_name(int plane) {
  return fmt::format("symmetry_{}", plane + 1);
}

/// A face that a plane cuts: films end there at these curves, and where it
/// `cuts` others, of this or another body.
CapEntry cut_face(const Case& input, const std::string& name, int plane,
                  const std::vector<std::string>& curves, bool cuts) {
  const SymmetryPlane& at = input.symmetry[static_cast<std::size_t>(plane)];
  CapEntry face{
      .spec = {.name = name, .curve = curves.empty() ? "" : curves.front()},
      .symmetry = plane,
      .line = at.line};
  if (!curves.empty()) {
    face.spec.more.assign(curves.begin() + 1, curves.end());
  }
  face.wetted =
      WettedWall{.at = constants(at.at, "at", at.line),
                 .normal = constants(at.normal, "normal", at.line),
                 .contact_angle = {.expression = Expression(kQuarterTurn),
                                   .line = at.line,
                                   .key = "symmetry.planes"},
                 .cuts = cuts};
  return face;
}

/// Curves that a solid of the case closes.
bool is_closed(const Case& input, const std::string& curve) {
  return std::any_of(input.caps.begin(), input.caps.end(),
                     [&](const CapEntry& cap) {
                       return !(cap.wetted && cap.symmetry >= 0) &&
                              names(cap.spec.curves(), curve);
                     });
}

/// Those in a plane at which some of the films end and no solid does.
std::vector<std::string> open_in_plane(const Case& input,
                                       const std::vector<std::string>& films,
                                       const std::set<std::string>& in_plane) {
  std::vector<std::string> result;
  for (const FilmEntry& film : input.films) {
    if (!names(films, film.spec.name)) {
      continue;
    }
    for (const std::string& curve : film.spec.curves) {
      if (in_plane.contains(curve) && !names(result, curve) &&
          !is_closed(input, curve)) {
        result.push_back(curve);
      }
    }
  }
  return result;
}

/// Films that a plane cuts, or that end at a curve in it and slide.
std::vector<std::string> sliding_films(const Case& input,
                                       const std::set<std::string>& in_plane,
                                       const std::vector<std::string>& cut) {
  std::vector<std::string> result;
  for (const FilmEntry& film : input.films) {
    if (names(cut, film.spec.name) ||
        !open_in_plane(input, {film.spec.name}, in_plane).empty()) {
      result.push_back(film.spec.name);
    }
  }
  return result;
}

/// Those of the films that enclose no body.
std::vector<std::string> without_body(const Case& input,
                                      std::vector<std::string> films) {
  std::erase_if(films, [&](const std::string& film) {
    return std::any_of(
        input.bodies.begin(), input.bodies.end(),
        [&](const BodyEntry& body) { return names(body.enclosed_by, film); });
  });
  return films;
}

void add_faces(Case& input, int plane, const std::set<std::string>& in_plane,
               const std::vector<std::string>& cut, CaseProblems& problems) {
  SymmetryPlane& at = input.symmetry[static_cast<std::size_t>(plane)];
  at.films = sliding_films(input, in_plane, cut);
  const std::vector<std::string> alone = without_body(input, at.films);
  // All faces in a plane that cuts are cut alike.
  const bool any_cut = !cut.empty() || !alone.empty();
  std::map<std::string, std::string> body_at;
  for (BodyEntry& body : input.bodies) {
    const std::vector<std::string> curves =
        open_in_plane(input, body.enclosed_by, in_plane);
    for (const std::string& curve : curves) {
      const auto [other, is_new] = body_at.emplace(curve, body.name);
      if (!is_new) {
        problems.add(
            at.line,
            fmt::format("curve '{}' lies in plane {} of symmetry and bounds "
                        "bodies '{}' and '{}'; a film that slides there is of "
                        "one body: let one body end elsewhere, or close both "
                        "with solids of the case",
                        curve, plane + 1, other->second, body.name));
        return;
      }
    }
    const bool cuts = std::any_of(
        cut.begin(), cut.end(),
        [&](const std::string& name) { return names(body.enclosed_by, name); });
    if (!curves.empty() || cuts) {
      input.caps.push_back(cut_face(input, body.name + "/" + plane_name(plane),
                                    plane, curves, any_cut));
      body.enclosed_by.push_back(input.caps.back().spec.name);
    }
  }
  if (!alone.empty()) {  // no face: where they slide
    input.caps.push_back(cut_face(input, plane_name(plane), plane,
                                  open_in_plane(input, alone, in_plane), true));
  }
}

}  // namespace

int symmetric_parts(const Case& input) {
  return 1 << static_cast<int>(input.symmetry.size());
}

std::string wall_end(const std::string& film, int plane) {
  return film + "/" + plane_name(plane);
}

std::vector<std::string> wall_ends(const Case& input, int plane) {
  std::vector<std::string> result;
  for (const std::string& film :
       input.symmetry[static_cast<std::size_t>(plane)].films) {
    const auto has = [&](const auto& entry) {
      return names(entry.films, film);
    };
    if (std::any_of(input.walls.begin(), input.walls.end(), has) ||
        std::any_of(input.shells.begin(), input.shells.end(), has)) {
      result.push_back(wall_end(film, plane));
    }
  }
  return result;
}

std::vector<std::string> cut_faces(const Case& input) {
  std::vector<std::string> result;
  for (const CapEntry& cap : input.caps) {
    if (cap.symmetry >= 0) {
      result.push_back(cap.spec.name);
    }
  }
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    const auto ends = wall_ends(input, static_cast<int>(p));
    result.insert(result.end(), ends.begin(), ends.end());
  }
  return result;
}

std::vector<std::string> cuts_of_whole(const Case& input, std::size_t plane) {
  std::vector<std::string> result;
  for (const CapEntry& cap : input.caps) {
    if (cap.symmetry == static_cast<int>(plane)) {
      result.push_back(cap.spec.name);
      result.push_back(image_name(cap.spec.name));
    }
  }
  for (const std::string& end : wall_ends(input, static_cast<int>(plane))) {
    result.push_back(end);
    result.push_back(image_name(end));
  }
  return result;
}

std::string image_name(const std::string& surface) {
  constexpr const char* kImage = "/image";
  return surface.ends_with(kImage) ? surface : surface + kImage;
}

std::vector<std::string> solids_of_whole(const Case& input) {
  std::vector<std::string> result;
  for (const CapEntry& cap : input.caps) {
    result.push_back(cap.spec.name);
  }
  if (!input.symmetry.empty()) {
    const std::vector<std::string> drawn = result;
    for (const std::string& name : drawn) {
      result.push_back(image_name(name));
    }
  }
  return result;
}

void check_planes(const Case& input, CaseProblems& problems) {
  const std::vector<SymmetryPlane>& planes = input.symmetry;
  if (planes.size() > kMostPlanes) {
    problems.add(planes.back().line,
                 fmt::format("symmetry has {} planes; expected one to three",
                             planes.size()));
    return;
  }
  for (std::size_t b = 1; b < planes.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const double cosine = std::abs(planes[a].normal.dot(planes[b].normal));
      if (cosine > kRightAngles) {
        problems.add(
            planes[b].line,
            fmt::format(
                "planes {} and {} of symmetry meet at {:.6g} deg; "
                "expected 90",
                a + 1, b + 1,
                std::acos(std::min(cosine, 1.0)) * 180.0 / std::numbers::pi));
      }
    }
  }
}

namespace {

bool has_side_in(const SymmetryPlane& plane, const curves::Curve& curve) {
  const Reach reach = reach_of(plane, curve);
  const auto lies = [&](const Vec3& place) {
    return std::abs(beyond(plane, place)) <= reach.rounding;
  };
  const std::vector<films::CurveSide> sides = films::sides_of(curve.shape);
  return !reach.is_in_plane() &&
         std::any_of(
             sides.begin(), sides.end(), [&](const films::CurveSide& side) {
               return lies(side.from) && lies(side.middle) && lies(side.to);
             });
}

/// SymmetryPlane::curves.
void find_sides_in_planes(Case& input,
                          const std::vector<curves::Curve>& curves) {
  for (SymmetryPlane& plane : input.symmetry) {
    for (const curves::Curve& curve : curves) {
      const bool of_film = std::any_of(
          input.films.begin(), input.films.end(), [&](const FilmEntry& film) {
            return names(film.spec.curves, curve.name);
          });
      if (of_film && has_side_in(plane, curve)) {
        plane.curves.push_back(curve.name);
      }
    }
  }
}

/// The curves that a plane cuts, or of whose cells it is a wall.
std::set<std::string> ended_by(const Case& input, std::size_t plane,
                               const std::vector<curves::Curve>& curves) {
  std::set<std::string> result = cut_by(input.symmetry[plane], curves);
  for (const std::string& curve : input.symmetry[plane].curves) {
    if (is_cell(input, curve)) {
      result.insert(curve);
    }
  }
  return result;
}

}  // namespace

void add_cut_faces(Case& input, CaseProblems& problems) {
  if (input.symmetry.empty()) {
    return;
  }
  const std::vector<curves::Curve> curves = curves_at_start(input);
  find_sides_in_planes(input, curves);
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    const int plane = static_cast<int>(p);
    std::set<std::string> in_plane;
    for (const curves::Curve& curve : curves) {
      if (reach_of(input.symmetry[p], curve).is_in_plane()) {
        in_plane.insert(curve.name);
      }
    }
    for (CapEntry& cap : input.caps) {
      const std::vector<std::string> rims = cap.spec.curves();
      const bool lies = std::all_of(
          rims.begin(), rims.end(),
          [&](const std::string& rim) { return in_plane.contains(rim); });
      if (!rims.empty() && lies && cap.symmetry < 0) {
        cap.symmetry = plane;
      }
    }
    add_faces(input, plane, in_plane,
              surfaces_at(input, ended_by(input, p, curves)), problems);
  }
}

namespace {

/// Faces that are meshed: of solid bodies, and ends of walls.
std::vector<std::string> held_faces(const Case& input) {
  std::vector<std::string> result = cut_faces(input);
  std::erase_if(result, [&](const std::string& face) {
    const bool is_cap =
        std::any_of(input.caps.begin(), input.caps.end(),
                    [&](const CapEntry& cap) { return cap.spec.name == face; });
    return is_cap && std::none_of(input.bodies.begin(), input.bodies.end(),
                                  [&](const BodyEntry& body) {
                                    return body.material != kVoid &&
                                           names(body.enclosed_by, face);
                                  });
  });
  return result;
}

/// A wall's end at a curve that a solid closes in the plane would not lie in
/// it, nor a shell's normal.
void refuse_held_walls(const Case& input, CaseProblems& problems) {
  for (const CapEntry& cap : input.caps) {
    if (cap.symmetry < 0 || cap.wetted) {
      continue;
    }
    const std::vector<std::string> rims = cap.spec.curves();
    const auto refuse = [&](const char* kind, const auto& entry) {
      const std::vector<std::string> curves =
          curves_of_wall(input, {.films = entry.films});
      if (std::any_of(rims.begin(), rims.end(), [&](const std::string& rim) {
            return names(curves, rim);
          })) {
        problems.add(
            entry.line,
            fmt::format("{}.{} is of a film that solid '{}' holds in plane "
                        "{} of symmetry; take '{}' out, so that the film "
                        "slides there, or draw the whole",
                        kind, entry.name, cap.spec.name, cap.symmetry + 1,
                        cap.spec.name));
      }
    };
    for (const WallEntry& wall : input.walls) {
      refuse("walls", wall);
    }
    for (const ShellEntry& shell : input.shells) {
      refuse("shells", shell);
    }
  }
}

/// The first of the surfaces that is a cut face; empty: none.
std::string cut_among(const std::vector<std::string>& faces,
                      const loads::Surfaces& surfaces) {
  const auto at =
      std::find_if(surfaces.begin(), surfaces.end(),
                   [&](const auto& surface) { return names(faces, surface); });
  return at == surfaces.end() ? "" : *at;
}

void refuse_on_cut(const char* what, const std::string& face, SourceLine line,
                   CaseProblems& problems) {
  if (!face.empty()) {
    problems.add(line, fmt::format("a {} on '{}', which lies in a plane of "
                                   "symmetry and is held along its normal "
                                   "alone; take it out",
                                   what, face));
  }
}

void hold(LoadCaseEntry& load_case, const std::vector<std::string>& faces,
          SourceLine line, CaseProblems& problems) {
  for (const LoadEntry& load : load_case.loads) {
    refuse_on_cut("load", cut_among(faces, load.surfaces), load.line, problems);
    refuse_on_cut("load", cut_among(faces, load.thread), load.line, problems);
  }
  for (const loads::SpringBed& bed : load_case.springs) {
    refuse_on_cut("spring bed", cut_among(faces, bed.surface), load_case.line,
                  problems);
  }
  for (const PinEntry& pin : load_case.pins) {
    refuse_on_cut("rigid support", cut_among(faces, pin.pin.surfaces), pin.line,
                  problems);
  }
  std::vector<std::string> held;
  for (const SupportEntry& entry : load_case.supports) {
    if (entry.support.kind == loads::SupportKind::Symmetry) {
      held.push_back(entry.support.surface);
    } else {
      refuse_on_cut("support", cut_among(faces, entry.support.surface),
                    entry.line, problems);
    }
  }
  for (const std::string& face : faces) {
    if (!names(held, face)) {
      load_case.supports.push_back(
          {.support = {.surface = face, .kind = loads::SupportKind::Symmetry},
           .displacement = std::nullopt,
           .line = line});
    }
  }
}

/// What is the sum over all parts of the whole.
bool adds_up(ResponseKind kind) {
  switch (kind) {
    case ResponseKind::Compliance:
    case ResponseKind::StrainEnergy:
    case ResponseKind::Mass:
    case ResponseKind::Volume:
    case ResponseKind::Inertia:
    case ResponseKind::FilmArea:
    case ResponseKind::FilmEnergy:
    case ResponseKind::Overhang:
    case ResponseKind::Draft:
      return true;
    default:
      return false;
  }
}

void apply_to(ResponseEntry& response, const std::vector<std::string>& cut,
              int parts, CaseProblems& problems) {
  const auto refuse = [&](const char* why) {
    problems.add(response.line,
                 fmt::format("responses.{}: {}", response.name, why));
  };
  if (adds_up(response.kind)) {
    response.images = parts;
  }
  if (response.kind == ResponseKind::Thickness) {
    refuse(
        "thickness is from face to face, and a plane of symmetry is no "
        "face; ask it of a case without [symmetry]");
  }
  if (response.kind == ResponseKind::Draft &&
      (response.surface.empty() || names(cut, response.surface))) {
    refuse(
        "with [symmetry], draft needs 'on', a surface that lies in no plane "
        "of it");
  }
  if (response.kind == ResponseKind::Overhang) {
    response.base.insert(response.base.end(), cut.begin(), cut.end());
  }
}

bool asks_for_modes(const Case& input) {
  return input.analysis.frequencies > 0 ||
         input.analysis.buckling.value_or(1) > 0 ||
         std::any_of(input.responses.begin(), input.responses.end(),
                     [](const ResponseEntry& r) {
                       return r.kind == ResponseKind::Frequency ||
                              r.kind == ResponseKind::BucklingFactor;
                     });
}

bool asks_for_free_part(const Case& input) {
  return input.analysis.supports_of == AnalysisEntry::kFree ||
         std::any_of(input.responses.begin(), input.responses.end(),
                     [](const ResponseEntry& r) {
                       return r.kind == ResponseKind::Frequency &&
                              r.load_case == AnalysisEntry::kFree;
                     });
}

/// Within the whole no corner is left in a plane.
void refuse_fillets(const Case& input, CaseProblems& problems) {
  for (const CapEntry& cap : input.caps) {
    for (const FilletEntry& fillet : input.fillets) {
      for (const std::string& curve : cap.spec.curves()) {
        if (cap.symmetry >= 0 && names(fillet.curves, curve)) {
          problems.add(fillet.line,
                       fmt::format("a fillet along '{}', which lies in plane "
                                   "{} of symmetry; take it out",
                                   curve, cap.symmetry + 1));
        }
      }
    }
  }
}

}  // namespace

void apply_symmetry(Case& input, CaseProblems& problems) {
  if (input.symmetry.empty() || !problems.empty()) {
    return;
  }
  const SourceLine line = input.symmetry.front().line;
  const std::vector<std::string> faces = held_faces(input);
  if (faces.empty()) {
    problems.add(line,
                 "no body or wall ends in a plane of symmetry: let it cut "
                 "curves, let films end at a closed curve in it, or at a "
                 "polygon whose sides lie in planes, or give it a solid that "
                 "lies in it");
  }
  for (LoadCaseEntry& load_case : input.load_cases) {
    hold(load_case, faces, line, problems);
    for (const LoadEntry& load : load_case.loads) {
      if (load.size) {
        problems.add(load.line,
                     "a load of given 'size' comes from one direction, and "
                     "with [symmetry] its images act with it; give a 'force'");
      }
    }
  }
  for (ResponseEntry& response : input.responses) {
    apply_to(response, faces, symmetric_parts(input), problems);
  }
  refuse_fillets(input, problems);
  refuse_held_walls(input, problems);
  const auto refuse = [&](SourceLine at, const std::string& what) {
    problems.add(at, what + " cannot be with [symmetry] yet; draw the whole");
  };
  if (!input.step_solids.empty()) {
    refuse(input.step_solids.front().line, "solids of STEP files");
  }
  if (asks_for_free_part(input)) {
    refuse(line, "a part that is free");
  }
  if (input.process.smallest_feature > 0.0) {
    refuse(line, "process.smallest_feature, which is from face to face,");
  }
  problems.warn(
      line, fmt::format("the films{} are judged for motions that are symmetric "
                        "too; a whole may be unstable where its part is not: "
                        "check the answer once without [symmetry]",
                        asks_for_modes(input)
                            ? ", buckling factors and natural frequencies"
                            : ""));
}

}  // namespace meniscus::case_data
