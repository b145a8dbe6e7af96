#include "tests/support/shell_shapes.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <utility>

#include "core/geometry/edge_key.h"

namespace meniscus::shell_shapes {

std::vector<int> MappedShell::nodes(
    const std::function<bool(double, double)>& where) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (where(place[i][0], place[i][1])) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

int MappedShell::node(double s, double t) const {
  const auto far = [&](const std::array<double, 2>& p) {
    return (p[0] - s) * (p[0] - s) + (p[1] - t) * (p[1] - t);
  };
  const auto nearest =
      std::min_element(place.begin(), place.end(),
                       [&](auto& a, auto& b) { return far(a) < far(b); });
  return static_cast<int>(nearest - place.begin());
}

std::vector<std::array<int, 3>> MappedShell::edges(
    const std::function<bool(double, double)>& where) const {
  std::vector<std::array<int, 3>> found;
  const auto holds = [&](int i) { return where(place[i][0], place[i][1]); };
  for (const auto& f : mesh.facets) {
    for (int e = 0; e < 3; ++e) {
      const std::array<int, 3> edge = {f[e], f[(e + 1) % 3], f[3 + e]};
      if (holds(edge[0]) && holds(edge[1]) && holds(edge[2])) {
        found.push_back(edge);
      }
    }
  }
  return found;
}

namespace {

/// Middles, places and thickness of given corners and triangles.
MappedShell finished(MappedShell shell, const std::vector<Triangle>& triangles,
                     const Map& map, double thickness, bool straight) {
  std::map<Edge, int> middles;
  for (const Triangle& c : triangles) {
    std::array<int, 6> facet = {c[0], c[1], c[2], 0, 0, 0};
    for (int e = 0; e < 3; ++e) {
      const Edge edge = edge_key(c[e], c[(e + 1) % 3]);
      const auto [at, fresh] =
          middles.try_emplace(edge, static_cast<int>(shell.place.size()));
      if (fresh) {
        const auto& p = shell.place[edge[0]];
        const auto& q = shell.place[edge[1]];
        shell.place.push_back({0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])});
      }
      facet[3 + e] = at->second;
    }
    shell.mesh.facets.push_back(facet);
  }
  for (const auto& p : shell.place) {
    shell.mesh.nodes.push_back(map(p[0], p[1]));
  }
  if (straight) {
    for (const auto& [edge, middle] : middles) {
      shell.mesh.nodes[middle] =
          0.5 * (shell.mesh.nodes[edge[0]] + shell.mesh.nodes[edge[1]]);
    }
  }
  shell.mesh.section.assign(shell.mesh.facets.size(), 0);
  shell.mesh.thickness.assign(shell.mesh.facets.size(),
                              Vec3::Constant(thickness));
  return shell;
}

}  // namespace

MappedShell mapped_shell(const Map& map, double thickness,
                         const GridOptions& o) {
  MappedShell shell;
  std::mt19937 random(o.seed);
  std::uniform_real_distribution<double> moved(-o.shake, o.shake);
  for (int j = 0; j <= o.n; ++j) {
    for (int i = 0; i <= o.m; ++i) {
      double s = i;
      double t = j;
      if (i > 0 && i < o.m) {
        s += moved(random);
      }
      if (j > 0 && j < o.n) {
        t += moved(random);
      }
      shell.place.push_back({s / o.m, t / o.n});
    }
  }
  std::vector<Triangle> triangles;
  for (int j = 0; j < o.n; ++j) {
    for (int i = 0; i < o.m; ++i) {
      const int a = j * (o.m + 1) + i;
      const int b = a + 1;
      const int c = a + o.m + 2;
      const int d = a + o.m + 1;
      const bool slash =
          o.cut == Cut::Slash || (o.cut == Cut::Mixed && random() % 2 == 0);
      if (slash) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      } else {
        triangles.push_back({a, b, d});
        triangles.push_back({b, c, d});
      }
    }
  }
  return finished(std::move(shell), triangles, map, thickness, o.straight);
}

MappedShell triangle_shell(const Map& map, double thickness,
                           const GridOptions& o) {
  MappedShell shell;
  std::mt19937 random(o.seed);
  std::uniform_real_distribution<double> moved(-o.shake, o.shake);
  std::vector<int> row;  // first corner of each
  for (int j = 0; j <= o.m; ++j) {
    row.push_back(static_cast<int>(shell.place.size()));
    for (int i = 0; i + j <= o.m; ++i) {
      const bool inside = i > 0 && j > 0 && i + j < o.m;
      const double s = i + (inside ? moved(random) : 0.0);
      const double t = j + (inside ? moved(random) : 0.0);
      shell.place.push_back({s / o.m, t / o.m});
    }
  }
  std::vector<Triangle> triangles;
  for (int j = 0; j < o.m; ++j) {
    for (int i = 0; i + j < o.m; ++i) {
      triangles.push_back({row[j] + i, row[j] + i + 1, row[j + 1] + i});
      if (i + j + 1 < o.m) {
        triangles.push_back(
            {row[j] + i + 1, row[j + 1] + i + 1, row[j + 1] + i});
      }
    }
  }
  return finished(std::move(shell), triangles, map, thickness, o.straight);
}

MappedShell joined(const MappedShell& first, const MappedShell& second,
                   double tolerance) {
  MappedShell both = first;
  std::vector<int> number;
  for (std::size_t i = 0; i < second.mesh.nodes.size(); ++i) {
    int same = -1;
    for (std::size_t k = 0; k < first.mesh.nodes.size(); ++k) {
      if ((first.mesh.nodes[k] - second.mesh.nodes[i]).norm() < tolerance) {
        same = static_cast<int>(k);
      }
    }
    if (same < 0) {
      same = static_cast<int>(both.mesh.nodes.size());
      both.mesh.nodes.push_back(second.mesh.nodes[i]);
      both.place.push_back(second.place[i]);
    }
    number.push_back(same);
  }
  for (std::size_t f = 0; f < second.mesh.facets.size(); ++f) {
    auto facet = second.mesh.facets[f];
    for (int& node : facet) {
      node = number[node];
    }
    both.mesh.facets.push_back(facet);
    both.mesh.thickness.push_back(second.mesh.thickness[f]);
    both.mesh.section.push_back(second.mesh.section[f]);
  }
  return both;
}

void hold(std::vector<shell::NodeSupport>& supports,
          const std::vector<int>& nodes, const char* held) {
  shell::NodeSupport support;
  for (const char* c = held; *c != 0; ++c) {
    support.held[std::strchr("xyzabc", *c) - std::strchr("xyzabc", 'x')] = true;
  }
  for (const int node : nodes) {
    support.node = node;
    supports.push_back(support);
  }
}

shell::Section isotropic(double youngs_modulus, double poisson_ratio,
                         double density) {
  element::Material material{
      "shell", youngs_modulus, poisson_ratio, density, {}};
  return {{{{material}}}};
}

}  // namespace meniscus::shell_shapes
