/// Films, walls and solid regions as one triangle complex, manifold or not,
/// before it is frozen into a model: what start, files, grooming, refinement
/// and equilibrium hand to each other.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/exact_shape.h"
#include "core/geometry/surface_mesh.h"
#include "core/math/place_field.h"
#include "evolve/films/bent_wall.h"
#include "evolve/films/drop_shape.h"
#include "evolve/films/film_system.h"
#include "evolve/films/ruled_band.h"
#include "evolve/films/spine_spec.h"

namespace meniscus::films {

enum class VertexKind {
  Free,     // liquid: moves with its films, within its constraints
  OnCurve,  // held at point_at(curves[curve], t)
  Slides,   // liquid: moves along curves[curve], t is unknown
  InCap,    // inside a flat cap: a fixed linear map of the cap's rim
  OnBand,   // inside a ring: held at point_on_band(bands[curve], t, share)
  OnEdge,   // of a solid: at solid_edges[curve], t
  OnFace,   // inside a solid's face: at solid_faces[curve], (t, share)
  Fixed     // solid
};

struct ComplexVertex {
  VertexKind kind = VertexKind::Free;
  int curve = -1;        // OnCurve, Slides: index into curves; OnBand: bands;
                         // OnEdge, OnFace: solid_edges, solid_faces
  double t = 0.0;        // of the curve; OnBand: of the band's outer curve
  int constraints = -1;  // Free, and InCap on planes of symmetry: index into
                         // constraint_sets; -1: none
  bool held = true;      // by them now; false: a one-sided wall was left
  double share = 0.0;    // OnBand: of the way to the inner curve; OnFace: the
                         // surface's second parameter, t the first
};

/// Marked edges: those that refinement and grooming must know of. Every other
/// edge is an ordinary edge of its films. Kept once per pair of vertices; line
/// integrals run from a to b.
struct ComplexEdge {
  int a = -1;
  int b = -1;
  VertexKind kind = VertexKind::Free;  // of the vertices born on it
  int curve = -1;                      // OnCurve, Slides, OnEdge; OnBand: bands
  int constraints = -1;                // index into constraint_sets
  bool refine = true;                  // false: stays one edge
  int integrals = -1;                  // index into integral_sets; -1: none
};

using VectorField = std::array<Expression, 3>;  // over x, y, z

/// Level set f(x, y, z) = 0 [any unit] that vertices are held to, or may not
/// cross. AtLeast: f >= 0; a vertex on such a wall leaves it where its film
/// pulls it away.
struct LevelSet {
  enum class Side { On, AtLeast, AtMost };
  std::string name;
  Expression formula;  // over x, y, z
  Side side = Side::On;
  bool convex = false;  // free marked edges on it carry gap energy
  std::optional<BentWall> bent = std::nullopt;  // the wall of the formula
};

/// Line integral of a vector field along marked edges: energy of walls that
/// are not meshed (contact angle) [force length], or volume that the facets
/// leave out (content), added to the bodies beside the edge, with the sign
/// with which the body's facets run through it.
struct LineIntegral {
  enum class Role { Energy, Content };
  std::string name;
  Role role = Role::Energy;
  VectorField field;
};

/// The wall behind a face that films wet.
struct WettedWall {
  Vec3 normal = Vec3::Zero();  // unit, that the facets on a plane have
  std::optional<BentWall> bent = std::nullopt;  // no plane
  double side = 1.0;  // -1: facets on a bent wall have their normals inward
};

struct ComplexSurface {
  std::string name;
  bool liquid = true;    // false: solid, its facets carry no tension
  double tension = 0.0;  // [force/length]; 0 on caps that wet no wall
  std::optional<PlaceField> tension_field;  // replaces tension
  DropShape drop_shape;                     // of a tension that turns
  bool refine = true;                       // false: facets stay as they are
  int constraints = -1;  // of the vertices born inside it (obstacles)
  int band = -1;         // of a ring: index into bands
  int face = -1;         // of a solid's face: index into solid_faces
  /// Of a solid face that films wet. Its area on the wall counts with
  /// `tension`, which may be below 0; `constraints` is of its rim, which slides
  /// there.
  std::optional<WettedWall> wetted;
  /// Of a film that a pop made, the one it was pulled from: its numbers are
  /// that one's. Empty: none.
  std::string pulled_from;

  /// The name of the film or cap whose numbers it has.
  const std::string& numbers_of() const {
    return pulled_from.empty() ? name : pulled_from;
  }
};

/// An edge or a face of a solid from a CAD program.
struct SolidPart {
  std::shared_ptr<const ExactShape> shape;
  int part = 0;    // index into its edges or faces
  int frame = -1;  // of curves: moves with it (evolve/films/solid_frame.h)

  const ExactEdge& edge() const { return shape->edges[part]; }
  const ExactFace& face() const { return shape->faces[part]; }
};

/// One surface's part in a body: sign +1 where the surface's facet normals
/// point out of the body, -1 where they point in.
struct BodySide {
  int surface = 0;
  int sign = 1;

  bool operator==(const BodySide&) const = default;
};

struct ComplexBody {
  std::string name;
  std::vector<BodySide> sides;
  std::optional<double> volume;    // [length^3]
  std::optional<double> pressure;  // [force/length^2]
  double density = 0.0;            // [mass/length^3]; weight under gravity
  double volume_offset = 0.0;      // added to the measured volume [length^3]

  bool operator==(const ComplexBody&) const = default;
};

/// Where the rays begin along which a body's scalar is summed.
struct RayOrigin {
  Vec3 at = Vec3::Zero();  // the scalar's pole, else a place amid the body
  bool is_pole = true;     // does the scalar have a pole there?
  int spans = 1;           // of a smooth scalar: pieces of a ray, eight places
                           // each
  /// So many points among the scalar's numbers, from the fourth number on, have
  /// their mean at the pole wherever the design takes them; 0: it stays.
  int moving_points = 0;
};

/// A named functional of the films: minimised with the energy (times modulus),
/// held at a target like a volume, or only reported.
struct FilmQuantity {
  enum class Role { Energy, Held, Info };
  enum class Kind {
    VectorIntegral,  // integral of field . normal over facets
    Area,            // plain area of facets
    ScalarIntegral,  // integral of scalar over facets
    BodyVolume,      // volume of `body`, or of all when -1
    // Integral of scalar over `body`, or over all when -1, which facets close:
    // where they do not, cones to `origin` do.
    BodyScalarIntegral,
    BodyPoles  // energy of `poles` per volume of `body`, which facets close
  };
  std::string name;
  Role role = Role::Info;
  Kind kind = Kind::VectorIntegral;
  VectorField field;          // VectorIntegral
  PlaceField scalar;          // ScalarIntegral, BodyScalarIntegral
  RayOrigin origin;           // BodyScalarIntegral
  std::vector<Pole> poles;    // BodyPoles: of the spines of `body`, in order
  double modulus = 1.0;       // Energy
  double target = 0.0;        // Held
  std::vector<int> surfaces;  // empty: every facet
  int body = -1;
};

/// How facets add up to volumes where a body is not closed by facets alone.
enum class VolumeRule {
  Cone,   // cones to a point: x . n / 3
  Column  // columns down to z = 0: z n_z
};

struct FilmComplex {
  // Compiled once, in film_complex.cpp: else in every source that holds one.
  FilmComplex();
  ~FilmComplex();
  FilmComplex(const FilmComplex& other);
  FilmComplex(FilmComplex&& other) noexcept;
  FilmComplex& operator=(const FilmComplex& other);
  FilmComplex& operator=(FilmComplex&& other) noexcept;

  SurfaceMesh mesh;                      // labels = surface names
  std::vector<ComplexVertex> vertices;   // one per point
  std::vector<ComplexEdge> edges;        // marked ones only
  std::vector<ComplexSurface> surfaces;  // one per label
  std::vector<ComplexBody> bodies;
  std::vector<curves::Curve> curves;
  std::vector<RuledBand> bands;  // of rings
  std::vector<SolidPart> solid_edges;
  std::vector<SolidPart> solid_faces;
  std::vector<LevelSet> level_sets;
  std::vector<std::vector<int>> constraint_sets;  // of indices of level_sets
  std::vector<LineIntegral> integrals;
  std::vector<std::vector<int>> integral_sets;  // of indices of integrals
  std::vector<FilmQuantity> quantities;
  std::vector<SpineSampling> spines;  // of the poles
  Vec3 gravity = Vec3::Zero();        // acceleration [length/time^2]
  VolumeRule volume_rule = VolumeRule::Cone;
  int line_points = 5;  // Gauss points of line integrals, per edge
  // Energy of free marked edges S on convex level sets, for the area between
  // edge and wall: gap_constant |S| (|S . n_a| + |S . n_b|) / 12 with the unit
  // normals of the level set at the edge's ends [force/length].
  double gap_constant = 0.0;
};

}  // namespace meniscus::films
