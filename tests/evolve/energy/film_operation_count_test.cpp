// The film's formulas for its work against its kernels written out in numbers
// that count what is done with them.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/operation_count.h"
#include "evolve/energy/energy.h"
#include "tests/support/counted.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_shapes.h"
#include "tests/support/shapes.h"

namespace meniscus::film_operation_count_test {
namespace {

constexpr double kSameSum = 1e-12;

struct CountedVector {
  std::array<Counted, 3> x;
};

CountedVector vector_of(const Vec3& v) {
  return {{{{v.x()}, {v.y()}, {v.z()}}}};
}
Vec3 plain(const CountedVector& v) {
  return {v.x[0].value, v.x[1].value, v.x[2].value};
}
CountedVector operator-(const CountedVector& a, const CountedVector& b) {
  return {{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}
CountedVector operator+(const CountedVector& a, const CountedVector& b) {
  return {{a.x[0] + b.x[0], a.x[1] + b.x[1], a.x[2] + b.x[2]}};
}
CountedVector operator*(Counted s, const CountedVector& a) {
  return {{s * a.x[0], s * a.x[1], s * a.x[2]}};
}
Counted dot(const CountedVector& a, const CountedVector& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}
CountedVector cross(const CountedVector& a, const CountedVector& b) {
  return {{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
           a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}
/// Backwards: no operation.
CountedVector minus(const CountedVector& a) {
  return {{{{-a.x[0].value}, {-a.x[1].value}, {-a.x[2].value}}}};
}

/// A closed drop of tension 1.3 that is nowhere symmetric.
struct Drop {
  films::FilmComplex complex = shapes::drop(shapes::sphere(1.0, 2), 4.0);
  Points points;
  films::FilmTargets targets;

  Drop() {
    for (Vec3& p : complex.mesh.points) {
      p += Vec3(0.1 * p.y() * p.z(), 0.2 * p.x(), 0.05 * p.x() * p.y());
    }
    points = complex.mesh.points;
    complex.surfaces[0].tension = 1.3;
    targets = energy::targets_of(complex);
  }
  CountedVector at(int v) const { return vector_of(points[v]); }
  CountedVector edge(const Triangle& t, int k) const {
    return at(t[k]) - at(t[0]);
  }
  double facets() const {
    return static_cast<double>(complex.mesh.facets.size());
  }
};

Counted textbook_energy(const Drop& drop) {
  Counted sum;
  for (const Triangle& t : drop.complex.mesh.facets) {
    const CountedVector n = cross(drop.edge(t, 1), drop.edge(t, 2));
    sum += Counted{1.3} * root(dot(n, n));
  }
  return Counted{0.5} * sum;
}

TEST(FilmOperationCount, AnEnergy) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  double value = 0.0;
  const double account =
      accounted([&] { value = energy.value(drop.points, drop.targets); });
  Counted expected;
  const double count = counted([&] { expected = textbook_energy(drop); });
  EXPECT_EQ(account, count - 1.0);  // the half of the sum
  EXPECT_NEAR(value, expected.value, kSameSum);
}

TEST(FilmOperationCount, ItsSlope) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  Points slope;
  const double account =
      accounted([&] { slope = energy.gradient(drop.points, drop.targets); });
  std::vector<CountedVector> sum(drop.points.size());
  const double count = counted([&] {
    for (const Triangle& t : drop.complex.mesh.facets) {
      const CountedVector ab = drop.edge(t, 1);
      const CountedVector ac = drop.edge(t, 2);
      const CountedVector n = cross(ab, ac);
      const CountedVector half =
          Counted{0.5} * Counted{1.3} / root(dot(n, n)) * n;
      const CountedVector b = cross(ac, half);
      const CountedVector c = cross(half, ab);
      sum[t[1]] = sum[t[1]] + b;
      sum[t[2]] = sum[t[2]] + c;
      sum[t[0]] = sum[t[0]] - (b + c);
    }
  });
  EXPECT_EQ(account, count);
  for (std::size_t v = 0; v < slope.size(); ++v) {
    EXPECT_LT((slope[v] - plain(sum[v])).norm(), kSameSum);
  }
}

TEST(FilmOperationCount, AVolume) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  VectorX volumes;
  const double account =
      accounted([&] { volumes = energy.volumes(drop.points); });
  Counted sum;
  const double count = counted([&] {
    const CountedVector origin = drop.at(0);
    for (const Triangle& t : drop.complex.mesh.facets) {
      const CountedVector a = drop.at(t[0]) - origin;
      const Counted cone =
          dot(a, cross(drop.at(t[1]) - origin, drop.at(t[2]) - origin)) /
          Counted{6.0};
      sum += Counted{1.0} * cone;
    }
  });
  EXPECT_EQ(account, count);
  EXPECT_NEAR(volumes[0], sum.value, kSameSum);
}

TEST(FilmOperationCount, TheSlopeOfAVolume) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  Points slope;
  const double account =
      accounted([&] { slope = energy.functional_gradient(drop.points, 0); });
  std::vector<CountedVector> sum(drop.points.size());
  const double count = counted([&] {
    for (const Triangle& t : drop.complex.mesh.facets) {
      const std::array<CountedVector, 3> x = {drop.at(t[0]) - drop.at(0),
                                              drop.at(t[1]) - drop.at(0),
                                              drop.at(t[2]) - drop.at(0)};
      const Counted w = Counted{1.0} / Counted{6.0};
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] = sum[t[k]] + w * cross(x[(k + 1) % 3], x[(k + 2) % 3]);
      }
    }
  });
  EXPECT_EQ(account, count);
  for (std::size_t v = 0; v < slope.size(); ++v) {
    EXPECT_LT((slope[v] - plain(sum[v])).norm(), kSameSum);
  }
}

TEST(FilmOperationCount, AreasAboutVertices) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  VectorX areas;
  const double account =
      accounted([&] { areas = energy.lumped_area(drop.points); });
  std::vector<Counted> sum(drop.points.size());
  const double count = counted([&] {
    for (const Triangle& t : drop.complex.mesh.facets) {
      const CountedVector n = cross(drop.edge(t, 1), drop.edge(t, 2));
      const Counted third = root(dot(n, n)) / Counted{6.0};
      for (const int v : t) {
        sum[v] += third;
      }
    }
  });
  EXPECT_EQ(account, count);
  for (int i = 0; i < energy.unknowns(); ++i) {
    EXPECT_NEAR(areas[i], sum[energy.vertices()[i]].value, kSameSum);
  }
}

TEST(FilmOperationCount, TurnsAgainstFolding) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  Points turned = drop.points;
  for (Vec3& x : turned) {
    x += 0.1 * Vec3(x.y(), x.z() * x.x(), x.x());
  }
  double least = 0.0;
  const double account =
      accounted([&] { least = energy.smallest_cosine(turned, drop.points); });
  double expected = 1.0;
  const double count = counted([&] {
    for (const Triangle& t : drop.complex.mesh.facets) {
      const CountedVector first = vector_of(turned[t[0]]);
      const CountedVector now = cross(vector_of(turned[t[1]]) - first,
                                      vector_of(turned[t[2]]) - first);
      const CountedVector was = cross(drop.edge(t, 1), drop.edge(t, 2));
      const Counted size = root(dot(now, now) * dot(was, was));
      expected = std::min(expected, (dot(now, was) / size).value);
    }
  });
  EXPECT_EQ(account, count);
  EXPECT_NEAR(least, expected, kSameSum);
}

/// The lower triangle of a facet's Hessian of tension x area - pressure x
/// volume, its corners moving along `move` (docs/theory.md, The film's Newton).
std::vector<Counted> textbook_element(const std::array<CountedVector, 3>& x,
                                      const std::array<CountedVector, 3>& move,
                                      const CountedVector& origin, Counted t,
                                      Counted p) {
  const std::array<CountedVector, 3> c = {x[0] - origin, x[1] - origin,
                                          x[2] - origin};
  const std::array<CountedVector, 3> e = {c[2] - c[1], c[0] - c[2],
                                          c[1] - c[0]};
  CountedVector n = cross(e[2], minus(e[1]));
  const Counted area2 = root(dot(n, n));
  n = {{n.x[0] / area2, n.x[1] / area2, n.x[2] / area2}};
  const Counted factor = Counted{0.5} * t / area2;
  std::array<CountedVector, 3> u;
  std::vector<Counted> lower;
  for (int a = 0; a < 3; ++a) {
    u[a] = cross(e[a], move[a]);
    u[a] = u[a] - dot(n, u[a]) * n;
    for (int b = 0; b <= a; ++b) {
      Counted sum = factor * dot(u[a], u[b]);
      if (a != b) {
        const CountedVector twist = cross(move[b], move[a]);
        const Counted sign{b == (a + 2) % 3 ? 1.0 : -1.0};
        sum += sign * (Counted{0.5} * t * dot(n, twist) -
                       p / Counted{6.0} * dot(c[3 - a - b], twist));
      }
      lower.push_back(sum);
    }
  }
  return lower;
}

TEST(FilmOperationCount, AHessian) {
  const Drop drop;
  const energy::FilmEnergy energy(drop.complex);
  const Points directions = energy.space().directions(drop.points);
  const double pressure = 0.7 * energy.side(0, 0);
  const VectorX pressures = VectorX::Constant(1, 0.7);
  std::vector<double> elements;
  const double account = accounted([&] {
    energy.elements(drop.points, directions, drop.targets, pressures, {},
                    elements);
  });
  std::vector<double> expected;
  std::vector<int> unknown(drop.points.size());
  for (int i = 0; i < energy.unknowns(); ++i) {
    unknown[energy.vertices()[i]] = i;
  }
  const double count = counted([&] {
    for (const Triangle& t : drop.complex.mesh.facets) {
      std::array<CountedVector, 3> x;
      std::array<CountedVector, 3> move;
      for (int k = 0; k < 3; ++k) {
        x[k] = drop.at(t[k]);
        move[k] = vector_of(directions[unknown[t[k]]]);
      }
      for (const Counted& entry :
           textbook_element(x, move, drop.at(0), {1.3}, {pressure})) {
        expected.push_back(entry.value);
      }
    }
  });
  EXPECT_EQ(account, count);
  ASSERT_EQ(elements.size(), expected.size());
  for (std::size_t k = 0; k < elements.size(); ++k) {
    EXPECT_NEAR(elements[k], expected[k], kSameSum);
  }
}

}  // namespace
}  // namespace meniscus::film_operation_count_test
