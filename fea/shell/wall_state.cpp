#include "fea/shell/wall_state.h"

namespace meniscus::shell {

double WallState::heat(double at) const {
  return temperature + temperature_across * at;
}

double WallState::stress(double at) const {
  return (0.5 - at) * stress_negative + (0.5 + at) * stress_positive;
}

Vec3 WallState::free_strain(const PlyLaw& ply, double at) const {
  return heat(at) * ply.expansion + stress(at) * ply.squeeze;
}

double NodeValues::at(const FacetPoint& p) const {
  double sum = 0.0;
  for (int i = 0; i < kNodes; ++i) {
    sum += p.shape[i] * value[i];
  }
  return sum;
}

NodeValues& NodeValues::operator+=(const NodeValues& more) {
  for (int i = 0; i < kNodes; ++i) {
    value[i] += more.value[i];
    slope[i] += more.slope[i];
  }
  return *this;
}

WallState WallStates::at(const FacetPoint& p) const {
  WallState state = same;
  if (fields != nullptr) {
    state.temperature += fields->temperature.at(p);
    state.stress_negative -= fields->negative.at(p);
    state.stress_positive += fields->positive.at(p);
  }
  return state;
}

void add_by_loads(const FacetPoint& p, const Vec3& by, ByLoads& sum) {
  for (int i = 0; i < kNodes; ++i) {
    sum.col(i) += p.shape[i] * by;
  }
}

void ByMass::add(const Vec3& factor, const Vec3& x) {
  gravity += factor;
  at_origin += factor;
  slope += factor * x.transpose();
}

void ByMass::add(double factor, const ByMass& more) {
  gravity += factor * more.gravity;
  at_origin += factor * more.at_origin;
  slope += factor * more.slope;
}

void ActionGradient::add(double factor, const ActionGradient& more) {
  for (std::size_t f = 0; f < more.facets.size(); ++f) {
    facets[f] += factor * more.facets[f];
  }
  mass.add(factor, more.mass);
}

void ActionGradient::multiply(double factor) {
  for (ByLoads& facet : facets) {
    facet *= factor;
  }
  mass.gravity *= factor;
  mass.at_origin *= factor;
  mass.slope *= factor;
}

void StateGradient::add_free_strain(const WallState& state, const PlyLaw& ply,
                                    double at, const Vec3& held,
                                    PlyLaw& by_ply) {
  by_ply.expansion += state.heat(at) * held;
  by_ply.squeeze += state.stress(at) * held;
  by[0] += ply.expansion.dot(held);
  add_stress(at, ply.squeeze.dot(held));
}

void StateGradient::add_stress(double at, double factor) {
  by[1] += (0.5 - at) * factor;
  by[2] += (0.5 + at) * factor;
}

void StateGradient::add_to(const FacetPoint& p, ByLoads& sum) const {
  add_by_loads(p, {by[0], -by[1], by[2]}, sum);
}

}  // namespace meniscus::shell
