/// Scans that a case compares its films with, and the match of one.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "evolve/film_model.h"
#include "evolve/scan.h"
#include "optimize/problem.h"
#include "pipeline/case.h"

namespace meniscus {

class ForwardModel;

/// By the path that responses name.
using Scans = std::map<std::string, std::shared_ptr<const Scan>>;

/// Where a case's scan lies: beside the case file, where it is not absolute.
std::filesystem::path scan_path(const Case& input, const std::string& scan);

/// Those of the case's responses of kind scan_distance, read from their files:
/// STL, OBJ or STEP. Throws IoError or InvalidInput, naming the response's
/// line, for files that cannot be read, or are others than those that the case
/// was read with.
Scans read_scans(const Case& input);

/// Distances of a design's film to the scan of a response of kind
/// scan_distance.
ScanDistances scan_distances(const ResponseEntry& response, const Scans& scans,
                             const FilmModel& film, const Points& points);

/// The residuals behind such a response, for least squares: distances over the
/// root of their number, so that the sum of squares is the mean square. Films
/// are settled for themselves; they have the bits of an evaluation's.
class ScanMatch {
 public:
  /// Both must outlive this.
  ScanMatch(const Case& input, const ForwardModel& model, int response);

  VectorX residuals(const VectorX& design);
  /// By every design variable; a film that has no derivatives is a failure.
  JacobianAnswer jacobian(const VectorX& design);

 private:
  struct Settled {
    VectorX design;
    EvaluatedCase numbers;
    FilmState film;
    ScanDistances distances;
  };
  const Settled& settled(const VectorX& design);

  const Case& input_;
  const ForwardModel& model_;
  const ResponseEntry& response_;
  Settled last_;
};

}  // namespace meniscus
