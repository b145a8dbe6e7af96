/// A case as its file says it: names checked, expressions compiled, nothing
/// computed; and the numbers that it comes to for one design.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/expression.h"
#include "core/types.h"
#include "core/units.h"
#include "evolve/film_system.h"
#include "fea/elasticity.h"

namespace meniscus {

/// A number of the case: an expression over the case's names (design variables
/// first, then parameters), in case units.
struct Quantity {
  Expression expression;
  int line = 0;     // in the case file
  std::string key;  // "curves.support.radius", for messages
};
using QuantityVector = std::array<Quantity, 3>;

struct DesignVariable {
  std::string name;
  double initial = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  int line = 0;
};

struct Parameter {
  std::string name;
  Quantity value;
};

enum class CurveKind { Circle, Ellipse, Rectangle, Polygon };

struct CurveEntry {
  std::string name;
  CurveKind kind = CurveKind::Circle;
  QuantityVector center, normal, axis;
  Quantity radius, radius_1, radius_2, width, height, corner_radius;
  std::vector<QuantityVector> points;
  int line = 0;
};

struct FilmEntry {
  FilmSpec spec;  // tension filled in by evaluate()
  Quantity tension;
  int line = 0;
};

struct CapEntry {
  CapSpec spec;
  int line = 0;
};

struct BodyEntry {
  std::string name;
  std::vector<std::string> enclosed_by;
  std::optional<Quantity> volume, pressure;
  int material = 0;  // index into materials
  int line = 0;
};

struct MaterialEntry {
  std::string name;
  Quantity youngs_modulus, poisson_ratio, density;
  std::optional<Quantity> yield_strength;
  int line = 0;
};

struct LoadEntry {
  std::string surface;
  std::optional<QuantityVector> force;  // total, else pressure
  std::optional<Quantity> pressure;
};

struct LoadCaseEntry {
  std::string name;
  std::vector<Support> supports;
  std::vector<LoadEntry> loads;
  int line = 0;
};

enum class ResponseKind {
  MeanDisplacement,
  Mass,
  Volume,
  MaxVonMises,
  StrainEnergy,
  FilmArea
};

struct ResponseEntry {
  std::string name;
  ResponseKind kind = ResponseKind::MeanDisplacement;
  std::string surface;
  QuantityVector direction;
  int load_case = 0;  // index
  int line = 0;
};

struct Resolution {
  double fea = 0.0;     // edge of the meshed film [length]
  double film = 0.0;    // edge of its nested refinement [length]
  int refinements = 1;  // film = fea / 2^refinements
  std::vector<double> export_edges;
};

enum class StudyKind { Analyse, Match };

struct StudyEntry {
  StudyKind kind = StudyKind::Analyse;
  std::vector<std::string> equal;
  std::vector<std::pair<std::string, double>> targets;
  double tolerance = 1e-3;
  std::string method = "ceres";
  int max_evaluations = 100;
  int line = 0;
};

struct Case {
  std::string path;
  std::string name;  // the file's, or its folder's for case.toml
  std::string title;
  std::string text;                    // the file, word for word
  std::vector<std::string> overrides;  // as given, "name=value"
  std::string hash;  // of all that evaluations depend on, 32 hex digits
  UnitSystem units;
  std::vector<DesignVariable> design;
  std::vector<Parameter> parameters;
  std::vector<int> parameter_order;  // each after those that it uses
  std::vector<CurveEntry> curves;
  std::vector<FilmEntry> films;
  std::vector<CapEntry> caps;
  std::vector<BodyEntry> bodies;
  std::vector<MaterialEntry> materials;
  std::vector<LoadCaseEntry> load_cases;
  std::vector<ResponseEntry> responses;
  Resolution resolution;
  StudyEntry study;
};

/// The numbers of one design.
struct EvaluatedCase {
  FilmSystem film_system;
  std::vector<Material> materials;  // one per body, in the bodies' order
  std::vector<LoadCase> load_cases;
  std::vector<Vec3> response_directions;  // one per response
  double fea_edge = 0.0;
};

/// `design`: one value per design variable. Throws InvalidInput, naming file,
/// line, key and values, where an expression has no finite value.
EvaluatedCase evaluate(const Case& input, const VectorX& design);

/// Values of the parameters, by name, at a design.
std::vector<std::pair<std::string, double>> parameter_values(
    const Case& input, const VectorX& design);

VectorX initial_design(const Case& input);
std::vector<std::string> design_names(const Case& input);
std::vector<std::string> response_names(const Case& input);
std::string response_unit(const Case& input, int response);

}  // namespace meniscus
