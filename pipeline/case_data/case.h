/// A case as its file says it, and the numbers that it comes to for one design.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "core/units.h"
#include "evolve/walls/wall_spec.h"
#include "pipeline/case_data/case_entries.h"

namespace meniscus::case_data {

/// A file that a case names, kept so that the case can be read again without
/// it.
struct CaseFile {
  std::string path;  // as the case names it
  std::string text;  // its bytes
};

/// Names of curves that have a side in common at the initial design, each pair
/// both ways.
using CurvePairs = std::set<std::pair<std::string, std::string>>;

struct Case {
  // Compiled once, in case.cpp: else in every source that holds one.
  Case();
  ~Case();
  Case(const Case& other);
  Case(Case&& other) noexcept;
  Case& operator=(const Case& other);
  Case& operator=(Case&& other) noexcept;

  std::string path;
  std::string name;  // the file's, or its folder's for case.toml
  std::string title;
  std::string text;                    // the file, word for word
  std::vector<std::string> overrides;  // as given, "name=value"
  std::vector<CaseFile> files;         // that it names, in the order of use
  std::string hash;  // of all that evaluations depend on (docs/case-file.md)
  std::string answer_hash;  // of all that a study's answer depends on
  UnitSystem units;
  std::vector<DesignVariable> design;
  std::vector<DesignVector> vectors;  // of these, in their order
  std::vector<Parameter> parameters;
  std::vector<int> parameter_order;  // each after those that it uses
  std::vector<CurveEntry> curves;
  std::vector<SymmetryPlane> symmetry;  // at right angles to each other
  std::vector<FilmEntry> films;
  std::vector<CapEntry> caps;               // cut faces are the last
  std::vector<FeatureEntry> features;       // whose faces are among the caps
  std::vector<StepSolidEntry> step_solids;  // the same
  std::vector<BodyEntry> bodies;
  std::vector<FilletEntry> fillets;
  std::vector<WallEntry> walls;
  std::vector<ShellEntry> shells;
  std::vector<ShapeEntry> shapes;
  std::vector<FieldEntry> fields;
  std::vector<SpineEntry> spines;
  std::vector<MaterialEntry> materials;
  std::vector<LoadCaseEntry> load_cases;
  std::vector<DirectionsEntry> directions;  // of load cases, in their order
  std::vector<ResponseEntry> responses;
  Resolution resolution;
  ProcessEntry process;
  AnalysisEntry analysis;
  StudyEntry study;
  std::vector<MergedCurves> merged;  // films and solids name the kept ones
  CurvePairs sharing_sides;          // of a case with walls
  std::vector<std::string> remarks;  // "PATH:LINE: ...": how it was read
  /// Designs that a study's models were frozen at before the one at `initial`,
  /// in order: its film begins from theirs (pipeline/store/refreeze.h).
  std::vector<VectorX> earlier_freezes;
  /// Where films begin before any of these, in order: values of the design
  /// variables, then of the parameters; NaN: this case's own.
  std::vector<VectorX> way;
};

/// The bodies that are not void, in order: the regions of the mesh. Without
/// such bodies the walls that have a material, one for each set of walls that
/// meet, named after its first. Behind them the layers of shells, which are no
/// regions.
std::vector<BodyEntry> solid_bodies(const Case& input);

/// Some body is not void.
bool has_solids(const Case& input);

/// What a response depends on beside fields.
struct ResponseInputs {
  Vec3 direction = Vec3::Zero();
  Vec3 point = Vec3::Zero();    // on an axis [length]
  loads::NumberOfPlace weight;  // empty: 1
  loads::VectorOfPlace weight_slope;
  loads::NumberOfPlace level;  // above 0 where the part must not be [length]
  loads::VectorOfPlace level_slope;
};

/// What a case hands to the stages: values, or their rates.
struct StageInputs {
  // Compiled once, in case.cpp: else in every source that holds one.
  StageInputs();
  ~StageInputs();
  StageInputs(const StageInputs& other);
  StageInputs(StageInputs&& other) noexcept;
  StageInputs& operator=(const StageInputs& other);
  StageInputs& operator=(StageInputs&& other) noexcept;

  films::FilmSystem film_system;
  std::vector<walls::WallSpec> walls;
  std::vector<walls::WallSpec> shells;
  std::vector<element::Material>
      materials;  // one per body that is solid, in order
  std::vector<double>
      layer_angles;  // of a case with shells: one per material [rad]
  std::vector<loads::LoadCase> load_cases;
  std::vector<ResponseInputs> responses;
};

/// The values at one design.
struct EvaluatedCase : StageInputs {
  VectorX design;  // where
  double fea_edge = 0.0;
};

/// The derivatives of these values by one design variable: every number that
/// has one holds it, what depends on places gives it there; orthotropic
/// constants, supports and springs, which never depend on the design, are
/// copies, as are the expressions that films are frozen with; weights and
/// regions of responses that do not move are empty.
struct CaseRates : StageInputs {};

/// `design`: one value per design variable. Throws InvalidInput, naming file,
/// line, key and values, where an expression has no finite value or one that
/// makes no curve, film, body or material.
EvaluatedCase evaluate(const Case& input, const VectorX& design);

/// The same, with every such message in `problems` instead of a throw; the
/// numbers are good only when there are none.
EvaluatedCase evaluate(const Case& input, const VectorX& design,
                       std::vector<std::string>& problems);

/// By the design variable of that index. Throws InvalidInput where an
/// expression has no finite derivative.
CaseRates rates(const Case& input, const VectorX& design, int variable);

/// "path:12", or "path: --set load_left=x" for what an override put there.
std::string place(const Case& input, SourceLine line);

/// Values of the parameters, by name, at a design.
std::vector<std::pair<std::string, double>> parameter_values(
    const Case& input, const VectorX& design);

VectorX initial_design(const Case& input);
std::vector<std::string> design_names(const Case& input);
std::vector<std::string> response_names(const Case& input);
Dimension dimension_of(ResponseKind kind);
/// The one that has these powers, neither angle nor rate; None: unknown, or
/// without a name.
Dimension dimension_of(const Measure& measure);
/// What is known of a response's dimension; of an expression what its parts
/// say.
Measure measure_of(const ResponseEntry& response);
std::string response_unit(const Case& input, int response);
/// What people are shown of it.
ShownUnit shown_unit(const Case& input, int response);
/// What a design variable's numbers are shown in.
ShownUnit shown_unit(const Case& input, const DesignVariable& variable);
/// What a number is in whose dimension the case says; empty for others.
std::string unit_of(const UnitSystem& units, const Measure& measure);

}  // namespace meniscus::case_data
