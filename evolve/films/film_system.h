/// What a design asks of the liquid at one set of parameters: curves, the
/// films between them, the solid caps and the bodies that they enclose.
/// Numbers only. For one model the names, kinds and order never change; the
/// numbers do.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/exact_shape.h"
#include "core/math/place_field.h"
#include "evolve/curves/curve.h"
#include "evolve/films/bent_wall.h"
#include "evolve/films/drop_shape.h"
#include "evolve/films/field_spec.h"
#include "evolve/films/spine_spec.h"

namespace meniscus::films {

enum class FilmKind {
  Branch,  // convex hull of any number of closed curves, less their caps
  Loft,    // band between two closed curves
  Disk,    // start across one closed curve, around others within it
  Spines,  // around the spines of its body, to any number of closed curves
  Facets   // given, its rims on any number of curves
};

/// Facets that a film starts from; only freezing a model looks at them.
struct StartFacets {
  Points points;                 // [length]
  std::vector<Triangle> facets;  // of points
};

struct FilmSpec {
  std::string name;
  FilmKind kind = FilmKind::Branch;
  std::vector<std::string> curves;
  double tension = 1.0;  // energy per area of the whole film [force/length]
  std::optional<PlaceField> tension_field;   // replaces tension
  DropShape drop_shape;                      // of a tension that turns
  std::shared_ptr<const StartFacets> start;  // of Facets
  double within = 0.0;  // its rims may be so far off their curves [length]
  /// Films that it ends on along the free sides of its curves, wherever that
  /// is (evolve/films/joined_sides.h).
  std::vector<std::string> joins = {};
};

/// A plane, cylinder, sphere or cone that films slide on where their curves lie
/// on it.
struct FilmWall {
  /// A point of the plane or of a cylinder's axis, a center, an apex [length].
  Vec3 at = Vec3::Zero();
  /// Not 0, any length: of a plane, either way; the axis of a cylinder, either
  /// way, and of a cone, from the apex into it.
  Vec3 normal = Vec3::UnitZ();
  /// Energy per wetted area [force/length]: -T cos a for films of tension T
  /// that meet the wall at the contact angle a, measured in the body (Young).
  double tension = 0.0;
  /// A plane of symmetry that cuts curves: what lies beyond it, on the side
  /// that `normal` points to, is left out of the start, and films, rings and
  /// flat disks end there. Its cap need not name a curve then. Tension 0.
  bool cuts = false;
  WallKind kind = WallKind::Plane;
  double radius = 0.0;      // of cylinder and sphere, above 0 [length]
  double half_angle = 0.0;  // of a cone, above 0 and below pi / 2
  /// What the ends of films made solid are called on it: "FILM/" and this.
  std::string rim;

  /// None of a plane.
  std::optional<BentWall> bent() const {
    if (kind == WallKind::Plane) {
      return std::nullopt;
    }
    return BentWall{kind, at, normal.normalized(), radius, half_angle};
  }
};

/// A solid from a CAD program whose faces are caps (CapSpec::solid).
struct SolidSpec {
  struct Rim {
    std::string curve;       // its name
    std::vector<int> edges;  // that it runs along
  };
  std::string name;
  std::shared_ptr<const ExactShape> shape;  // in its own coordinates
  std::string frame;  // the curve that says where it is (evolve/films/
                      // solid_frame.h); empty: in its own coordinates
  std::vector<Rim> rims;
};

/// Solid; carries no tension. A flat disk across a planar closed curve, a ring
/// between two closed curves, a patch between opposite sides of one, or facets
/// as they are, whose rims lie on curves. Where polygons and polylines have the
/// same side their faces are joined (evolve/films/shared_sides.h).
struct CapSpec {
  std::string name;
  std::string curve;  // of a disk or ring
  /// Of a ring the curve around its hole; empty: a disk. A ring between curves
  /// of one plane is flat, others are ruled bands.
  std::string inner = {};
  std::shared_ptr<const StartFacets> start = nullptr;
  std::vector<std::string> rims = {};  // of facets: their curves
  double within = 0.0;                 // as of films
  /// Of a disk: planar curves that it ends at too. One that lies within
  /// another's disk is a hole in it, others have disks of their own.
  std::vector<std::string> more = {};
  /// Instead of a disk the ruled patch between the first and the third of the
  /// curve's four sides; a cylinder's where these are equal arcs.
  bool ruled = false;
  /// Of a disk: the face that a body wets on this wall. Its curves are where
  /// the films on them begin; they hold nothing. The same for every design of a
  /// model but for its tension.
  std::optional<FilmWall> wall = std::nullopt;
  /// Instead of these a face of one of the system's solids; `rims` are the
  /// solid's rims at which it ends.
  int solid = -1;
  int face = -1;

  /// Those that it ends at.
  std::vector<std::string> curves() const {
    if (start || solid >= 0) {
      return rims;
    }
    std::vector<std::string> all;
    if (!curve.empty()) {  // planes that cut may have none
      all.push_back(curve);
    }
    if (!inner.empty()) {
      all.push_back(inner);
    }
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

struct BodySpec {
  std::string name;
  std::vector<std::string> enclosed_by;  // films and caps
  // At most one of the two; none means pressure 0.
  std::optional<double> volume;    // [length^3]
  std::optional<double> pressure;  // inside minus outside [force/length^2]
  bool is_void = false;            // of no material: not part of what is meshed

  bool is_enclosed_by(const std::string& surface) const {
    return std::find(enclosed_by.begin(), enclosed_by.end(), surface) !=
           enclosed_by.end();
  }
};

/// The arc of a ball in the corner along a curve where a film meets another
/// surface (evolve/fillets). The liquid does not know it: the settled film is
/// rounded afterwards.
struct FilletSpec {
  std::string name;
  std::string curve;
  double radius = 0.0;  // >= 0 [length]
};

struct FilmSystem {
  std::vector<curves::Curve> curves;
  std::vector<FilmSpec> films;
  std::vector<SolidSpec> solids;
  std::vector<CapSpec> caps;
  std::vector<BodySpec> bodies;
  // Field energies.
  std::vector<FieldSpec> fields;
  std::vector<PressureSpec> pressures;
  std::vector<SpineSpec> spines;
  std::vector<FilletSpec> fillets;
  /// Facets that are given are the film's own: halved until they are as small
  /// as its edge, never remeshed.
  bool keep_facets = false;
  /// Junctions that no film keeps are popped when a model is frozen
  /// (evolve/groom/pop.h); else they are what is wrong with its film.
  bool pop = false;
};

}  // namespace meniscus::films
