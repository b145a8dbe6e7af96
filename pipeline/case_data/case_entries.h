/// What the tables of a case file hold: names checked, expressions compiled,
/// nothing computed.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/math/expression.h"
#include "core/math/measure.h"
#include "core/math/place_shape.h"
#include "core/math/worst_direction.h"
#include "evolve/films/film_system.h"
#include "evolve/scan/scan.h"
#include "evolve/walls/thicken.h"
#include "fea/elastic/elasticity.h"
#include "fea/stress/exclusion_zones.h"

namespace meniscus::case_data {

/// Where an entry stands in the case file: its line from 1; -k where the k-th
/// override (--set) put it; 0 when not known.
using SourceLine = int;

/// A number of the case: an expression over the case's names (design variables
/// first, then parameters), in case units.
struct Quantity {
  Expression expression;
  SourceLine line = 0;
  std::string key;  // "curves.support.radius", for messages
  Measure measure;  // its dimension, where that is known
};
using QuantityVector = std::array<Quantity, 3>;

/// A number, or an expression that knows the coordinates x, y, z after the
/// case's names, and after these, where it is of a film's field, the shapes.
struct PlaceQuantity {
  Quantity quantity;
  bool of_place = false;  // x, y, z or a shape appear
};

struct DesignVariable {
  std::string name;
  double initial = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  SourceLine line = 0;
  Measure measure;  // of all three
};

/// Design variables that people know by one name: neighbours in the list of all
/// of them, each named as expressions do, "t[2,3]", the last index running
/// fastest.
struct DesignVector {
  std::string name;
  std::vector<int> shape;  // one to three counts, each 1 or more
  std::size_t first = 0;   // its first element among the design variables
  SourceLine line = 0;

  std::size_t size() const {
    std::size_t count = 1;
    for (const int along : shape) {
      count *= static_cast<std::size_t>(along);
    }
    return count;
  }
};

struct Parameter {
  std::string name;
  Quantity value;
};

enum class CurveKind {
  Circle,
  Ellipse,
  Rectangle,
  Polygon,
  Spline,
  Polyline,
  Copy,
  OfFeature  // an edge of a boss, flange, lug or block
};

/// A corner of a polyline, or what the arc between two corners goes through.
struct PathPoint {
  QuantityVector at;
  bool through = false;
};

/// Another curve offset, scaled, mirrored, turned about `axis` and moved.
struct CopyEntry {
  int of = -1;  // index of a curve above
  std::optional<Quantity> offset;
  QuantityVector scale;
  std::optional<QuantityVector> mirror;
  Quantity angle;
  QuantityVector about, move;
};

/// A curve that no design variable moves, and its rates, which are none.
struct FixedCurve {
  curves::Curve value, rate;
};

/// What the kind does not need is empty.
struct CurveEntry {
  std::string name;
  CurveKind kind = CurveKind::Circle;
  QuantityVector center, normal, axis;
  Quantity radius, radius_1, radius_2, width, height, corner_radius;
  std::vector<PathPoint> points;   // of polygon, spline, polyline; or
  std::vector<Vec3> fixed_points;  // of polygon and spline: from a file
  CopyEntry copy;
  double pieces = 0.0;  // length that it is cut into [length]; 0: the films'
  bool free = false;    // films begin along it and move on
  std::vector<int> free_sides = {};  // or along these of its sides, from 0
  int feature = -1;                  // index of the feature, and of its curves
  int of_feature = -1;
  std::shared_ptr<const FixedCurve> fixed = nullptr;  // by fix_curves()
  SourceLine line = 0;

  bool is_free_somewhere() const { return free || !free_sides.empty(); }
};

/// Two curves in one place, indices of curves: one for films and solids.
struct MergedCurves {
  int kept = 0;
  int dropped = 0;
};

/// One of the spheroids whose sum is the shape of a film's free drops.
struct SpheroidEntry {
  QuantityVector axis;
  Quantity along, across;
  SourceLine line = 0;
  std::string key;
};

struct FilmEntry {
  films::FilmSpec spec;  // tension and start filled in by evaluate()
  PlaceQuantity tension;
  std::vector<SpheroidEntry> drop;  // none: a sphere
  /// One number for all of the film, however it is turned.
  bool has_one_tension() const { return !tension.of_place && drop.empty(); }
  std::vector<QuantityVector> vertices;  // of facets in the case
  std::vector<Triangle> facets;          // of vertices
  SourceLine line = 0;
};

/// The wall of a face that films wet, and the angle that they meet it at, in
/// the body.
struct WettedWall {
  films::WallKind kind = films::WallKind::Plane;
  QuantityVector at, normal;  // of cylinder and cone the axis
  std::optional<Quantity> radius, half_angle;
  Quantity contact_angle;  // [rad]
  bool cuts = false;       // a plane of symmetry that cuts curves of the body
};

/// A plane in which the part that the case draws is mirrored. What is drawn
/// lies on the side that the normal points away from.
struct SymmetryPlane {
  Vec3 at = Vec3::Zero();       // a point of it [length]
  Vec3 normal = Vec3::UnitZ();  // of length 1
  SourceLine line = 0;
  std::vector<std::string> films;   // that slide on it
  std::vector<std::string> curves;  // of films, of which a side lies in it
};

struct CapEntry {
  films::CapSpec spec;  // wall filled in by evaluate()
  std::optional<WettedWall> wetted;
  int symmetry = -1;     // index of the plane that it lies in; -1: none
  bool is_file = false;  // of facets or a STEP solid; else a flat disk
  SourceLine line = 0;
};

enum class FeatureKind { Boss, Flange, Lug, Block };

/// Where a film grows from a boss: the circle of its seat, of its base, or one
/// around it.
struct FeatureRim {
  enum class Place { Seat, Base, Height };
  Place place = Place::Base;
  Quantity height;  // above the base
};

/// A parametric solid that films grow from: its curves NAME/... and its faces,
/// solids NAME/..., are entries of their own (pipeline/case_data/
/// feature_shapes.h). What the kind does not need is empty.
struct FeatureEntry {
  std::string name;
  FeatureKind kind = FeatureKind::Boss;
  QuantityVector at, axis;
  QuantityVector across;  // of flange, block: of its width; of lug: to its foot
  Quantity radius, height, thickness, length;
  std::optional<Quantity> bore, base_radius, depth, chamfer;
  std::optional<Quantity> width;  // of lug: of its foot
  std::optional<Quantity> corner_radius;
  QuantityVector size;
  std::vector<QuantityVector> holes;  // centres
  Quantity hole_radius;
  std::vector<FeatureRim> rims;         // of boss: one or two, base to seat
  std::vector<std::string> rim_curves;  // of flange: in its top face
  std::vector<std::string> open;        // faces of block that films close
  bool round = false;                   // of flange
  SourceLine line = 0;
};

/// A solid of a STEP file as it is: its faces, solids NAME/FACE, and the curves
/// of its rims are entries of their own.
struct StepSolidEntry {
  films::SolidSpec spec;
  std::vector<int> faces;  // those that are there: not open
  SourceLine line = 0;
};

/// "NAME/FACE".
inline std::string face_name(const StepSolidEntry& solid, int face) {
  return solid.spec.name + "/" +
         solid.spec.shape->faces[static_cast<std::size_t>(face)].name;
}

inline constexpr int kVoid = -1;

struct BodyEntry {
  std::string name;
  std::vector<std::string> enclosed_by;
  std::optional<Quantity> volume, pressure;
  int material = 0;  // index into materials; kVoid: none
  SourceLine line = 0;
  SourceLine enclosure_line = 0;  // of enclosed_by
};

struct WallEntry {
  std::string name;
  std::vector<std::string> films;
  PlaceQuantity thickness;
  walls::WallSide side = walls::WallSide::Both;
  std::optional<double> fillet;  // [length]
  std::vector<std::string> flush;
  int material = kVoid;  // index into materials; kVoid: none given
  int region = 0;        // walls whose films share a curve are of one
  SourceLine line = 0;
};

/// One of those that a shell is made of.
struct LayerEntry {
  int material = 0;    // index into materials
  double share = 1.0;  // of the thickness, in parts of the sum of all shares
  Quantity angle;      // about the normal to the outside [rad]
  SourceLine line = 0;
};

/// Films solved on their own facets.
struct ShellEntry {
  std::string name;
  std::vector<std::string> films;
  PlaceQuantity thickness;
  walls::WallSide side = walls::WallSide::Both;
  std::vector<LayerEntry> layers;  // from the inside to the outside; 1 or more
  /// Angles count from its projection on the film; nothing: from that of the
  /// layers' own axis 1.
  std::optional<Vec3> direction = {};
  SourceLine line = 0;
};

struct FilletEntry {
  std::string name;
  std::vector<std::string> curves;
  Quantity radius;
  SourceLine line = 0;
};

/// A shape of fields and its coefficients: one per function.
struct ShapeEntry {
  std::string name;
  std::shared_ptr<const PlaceShape> shape;
  std::vector<Quantity> coefficients;
  SourceLine line = 0;
};

enum class FieldKind { Point, Segment, Polyline, Plane, Pressure };

struct FieldEntry {
  std::string name;
  FieldKind kind = FieldKind::Point;
  QuantityVector at, normal, from, to;
  std::vector<QuantityVector> points;
  Quantity strength, power, core;
  std::vector<std::string> films;  // acts per area of these; or
  std::string body;                // per volume of this
  PlaceQuantity pressure;
  SourceLine line = 0;
};

struct SpineEntry {
  std::string name;
  std::string body;
  std::vector<QuantityVector> points;
  bool smooth = true;
  std::vector<Quantity> radii;  // one, or one per point
  bool along = false;  // the one radius knows s after the case's names: the
                       // share of the way along the points, from 0 to 1
  Quantity tension;
  SourceLine line = 0;
};

struct MaterialEntry {
  std::string name;
  Quantity youngs_modulus, poisson_ratio, density;
  std::optional<Quantity> yield_strength;
  // Of fatigue [pressure]:
  std::optional<double> endurance_limit;
  std::optional<double> tensile_strength;
  std::optional<double> torsion_limit;
  std::optional<element::Orthotropic>
      orthotropic;  // instead of modulus and ratio
  Vec3 thermal_expansion = Vec3::Zero();
  SourceLine line = 0;
};

enum class LoadKind {
  Force,
  Remote,  // force or moment through a point
  Pressure,
  Traction,
  RimTension,  // of shells
  Gravity,
  Spin,
  Temperature,
  Preload  // of a bolt: two remote loads in balance
};

/// How surfaces take a force or a moment.
enum class LoadPath {
  Spread,  // without being stiffened
  Rigid,   // as one rigid body
  Bearing  // pressed by a round pin; forces only
};

/// What the kind does not need is empty.
struct LoadEntry {
  LoadKind kind = LoadKind::Force;
  LoadPath by = LoadPath::Spread;  // of forces and moments
  loads::Surfaces surfaces;        // of a preload the seat under the head
  loads::Surfaces thread;          // of a preload
  QuantityVector vector;           // force, gravity, axis of spin or of a bolt
  QuantityVector moment;
  QuantityVector at;                   // the remote point; on such an axis
  bool has_at = false;                 // a bearing's may be left out
  std::optional<QuantityVector> axis;  // of a bearing
  PlaceQuantity place;                 // pressure, temperature
  std::array<PlaceQuantity, 3> traction;
  Quantity number;               // rate of spin, reference temperature, tension
                                 // of a bolt or a rim
  std::optional<Quantity> size;  // of a force from any direction in the cone
  Cone cone;
  SourceLine line = 0;
};

/// A load of given size from any direction in a cone: three of the case's load
/// cases, NAME_x, NAME_y and NAME_z, are that size along x, y and z.
struct DirectionsEntry {
  std::string name;
  int first = 0;  // index of NAME_x
  Cone cone;
};

/// The numbers of a support are here, not in its struct.
struct SupportEntry {
  loads::Support support;
  std::optional<QuantityVector> displacement, rotation, at;
  SourceLine line = 0;
};

struct PinEntry {
  loads::RigidPin pin;
  QuantityVector at;
  std::optional<QuantityVector> displacement, rotation;
  SourceLine line = 0;
};

struct LoadCaseEntry {
  std::string name;
  std::vector<SupportEntry> supports;
  std::vector<loads::SpringBed> springs;
  std::vector<PinEntry> pins;  // that supports make; free ones are of loads
  std::vector<LoadEntry> loads;
  SourceLine line = 0;
};

/// A zone that stress figures leave out.
struct ExclusionEntry {
  stress::ExclusionZone zone;
  std::string key;  // "analysis.exclude[0]", for messages
  SourceLine line = 0;
};

struct AnalysisEntry {
  bool adapt = false;  // one round of adaptive refinement
  std::vector<ExclusionEntry> exclude;
  equations::SolverKind solver = equations::SolverKind::Automatic;
  int processes = 2;  // of Distributed
  // Eigenvalues of the best design:
  static constexpr int kFree = -1;  // not held at all
  /// More at once would take more memory than the part's own solve.
  static constexpr int kMostModes = 50;
  int frequencies = 0;  // lowest natural ones
  int supports_of = 0;  // held as in this load case: index, or kFree
  /// Smallest factors per load case; without it one, roughly; 0: none.
  std::optional<int> buckling;
};

enum class ResponseKind {
  MeanDisplacement,
  DisplacementNorm,
  Rotation,
  Compliance,
  StrainEnergy,
  BucklingFactor,
  Frequency,
  Mass,
  Volume,
  CentreOfMass,
  Inertia,
  MaxVonMises,
  VonMisesNorm,
  VonMisesKs,
  Uniformity,
  EnergyUniformity,
  FilmArea,
  FilmEnergy,
  Pressure,
  CollapseMargin,
  Radius,
  Thickness,
  Groove,
  Distance,
  Gap,
  ScanDistance,
  Overhang,
  Draft,
  StressRatio,
  Fatigue,
  Envelope,
  Expression
};

enum class StressMeasure { VonMises, Tension };

enum class FatigueCriterion { Goodman, Crossland };

enum class RegionSide { KeepOut, KeepIn };

/// What the kind does not need is empty.
struct ResponseEntry {
  std::string name;
  ResponseKind kind = ResponseKind::MeanDisplacement;
  std::string surface;
  QuantityVector direction;             // an axis for Rotation
  std::optional<QuantityVector> point;  // on the axis of Inertia
  int load_case = 0;  // index; of Frequency also AnalysisEntry::kFree
  /// Of the worst direction in this cone: load_case and the two after it are
  /// the unit loads (DirectionsEntry).
  std::optional<Cone> worst_in;
  std::vector<int> load_cases;  // of Fatigue the two: indices
  std::optional<PlaceQuantity> weight;
  double power = 8.0;
  double sharpness = 50.0;
  std::optional<double> scale;  // [pressure]
  /// Of thickness, distance and gap [length].
  std::optional<double> smoothing;
  std::optional<PlaceQuantity> region;  // above 0 in it
  RegionSide side = RegionSide::KeepOut;
  std::string film;                // empty: all
  std::vector<std::string> films;  // of gap two; of scan_distance
  std::string scan;                // of scan_distance: its path
  scan::ScanMeasure measure = scan::ScanMeasure::Rms;
  int body = 0;  // index
  StressMeasure stress = StressMeasure::VonMises;
  FatigueCriterion criterion = FatigueCriterion::Goodman;
  std::optional<double> allowable;  // of StressRatio [pressure]
  double excess = 0.02;  // of smooth bounds, as a part of what they bound
  double angle = 0.0;    // of Overhang, Draft [rad]
  double width = 0.0;    // of their switch about it [rad]
  std::vector<std::string> base;  // of Overhang: surfaces on the build plate
  int images = 1;  // of the drawn part, itself among them: it is their sum
  std::vector<int> parts;  // of Envelope: indices of responses above
  bool least = false;      // of Envelope: the smallest of them
  /// Of BucklingFactor and Frequency: which mode, from 1; and the width of the
  /// cluster that a bound is over, 0: of that mode alone.
  int number = 1;
  double cluster = 0.0;
  /// Of Expression: over the case's names, then the responses above it; of
  /// Envelope only its measure.
  Quantity value;
  SourceLine line = 0;
};

struct Resolution {
  double fea = 0.0;          // edge of the meshed film [length]
  double film = 0.0;         // edge of its nested refinement [length]
  int refinements = 1;       // film = fea / 2^refinements
  bool keep_facets = false;  // of films of facets: halved, never remeshed
  bool pop = false;          // junctions that no film keeps
  std::vector<double> export_edges;
};

/// How the part is made.
struct ProcessEntry {
  std::string name;               // for messages
  double smallest_feature = 0.0;  // the thinnest it makes [length]; 0: not said
};

enum class StudyKind { Analyse, Match, Minimize, Sweep, Tolerance, Pareto };

/// lower <= response <= upper.
struct ConstraintEntry {
  int response = 0;  // index
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  SourceLine line = 0;
};

/// One member of a family: the case with these overrides on top of its own.
struct MemberEntry {
  std::string name;                    // of its folder too
  std::vector<std::string> overrides;  // "name=value", as for --set
  std::string place;                   // "case.toml:12" or "members.csv:3"
};

struct StudyEntry {
  StudyKind kind = StudyKind::Analyse;  // of a family: of each member's study
  std::vector<MemberEntry> members;     // of a family, in order; else empty
  std::vector<std::string> equal;
  std::vector<std::pair<std::string, double>> targets;
  /// Of match instead of both: index of the scan_distance, whose distances are
  /// made small; its tolerance is a length, 0: as small as they get.
  std::optional<int> fit;
  std::optional<int> objective;  // index of a response
  std::optional<int> second;     // of a front: the other objective
  std::vector<ConstraintEntry> constraints;
  double tolerance = 1e-3;
  std::string method = "ceres";
  int max_evaluations = 400;
  int earlier_evaluations = 0;     // of models before; the limit is their sum
  double coarse_first = 1.0;       // edges of a first, coarser model; 1: none
  double time_limit = 0.0;         // [s], 0: none
  bool refreeze = true;            // where the frozen mesh no longer follows
  std::vector<int> levels;         // of a grid, per design variable; 0: none
  std::vector<double> deviations;  // of tolerances, likewise
  int count = 0;                   // of samples, or points of a front
  int seed = 1;
  SourceLine line = 0;
};

}  // namespace meniscus::case_data
