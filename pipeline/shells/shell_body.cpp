#include "pipeline/shells/shell_body.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "pipeline/shells/film_normals.h"

namespace meniscus::shells {

namespace {

using Face = std::array<int, 6>;

/// Names of the rims that an edge is on, by its middle.
using RimsAtMiddles = std::map<int, std::vector<std::string>>;

RimsAtMiddles rims_at_middles(const ShellPart& part) {
  RimsAtMiddles rims;
  for (const auto& [name, rim] : part.rims) {
    for (const auto& [from, to, middle] : rim) {
      rims[middle].push_back(name);
    }
  }
  return rims;
}

/// One film's closed surface.
class FilmBody {
 public:
  FilmBody(const ShellPart& part, const RimsAtMiddles& rims, int label,
           int number, ShellBody& body)
      : part_(part),
        rims_(rims),
        label_(label),
        number_(number),
        body_(body),
        normals_(film_normals(part, label)) {
    for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
      if (part.skin.face_label[f] == label) {
        add_walls(f);
      }
    }
  }

  void build(const std::string& name) {
    const int outside = label(name);
    const int inside = label(name + "/back");
    std::map<Edge, std::pair<Triangle, int>> open;  // from, to, middle; uses
    for (std::size_t f = 0; f < part_.mesh.facets.size(); ++f) {
      if (part_.skin.face_label[f] != label_) {
        continue;
      }
      const Face& n = part_.mesh.facets[f];
      Face face = n;
      for (int& node : face) {
        node = point(node, 1);
      }
      add(face, outside);
      face = {n[0], n[2], n[1], n[5], n[4], n[3]};
      for (int& node : face) {
        node = point(node, -1);
      }
      add(face, inside);
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = n[k];
        const int b = n[(k + 1) % 3];
        auto& edge = open[{std::min(a, b), std::max(a, b)}];
        edge.first = {a, b, n[k + 3]};
        ++edge.second;
      }
    }
    for (const auto& [key, edge] : open) {
      if (edge.second == 1) {
        const auto [a, b, m] = edge.first;
        add_rim(a, b, m, label(rim_name(name, m)));
      }
    }
  }

 private:
  struct Wall {
    double thickness = 0.0;
    double offset = 0.0;
    double facets = 0.0;
  };

  void add_walls(std::size_t f) {
    const Face& facet = part_.mesh.facets[f];
    const std::array<double, 6> t = shell::facet_thicknesses(part_.mesh, f);
    for (std::size_t i = 0; i < facet.size(); ++i) {
      Wall& wall = walls_[facet[i]];
      wall.thickness += t[i];
      wall.offset += part_.sections[part_.mesh.section[f]].offset;
      wall.facets += 1.0;
    }
  }

  int label(const std::string& name) {
    const int known = body_.mesh.label_of(name);
    if (known < 0) {
      body_.mesh.labels.push_back(name);
      return static_cast<int>(body_.mesh.labels.size()) - 1;
    }
    return known;
  }

  /// Of the edge with that middle.
  std::string rim_name(const std::string& film, int middle) const {
    const std::string start = film + "/rim";
    if (const auto at = rims_.find(middle); at != rims_.end()) {
      for (const std::string& name : at->second) {
        if (name.starts_with(start + ":")) {
          return name;
        }
      }
    }
    return start;
  }

  int point(int node, int side) {
    const auto [at, is_new] = ids_.emplace(
        std::pair(node, side), static_cast<int>(body_.points.size()));
    if (is_new) {
      const Wall& wall = walls_.at(node);
      const double thickness = wall.thickness / wall.facets;
      const double height =
          thickness * (wall.offset / wall.facets + 0.5 * side);
      const Vec3 over = height * normals_.at(node);
      body_.points.push_back({node, side, over});
      body_.mesh.nodes.emplace_back(part_.mesh.nodes[node] + over);
    }
    return at->second;
  }

  void add(const Face& face, int label) {
    body_.mesh.faces.insert(body_.mesh.faces.end(), face.begin(), face.end());
    body_.mesh.face_label.push_back(label);
    body_.film.push_back(number_);
  }

  /// Between both faces along an edge that runs from a over m to b, as the
  /// outside has it.
  void add_rim(int a, int b, int m, int label) {
    add({point(b, 1), point(a, 1), point(a, -1), point(m, 1), point(a, 0),
         point(m, 0)},
        label);
    add({point(b, 1), point(a, -1), point(b, -1), point(m, 0), point(m, -1),
         point(b, 0)},
        label);
  }

  const ShellPart& part_;
  const RimsAtMiddles& rims_;
  int label_;
  int number_;
  ShellBody& body_;
  std::map<int, Vec3> normals_;
  std::map<int, Wall> walls_;  // of the film's nodes: sums over facets
  std::map<std::pair<int, int>, int> ids_;
};

}  // namespace

ShellBody shell_body(const ShellPart& part) {
  ShellBody body;
  body.mesh.order = 2;
  const std::vector<std::string> names = body_names(part);
  const RimsAtMiddles rims = rims_at_middles(part);
  for (std::size_t film = 0; film < names.size(); ++film) {
    FilmBody(part, rims, part.skin.label_of(names[film]),
             static_cast<int>(film), body)
        .build(names[film]);
  }
  return body;
}

std::vector<std::string> body_names(const ShellPart& part) {
  const std::set<int> used(part.skin.face_label.begin(),
                           part.skin.face_label.end());
  std::vector<std::string> names;
  names.reserve(used.size());
  for (const int label : used) {
    names.push_back(part.skin.labels[label]);
  }
  return names;
}

VectorX body_displacements(const ShellBody& body, const VectorX& six) {
  VectorX u(3 * std::ssize(body.points));
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const ShellBody::Point& at = body.points[p];
    const Eigen::Index first = Eigen::Index{6} * at.node;
    const Vec3 turn = six.segment<3>(first + 3);
    u.segment<3>(3 * static_cast<Eigen::Index>(p)) =
        six.segment<3>(first) + turn.cross(at.over);
  }
  return u;
}

std::vector<double> body_von_mises(const ShellBody& body, const ShellPart& part,
                                   std::size_t load_case) {
  using W = shell::WallStress;
  const std::array<std::vector<double>, 3> nodal = {
      nodal_von_mises(part, load_case, {&W::negative}),
      nodal_von_mises(part, load_case, {&W::middle}),
      nodal_von_mises(part, load_case, {&W::positive})};
  std::vector<double> values;
  values.reserve(body.points.size());
  for (const ShellBody::Point& at : body.points) {
    values.push_back(nodal[static_cast<std::size_t>(at.side + 1)][at.node]);
  }
  return values;
}

SurfaceMesh body_surface(const ShellBody& body) {
  constexpr std::array<Triangle, 4> kCut = {
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  SurfaceMesh surface{.points = body.mesh.nodes, .labels = body.mesh.labels};
  for (int f = 0; f < body.mesh.face_count(); ++f) {
    const auto face = body.mesh.face(f);
    for (const Triangle& cut : kCut) {
      surface.facets.push_back({face[cut[0]], face[cut[1]], face[cut[2]]});
      surface.facet_label.push_back(body.mesh.face_label[f]);
      surface.facet_bodies.push_back({.behind = body.film[f]});
    }
  }
  return surface;
}

SurfaceMesh part_surface(const ShellPart& part, SurfaceMesh solids) {
  SurfaceMesh walls = body_surface(shell_body(part));
  if (!part.solid) {
    return walls;
  }
  if (solids.facet_bodies.empty()) {
    solids.facet_bodies.resize(solids.facets.size());
  }
  const auto points = static_cast<int>(solids.points.size());
  const auto labels = static_cast<int>(solids.labels.size());
  const int bodies = body_count(solids);
  solids.points.insert(solids.points.end(), walls.points.begin(),
                       walls.points.end());
  solids.labels.insert(solids.labels.end(), walls.labels.begin(),
                       walls.labels.end());
  for (std::size_t f = 0; f < walls.facets.size(); ++f) {
    Triangle& facet = solids.facets.emplace_back(walls.facets[f]);
    for (int& point : facet) {
      point += points;
    }
    solids.facet_label.push_back(labels + walls.facet_label[f]);
    solids.facet_bodies.push_back(
        {bodies + body_of_side(walls, static_cast<int>(2 * f)), -1});
  }
  return solids;
}

}  // namespace meniscus::shells
