/// The works of the elasticity's speed table: from a mesh in memory to
/// stresses, this program's solver and CalculiX on the same meshes.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/elastic/elasticity.h"

namespace meniscus {

/// A part held at one end and loaded at the other.
struct ElasticPart {
  TetMesh mesh;
  TetMesh moved;  // about 1 % of its size away
  std::vector<element::Material> materials;
  loads::LoadCase load_case;
};

struct ElasticWork {
  std::string name;
  /// `scale`: one over the number of elements.
  ElasticPart (*make)(double scale) = nullptr;
  // Ratios of CPU seconds to CalculiX's default and to its best.
  double least_default = 0.0;
  double least_best = 0.0;
  double aim_default = 0.0;
  double aim_best = 0.0;
  // The same for the next design, to its default.
  double least_next = 0.0;
  double aim_next = 0.0;
  bool large = true;  // enough for the targets of threads and processes
};

void PrintTo(const ElasticWork& work, std::ostream* out);

/// A curved thin tube and a solid block of ten-node elements, a block of
/// four-node ones; about 115,000 elements at scale 1.
const std::vector<ElasticWork>& elastic_works();

/// A block of about 480,000 ten-node elements.
ElasticPart large_block(double scale);

/// Wall-clock seconds.
struct ElasticStages {
  double setup = 0.0;  // order, pattern, assembly, levels; of a next design:
                       // its assembly
  double solve = 0.0;
  double stress = 0.0;

  double all() const { return setup + solve + stress; }
};

/// What our solver took, in a child process of its own.
struct ElasticRun {
  bool solved = false;
  std::string message;  // why not
  int elements = 0;
  int dofs = 0;
  int iterations = 0;
  ElasticStages first;
  ElasticStages next;
  double first_cpu = 0.0;   // user and system, of all of it [s]
  double next_cpu = 0.0;    // the same of the next design
  double peak_bytes = 0.0;  // of the whole process, both meshes included
};
ElasticRun run_elastic(
    ElasticPart (*make)(double), double scale, int threads,
    equations::SolverKind solver = equations::SolverKind::Automatic);

struct CalculixTime {
  bool ended = false;
  double user_seconds = 0.0;  // CPU, user and system, of the whole program
  double wall_seconds = 0.0;
  double peak_bytes = 0.0;
};

/// `solver` as CalculixDeck has it. Nothing is printed.
CalculixTime time_calculix(ElasticPart (*make)(double), double scale,
                           const std::string& solver, double time_limit);

/// Largest difference over the largest of CalculiX's (SPOOLES, all threads):
/// nodal displacements, stresses at integration points. Throws
/// std::runtime_error when either program fails.
struct CalculixAgreement {
  double displacement = 0.0;
  double stress = 0.0;
};
CalculixAgreement compare_with_calculix(ElasticPart (*make)(double),
                                        double scale, double time_limit);

}  // namespace meniscus
