#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/math/worst_direction.h"
#include "fea/functionals/stress_criteria.h"
#include "pipeline/responses/response_partials.h"
#include "pipeline/responses/worst_loads.h"

namespace meniscus::responses {

namespace {

/// Adds `factor` times `more`, of another unit load, but for its load cases.
void add_partials(double factor, const ResponsePartials& more,
                  ResponsePartials& sum) {
  sum.value += factor * more.value;
  sum.by_direction += factor * more.by_direction;
  sum.by_nodes.resize(std::max(sum.by_nodes.size(), more.by_nodes.size()),
                      Vec3::Zero());
  for (std::size_t i = 0; i < more.by_nodes.size(); ++i) {
    sum.by_nodes[i] += factor * more.by_nodes[i];
  }
}

/// That of the combined load, in the share of each unit load: the largest
/// first, whose adjoint makes those of the others.
std::vector<CasePartials> shared_out(const CasePartials& combined, int first,
                                     const Vec3& d) {
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::abs(d[a]) > std::abs(d[b]);
  });
  std::vector<CasePartials> cases;
  for (const int k : order) {
    CasePartials share{.load_case = first + k,
                       .by_displacement = d[k] * combined.by_displacement,
                       .by_forces = d[k] * combined.by_forces,
                       .by_temperature = {}};
    if (k != order[0]) {
      share.of_first = d[k] / d[order[0]];
    }
    cases.push_back(std::move(share));
  }
  return cases;
}

/// A displacement is the sum of those of the unit loads.
ResponsePartials worst_linear(const ResponseTask& task) {
  std::array<ResponsePartials, 3> unit;
  Vec3 values;
  for (int k = 0; k < 3; ++k) {
    case_data::ResponseEntry one = task.response;
    one.worst_in.reset();
    one.load_case += k;
    unit[k] =
        compute_partials({one, task.inputs, task.fields, task.derivatives});
    values[k] = unit[k].value;
  }
  const Vec3 d = worst_of_linear(values, *task.response.worst_in).direction;
  ResponsePartials result;
  for (int k = 0; k < 3; ++k) {
    add_partials(d[k], unit[k], result);
  }
  if (!unit[0].cases.empty()) {
    result.cases =
        shared_out(unit[0].cases.front(), task.response.load_case, d);
  }
  result.worst_direction = d;
  return result;
}

/// Work and energy are quadratic in the load: their matrix from its values at
/// the unit loads and their sums.
ResponsePartials worst_energy(const ResponseTask& task) {
  const auto at = [&](const Vec3& d, element::Derivatives derivatives) {
    return energy_of({task.response, task.inputs, task.fields, derivatives},
                     combined_load(task.fields.inputs.load_cases,
                                   task.response.load_case, d),
                     combined(task.fields.solution.displacements,
                              task.response.load_case, d));
  };
  const auto value = [&](const Vec3& d) {
    return at(d, element::Derivatives::None).value;
  };
  Mat3 Q;
  for (int i = 0; i < 3; ++i) {
    Q(i, i) = value(Vec3::Unit(i));
    for (int j = 0; j < i; ++j) {
      Q(i, j) = Q(j, i) =
          0.5 * (value(Vec3::Unit(i) + Vec3::Unit(j)) - Q(i, i) - Q(j, j));
    }
  }
  const Vec3 d = worst_of_quadratic(Q, *task.response.worst_in).direction;
  ResponsePartials result = at(d, task.derivatives);
  if (!result.cases.empty()) {
    const CasePartials combined = std::move(result.cases.front());
    result.cases = shared_out(combined, task.response.load_case, d);
  }
  result.worst_direction = d;
  return result;
}

}  // namespace

ResponsePartials worst_partials(const ResponseTask& task) {
  using case_data::WorstKnown;
  const int first = task.response.load_case;
  switch (case_data::row_of(task.response.kind).worst) {
    case WorstKnown::ByEnergy:
      return worst_energy(task);
    case WorstKnown::AtNodes:
      return nodal_peak_partials(
          task, {first, first + 1, first + 2},
          functionals::worst_von_mises_ratio(allowable_stress(task),
                                             *task.response.worst_in));
    case WorstKnown::BySum:
    case WorstKnown::No:  // refused when the case is read
      break;
  }
  return worst_linear(task);
}

}  // namespace meniscus::responses
