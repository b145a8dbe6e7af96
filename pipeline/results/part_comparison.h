/// Parts side by side: what they weigh and how they carry the same loads.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/monitor.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/exclusion.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::results {

struct PartLoadFigures {
  std::string load_case;
  /// |R|^2 / (f . u) [force/length]: R is the resultant of all loads of the
  /// case, f . u their work on the displacements. For one force this is the
  /// force over the mean displacement of the loaded surface along it. None
  /// where the loads have no resultant (moments) or heat acts.
  std::optional<double> stiffness;
  double work = 0.0;  // f . u [force length], twice the strain energy
  /// Of stresses that count; the largest of the readings on one mesh tells how
  /// far to trust the peak, which is recovered.
  double max_von_mises = 0.0;  // [pressure]
  double highest_reading = 0.0;
  Vec3 peak_position = Vec3::Zero();
  double max_principal = 0.0;  // the same of principal stresses
  /// Of von Mises over the volume that counts (fea/stress/stress_uniformity.h).
  double coefficient_of_variation = 0.0;
  double gini = 0.0;
};

/// Zones of analysis.exclude do not count for stresses, as in result.json.
struct PartFigures {
  std::string name;
  int parts = 0;             // pieces: elements of one body that share corners
  double weld_length = 0.0;  // of the seams between them [length]
  double volume = 0.0;       // [length^3]
  double mass = 0.0;
  int elements = 0;
  std::vector<PartLoadFigures> load_cases;
  forward::ExclusionShare left_out;  // of stress figures, all zones together
  std::vector<forward::ExclusionShare> zones;
  std::string surface;  // file beside compare.json with its fields, or empty
};

/// `fields` as evaluate() leaves them.
PartFigures part_figures(const std::string& name,
                         forward::EvaluationFields& fields);

/// A run's case and the part of its answer, made again (the same bits).
struct RunPart {
  case_data::Case input;
  VectorX design;
  forward::EvaluationFields fields;
  PartFigures figures;
};

/// Throws IoError (no study there), InvalidInput (no finished evaluation),
/// MeshError (a design that this version cannot evaluate).
RunPart load_run_part(const std::filesystem::path& folder, Monitor* monitor);

/// Columns: figure with unit, each part, and from the second one on the ratio
/// to the first. Load cases by name; what a part lacks is empty.
std::vector<std::vector<std::string>> comparison_table(
    const std::vector<PartFigures>& parts, const UnitSystem& units);

/// compare.json (docs/results.md).
nlohmann::ordered_json comparison_json(const std::vector<PartFigures>& parts,
                                       const UnitSystem& units,
                                       const std::string& program_version);

}  // namespace meniscus::results
