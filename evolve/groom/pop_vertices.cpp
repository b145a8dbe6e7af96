#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "evolve/groom/film_cutter.h"
#include "evolve/groom/pop.h"

namespace meniscus::groom {

namespace {

constexpr double kBall = 0.3;  // radius of the ball, x the shortest edge
constexpr double kApart =
    0.1;  // sheets pulled apart, x the way to their middle

using Arc = std::array<int, 3>;  // from, to (neighbours of the vertex), facet

// The link of a vertex, drawn on a sphere around it: its neighbours are nodes,
// its facets arcs, and the regions between the films are faces.
struct Link {
  std::vector<Arc> arcs;  // each facet once, as the facet runs
  std::map<int, std::vector<std::pair<int, int>>> at;  // node: (other, facet)
};

class VertexPopper {
 public:
  explicit VertexPopper(films::FilmComplex& complex) : cut_(complex) {}

  PopReport run() {
    const int count = static_cast<int>(cut_.points().size());
    for (int v = 0; v < count; ++v) {
      pop_at(v);
    }
    cut_.tidy();
    return std::move(report_);
  }

 private:
  Link link_of(int v) const {
    Link link;
    for (const int f : cut_.star(v)) {
      const Triangle& t = cut_.facet(f);
      const int k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const Arc arc = {t[(k + 1) % 3], t[(k + 2) % 3], f};
      link.arcs.push_back(arc);
      link.at[arc[0]].emplace_back(arc[1], f);
      link.at[arc[1]].emplace_back(arc[0], f);
    }
    return link;
  }

  // Connected parts of the link: their facets.
  static std::vector<std::vector<int>> sheets_of(const Link& link) {
    std::map<int, int> part;
    std::vector<std::vector<int>> sheets;
    for (const auto& [node, ends] : link.at) {
      if (part.contains(node)) {
        continue;
      }
      const int id = static_cast<int>(sheets.size());
      sheets.emplace_back();
      std::vector<int> open = {node};
      part[node] = id;
      while (!open.empty()) {
        const int at = open.back();
        open.pop_back();
        for (const auto& [other, facet] : link.at.at(at)) {
          if (part.emplace(other, id).second) {
            open.push_back(other);
          }
        }
      }
    }
    for (const Arc& arc : link.arcs) {
      sheets[part[arc[0]]].push_back(arc[2]);
    }
    return sheets;
  }

  // A disk has no node of three arcs, a line two, a minimal point four, each
  // joined to each.
  static bool is_minimal(const Link& link) {
    int triple = 0;
    for (const auto& [node, ends] : link.at) {
      triple += ends.size() == 3 ? 1 : 0;
    }
    return triple == 0 || triple == 2 || (triple == 4 && joins_all(link));
  }

  static bool joins_all(const Link& link) {
    for (const auto& [node, ends] : link.at) {
      std::vector<int> reached;
      for (const auto& [first, facet] : ends) {
        int from = node;
        int at = first;
        while (link.at.at(at).size() == 2) {
          const auto& two = link.at.at(at);
          const int next = two[0].first == from ? two[1].first : two[0].first;
          from = at;
          at = next;
        }
        reached.push_back(at);
      }
      std::sort(reached.begin(), reached.end());
      if (ends.size() == 3 &&
          (std::adjacent_find(reached.begin(), reached.end()) !=
               reached.end() ||
           std::find(reached.begin(), reached.end(), node) != reached.end())) {
        return false;
      }
    }
    return true;
  }

  void pop_at(int v) {
    const Link link = link_of(v);
    if (link.arcs.empty()) {
      return;
    }
    const std::vector<std::vector<int>> sheets = sheets_of(link);
    bool known = true;  // every node on two or three films
    for (const auto& [node, ends] : link.at) {
      known = known && (ends.size() == 2 || ends.size() == 3);
    }
    if (sheets.size() == 1 && (!known || is_minimal(link))) {
      return;
    }
    if (!cut_.is_loose(v)) {
      ++report_.refused;
      return;
    }
    const Vec3 place = cut_.points()[v];
    if (sheets.size() > 1) {
      separate(v, sheets);
    } else if (!open_ball(v, link)) {
      ++report_.refused;
      return;
    }
    ++report_.popped;
    report_.places.push_back(place);
  }

  void separate(int v, const std::vector<std::vector<int>>& sheets) {
    const Vec3 place = cut_.points()[v];
    for (std::size_t s = 0; s < sheets.size(); ++s) {
      Vec3 middle = Vec3::Zero();
      for (const int f : sheets[s]) {
        for (const int u : cut_.facet(f)) {
          middle += u == v ? Vec3(Vec3::Zero()) : cut_.points()[u];
        }
      }
      middle /= 2.0 * static_cast<double>(sheets[s].size());
      const Vec3 apart = place + kApart * (middle - place);
      if (s == 0) {
        cut_.complex().mesh.points[v] = apart;
        continue;
      }
      const int copy = cut_.add_vertex(apart);
      for (const int f : sheets[s]) {
        cut_.replace(f, v, copy);
      }
    }
  }

  // A face of the link: its arcs in order, the face on their left seen from
  // outside the sphere.
  struct Face {
    std::vector<std::pair<int, int>> arcs;  // node the arc starts at, facet
    double area = 0.0;                      // solid angle, by its fan
    int body = -1;
  };

  // Of the arcs at a node, the next clockwise after (other, facet), seen from
  // outside.
  std::pair<int, int> turn(int v, int node, const Link& link,
                           const std::pair<int, int>& from) const {
    const Vec3 axis = (cut_.points()[node] - cut_.points()[v]).normalized();
    const auto off = [&](int other) {
      const Vec3 out = cut_.points()[other] - cut_.points()[v];
      return Vec3(out - axis.dot(out) * axis);
    };
    const Vec3 zero = off(from.first);
    std::pair<int, int> best = from;
    double least = 10.0;
    for (const auto& end : link.at.at(node)) {
      if (end.second == from.second) {
        continue;
      }
      const Vec3 way = off(end.first);
      double angle = -std::atan2(axis.dot(zero.cross(way)), zero.dot(way));
      angle += angle < 0.0 ? 2.0 * std::numbers::pi : 0.0;
      if (angle < least) {
        least = angle;
        best = end;
      }
    }
    return best;
  }

  std::vector<Face> faces_of(int v, const Link& link) const {
    std::map<std::pair<int, int>, bool> used;  // (from node, facet)
    std::vector<Face> faces;
    for (const Arc& first : link.arcs) {
      for (const int start : {first[0], first[1]}) {
        if (used[{start, first[2]}]) {
          continue;
        }
        Face face;
        int node = start;
        int facet = first[2];
        while (!used[{node, facet}]) {
          used[{node, facet}] = true;
          face.arcs.emplace_back(node, facet);
          const int to = cut_.corner_off(facet, v, node);
          const auto next = turn(v, to, link, {node, facet});
          node = to;
          facet = next.second;
        }
        measure(v, face);
        faces.push_back(std::move(face));
      }
    }
    return faces;
  }

  void measure(int v, Face& face) const {
    // The face is on the left of an arc: ahead of a facet that runs as it.
    const auto [node, facet] = face.arcs.front();
    face.body = cut_.body_at(facet, runs_from(v, node, facet)
                                        ? FilmCutter::Side::Ahead
                                        : FilmCutter::Side::Behind);
    const auto direction = [&](int u) {
      return Vec3((cut_.points()[u] - cut_.points()[v]).normalized());
    };
    Vec3 sum = Vec3::Zero();
    for (const auto& [at, f] : face.arcs) {
      sum += direction(at).cross(direction(cut_.corner_off(f, v, at)));
    }
    face.area = sum.norm();
  }

  // Does the facet run v -> node -> other?
  bool runs_from(int v, int node, int facet) const {
    const Triangle& t = cut_.facet(facet);
    const int k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    return t[(k + 1) % 3] == node;
  }

  bool open_ball(int v, const Link& link) {
    const std::vector<Face> faces = faces_of(v, link);
    const int nodes = static_cast<int>(link.at.size());
    const int arcs = static_cast<int>(link.arcs.size());
    if (nodes - arcs + static_cast<int>(faces.size()) != 2) {
      return false;  // films cross, or the link has open ends
    }
    const Vec3 place = cut_.points()[v];
    double radius = 1e300;
    for (const auto& [node, ends] : link.at) {
      radius = std::min(radius, (cut_.points()[node] - place).norm());
    }
    std::map<int, int> on_ball;
    for (const auto& [node, ends] : link.at) {
      const Vec3 way = (cut_.points()[node] - place).normalized();
      on_ball[node] = cut_.add_vertex(place + kBall * radius * way);
    }
    const auto largest = std::max_element(
        faces.begin(), faces.end(), [](const Face& one, const Face& two) {
          return one.area < (1.0 - 1e-9) * two.area;
        });
    for (const Face& face : faces) {
      if (&face != &*largest) {
        close_face(v, face, *largest, on_ball);
      }
    }
    for (const Arc& arc : link.arcs) {
      const int label = cut_.label(arc[2]);
      const int a = on_ball[arc[0]];
      const int b = on_ball[arc[1]];
      cut_.remove(arc[2]);
      cut_.add_facet({a, arc[0], arc[1]}, label);
      cut_.add_facet({a, arc[1], b}, label);
    }
    return true;
  }

  // The film between a face's region and the ball, which is the largest
  // region's now. Where a film parted the two regions, it goes on.
  void close_face(int v, const Face& face, const Face& largest,
                  const std::map<int, int>& on_ball) {
    int label = -1;
    bool turned = false;
    for (const auto& [node, facet] : face.arcs) {
      const auto same = [&, f = facet](const std::pair<int, int>& arc) {
        return arc.second == f;
      };
      if (label < 0 &&
          std::any_of(largest.arcs.begin(), largest.arcs.end(), same)) {
        label = cut_.label(facet);
        // Outward of the ball: into the face's region.
        turned = !runs_from(v, node, facet);
      }
    }
    if (label < 0) {
      label = cut_.add_surface(cut_.label(face.arcs.front().second), face.body,
                               largest.body);
    }
    Vec3 middle = Vec3::Zero();
    for (const auto& [node, facet] : face.arcs) {
      middle += cut_.points()[on_ball.at(node)];
    }
    const int centre =
        cut_.add_vertex(middle / static_cast<double>(face.arcs.size()));
    for (const auto& [node, facet] : face.arcs) {
      const int a = on_ball.at(node);
      const int b = on_ball.at(cut_.corner_off(facet, v, node));
      cut_.add_facet(turned ? Triangle{b, a, centre} : Triangle{a, b, centre},
                     label);
    }
  }

  FilmCutter cut_;
  PopReport report_;
};

}  // namespace

PopReport pop_vertices(films::FilmComplex& complex) {
  return VertexPopper(complex).run();
}

}  // namespace meniscus::groom
