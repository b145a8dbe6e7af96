#include "tests/support/film_parts.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meniscus {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRadius = 20.0;

/// A disk in polar coordinates (radius 0 to 1, angle): ring k has 6 k points.
struct DiskMesh {
  std::vector<std::array<double, 2>> at;
  std::vector<Triangle> facets;
  std::vector<int> rim;
};

DiskMesh disk(int rings) {
  DiskMesh mesh;
  mesh.at.push_back({0.0, 0.0});
  std::vector<int> inner{0};
  for (int k = 1; k <= rings; ++k) {
    std::vector<int> outer;
    for (int j = 0; j < 6 * k; ++j) {
      outer.push_back(static_cast<int>(mesh.at.size()));
      mesh.at.push_back({static_cast<double>(k) / rings, kTurn * j / (6 * k)});
    }
    for (int sector = 0; sector < 6; ++sector) {
      const auto out = [&](int j) { return outer[(sector * k + j) % (6 * k)]; };
      const auto in = [&](int j) {
        return inner[(sector * (k - 1) + j) % inner.size()];
      };
      for (int j = 0; j < k; ++j) {
        mesh.facets.push_back({in(j), out(j), out(j + 1)});
        if (j + 1 < k) {
          mesh.facets.push_back({in(j), out(j + 1), in(j + 1)});
        }
      }
    }
    inner = outer;
  }
  mesh.rim = inner;
  return mesh;
}

void add(SurfaceMesh& mesh, const Triangle& t, int label) {
  mesh.facets.push_back(t);
  mesh.facet_label.push_back(label);
}

solid::RimCurve circle(double radius, double z) {
  return solid::RimCurve(
      {{solid::EllipseCurve{Vec3(0, 0, z), radius * Vec3::UnitX(),
                            radius * Vec3::UnitY()},
        0.0, kTurn}});
}

/// The film from points of the disk, and the floor as a fan.
FilmPart over_floor(int rings,
                    const std::function<Vec3(double, double)>& point) {
  FilmPart part;
  const DiskMesh film = disk(rings);
  part.mesh.labels = {"skin", "floor"};
  part.caps = {"floor"};
  part.edge = kRadius / rings;
  for (const auto& [r, angle] : film.at) {
    part.mesh.points.push_back(point(r, angle));
  }
  for (const Triangle& t : film.facets) {
    add(part.mesh, t, 0);
  }
  const int middle = static_cast<int>(part.mesh.points.size());
  part.mesh.points.emplace_back(0.0, 0.0, 0.0);
  for (std::size_t k = 0; k < film.rim.size(); ++k) {
    add(part.mesh, {film.rim[(k + 1) % film.rim.size()], film.rim[k], middle},
        1);
  }
  part.rims.push_back({"rim", circle(kRadius, 0.0), film.rim});
  return part;
}

}  // namespace

solid::FilmSolid solid_of(const FilmPart& part) {
  return solid::film_solid({.mesh = part.mesh,
                            .rims = part.rims,
                            .caps = part.caps,
                            .edge = part.edge});
}

FilmPart dome(int rings, const Height& height) {
  return over_floor(rings, [&](double r, double angle) {
    const double x = kRadius * r * std::cos(angle);
    const double y = kRadius * r * std::sin(angle);
    return Vec3(x, y, r < 1.0 ? height(x, y) : 0.0);
  });
}

FilmPart ball_cap(int rings, double rise) {
  const double radius = (kRadius * kRadius + rise * rise) / (2.0 * rise);
  const double half = std::atan2(kRadius, radius - rise);  // at the center
  return over_floor(rings, [&](double r, double angle) {
    const double ring = radius * std::sin(half * r);
    return Vec3(ring * std::cos(angle), ring * std::sin(angle),
                r < 1.0 ? rise - radius * (1.0 - std::cos(half * r)) : 0.0);
  });
}

FilmPart ellipsoid(int rings, const Vec3& half_axes) {
  FilmPart part;
  const DiskMesh half = disk(rings);
  part.mesh.labels = {"skin"};
  part.edge = 0.5 * std::numbers::pi * half_axes.mean() / rings;
  const int count = static_cast<int>(half.at.size());
  const int inside = count - static_cast<int>(half.rim.size());
  const auto point = [&](double r, double angle, double sign) {
    const double polar = 0.25 * kTurn * r;
    return Vec3(Vec3(3, 2, 1) +
                half_axes.cwiseProduct(Vec3(std::sin(polar) * std::cos(angle),
                                            std::sin(polar) * std::sin(angle),
                                            sign * std::cos(polar))));
  };
  for (const auto& [r, angle] : half.at) {
    part.mesh.points.push_back(point(r, angle, 1.0));
  }
  for (int v = 0; v < inside; ++v) {
    part.mesh.points.push_back(point(half.at[v][0], half.at[v][1], -1.0));
  }
  const auto below = [&](int v) { return v < inside ? count + v : v; };
  for (const Triangle& t : half.facets) {
    add(part.mesh, t, 0);
    add(part.mesh, {below(t[0]), below(t[2]), below(t[1])}, 0);
  }
  return part;
}

FilmPart spool(int around, double height,
               const std::function<double(double z)>& radius, bool bored) {
  FilmPart part;
  SurfaceMesh& mesh = part.mesh;
  mesh.labels = {"skin", "bottom", "top"};
  part.caps = {"bottom", "top"};
  part.edge = kTurn * radius(0.0) / around;
  const int rings = around / 3;
  const auto tube = [&](const std::function<double(double)>& r, int label,
                        bool inward) {
    const int first = static_cast<int>(mesh.points.size());
    const auto id = [=](int i, int j) {
      return first + i * around + (j % around + around) % around;
    };
    for (int i = 0; i <= rings; ++i) {
      const double z = height * i / rings;
      for (int j = 0; j < around; ++j) {
        const double angle = kTurn * (j + 0.5 * i) / around;
        mesh.points.emplace_back(r(z) * std::cos(angle), r(z) * std::sin(angle),
                                 z);
      }
    }
    for (int i = 0; i < rings; ++i) {
      for (int j = 0; j < around; ++j) {
        for (Triangle t :
             {Triangle{id(i, j), id(i, j + 1), id(i + 1, j)},
              Triangle{id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)}}) {
          if (inward) {
            std::swap(t[1], t[2]);
          }
          add(mesh, t, label);
        }
      }
    }
    for (const int i : {0, rings}) {
      solid::NamedRim rim{i == 0 ? "low" : "high",
                          circle(r(height * i / rings), height * i / rings),
                          {}};
      for (int j = 0; j < around; ++j) {
        rim.vertices.push_back(id(i, j));
      }
      part.rims.push_back(std::move(rim));
    }
  };
  tube(radius, 0, false);
  if (bored) {
    mesh.labels.emplace_back("bore");
    const double bore = 0.25 * radius(0.0);
    tube([bore](double) { return bore; }, 3, true);
  }
  for (int end = 0; end < 2; ++end) {
    const std::vector<int> outer = part.rims[end].vertices;
    int middle = -1;
    if (!bored) {
      middle = static_cast<int>(mesh.points.size());
      mesh.points.emplace_back(0.0, 0.0, end * height);
    }
    for (int j = 0; j < around; ++j) {
      const int k = (j + 1) % around;
      const int a = outer[end == 0 ? k : j];
      const int b = outer[end == 0 ? j : k];
      if (!bored) {
        add(mesh, {middle, a, b}, 1 + end);
        continue;
      }
      const std::vector<int>& inner = part.rims[2 + end].vertices;
      const int c = inner[end == 0 ? k : j];
      const int d = inner[end == 0 ? j : k];
      add(mesh, {a, b, c}, 1 + end);
      add(mesh, {c, b, d}, 1 + end);
    }
  }
  return part;
}

FilmPart square_dome(int half, double rise) {
  FilmPart part;
  SurfaceMesh& mesh = part.mesh;
  mesh.labels = {"skin", "floor"};
  part.caps = {"floor"};
  const int n = 2 * half;
  part.edge = 40.0 / n;
  const auto id = [=](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = -20.0 + 40.0 * i / n;
      const double y = -20.0 + 40.0 * j / n;
      mesh.points.emplace_back(
          x, y, rise * (1.0 - x * x / 400.0) * (1.0 - y * y / 400.0));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      // Diagonals that no corner is cut off by.
      const bool other = (i < half) != (j < half);
      const int a = id(i, j);
      const int b = id(i + 1, j);
      const int c = id(i + 1, j + 1);
      const int d = id(i, j + 1);
      if (other) {
        add(mesh, {a, b, d}, 0);
        add(mesh, {b, c, d}, 0);
      } else {
        add(mesh, {a, b, c}, 0);
        add(mesh, {a, c, d}, 0);
      }
    }
  }
  std::vector<int> rim;
  for (int k = 0; k < n; ++k) {
    rim.push_back(id(k, 0));
  }
  for (int k = 0; k < n; ++k) {
    rim.push_back(id(n, k));
  }
  for (int k = 0; k < n; ++k) {
    rim.push_back(id(n - k, n));
  }
  for (int k = 0; k < n; ++k) {
    rim.push_back(id(0, n - k));
  }
  const int middle = static_cast<int>(mesh.points.size());
  mesh.points.emplace_back(0.0, 0.0, 0.0);
  for (std::size_t k = 0; k < rim.size(); ++k) {
    add(mesh, {rim[(k + 1) % rim.size()], rim[k], middle}, 1);
  }
  std::vector<solid::RimPiece> sides;
  const Points corners = {
      {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}};
  for (int k = 0; k < 4; ++k) {
    sides.push_back(
        {solid::StraightLine{corners[k],
                             (corners[(k + 1) % 4] - corners[k]) / 40.0},
         0.0, 40.0});
  }
  part.rims.push_back({"rim", solid::RimCurve(std::move(sides)), rim});
  return part;
}

void expect_closed(const solid::Brep& brep) {
  std::vector<int> uses(brep.edges.size(), 0);
  for (const solid::BrepFace& face : brep.faces) {
    for (const auto& loop : face.loops) {
      std::vector<solid::BrepUse> real;
      std::copy_if(
          loop.begin(), loop.end(), std::back_inserter(real),
          [](const solid::BrepUse& use) { return use.edge != solid::kPole; });
      for (std::size_t k = 0; k < real.size(); ++k) {
        const solid::BrepUse& use = real[k];
        const solid::BrepUse& next = real[(k + 1) % real.size()];
        uses[use.edge] += use.forward ? 1 : 100;
        const solid::BrepEdge& e = brep.edges[use.edge];
        const solid::BrepEdge& f = brep.edges[next.edge];
        EXPECT_EQ(use.forward ? e.to : e.from, next.forward ? f.from : f.to);
      }
    }
  }
  EXPECT_THAT(uses, testing::Each(101));
}

}  // namespace meniscus
