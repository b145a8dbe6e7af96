/// Film systems that several tests share.
#pragma once

#include <cmath>
#include <numbers>

#include "evolve/films/film_system.h"

namespace meniscus::systems {

/// The two-arm bracket (cases/two_arm): three circles, one skin, one volume.
/// Lengths in mm.
inline films::FilmSystem two_arm(double support_x, double volume = 1.7e6,
                                 double reach = 120.0, double rim = 50.0) {
  const double angle = std::numbers::pi / 3.0;
  films::FilmSystem system;
  system.curves = {
      {"support", curves::Circle{Vec3(support_x, 0, 0), Vec3(0, 0, -1), 35.0}},
      {"left", curves::Circle{Vec3(-reach, 0, 72),
                              Vec3(-std::sin(angle), 0, std::cos(angle)), rim}},
      {"right",
       curves::Circle{Vec3(reach, 0, 72),
                      Vec3(std::sin(angle), 0, std::cos(angle)), rim}}};
  system.films = {
      {"skin", films::FilmKind::Branch, {"support", "left", "right"}, 1.0}};
  system.caps = {
      {"support_pad", "support"}, {"left_pad", "left"}, {"right_pad", "right"}};
  system.bodies = {{"part",
                    {"skin", "support_pad", "left_pad", "right_pad"},
                    volume,
                    std::nullopt}};
  return system;
}

/// The strut of cases/strut_family: a square foot with rounded corners, a round
/// end that stands off and leans. Lengths in mm.
inline films::FilmSystem leaning_strut(double length = 70.0,
                                       double offset = 8.0,
                                       double tilt = 10.0) {
  const double angle = tilt * std::numbers::pi / 180.0;
  const double base = 38.0;
  const double head = 14.0;
  films::FilmSystem system;
  system.curves = {
      {"foot", curves::Rectangle{Vec3::Zero(), Vec3(0, 0, -1), Vec3::UnitX(),
                                 base, base, 5.0}},
      {"eye", curves::Circle{Vec3(offset, 0, length),
                             Vec3(std::sin(angle), 0, std::cos(angle)), head}}};
  system.films = {{"skin", films::FilmKind::Branch, {"foot", "eye"}, 1.0}};
  system.caps = {{"foot_pad", "foot"}, {"eye_pad", "eye"}};
  system.bodies = {
      {"part",
       {"skin", "foot_pad", "eye_pad"},
       length * (base * base + std::numbers::pi * head * head) / 2.0,
       std::nullopt}};
  return system;
}

/// Film between two rings of radius 1, without a body.
inline films::FilmSystem catenoid(double spacing) {
  films::FilmSystem system;
  system.curves = {
      {"bottom",
       curves::Circle{Vec3(0, 0, -0.5 * spacing), Vec3(0, 0, -1), 1.0}},
      {"top", curves::Circle{Vec3(0, 0, 0.5 * spacing), Vec3(0, 0, 1), 1.0}}};
  system.films = {{"film", films::FilmKind::Loft, {"bottom", "top"}, 1.0}};
  return system;
}

}  // namespace meniscus::systems
