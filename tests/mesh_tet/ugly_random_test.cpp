// 200 ugly surfaces from fixed seeds: each a mesh or a typed failure, soon.
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/timer.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::ugly_random_test {

namespace {

constexpr double kTimeLimit = 10.0;  // of one surface [s]

/// What must come out.
enum class Outcome { Mesh, Failure, Either };

/// One random surface of a kind.
class Ugly {
 public:
  explicit Ugly(unsigned seed) : random_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int below(std::size_t count) {
    return std::uniform_int_distribution<int>(
        0, static_cast<int>(count) - 1)(random_);
  }
  /// 10 to a random power.
  double magnitude(double low, double high) {
    return std::pow(10.0, between(low, high));
  }
  Vec3 vector(double size) {
    return Vec3(between(-size, size), between(-size, size),
                between(-size, size));
  }

  /// A smooth body of size about 1, its facets of edge 0.1 to 0.4.
  SurfaceMesh body() {
    SurfaceMesh mesh = below(2) == 0 ? shapes::box(Vec3(1, 1, 1), 2 + below(3))
                                     : shapes::sphere(0.6, 1 + below(2));
    const Mat3 turn = Eigen::AngleAxisd(between(0, 3), vector(1.0).normalized())
                          .toRotationMatrix();
    const Vec3 stretch(between(0.5, 2), between(0.5, 2), between(0.5, 2));
    for (Vec3& p : mesh.points) {
      p = turn * stretch.cwiseProduct(p);
    }
    return mesh;
  }

  static void add(SurfaceMesh& mesh, const Triangle& t) {
    mesh.facets.push_back(t);
    mesh.facet_label.push_back(0);
  }
  static SurfaceMesh both(SurfaceMesh mesh, const SurfaceMesh& other,
                          const Vec3& shift, double scale, bool turned) {
    const int n = static_cast<int>(mesh.points.size());
    for (const Vec3& p : other.points) {
      mesh.points.push_back(scale * p + shift);
    }
    for (const Triangle& t : other.facets) {
      add(mesh, turned ? Triangle{n + t[0], n + t[2], n + t[1]}
                       : Triangle{n + t[0], n + t[1], n + t[2]});
    }
    return mesh;
  }

  SurfaceMesh crossing() {
    const SurfaceMesh first = body();
    return both(first, first, vector(0.3) + Vec3(0.2, 0, 0), between(0.9, 1.1),
                false);
  }
  SurfaceMesh slivers() {
    SurfaceMesh mesh = body();
    const int count = 1 + below(10);
    for (int i = 0; i < count; ++i) {
      const Triangle& t = mesh.facets[below(mesh.facets.size())];
      mesh.points[t[0]] += (1.0 - magnitude(below(2) == 0 ? -9 : -1, 0)) *
                           (mesh.points[t[1]] - mesh.points[t[0]]);
    }
    return mesh;
  }
  SurfaceMesh open() {
    SurfaceMesh mesh = body();
    const int count = 1 + below(8);
    for (int i = 0; i < count; ++i) {
      const int f = below(mesh.facets.size());
      mesh.facets.erase(mesh.facets.begin() + f);
      mesh.facet_label.erase(mesh.facet_label.begin() + f);
    }
    return mesh;
  }
  SurfaceMesh duplicated() {
    SurfaceMesh mesh = body();
    if (below(2) == 0) {
      return both(mesh, mesh, Vec3::Zero(), 1.0, below(2) == 0);
    }
    Triangle t = mesh.facets[below(mesh.facets.size())];
    if (below(2) == 0) {
      std::swap(t[0], t[1]);
    }
    add(mesh, t);
    return mesh;
  }
  SurfaceMesh touching() {
    const SurfaceMesh box = shapes::box(Vec3::Ones(), 1 + below(3));
    const double gap = below(4) == 0 ? 0.0 : magnitude(-14, -1);
    return both(box, box, Vec3(1.0 + gap, between(-1, 1), between(-1, 1)), 1.0,
                false);
  }
  SurfaceMesh flat() {
    SurfaceMesh mesh = body();
    const Vec3 normal = vector(1.0).normalized();
    const double factor = below(4) == 0 ? 0.0 : magnitude(-4, -0.5);
    for (Vec3& p : mesh.points) {
      p -= (1.0 - factor) * normal.dot(p) * normal;
    }
    return mesh;
  }
  SurfaceMesh not_numbers() {
    SurfaceMesh mesh = body();
    const std::array<double, 4> bad = {std::numeric_limits<double>::quiet_NaN(),
                                       HUGE_VAL, -HUGE_VAL, 1e300};
    mesh.points[below(mesh.points.size())][below(3)] = bad.at(below(4));
    return mesh;
  }
  SurfaceMesh is_converged() {
    SurfaceMesh mesh = body();
    const double size = below(2) == 0 ? 1e-9 : 1e9;
    for (Vec3& p : mesh.points) {
      p *= size;
    }
    return mesh;
  }
  SurfaceMesh nested() {
    const SurfaceMesh outer = shapes::sphere(1.0, 2);
    SurfaceMesh inner = shapes::sphere(1.0, 1);
    switch (below(3)) {
      case 0:  // solid in solid
        return both(outer, inner, vector(0.2), between(0.2, 0.5), false);
      case 1:  // cavity outside
        return both(outer, inner, Vec3(between(2, 4), 0, 0), 0.5, true);
      default:  // cavity in a cavity
        return both(both(outer, inner, Vec3::Zero(), 0.7, true), inner,
                    vector(0.1), 0.4, true);
    }
  }
  SurfaceMesh noisy() {
    SurfaceMesh mesh = body();
    const double noise = magnitude(-3, 0);
    for (Vec3& p : mesh.points) {
      p += vector(noise);
    }
    return mesh;
  }
  SurfaceMesh turned() {
    SurfaceMesh mesh = body();
    const int count = 1 + below(mesh.facets.size());
    for (int i = 0; i < count; ++i) {
      Triangle& t = mesh.facets[below(mesh.facets.size())];
      std::swap(t[0], t[1]);
    }
    return mesh;
  }
  SurfaceMesh soup() {
    SurfaceMesh mesh;
    mesh.labels = {"soup"};
    const int points = 4 + below(60);
    for (int p = 0; p < points; ++p) {
      mesh.points.push_back(vector(1.0));
    }
    const int facets = 1 + below(300);
    for (int f = 0; f < facets; ++f) {
      add(mesh, {below(mesh.points.size()), below(mesh.points.size()),
                 below(mesh.points.size())});
    }
    return mesh;
  }
  SurfaceMesh bodies() {
    std::array<int, 8> body{};
    for (int& b : body) {
      b = below(5) - 1;
    }
    SurfaceMesh mesh = shapes::cubes({2, 2, 2}, 1, [&](int i, int j, int k) {
      return body.at(static_cast<std::size_t>(4 * i + 2 * j + k));
    });
    if (below(2) == 0) {
      mesh = shapes::cubes({3, 2, 2}, 2, [](int i, int, int) { return i; });
      for (FacetBodies& b : mesh.facet_bodies) {
        if (below(20) == 0) {
          b = {below(4) - 1, below(4) - 1};
        }
      }
    }
    return mesh;
  }
  SurfaceMesh wrong_ids() {
    SurfaceMesh mesh = body();
    const std::array<int, 4> bad = {-1, static_cast<int>(mesh.points.size()),
                                    1 << 30, std::numeric_limits<int>::min()};
    mesh.facets[below(mesh.facets.size())][below(3)] = bad.at(below(4));
    return mesh;
  }
  SurfaceMesh spiked() {
    SurfaceMesh mesh = shapes::sphere(1.0, 2);
    const int count = 1 + below(4);
    for (int i = 0; i < count; ++i) {
      mesh.points[below(mesh.points.size())] *=
          between(-2, 1) < 0 ? between(-3, 0.5) : magnitude(0, 3);
    }
    return mesh;
  }
  SurfaceMesh welded() {  // points of two places made one
    SurfaceMesh mesh = body();
    const int from = below(mesh.points.size());
    const int to = below(mesh.points.size());
    for (Triangle& t : mesh.facets) {
      std::replace(t.begin(), t.end(), from, to);
    }
    return mesh;
  }

 private:
  std::mt19937 random_;
};

struct Kind {
  const char* name;
  SurfaceMesh (Ugly::*make)();
  int count;
  Outcome outcome;
};

constexpr std::array<Kind, 16> kKinds = {{
    {"crossing", &Ugly::crossing, 16, Outcome::Failure},
    {"slivers", &Ugly::slivers, 20, Outcome::Either},
    {"open", &Ugly::open, 12, Outcome::Failure},
    {"duplicated", &Ugly::duplicated, 12, Outcome::Failure},
    {"touching", &Ugly::touching, 16, Outcome::Either},
    {"flat", &Ugly::flat, 16, Outcome::Either},
    {"not numbers", &Ugly::not_numbers, 8, Outcome::Failure},
    {"sized", &Ugly::is_converged, 12, Outcome::Mesh},
    {"nested", &Ugly::nested, 12, Outcome::Failure},
    {"noisy", &Ugly::noisy, 20, Outcome::Either},
    {"turned", &Ugly::turned, 8, Outcome::Either},
    {"soup", &Ugly::soup, 12, Outcome::Either},
    {"bodies", &Ugly::bodies, 12, Outcome::Either},
    {"wrong ids", &Ugly::wrong_ids, 8, Outcome::Failure},
    {"spiked", &Ugly::spiked, 10, Outcome::Either},
    {"welded", &Ugly::welded, 6, Outcome::Failure},
}};

double mesh_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_GT(corner_volume(mesh, e), 0.0);
    volume += corner_volume(mesh, e);
  }
  return volume;
}

/// A mesh of the surface's volume and quality, or a typed failure in words.
bool check(const SurfaceMesh& surface, Outcome outcome) {
  const Timer timer;
  const auto result =
      mesh_tet::tetrahedralize(surface, {.time_limit = kTimeLimit});
  EXPECT_LT(timer.seconds(), kTimeLimit + 1.0);
  if (result.failure) {
    EXPECT_NE(outcome, Outcome::Mesh) << result.failure->message;
    EXPECT_TRUE(result.failure->kind == FailureKind::SurfaceInvalid ||
                result.failure->kind == FailureKind::MeshingFailed);
    EXPECT_FALSE(result.failure->message.empty());
    EXPECT_TRUE(result.mesh.nodes.empty());
    return false;
  }
  EXPECT_NE(outcome, Outcome::Failure);
  const double expected = enclosed_volume(surface);
  EXPECT_NEAR(mesh_volume(result.mesh), expected, 1e-9 * expected);
  EXPECT_GE(result.quality.min_dihedral_deg,
            mesh_tet::QualityBounds{}.min_dihedral_deg);
  return true;
}

TEST(UglySurfaces, TwoHundredAtRandom) {
  int total = 0;
  int meshes = 0;
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    const Kind& kind = kKinds.at(k);
    const Timer timer;
    int filled = 0;
    for (int i = 0; i < kind.count; ++i) {
      SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(i));
      Ugly ugly(static_cast<unsigned>(100 * k + static_cast<unsigned>(i)));
      filled += check((ugly.*kind.make)(), kind.outcome) ? 1 : 0;
    }
    total += kind.count;
    meshes += filled;
    RecordProperty(std::string(kind.name) + " filled",
                   std::to_string(filled) + " of " +
                       std::to_string(kind.count) + " in " +
                       std::to_string(timer.seconds()) + " s");
  }
  EXPECT_EQ(total, 200);
  EXPECT_GT(meshes, 30);  // not all refused
}

}  // namespace

}  // namespace meniscus::ugly_random_test
