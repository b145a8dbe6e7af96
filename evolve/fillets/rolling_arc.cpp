#include "evolve/fillets/rolling_arc.h"

namespace meniscus::fillets {

namespace {

constexpr double kFlat = 1e-6;     // sine of a turn that is none
constexpr double kNearEnd = 0.95;  // of a section: beyond, nothing is left
constexpr int kMostSteps = 40;
constexpr double kAtRest = 1e-14;  // of the sections' lengths

}  // namespace

std::optional<Contact> find_contact(const Corner<double>& corner) {
  BallCenters<double> centers{corner.along.normalized(), corner.a.nodes[0],
                              0.0};
  const Vec3 a = centers.normal(corner.a, 0.0);
  const Vec3 b = centers.normal(corner.b, 0.0);
  const Vec3 inward = centers.across(corner.a.slope(0.0)).normalized();
  const double rise = inward.dot(b);
  Contact contact;
  if (std::abs(rise) < kFlat && a.dot(b) > 0.0) {
    return contact;
  }
  contact.sign = rise > 0.0 ? 1.0 : -1.0;
  centers.reach = contact.sign * corner.radius;
  const double half = 0.5 * std::atan2(b.cross(a).norm(), a.dot(b));
  contact.a = std::min(corner.radius * std::tan(half),
                       0.5 * kNearEnd * corner.a.length);
  contact.b = std::min(contact.a, 0.5 * kNearEnd * corner.b.length);
  const double size = corner.a.length + corner.b.length;
  double moved = size;
  for (int k = 0; k < kMostSteps && moved > kAtRest * size; ++k) {
    const Contact last = contact;
    centers.step(corner, contact.a, contact.b);
    moved = std::abs(contact.a - last.a) + std::abs(contact.b - last.b);
    if (!(moved < size)) {
      return std::nullopt;
    }
  }
  const auto within = [](double s, double length) {
    return s >= 0.0 && s <= kNearEnd * length;
  };
  if (!(moved <= 1e3 * kAtRest * size) || !within(contact.a, corner.a.length) ||
      !within(contact.b, corner.b.length)) {
    return std::nullopt;
  }
  return contact;
}

}  // namespace meniscus::fillets
