/// Films that spines hold, from the start to the verdict: tubes, arms that
/// meet, and random trees of many spines. Prints a table; ends with 1 where a
/// target is missed.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "evolve/frozen/film_model.h"

namespace meniscus {
namespace {

/// Arms between nodes; nodes with one arm end in a ring.
struct Graph {
  Points nodes;
  std::vector<Edge> arms;
  double radius = 10.0;
};

films::FilmSystem system_of(const Graph& graph) {
  films::FilmSystem system;
  system.films = {{.name = "skin", .kind = films::FilmKind::Spines}};
  system.bodies = {{.name = "part", .enclosed_by = {"skin"}}};
  std::vector<std::vector<int>> neighbours(graph.nodes.size());
  for (std::size_t k = 0; k < graph.arms.size(); ++k) {
    const auto [a, b] = graph.arms[k];
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
    system.spines.push_back({.name = fmt::format("arm_{}", k),
                             .body = "part",
                             .points = {graph.nodes[a], graph.nodes[b]},
                             .smooth = false,
                             .radii = {graph.radius, graph.radius}});
  }
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    if (neighbours[n].size() != 1) {
      continue;
    }
    const Vec3 out =
        (graph.nodes[n] - graph.nodes[neighbours[n][0]]).normalized();
    const std::string name = fmt::format("rim_{}", n);
    system.curves.push_back(
        {name, curves::Circle{graph.nodes[n], out, graph.radius}});
    system.films[0].curves.push_back(name);
    system.caps.push_back({fmt::format("cap_{}", n), name});
    system.bodies[0].enclosed_by.push_back(system.caps.back().name);
  }
  return system;
}

Graph tube(double length) {
  return {{Vec3::Zero(), Vec3(0, 0, length)}, {{0, 1}}};
}

Graph star(int arms, double length) {
  Graph graph{{Vec3::Zero()}, {}};
  for (int k = 0; k < arms; ++k) {
    const double a = 2.0 * std::numbers::pi * k / arms;
    graph.nodes.push_back(length * Vec3(std::cos(a), std::sin(a), 0));
    graph.arms.push_back({0, k + 1});
  }
  return graph;
}

/// Grown arm by arm from random nodes, away from all others; nodes of at most
/// three arms.
Graph tree(int arms, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> length(50.0, 90.0);
  Graph graph{{Vec3::Zero()}, {}};
  std::vector<int> count = {0};
  while (static_cast<int>(graph.arms.size()) < arms) {
    const auto from =
        static_cast<int>(std::uniform_int_distribution<std::size_t>(
            0, count.size() - 1)(engine));
    if (count[from] >= 3) {
      continue;
    }
    const Vec3 way =
        Vec3(normal(engine), normal(engine), normal(engine)).normalized();
    const Vec3 to = graph.nodes[from] + length(engine) * way;
    bool clear = true;
    for (const auto& [a, b] : graph.arms) {
      // The new arm but for its first part keeps away from every other.
      for (double s = 0.35; s <= 1.0 && clear; s += 0.05) {
        const Vec3 at = graph.nodes[from] + s * (to - graph.nodes[from]);
        const Vec3 way_ab = graph.nodes[b] - graph.nodes[a];
        const double t = std::clamp(
            (at - graph.nodes[a]).dot(way_ab) / way_ab.squaredNorm(), 0.0, 1.0);
        clear = (at - graph.nodes[a] - t * way_ab).norm() >
                (a == from || b == from ? 2.5 : 4.5) * graph.radius;
      }
    }
    if (clear) {
      graph.arms.push_back({from, static_cast<int>(graph.nodes.size())});
      graph.nodes.push_back(to);
      ++count[from];
      count.push_back(1);
    }
  }
  return graph;
}

/// True where the film stands within the time.
bool measure(const std::string& name, const Graph& graph, double edge,
             double allowed) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system_of(graph), {.edge = edge});
  const settle::FilmReport& report = model.reference().report;
  const bool good = !model.reference().failure && report.seconds <= allowed;
  std::printf("%-28s %7zu arms %8d facets %8.2f s (at most %g) %s\n",
              name.c_str(), graph.arms.size(), report.facets, report.seconds,
              allowed, good ? "" : report.verdict.c_str());
  std::fflush(stdout);
  return good;
}

}  // namespace
}  // namespace meniscus

int main() {
  using namespace meniscus;  // NOLINT: of a program of one file
  bool good = measure("tube, L/R = 20", tube(200.0), 4.8, 0.5);
  good &= measure("tube, L/R = 40", tube(400.0), 6.8, 0.5);
  good &= measure("tube, L/R = 20", tube(200.0), 1.5, 3.0);
  good &= measure("tube, L/R = 40", tube(400.0), 2.1, 3.0);
  good &= measure("three arms, L/R = 13", star(3, 130.0), 6.8, 0.5);
  good &= measure("three arms, L/R = 13", star(3, 130.0), 2.1, 3.0);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    good &= measure("tree " + std::to_string(seed), tree(40, seed), 7.0, 10.0);
  }
  return good ? 0 : 1;
}
