#include "evolve/fillets/fillet_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <unsupported/Eigen/AutoDiff>

#include "core/error.h"
#include "evolve/fillets/rolling_arc.h"

namespace meniscus::fillets {

namespace {

// Of a profile: its foot, three points of each section, the curve's direction,
// and the radius.
constexpr int kNodes = 7;
constexpr int kNumbers = 3 * kNodes + 3 + 1;

using Rates = Eigen::Matrix<double, kNumbers, 1>;
using Dual = Eigen::AutoDiffScalar<Rates>;

template <class T>
using VectorOf = Eigen::Matrix<T, 3, 1>;

/// The points that a profile's sections go through: foot, a, b.
std::array<Mean, kNodes> nodes_of(const Profile& profile) {
  return {Mean{{profile.point, 1.0}},
          profile.a[0],
          profile.a[1],
          profile.a[2],
          profile.b[0],
          profile.b[1],
          profile.b[2]};
}

VectorOf<Dual> variable(const Vec3& at, int first) {
  return {Dual(at.x(), kNumbers, first), Dual(at.y(), kNumbers, first + 1),
          Dual(at.z(), kNumbers, first + 2)};
}

template <class T>
Corner<T> corner_of(const FilletBands& bands, const Profile& profile,
                    const std::array<VectorOf<T>, kNodes>& x,
                    const VectorOf<T>& along, const T& radius) {
  return {.a = {{x[0], x[1], x[2], x[3]},
                bands.length_a,
                bands.out_a,
                profile.arc_a},
          .b = {{x[0], x[4], x[5], x[6]},
                bands.length_b,
                bands.out_b,
                profile.arc_b},
          .along = along,
          .radius = radius,
          .share = bands.share};
}

Corner<double> corner_at(const FilletBands& bands, const Profile& profile,
                         const Points& film, double radius) {
  std::array<Vec3, kNodes> x;
  const std::array<Mean, kNodes> nodes = nodes_of(profile);
  std::transform(nodes.begin(), nodes.end(), x.begin(),
                 [&](const Mean& mean) { return at_mean(mean, film); });
  return corner_of<double>(bands, profile, x,
                           film[profile.after] - film[profile.before], radius);
}

/// Whether the model is being frozen, or asked of a design.
enum class At { Freeze, Design };

Contact contact_at(const FilletBands& bands, const Corner<double>& corner,
                   At at) {
  const std::optional<Contact> contact = find_contact(corner);
  if (!contact) {
    const Vec3& p = corner.a.nodes[0];
    throw InvalidInput(fmt::format(
        "fillet '{}': a ball of radius {:.4g} does not fit in the corner at "
        "({:.4g}, {:.4g}, {:.4g}) of curve '{}'; {}make the radius smaller or "
        "the surfaces beside it wider",
        bands.name, corner.radius, p.x(), p.y(), p.z(), bands.curve,
        at == At::Freeze
            ? ""
            : "a model frozen nearer to this design may reach further, else "));
  }
  return *contact;
}

double radius_of(const FilletBands& bands, const films::FilmSystem& system,
                 std::size_t k) {
  const double radius = system.fillets.at(k).radius;
  if (!(radius >= 0.0) || !std::isfinite(radius)) {
    throw InvalidInput(
        fmt::format("fillet '{}': its radius is {:g}; it must not be below 0",
                    bands.name, radius));
  }
  if (bands.profiles.empty() && radius > 0.0) {
    throw InvalidInput(fmt::format(
        "fillet '{}': its radius is {:.4g}, and the model was frozen with 0, "
        "a sharp corner; begin with a radius above 0",
        bands.name, radius));
  }
  return radius;
}

/// What the moves of a profile's points are worth, with its rates.
Dual worth(const RollingArc<Dual>& arc, const Profile& profile,
           const Points& by_rounded) {
  const auto dot = [](const VectorOf<Dual>& move, const Vec3& by) {
    return Dual(move[0] * by[0] + move[1] * by[1] + move[2] * by[2]);
  };
  Dual sum = dot(arc.rim_move(), by_rounded[profile.point]);
  for (const Follower& follower : profile.followers) {
    sum += dot(arc.move(follower.of_a, follower.s),
               follower.weight * by_rounded[follower.point]);
  }
  return sum;
}

void spread(const Profile& profile, const Rates& rates, Points& film) {
  const std::array<Mean, kNodes> nodes = nodes_of(profile);
  for (int k = 0; k < kNodes; ++k) {
    for (const auto& [point, weight] : nodes[k]) {
      film[point] += weight * rates.segment<3>(3 * k);
    }
  }
  film[profile.after] += rates.segment<3>(3 * kNodes);
  film[profile.before] -= rates.segment<3>(3 * kNodes);
}

}  // namespace

FilletModel FilletModel::freeze(const frozen::FilmModel& film,
                                const films::FilmSystem& system,
                                const Points& points) {
  std::vector<std::vector<int>> rims;
  rims.reserve(system.fillets.size());
  for (const films::FilletSpec& fillet : system.fillets) {
    rims.push_back(film.rim(fillet.curve));
  }
  return {film.solids(points), system, rims};
}

FilletModel::FilletModel(const SurfaceMesh& surface,
                         const films::FilmSystem& system,
                         const std::vector<std::vector<int>>& rims) {
  for (std::size_t k = 0; k < system.fillets.size(); ++k) {
    bands_.push_back(freeze_bands(surface, system, rims, k));
  }
  for (std::size_t k = 0; k < bands_.size(); ++k) {
    for (Profile& profile : bands_[k].profiles) {
      const Corner<double> corner = corner_at(
          bands_[k], profile, surface.points, system.fillets[k].radius);
      const RollingArc<double> arc(corner,
                                   contact_at(bands_[k], corner, At::Freeze));
      profile.arc_a = arc.arc_length(true);
      profile.arc_b = arc.arc_length(false);
    }
  }
}

Points FilletModel::rounded(const Points& film,
                            const films::FilmSystem& system) const {
  Points result = film;
  for (std::size_t k = 0; k < bands_.size(); ++k) {
    const double radius = radius_of(bands_[k], system, k);
    for (const Profile& profile : bands_[k].profiles) {
      const Corner<double> corner = corner_at(bands_[k], profile, film, radius);
      const RollingArc<double> arc(corner,
                                   contact_at(bands_[k], corner, At::Design));
      result[profile.point] += arc.rim_move();
      for (const Follower& follower : profile.followers) {
        result[follower.point] +=
            follower.weight * arc.move(follower.of_a, follower.s);
      }
    }
  }
  return result;
}

FilletGradient FilletModel::transpose(const Points& film,
                                      const films::FilmSystem& system,
                                      const Points& by_rounded) const {
  FilletGradient result{
      by_rounded, VectorX::Zero(static_cast<Eigen::Index>(bands_.size()))};
  for (std::size_t k = 0; k < bands_.size(); ++k) {
    const double radius = radius_of(bands_[k], system, k);
    for (const Profile& profile : bands_[k].profiles) {
      const Corner<double> at = corner_at(bands_[k], profile, film, radius);
      std::array<VectorOf<Dual>, kNodes> x;
      for (int node = 0; node < kNodes; ++node) {
        const Vec3& value = node < 4 ? at.a.nodes[node] : at.b.nodes[node - 3];
        x[node] = variable(value, 3 * node);
      }
      const RollingArc<Dual> arc(
          corner_of<Dual>(bands_[k], profile, x, variable(at.along, 3 * kNodes),
                          Dual(radius, kNumbers, kNumbers - 1)),
          contact_at(bands_[k], at, At::Design));
      const Rates rates = worth(arc, profile, by_rounded).derivatives();
      spread(profile, rates, result.film);
      result.radius[static_cast<Eigen::Index>(k)] += rates[kNumbers - 1];
    }
  }
  return result;
}

}  // namespace meniscus::fillets
