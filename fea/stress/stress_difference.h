/// Recovered minus computed stress: what error estimates integrate.
#pragma once

#include <array>
#include <vector>

#include "fea/element/elastic_law.h"
#include "fea/stress/error_estimate.h"

namespace meniscus::stress {

/// At the fourteen points of fine_tet_rule() (tet_shape.h). The stiffness
/// rule's own points would miss part of the error: there it is smallest.
struct PointDifferences {
  std::array<element::Stress, 14> recovered_minus_computed;  // [pressure]
  std::array<element::Stress, 14> computed;                  // [pressure]
  std::array<double, 14> volume;  // weight x det J [length^3]
};

/// All arguments are on loan.
class StressDifference {
 public:
  StressDifference(const TetMesh& mesh,
                   const std::vector<element::Material>& materials,
                   const StressedSolution& solution);
  PointDifferences of(int element) const;

 private:
  template <int Nodes>
  PointDifferences differences(int element) const;

  const TetMesh& mesh_;
  const StressedSolution& solution_;
  std::vector<element::ElasticLaw> laws_;
};

}  // namespace meniscus::stress
