/// STEP in: closed boundary curves from the edges and faces of a file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cad/solid/brep.h"

namespace meniscus::step {

class StepChild;

/// One edge of a loop, in the loop's direction.
struct StepPiece {
  enum class Kind { Line, Arc, Free };
  static constexpr int kIntervals = 512;
  Kind kind = Kind::Free;
  int edge = 0;    // its number in the file, from 1
  Points samples;  // kIntervals + 1, at equal arclength, ends included
  Vec3 leaves = Vec3::Zero();   // unit tangent at the start
  Vec3 arrives = Vec3::Zero();  // and at the end
  double length = 0.0;
};

/// A closed curve of edges; a planar face's rim runs counter-clockwise seen
/// from outside.
struct StepLoop {
  std::optional<solid::EllipseCurve>
      whole;                      // all of it is this circle or ellipse
  std::vector<StepPiece> pieces;  // each starts where the last one ended
};

/// The edges of one file, held open in a process of its own
/// (cad/step/step_child.h).
class StepEdges {
 public:
  /// `unit`: that lengths are wanted in: mm, m or in. Throws InvalidInput (no
  /// STEP, no shape, an unknown unit, a file that OpenCASCADE cannot read in
  /// its process's limits), IoError, Interrupted.
  StepEdges(const std::filesystem::path& path, const std::string& unit);
  StepEdges(StepEdges&&) noexcept;
  StepEdges& operator=(StepEdges&&) noexcept;
  ~StepEdges();

  /// One closed edge, or several in any order and direction that close. By
  /// their names in the file or their numbers, from 1, in the order in which
  /// faces use edges. Throws InvalidInput for an edge that is not there (those
  /// that are are in the message, with length and middle), twice the same, and
  /// edges that do not close (names the place and the nearest edge).
  StepLoop loop(const std::vector<std::string>& edges) const;

  /// The outer rim of a face, by its name in the file or its number, or
  /// "face_7". Throws InvalidInput for a face that is not there, for several
  /// of one name and for one that has no single rim (a tube's).
  StepLoop rim(const std::string& face) const;

 private:
  std::unique_ptr<StepChild> child_;
};

}  // namespace meniscus::step
