#include "pipeline/forward/singular_places.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/responses/response_partials.h"

namespace meniscus::forward {

namespace {

constexpr double kLargestPoisson = 0.49;

/// One char per face of the mesh: 1 where no component of displacement is free,
/// or none but of a rigid motion.
std::vector<char> held_faces(const TetMesh& mesh, const loads::LoadCase& load) {
  std::vector<std::array<bool, 3>> fixed(mesh.labels.size());
  for (const loads::Support& support : load.supports) {
    const int label = mesh.label_of(support.surface);
    if (label >= 0 && support.kind == loads::SupportKind::Components) {
      auto& f = fixed[static_cast<std::size_t>(label)];
      f = {f[0] || support.fix_x, f[1] || support.fix_y, f[2] || support.fix_z};
    }
  }
  for (const loads::RigidPin& pin : load.pins) {
    for (const std::string& surface : pin.surfaces) {
      if (const int label = mesh.label_of(surface); label >= 0) {
        fixed[static_cast<std::size_t>(label)] = {true, true, true};
      }
    }
  }
  std::vector<char> held;
  for (const int label : mesh.face_label) {
    const auto& f = fixed[static_cast<std::size_t>(label)];
    held.push_back(f[0] && f[1] && f[2] ? 1 : 0);
  }
  return held;
}

/// One char per face: 1 in planes of symmetry.
std::vector<char> mirror_faces(const TetMesh& mesh,
                               const loads::LoadCase& load) {
  std::vector<char> mirrors(mesh.face_label.size(), 0);
  for (const loads::Support& support : load.supports) {
    const int label = mesh.label_of(support.surface);
    for (std::size_t f = 0; f < mirrors.size(); ++f) {
      if (support.kind == loads::SupportKind::Symmetry &&
          mesh.face_label[f] == label) {
        mirrors[f] = 1;
      }
    }
  }
  return mirrors;
}

/// Poisson's ratio by region; the largest where it differs by direction.
std::vector<double> poisson_ratios(
    const std::vector<element::Material>& materials) {
  std::vector<double> ratios;
  ratios.reserve(materials.size());
  for (const element::Material& m : materials) {
    ratios.push_back(m.orthotropic
                         ? std::clamp(m.orthotropic->poisson_ratios.maxCoeff(),
                                      0.0, kLargestPoisson)
                         : m.poisson_ratio);
  }
  return ratios;
}

/// By element, the largest order of the singular edges at its corners, of those
/// that count.
std::vector<double> element_orders(
    const TetMesh& mesh, const std::vector<stress::SingularEdge>& edges,
    const stress::Excluded& excluded) {
  std::vector<double> corner(static_cast<std::size_t>(mesh.corner_count), 0.0);
  for (const stress::SingularEdge& edge : edges) {
    for (const int n : edge.corners) {
      double& order = corner[static_cast<std::size_t>(n)];
      order = std::max(order, edge.order);
    }
  }
  std::vector<double> orders;
  for (int e = 0; e < mesh.element_count(); ++e) {
    double order = 0.0;
    for (const int n : mesh.element(e).first<4>()) {
      if (excluded.counts(e, n)) {
        order = std::max(order, corner[static_cast<std::size_t>(n)]);
      }
    }
    orders.push_back(order);
  }
  return orders;
}

/// ln of a sum of exponentials.
class LogSum {
 public:
  void add(double weight, double exponent) {
    if (exponent > largest_) {
      sum_ *= std::exp(largest_ - exponent);
      largest_ = exponent;
    }
    sum_ += weight * std::exp(exponent - largest_);
  }
  double value() const { return largest_ + std::log(sum_); }

 private:
  double largest_ = -1e300;
  double sum_ = 0.0;
};

}  // namespace

std::vector<stress::SingularEdge> singular_edges_of(
    const EvaluationFields& fields, std::size_t load_case) {
  const loads::LoadCase& load = fields.inputs.load_cases[load_case];
  return stress::singular_edges(fields.mesh, held_faces(fields.mesh, load),
                                poisson_ratios(fields.inputs.materials),
                                mirror_faces(fields.mesh, load));
}

double growth_of_mean(const case_data::ResponseEntry& response,
                      const EvaluationFields& fields) {
  const bool is_norm = response.kind == case_data::ResponseKind::VonMisesNorm;
  if ((!is_norm && response.kind != case_data::ResponseKind::VonMisesKs) ||
      fields.shell) {
    return 0.0;
  }
  // Of both the mean of exp(t): t = power ln s, or sharpness s / scale.
  const double factor =
      is_norm ? response.power
              : response.sharpness /
                    responses::ks_scale(response, fields.inputs.materials);
  const auto exponent = [&](double stress) {
    return factor * (is_norm ? std::log(stress) : stress);
  };
  const auto k = static_cast<std::size_t>(response.load_case);
  const element::PointStress& points = fields.stresses[k].points;
  const stress::Excluded& excluded = fields.exclusion.what;
  const std::vector<double> orders =
      element_orders(fields.mesh, singular_edges_of(fields, k), excluded);
  constexpr double kPart = 1.0 / (kShorterEdges * kShorterEdges);
  LogSum here;
  LogSum grown;
  double volume = 0.0;
  for (int e = 0; e < fields.mesh.element_count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (!excluded.element.empty() && excluded.element[i] != 0) {
      continue;
    }
    const double growth = std::pow(kShorterEdges, orders[i]);
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      const double stress = element::von_mises(points.stress[at]);
      volume += points.volume[at];
      if (stress > 0.0) {
        here.add(points.volume[at], exponent(stress));
        grown.add(points.volume[at], exponent(stress));
        if (growth > 1.0) {
          grown.add(kPart * points.volume[at], exponent(growth * stress));
        }
      }
    }
  }
  const auto mean = [&](const LogSum& sum) {
    const double t = (sum.value() - std::log(volume)) / factor;
    return is_norm ? std::exp(t) : t;
  };
  const double growth = mean(grown) - mean(here);
  return growth > 0.0 ? growth : 0.0;  // no number without stress
}

}  // namespace meniscus::forward
