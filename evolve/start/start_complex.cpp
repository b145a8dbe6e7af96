#include "evolve/start/start_complex.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/curve_cut.h"
#include "evolve/energy/fields.h"
#include "evolve/energy/film_terms.h"
#include "evolve/energy/tension_field.h"
#include "evolve/films/body_sides.h"
#include "evolve/films/edge_marks.h"
#include "evolve/films/loft.h"
#include "evolve/films/rim_grading.h"
#include "evolve/films/shared_sides.h"
#include "evolve/spines/spine_start.h"
#include "evolve/start/band_rows.h"
#include "evolve/start/branch_facets.h"
#include "evolve/start/cap_faces.h"
#include "evolve/start/close_rims.h"
#include "evolve/start/cut_start.h"
#include "evolve/start/disk_fill.h"
#include "evolve/start/face_loops.h"
#include "evolve/start/facet_start.h"
#include "evolve/start/fill_patch.h"
#include "evolve/start/join_films.h"
#include "evolve/start/raise_disks.h"
#include "evolve/start/solid_start.h"
#include "evolve/start/wetted_faces.h"

namespace meniscus::start {

namespace {

constexpr double kShortestToJoin = 0.125;  // x the edge

struct Rim {
  int curve = 0;
  std::vector<int> ids;  // of its points, in order

  int count() const { return static_cast<int>(ids.size()); }
};

class StartBuilder {
 public:
  StartBuilder(const films::FilmSystem& system, double edge)
      : system_(with_rims_apart(system, edge)),
        edge_(edge),
        shared_(system_.curves),
        solids_(system_, edge),
        join_cuts_(cuts_for_joins(system_)) {}

  films::FilmComplex build() {
    check_names();
    result_.curves = system_.curves;
    facets_ = start_from_facets(system_, edge_, system_.keep_facets);
    facets_.cuts.merge(solids_.take_cuts());
    facet_points_.assign(facets_.points.size(), -1);
    make_rims();
    require_room_for_caps();
    solids_.add_edges(
        [&](const std::string& curve) -> const std::vector<int>& {
          return rims_.at(curve).ids;
        },
        result_);
    const films::FreePlaces free = free_places();
    shared_.mark_edges(free, result_);
    for (const films::FilmSpec& film : system_.films) {
      declare_film(film);
      if (film.joins.empty()) {
        add_film(film);
      }
    }
    add_joining_films();
    for (const films::CapSpec& cap : system_.caps) {
      add_cap(cap);
    }
    const std::vector<RaisedDisk> raised = raise_disks(system_, result_);
    refuse_twins();
    add_bodies(raised);
    add_walls();
    free_lines(free);
    if (films_join_) {
      drop_unused(result_);  // rims in whose place lines are
    }
    std::vector<films::FilmQuantity> poles = poles_of_bodies();
    cut_start(system_, edge_, result_);
    if (has_cuts(system_)) {
      close_wetted_faces(result_, edge_);
    }
    add_fields();
    std::move(poles.begin(), poles.end(),
              std::back_inserter(result_.quantities));
    const std::vector<double> tensions = energy::tensions_at(
        result_, energy::targets_of(result_), result_.mesh.points);
    for (std::size_t s = 0; s < tensions.size(); ++s) {
      if (result_.surfaces[s].tension_field) {
        result_.surfaces[s].tension = tensions[s];
      }
    }
    return std::move(result_);
  }

 private:
  void check_names() const {
    std::set<std::string> names;
    for (const curves::Curve& curve : system_.curves) {
      curves::validate(curve);
      if (!names.insert(curve.name).second) {
        throw InvalidInput(
            fmt::format("two curves are named '{}'; rename one", curve.name));
      }
    }
    names.clear();
    const auto add = [&](const std::string& name) {
      if (!names.insert(name).second) {
        throw InvalidInput(
            fmt::format("two surfaces are named '{}'; rename one", name));
      }
    };
    for (const films::FilmSpec& film : system_.films) {
      add(film.name);
      if (!std::isfinite(film.tension) || film.tension <= 0.0) {
        throw InvalidInput(
            fmt::format("film '{}': tension is {}, must be above 0", film.name,
                        film.tension));
      }
      if (const std::string wrong = films::what_is_wrong(film.drop_shape);
          !wrong.empty()) {
        throw InvalidInput(fmt::format("film '{}': {}", film.name, wrong));
      }
    }
    for (const films::CapSpec& cap : system_.caps) {
      add(cap.name);
    }
  }

  /// Of all films and solids.
  void make_rims() {
    for (const films::FilmSpec& film : system_.films) {
      for (const std::string& name : film.curves) {
        rim_of(name, film.name);
      }
    }
    for (const films::CapSpec& cap : system_.caps) {
      for (const std::string& name : cap.curves()) {
        rim_of(name, cap.name);
      }
    }
  }

  films::FreePlaces free_places() const {
    std::vector<char> used(system_.curves.size(), 0);
    for (const auto& [name, rim] : rims_) {
      used[static_cast<std::size_t>(rim.curve)] = 1;
    }
    return {system_.curves, used};
  }

  /// Films began along free curves; from here on their lines are liquid.
  void free_lines(const films::FreePlaces& free) {
    for (films::ComplexVertex& vertex : result_.vertices) {
      if (vertex.kind == films::VertexKind::OnCurve &&
          free.is_free(vertex.curve, vertex.t)) {
        vertex = {};
      }
    }
  }

  /// Before they are filled: their flat areas alone tell edges that are far too
  /// short.
  void require_room_for_caps() {
    double area = 0.0;
    for (const films::CapSpec& cap : system_.caps) {
      if (!cap.start && !cap.ruled && cap.inner.empty() && cap.solid < 0) {
        for (const std::string& name : cap.curves()) {
          area += polygon_area_vector(points_of(rims_.at(name))).norm();
        }
      }
    }
    require_room(area, edge_);
  }

  /// Two films that begin with the same facets never come apart: all of them
  /// lie on each other.
  void refuse_twins() const {
    std::map<Triangle, int> film_of;
    for (std::size_t f = 0; f < result_.mesh.facets.size(); ++f) {
      const int film = result_.mesh.facet_label[f];
      Triangle corners = result_.mesh.facets[f];
      const bool on_rims =
          std::all_of(corners.begin(), corners.end(), [&](int v) {
            return result_.vertices[v].kind == films::VertexKind::OnCurve;
          });
      if (!result_.surfaces[film].liquid || !on_rims ||
          system_.films[static_cast<std::size_t>(film)].kind ==
              films::FilmKind::Disk) {  // disks are raised
        continue;
      }
      std::sort(corners.begin(), corners.end());
      const auto [other, is_new] = film_of.emplace(corners, film);
      if (!is_new && other->second != film) {
        throw InvalidInput(fmt::format(
            "films '{}' and '{}' begin with the same facets between the same "
            "curves and lie on each other; leave one out, or give it a curve "
            "of its own",
            result_.surfaces[other->second].name, result_.surfaces[film].name));
      }
    }
  }

  // The rim of a curve, its points made at first use.
  const Rim& rim_of(const std::string& curve_name, const std::string& user) {
    const auto known = rims_.find(curve_name);
    if (known != rims_.end()) {
      return known->second;
    }
    const auto found = std::find_if(
        system_.curves.begin(), system_.curves.end(),
        [&](const curves::Curve& c) { return c.name == curve_name; });
    if (found == system_.curves.end()) {
      throw InvalidInput(
          fmt::format("surface '{}' names the curve '{}', which does not exist",
                      user, curve_name));
    }
    Rim rim;
    rim.curve = static_cast<int>(found - system_.curves.begin());
    const auto cuts = facets_.cuts.find(rim.curve);
    const bool is_cut = cuts != facets_.cuts.end();
    const std::vector<double> t = is_cut ? cuts->second : sampled(*found);
    if (shared_.shares(rim.curve)) {
      rim.ids = shared_.rim(rim.curve, t, result_);
      if (is_cut && rim.ids.size() != t.size()) {
        throw InvalidInput(fmt::format(
            "surface '{}': facets end at curve '{}', a side of which another "
            "solid cuts otherwise; let the facets have that side's corners "
            "only, or make them of kind cap",
            user, curve_name));
      }
      return rims_.emplace(curve_name, std::move(rim)).first->second;
    }
    rim.ids.resize(t.size());
    std::iota(rim.ids.begin(), rim.ids.end(),
              static_cast<int>(result_.mesh.points.size()));
    const Points points = curves::points_at(found->shape, t);
    result_.mesh.points.insert(result_.mesh.points.end(), points.begin(),
                               points.end());
    for (const double at : t) {
      result_.vertices.push_back({films::VertexKind::OnCurve, rim.curve, at});
    }
    return rims_.emplace(curve_name, rim).first->second;
  }

  std::vector<double> sampled(const curves::Curve& curve) const {
    try {
      const std::vector<double> t =
          curves::sample_parameters(curve.shape, curve.fineness * edge_);
      std::vector<double> cuts = cuts_of(system_, curve);
      if (const auto more =
              join_cuts_.find(static_cast<int>(&curve - system_.curves.data()));
          more != join_cuts_.end()) {
        cuts.insert(cuts.end(), more->second.begin(), more->second.end());
        std::sort(cuts.begin(), cuts.end());
      }
      return cuts.empty() ? t : curves::with_parameters(curve.shape, t, cuts);
    } catch (const InvalidInput& error) {
      throw InvalidInput(
          fmt::format("curve '{}': {}", curve.name, error.what()));
    }
  }

  Points points_of(const Rim& rim) const {
    Points points;
    points.reserve(rim.ids.size());
    for (const int id : rim.ids) {
      points.push_back(result_.mesh.points[id]);
    }
    return points;
  }

  int add_surface(const films::ComplexSurface& surface) {
    result_.surfaces.push_back(surface);
    result_.mesh.labels.push_back(surface.name);
    return static_cast<int>(result_.surfaces.size()) - 1;
  }

  void add_facet(const Triangle& corners, int label) {
    result_.mesh.facets.push_back(corners);
    result_.mesh.facet_label.push_back(label);
  }

  void declare_film(const films::FilmSpec& film) {
    const int label = add_surface(
        {film.name, true, film.tension, film.tension_field, film.drop_shape});
    if (film.tension_field) {
      result_.surfaces[label].tension_field->positive = true;
    }
    std::set<std::string> used;
    for (const std::string& name : film.curves) {
      if (!used.insert(name).second) {
        throw InvalidInput(fmt::format("film '{}' names the curve '{}' twice",
                                       film.name, name));
      }
    }
  }

  void add_film(const films::FilmSpec& film) {
    const int label = result_.mesh.label_of(film.name);
    switch (film.kind) {
      case films::FilmKind::Branch:
        add_branch(film, label);
        break;
      case films::FilmKind::Loft:
        add_loft(film, label);
        break;
      case films::FilmKind::Disk:
        add_disk(film, label);
        break;
      case films::FilmKind::Facets:
        add_sheet(film.name, label, films::VertexKind::Free);
        break;
      case films::FilmKind::Spines:
        add_spined(film, label);
        break;
    }
  }

  /// Those that end on others, after these; where lines are too close together
  /// for the start's edges, along shorter ones.
  void add_joining_films() {
    films_join_ = std::any_of(
        system_.films.begin(), system_.films.end(),
        [](const films::FilmSpec& film) { return !film.joins.empty(); });
    const films::FilmComplex before =
        films_join_ ? result_ : films::FilmComplex();
    const std::map<std::string, Rim> rims = rims_;
    for (double edge = edge_; films_join_; edge *= 0.5) {
      try {
        add_joining_films(edge);
        return;
      } catch (const NoWayAlong&) {
        if (edge <= kShortestToJoin * edge_) {
          throw;
        }
        result_ = before;
        rims_ = rims;
      }
    }
  }

  void add_joining_films(double edge) {
    FilmJoiner joiner(system_, edge, result_);
    for (const films::JoinedSide& side : films::joined_sides(system_)) {
      joiner.find_corners(side.curve,
                          rims_.at(system_.curves[side.curve].name).ids);
    }
    joiner.refine_joined();
    std::set<std::string> missing;
    for (const films::FilmSpec& film : system_.films) {
      if (!film.joins.empty()) {
        missing.insert(film.name);
      }
    }
    for (const int f : films::joining_order(system_.films)) {
      const films::FilmSpec& film = system_.films[static_cast<std::size_t>(f)];
      join(f, joiner);
      add_film(film);
      missing.erase(film.name);
    }
    if (!missing.empty()) {
      throw InvalidInput(
          fmt::format("film '{}' joins films that join it; let one of them "
                      "have curves of its own there",
                      *missing.begin()));
    }
  }

  void join(int film, FilmJoiner& joiner) {
    for (const std::string& name : system_.films[film].curves) {
      Rim& rim = rims_.at(name);
      rim.ids =
          joiner.join_rim(film, rim.curve, rim.ids, !shared_.shares(rim.curve));
    }
    for (auto& [name, rim] : rims_) {
      for (int& id : rim.ids) {
        const auto at = joiner.replaced().find(id);
        id = at == joiner.replaced().end() ? id : at->second;
      }
    }
  }

  static void require_curves(const films::FilmSpec& film, std::size_t count) {
    if (film.curves.size() != count) {
      throw InvalidInput(
          fmt::format("film '{}' has {} curves, its kind needs {}", film.name,
                      film.curves.size(), count));
    }
  }

  /// Within its first curve, around the others.
  void add_disk(const films::FilmSpec& film, int label) {
    std::vector<Rim> rims;
    for (const std::string& name : film.curves) {
      rims.push_back(rim_of(name, film.name));
    }
    fill(rims, label, films::VertexKind::Free);
  }

  void add_loft(const films::FilmSpec& film, int label) {
    require_curves(film, 2);
    const Rim low = rim_of(film.curves[0], film.name);
    const Rim high = rim_of(film.curves[1], film.name);
    for (Triangle t : films::loft_band(points_of(low), points_of(high))) {
      for (int& v : t) {
        v = v < low.count() ? low.ids[v] : high.ids[v - low.count()];
      }
      add_facet(t, label);
    }
  }

  /// Around the spines of its body.
  void add_spined(const films::FilmSpec& film, int label) {
    std::vector<films::SpineSpec> own;
    for (const films::BodySpec& body : system_.bodies) {
      for (const films::SpineSpec& spine : system_.spines) {
        if (spine.body == body.name && body.is_enclosed_by(film.name)) {
          require_only(film, body);
          own.push_back(spine);
        }
      }
    }
    if (own.empty()) {
      throw InvalidInput(fmt::format(
          "film '{}' starts from spines, but its body has none: give one of "
          "[spines.NAME] that body",
          film.name));
    }
    std::vector<Rim> rims;
    for (const std::string& name : film.curves) {
      rims.push_back(rim_of(name, film.name));
    }
    add_filling(spines::spine_start(own, spine_rims(film), film.name), rims,
                label, films::VertexKind::Free);
  }

  /// All of a body's spines make one film.
  void require_only(const films::FilmSpec& film,
                    const films::BodySpec& body) const {
    for (const films::FilmSpec& other : system_.films) {
      if (other.name != film.name && other.kind == films::FilmKind::Spines &&
          body.is_enclosed_by(other.name)) {
        throw InvalidInput(fmt::format(
            "films '{}' and '{}' both start from the spines of body '{}'; let "
            "one film have the curves of both",
            film.name, other.name, body.name));
      }
    }
  }

  /// Those that a film ends at, as they begin; between two with a ring a bore.
  std::vector<spines::SpineRim> spine_rims(const films::FilmSpec& film) {
    std::vector<spines::SpineRim> rims;
    for (const std::string& name : film.curves) {
      rims.push_back({name, points_of(rim_of(name, film.name))});
    }
    const auto number = [&](const std::string& curve) {
      const auto at = std::find(film.curves.begin(), film.curves.end(), curve);
      return at == film.curves.end()
                 ? -1
                 : static_cast<int>(at - film.curves.begin());
    };
    for (const films::CapSpec& cap : system_.caps) {
      const int outer = cap.inner.empty() ? -1 : number(cap.curve);
      const int inner = cap.inner.empty() ? -1 : number(cap.inner);
      if (outer >= 0 && inner >= 0) {
        rims[outer].bore = inner;
        rims[inner].bore = outer;
      }
    }
    return rims;
  }

  /// The first of the rims filled, the others left open.
  void fill(const std::vector<Rim>& rims, int label, films::VertexKind kind) {
    std::vector<Points> loops;
    bool graded = false;
    for (const Rim& rim : rims) {
      loops.push_back(points_of(rim));
      graded = graded || shared_.shares(rim.curve) ||
               films::is_cut_finely(system_.curves[rim.curve]);
    }
    add_filling(
        fill_face(loops, edge_, graded, system_.curves[rims[0].curve].name),
        rims, label, kind);
  }

  // `disk`: the points of the rims come first, in their order.
  void add_filling(const SurfaceMesh& disk, const std::vector<Rim>& rims,
                   int label, films::VertexKind kind) {
    std::vector<int> ids;
    for (const Rim& rim : rims) {
      ids.insert(ids.end(), rim.ids.begin(), rim.ids.end());
    }
    for (std::size_t i = ids.size(); i < disk.points.size(); ++i) {
      ids.push_back(static_cast<int>(result_.mesh.points.size()));
      result_.mesh.points.push_back(disk.points[i]);
      result_.vertices.push_back({kind, -1, 0.0});
    }
    for (const Triangle& t : disk.facets) {
      add_facet({ids[t[0]], ids[t[1]], ids[t[2]]}, label);
    }
  }

  /// Facets of the system's own.
  void add_sheet(const std::string& name, int label, films::VertexKind kind) {
    const auto sheet =
        std::find_if(facets_.sheets.begin(), facets_.sheets.end(),
                     [&](const FacetSheet& s) { return s.name == name; });
    if (sheet == facets_.sheets.end()) {
      throw InvalidInput(fmt::format("'{}' has no facets", name));
    }
    for (const auto& corners : sheet->facets) {
      Triangle t;
      for (int k = 0; k < 3; ++k) {
        const FacetCorner& corner = corners[k];
        if (corner.point < 0) {
          t[k] = rim_of(system_.curves[corner.curve].name, name)
                     .ids[static_cast<std::size_t>(corner.cut)];
          continue;
        }
        int& id = facet_points_[corner.point];
        if (id < 0) {
          id = static_cast<int>(result_.mesh.points.size());
          result_.mesh.points.push_back(facets_.points[corner.point]);
          result_.vertices.push_back({kind, -1, 0.0});
        } else if (result_.vertices[id].kind != kind) {
          const Vec3& p = facets_.points[corner.point];
          throw InvalidInput(
              fmt::format("solid '{}' meets a film at ({:.6g}, {:.6g}, {:.6g}) "
                          "on no curve; "
                          "films are held by curves: name one there for both",
                          name, p.x(), p.y(), p.z()));
        }
        t[k] = id;
      }
      add_facet(t, label);
    }
  }

  void add_cap(const films::CapSpec& cap) {
    const int label = add_surface({cap.name, false, 0.0});
    if (cap.start) {
      add_sheet(cap.name, label, films::VertexKind::InCap);
      return;
    }
    if (cap.solid >= 0) {
      solids_.add_face(cap, label, result_);
      return;
    }
    std::vector<Rim> rims;
    std::vector<Points> loops;
    for (const std::string& name : cap.curves()) {
      rims.push_back(rim_of(name, cap.name));
      loops.push_back(points_of(rims.back()));
    }
    if (cap.ruled) {
      add_patch(rims[0], label);
      return;
    }
    if (!cap.inner.empty()) {
      add_ring(rims, label);
      return;
    }
    if (cap.wall && cap.wall->bent()) {
      add_filling(fill_wetted_face(cap, loops, edge_), rims, label,
                  films::VertexKind::InCap);
      return;
    }
    for (std::size_t k = 0; k < loops.size(); ++k) {
      require_flat(loops[k], cap.name, system_.curves[rims[k].curve].name);
    }
    for (const std::vector<int>& face : faces_with_holes(loops)) {
      std::vector<Rim> bounds;
      bounds.reserve(face.size());
      for (const int k : face) {
        bounds.push_back(rims[k]);
      }
      fill(bounds, label, films::VertexKind::InCap);
    }
  }

  void add_ring(const std::vector<Rim>& rims, int label) {
    const auto id = static_cast<int>(result_.bands.size());
    result_.surfaces[label].band = id;
    result_.bands.push_back(
        films::match_band(result_.curves, rims[0].curve, rims[1].curve));
    match_cuts(system_, result_.surfaces[label].name, result_.bands.back());
    const films::RuledBand& band = result_.bands.back();
    std::vector<int> ids;
    std::vector<BandRim> sides;
    for (const Rim& rim : rims) {
      BandRim& side = sides.emplace_back();
      side.points = points_of(rim);
      for (const int v : rim.ids) {
        side.t.push_back(
            films::place_on_band(result_, id,
                                 {result_.vertices[v], result_.mesh.points[v]})
                .t);
      }
      ids.insert(ids.end(), rim.ids.begin(), rim.ids.end());
    }
    const BandFilling filling =
        fill_band(band, result_.curves, sides[0], sides[1], edge_);
    for (std::size_t k = 0; k < filling.between.size(); ++k) {
      ids.push_back(static_cast<int>(result_.mesh.points.size()));
      const films::BandPlace& place = filling.between[k];
      result_.vertices.push_back({.kind = films::VertexKind::OnBand,
                                  .curve = id,
                                  .t = place.t,
                                  .share = place.share});
      result_.mesh.points.push_back(filling.mesh.points[ids.size() - 1]);
    }
    for (const Triangle& t : filling.mesh.facets) {
      add_facet({ids[t[0]], ids[t[1]], ids[t[2]]}, label);
    }
  }

  void add_patch(const Rim& rim, int label) {
    const auto id = static_cast<int>(result_.bands.size());
    result_.surfaces[label].band = id;
    result_.bands.push_back(films::match_patch(result_.curves, rim.curve));
    std::vector<films::BandPlace> around;
    for (const int v : rim.ids) {
      around.push_back(films::place_on_band(
          result_, id, {result_.vertices[v], result_.mesh.points[v]}));
    }
    const PatchFilling filling =
        fill_patch(result_.bands.back(), result_.curves, around, edge_);
    std::vector<int> ids = rim.ids;
    for (const films::BandPlace& place : filling.between) {
      ids.push_back(static_cast<int>(result_.mesh.points.size()));
      result_.vertices.push_back({.kind = films::VertexKind::OnBand,
                                  .curve = id,
                                  .t = place.t,
                                  .share = place.share});
      result_.mesh.points.push_back(films::point_on_band(
          result_.bands[id], result_.curves, place.t, place.share));
    }
    for (const Triangle& t : filling.facets) {
      add_facet({ids[t[0]], ids[t[1]], ids[t[2]]}, label);
    }
  }

  void add_branch(const films::FilmSpec& film, int label);

  /// Faces that planes will cut, and that have no curve of their own, are not
  /// needed to close the whole.
  void add_bodies(const std::vector<RaisedDisk>& raised) {
    std::map<std::string, int> later;  // by name: the label
    for (const films::CapSpec& cap : system_.caps) {
      if (cap.wall && cap.wall->cuts && cap.curves().empty()) {
        later[cap.name] = result_.mesh.label_of(cap.name);
      }
    }
    std::vector<std::vector<int>> faces;
    std::vector<std::vector<films::BodySide>> in_cells;  // per body: its films
    for (films::BodySpec body : system_.bodies) {
      std::vector<int>& of_body = faces.emplace_back();
      std::erase_if(body.enclosed_by, [&](const std::string& name) {
        const auto at = later.find(name);
        if (at != later.end()) {
          of_body.push_back(at->second);
        }
        return at != later.end();
      });
      result_.bodies.push_back(films::make_body(body, result_.mesh));
      auto& films = in_cells.emplace_back();
      if (is_in_cell(body)) {
        films.swap(result_.bodies.back().sides);
      }
    }
    for (const films::CapSpec& cap : system_.caps) {
      if (!cap.wall || !cap.wall->cuts) {  // films may slide on a plane alone
        films::require_body(system_, cap.name);
      }
    }
    films::orient_bodies(result_);
    if (turn_shared_disks(raised, result_)) {
      films::orient_bodies(result_);
    }
    std::set<int> behind;  // films that have a body behind them
    for (std::size_t b = 0; b < faces.size(); ++b) {
      for (films::BodySide side : in_cells[b]) {
        side.sign = behind.insert(side.surface).second ? 1 : -1;
        result_.bodies[b].sides.push_back(side);
      }
      for (const int label : faces[b]) {
        result_.bodies[b].sides.push_back({label, 1});
      }
    }
  }

  /// Do its films end on planes that cut, all around? Nothing closes such a
  /// body before these do: it lies behind the first of its films, which run as
  /// their curves do, and another before them.
  bool is_in_cell(const films::BodySpec& body) const {
    const double reach = reach_of_planes(result_.mesh.points);
    const auto lies = [&](int v) {
      return std::any_of(
          system_.caps.begin(), system_.caps.end(),
          [&](const films::CapSpec& cap) {
            return cap.wall && cap.wall->cuts &&
                   std::abs(off_wall(*cap.wall, result_.mesh.points[v])) <=
                       reach;
          });
    };
    return std::all_of(
        body.enclosed_by.begin(), body.enclosed_by.end(),
        [&](const std::string& name) {
          const auto film = std::find_if(
              system_.films.begin(), system_.films.end(),
              [&](const films::FilmSpec& f) { return f.name == name; });
          return film != system_.films.end() &&
                 std::all_of(film->curves.begin(), film->curves.end(),
                             [&](const std::string& curve) {
                               const std::vector<int>& rim =
                                   rims_.at(curve).ids;
                               return std::all_of(rim.begin(), rim.end(), lies);
                             });
        });
  }

  void add_walls() {
    for (std::size_t k = 0; k < system_.caps.size(); ++k) {
      const films::CapSpec& cap = system_.caps[k];
      if (!cap.wall) {
        continue;
      }
      if (cap.start || cap.ruled || !cap.inner.empty()) {
        throw InvalidInput(fmt::format(
            "solid '{}' has a wall; faces that films wet have curves only",
            cap.name));
      }
      std::vector<std::vector<int>> rims;
      for (const std::string& name : cap.curves()) {
        rims.push_back(rims_.at(name).ids);
        if (shared_.shares(rims_.at(name).curve)) {
          throw InvalidInput(fmt::format(
              "curve '{}' shares a side with another curve and cannot slide on "
              "the wall of '{}'",
              name, cap.name));
        }
      }
      slide_on_wall(system_, cap, static_cast<int>(system_.films.size() + k),
                    rims, result_);
    }
  }

  void add_fields() {
    for (const films::FieldSpec& field : system_.fields) {
      result_.quantities.push_back(energy::field_quantity(result_, field));
    }
    for (const films::PressureSpec& spec : system_.pressures) {
      result_.quantities.push_back(energy::pressure_quantity(
          result_, spec.name, spec.body, spec.pressure));
    }
  }

  /// The poles of the bodies' spines, which go on beyond the rims of their
  /// films. Planes have not cut these yet.
  std::vector<films::FilmQuantity> poles_of_bodies() {
    std::vector<films::FilmQuantity> result;
    for (std::size_t b = 0; b < system_.bodies.size(); ++b) {
      const films::BodySpec& body = system_.bodies[b];
      films::FilmQuantity poles{fmt::format("spines of {}", body.name),
                                films::FilmQuantity::Role::Energy,
                                films::FilmQuantity::Kind::BodyPoles};
      poles.body = static_cast<int>(b);
      poles.modulus = -1.0;
      std::vector<spines::SpineRim> rims;
      for (const films::FilmSpec& film : system_.films) {
        if (body.is_enclosed_by(film.name)) {
          const std::vector<spines::SpineRim> more = spine_rims(film);
          rims.insert(rims.end(), more.begin(), more.end());
        }
      }
      for (const films::SpineSpec& spine : system_.spines) {
        if (spine.body != body.name) {
          continue;
        }
        require_no_wall(spine, body);
        const std::array<int, 2> at = spines::rims_at_ends(spine, rims);
        result_.spines.push_back(
            spines::sample_spine(spine, poles.body, {at[0] >= 0, at[1] >= 0}));
      }
      poles.poles =
          spines::poles_of(result_.spines, poles.body, system_.spines);
      if (!poles.poles.empty()) {
        result.push_back(std::move(poles));
      }
    }
    return result;
  }

  /// A face that slides is open while its film is sought, and what lies beyond
  /// a plane of symmetry presses too.
  void require_no_wall(const films::SpineSpec& spine,
                       const films::BodySpec& body) const {
    for (const films::CapSpec& cap : system_.caps) {
      if (cap.wall && body.is_enclosed_by(cap.name)) {
        throw InvalidInput(fmt::format(
            "spine '{}' holds body '{}', which ends at {} '{}'; spines are for "
            "bodies without wetted faces and planes of symmetry: draw the "
            "whole",
            spine.name, body.name,
            cap.wall->cuts ? "the plane of symmetry" : "the wetted face",
            cap.name));
      }
    }
  }

  films::FilmSystem system_;
  double edge_;
  films::FilmComplex result_;
  std::map<std::string, Rim> rims_;
  films::SharedRims shared_;
  SolidStart solids_;
  FacetStart facets_;
  std::vector<int> facet_points_;  // ids of its points; -1: not yet
  std::map<int, std::vector<double>> join_cuts_;  // by curve
  bool films_join_ = false;
};

void StartBuilder::add_branch(const films::FilmSpec& film, int label) {
  if (film.curves.size() < 2) {
    throw InvalidInput(
        fmt::format("film '{}' has {} curves, a branch needs 2 "
                    "or more; use kind disk for one",
                    film.name, film.curves.size()));
  }
  std::vector<int> counts;
  std::vector<int> ids;
  Points points;
  for (const std::string& name : film.curves) {
    const Rim& rim = rim_of(name, film.name);
    counts.push_back(rim.count());
    ids.insert(ids.end(), rim.ids.begin(), rim.ids.end());
    const Points of_rim = points_of(rim);
    points.insert(points.end(), of_rim.begin(), of_rim.end());
  }
  for (const Triangle& t : branch_facets(film, points, counts)) {
    add_facet({ids[t[0]], ids[t[1]], ids[t[2]]}, label);
  }
}

}  // namespace

films::FilmComplex build_start(const films::FilmSystem& system, double edge) {
  if (!std::isfinite(edge) || edge <= 0.0) {
    throw InvalidInput(fmt::format("edge length is {}, must be above 0", edge));
  }
  return StartBuilder(system, edge).build();
}

}  // namespace meniscus::start
