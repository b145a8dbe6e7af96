#include "fea/stress/size_field.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/node_elements.h"
#include "fea/element/point_grid.h"

namespace meniscus::stress {

namespace {

constexpr double kDimensions = 3.0;
constexpr double kHuge = 1e300;

void check(const TetMesh& mesh, const EnergyError& error,
           const SizeFieldOptions& o) {
  if (!(o.relative_error > 0.0) || !(o.most_refinement >= 1.0) ||
      !(o.most_coarsening >= 1.0) || !(o.growth > 0.0)) {
    throw InvalidInput(fmt::format(
        "size field: relative_error is {}, growth {} (both must be above 0), "
        "most_refinement {}, most_coarsening {} (both at least 1)",
        o.relative_error, o.growth, o.most_refinement, o.most_coarsening));
  }
  if (error.element.size() != static_cast<std::size_t>(mesh.element_count())) {
    throw InvalidInput(fmt::format("size field: errors of {} elements for {}",
                                   error.element.size(), mesh.element_count()));
  }
}

double mean_edge(const TetMesh& mesh, int e) {
  const auto ids = mesh.element(e);
  double sum = 0.0;
  for (const auto& [a, b] : kTetEdges) {
    sum += (mesh.nodes[ids[a]] - mesh.nodes[ids[b]]).norm();
  }
  return sum / 6.0;
}

/// Old edge over new edge per element, between the bounds. What the bounds
/// take from some elements the others make up for, as far as they can.
std::vector<double> refinements(const TetMesh& mesh, const EnergyError& error,
                                const SizeFieldOptions& o, double target) {
  const double power = 2.0 / (2.0 * mesh.order + kDimensions);
  std::vector<double> ratio(error.element.size());
  std::vector<double> weight(error.element.size());
  std::transform(error.element.begin(), error.element.end(), weight.begin(),
                 [power](double e) { return std::pow(e, power); });
  const auto fill = [&](double log_c) {
    const double c = std::exp(log_c);
    double squares = 0.0;
    for (std::size_t e = 0; e < ratio.size(); ++e) {
      ratio[e] =
          std::clamp(c * weight[e], 1.0 / o.most_coarsening, o.most_refinement);
      const double fall = mesh.order == 1 ? ratio[e] : ratio[e] * ratio[e];
      const double finer = error.element[e] / fall;
      squares += finer * finer;
    }
    return std::sqrt(squares);
  };
  // The error falls as c rises: bisection in its logarithm.
  double low = -700.0;
  double high = 700.0;
  constexpr int kHalvings = 60;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (fill(middle) > target ? low : high) = middle;
  }
  fill(high);
  return ratio;
}

/// No corner more than growth x distance above one that shares an edge.
void limit_growth(const TetMesh& mesh, double growth,
                  std::vector<double>& length) {
  const element::NodeElements around = element::node_elements(
      mesh.elements, mesh.nodes_per_element(), 4, mesh.corner_count);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (int i = 0; i < mesh.corner_count; ++i) {
    queue.emplace(length[i], i);
  }
  while (!queue.empty()) {
    const auto [h, i] = queue.top();
    queue.pop();
    if (h > length[i]) {
      continue;  // was lowered since
    }
    for (const int e : around.of(i)) {
      for (const int j : mesh.element(e).first<4>()) {
        const double most = h + growth * (mesh.nodes[i] - mesh.nodes[j]).norm();
        if (most < length[j]) {
          length[j] = most;
          queue.emplace(most, j);
        }
      }
    }
  }
}

}  // namespace

SizeField size_field(const TetMesh& mesh, const EnergyError& error,
                     const SizeFieldOptions& options) {
  check(mesh, error, options);
  const double whole = std::hypot(error.energy_norm, error.error);
  const std::vector<double> ratio =
      refinements(mesh, error, options, options.relative_error * whole);
  SizeField field;
  field.growth = options.growth;
  field.points.assign(mesh.nodes.begin(),
                      mesh.nodes.begin() + mesh.corner_count);
  field.length.assign(mesh.corner_count, kHuge);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double wanted = mean_edge(mesh, e) / ratio[e];
    for (const int i : mesh.element(e).first<4>()) {
      field.length[i] = std::min(field.length[i], wanted);
    }
  }
  limit_growth(mesh, options.growth, field.length);
  double squares = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    double mean = 0.0;
    for (const int i : mesh.element(e).first<4>()) {
      mean += 0.25 * field.length[i];
    }
    const double finer = mean_edge(mesh, e) / mean;
    field.elements += std::pow(finer, kDimensions);
    squares += std::pow(error.element[e] * std::pow(finer, -mesh.order), 2.0);
  }
  field.error = std::sqrt(squares);
  return field;
}

std::function<double(const Vec3&)> SizeField::function() const {
  struct Lookup {
    element::PointGrid nearest;
    SizeField field;
  };
  const auto lookup =
      std::make_shared<const Lookup>(Lookup{element::PointGrid(points), *this});
  return [lookup](const Vec3& x) {
    const int i = lookup->nearest.of(x);
    return lookup->field.length[i] +
           lookup->field.growth * (lookup->field.points[i] - x).norm();
  };
}

}  // namespace meniscus::stress
