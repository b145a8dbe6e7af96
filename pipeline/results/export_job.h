/// What the writers of a run's part share: its case and answer and, made when
/// first asked for, its film, its mesh and its solution.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "io/file_notes.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::results {

/// A film at rest and the model that settled it.
struct SettledFilm {
  frozen::FilmModel model;
  settle::FilmState state;
};

class ExportJob {
 public:
  struct Options {
    std::optional<double> edge;   // [length]; the run's own when absent
    std::string program_version;  // for the notes
    Monitor* monitor = nullptr;
  };

  /// The answer of the study in `folder`. Throws IoError (no study there),
  /// InvalidInput (no finished evaluation).
  ExportJob(const std::filesystem::path& folder, Options options);

  const case_data::Case& input() const { return input_; }
  const VectorX& design() const { return design_; }
  const case_data::EvaluatedCase& inputs() const { return inputs_; }
  std::optional<double> edge() const { return options_.edge; }
  Monitor* monitor() const { return options_.monitor; }

  /// Without an edge the run's own film, at the film's own resolution: frozen
  /// at the initial design, settled at the answer, the same bits. At an edge,
  /// settled from the answer's curves there. Throws MeshError where there is no
  /// stable film.
  const SettledFilm& film();

  /// The closed surface of that film with the bodies on its sides, at the
  /// film's own resolution; of shells the bodies of their walls.
  SurfaceMesh bodies_surface();

  /// The mesh and the case's numbers there: nothing is solved for it. Throws
  /// MeshError where the design has no mesh, what ForwardModel throws.
  const forward::EvaluationFields& meshed();

  /// Mesh, solution and stresses. Throws MeshError where the design cannot be
  /// evaluated, what ForwardModel throws.
  const forward::EvaluationFields& fields();

  /// Program, title, units, name of the case and the answer's design.
  io::FileNotes notes() const;

  /// Of the bodies of material, in the order of the mesh's regions; of shells,
  /// the films.
  std::vector<std::string> body_names();

 private:
  Options options_;
  case_data::Case input_;
  VectorX design_;
  case_data::EvaluatedCase inputs_;
  std::optional<SettledFilm> film_;
  std::optional<forward::EvaluationFields> meshed_;
  std::optional<forward::EvaluationFields> fields_;
};

}  // namespace meniscus::results
