#include "evolve/start/face_loops.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "evolve/start/cap_faces.h"

namespace meniscus::start {

namespace {

constexpr double kOnPlane = 1e-9;   // of the size
constexpr double kParallel = 1e-6;  // sine between normals

}  // namespace

std::set<Edge> open_runs(const SurfaceMesh& mesh, int label) {
  std::set<Edge> runs;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] != label) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      if (runs.erase(Edge{b, a}) == 0) {
        runs.insert(Edge{a, b});
      }
    }
  }
  return runs;
}

int joined_set(films::FilmComplex& complex, int a, int b) {
  if (a < 0 || b < 0 || a == b) {
    return std::max(a, b);
  }
  std::vector<int> all = complex.constraint_sets[a];
  const std::vector<int>& more = complex.constraint_sets[b];
  all.insert(all.end(), more.begin(), more.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  auto& sets = complex.constraint_sets;
  const auto known = std::find(sets.begin(), sets.end(), all);
  if (known != sets.end()) {
    return static_cast<int>(known - sets.begin());
  }
  sets.push_back(all);
  return static_cast<int>(sets.size()) - 1;
}

void add_filling(const SurfaceMesh& filling, std::vector<int> ids, int label,
                 films::FilmComplex& complex) {
  SurfaceMesh& mesh = complex.mesh;
  for (std::size_t i = ids.size(); i < filling.points.size(); ++i) {
    ids.push_back(static_cast<int>(mesh.points.size()));
    mesh.points.push_back(filling.points[i]);
    complex.vertices.push_back({films::VertexKind::InCap});
  }
  for (const Triangle& t : filling.facets) {
    mesh.facets.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
    mesh.facet_label.push_back(label);
  }
}

void fill_loops(const std::vector<std::vector<int>>& loops, double edge,
                bool graded, int label, films::FilmComplex& complex) {
  SurfaceMesh& mesh = complex.mesh;
  std::vector<Points> places;
  for (const std::vector<int>& loop : loops) {
    Points& of_loop = places.emplace_back();
    for (const int v : loop) {
      of_loop.push_back(mesh.points[v]);
    }
  }
  for (const std::vector<int>& part : faces_with_holes(places)) {
    std::vector<int> ids;
    std::vector<Points> bounds;
    for (const int k : part) {
      bounds.push_back(places[k]);
      ids.insert(ids.end(), loops[k].begin(), loops[k].end());
    }
    const SurfaceMesh filling =
        fill_face(bounds, edge, graded, complex.surfaces[label].name);
    add_filling(filling, std::move(ids), label, complex);
  }
}

void drop_unused(films::FilmComplex& complex) {
  SurfaceMesh& mesh = complex.mesh;
  std::vector<int> number(complex.vertices.size(), -1);
  for (const Triangle& t : mesh.facets) {
    for (const int v : t) {
      number[v] = 0;
    }
  }
  int count = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) {
      mesh.points[count] = mesh.points[v];
      complex.vertices[count] = complex.vertices[v];
      number[v] = count++;
    }
  }
  mesh.points.resize(count);
  complex.vertices.resize(count);
  for (Triangle& t : mesh.facets) {
    for (int& v : t) {
      v = number[v];
    }
  }
  std::vector<films::ComplexEdge> marks;
  for (films::ComplexEdge mark : complex.edges) {
    mark.a = number[mark.a];
    mark.b = number[mark.b];
    if (mark.a >= 0 && mark.b >= 0) {
      marks.push_back(mark);
    }
  }
  complex.edges = std::move(marks);
}

double reach_of_planes(const Points& points) {
  return kOnPlane * bounding_diagonal(points);
}

FaceSeams::FaceSeams(films::FilmComplex& complex, std::vector<FacePlane> planes,
                     double edge)
    : complex_(complex),
      planes_(std::move(planes)),
      edge_(edge),
      reach_(reach_of_planes(complex.mesh.points)) {}

std::vector<std::vector<int>> FaceSeams::loops(const FacePlane& face,
                                               std::map<int, int> next,
                                               const std::string& name) {
  close(face, next);
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    const int first = next.begin()->first;
    int last = first;
    for (auto at = next.begin(); at != next.end();) {
      loop.push_back(at->first);
      last = at->second;
      next.erase(at);
      at = next.find(last);
    }
    if (last != first) {
      const Vec3& p = complex_.mesh.points[last];
      throw InvalidInput(fmt::format(
          "the boundary of '{}' ends at ({:.6g}, {:.6g}, {:.6g}), on no plane "
          "that could close it",
          name, p.x(), p.y(), p.z()));
    }
  }
  return loops;
}

void FaceSeams::close(const FacePlane& face, std::map<int, int>& next) {
  std::set<int> reached;
  std::set<int> beginnings;
  for (const auto& [from, to] : next) {
    reached.insert(to);
  }
  for (const auto& [from, to] : next) {
    if (reached.count(from) == 0) {
      beginnings.insert(from);
    }
  }
  const std::map<int, int> given = next;
  for (const int end : reached) {
    if (given.count(end) == 0) {
      walk(face, end, beginnings, next);
    }
  }
}

void FaceSeams::walk(const FacePlane& face, int vertex,
                     std::set<int>& beginnings, std::map<int, int>& next) {
  int plane = plane_at(face, vertex);
  for (std::size_t seams = 0; plane >= 0 && seams <= planes_.size(); ++seams) {
    const Vec3 from = complex_.mesh.points[vertex];
    const Vec3 way = face.normal.cross(planes_[plane].normal).normalized();
    double far = std::numeric_limits<double>::infinity();
    const int beyond = next_plane(face, plane, from, way, far);
    int to = -1;
    for (const int beginning : beginnings) {
      const Vec3& at = complex_.mesh.points[beginning];
      const double there = way.dot(at - from);
      if (std::abs(planes_[plane].normal.dot(at - planes_[plane].at)) <=
              reach_ &&
          there > 0.0 && there <= far + reach_) {
        far = there;
        to = beginning;
      }
    }
    if (to >= 0) {
      join(face, plane, vertex, to, next);
      beginnings.erase(to);
      return;
    }
    if (beyond >= 0) {
      const int turn = corner(face, plane, beyond);
      join(face, plane, vertex, turn, next);
      vertex = turn;
    }
    plane = beyond;
  }
}

/// The plane beside the face's own that a vertex lies on; -1: none.
int FaceSeams::plane_at(const FacePlane& face, int vertex) const {
  const Vec3& at = complex_.mesh.points[vertex];
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const FacePlane& plane = planes_[p];
    if (plane.set != face.set &&
        face.normal.cross(plane.normal).norm() > kParallel &&
        std::abs(plane.normal.dot(at - plane.at)) <= reach_) {
      return static_cast<int>(p);
    }
  }
  return -1;
}

/// The plane that cuts off the face's edge in `plane` first, on the `way` from
/// a place, and how `far` that is; -1: none does.
int FaceSeams::next_plane(const FacePlane& face, int plane, const Vec3& from,
                          const Vec3& way, double& far) const {
  int first = -1;
  for (std::size_t q = 0; q < planes_.size(); ++q) {
    const double toward = planes_[q].normal.dot(way);
    const double there = planes_[q].normal.dot(planes_[q].at - from) / toward;
    if (static_cast<int>(q) != plane && planes_[q].set != face.set &&
        toward > kParallel && there > reach_ && there < far) {
      first = static_cast<int>(q);
      far = there;
    }
  }
  return first;
}

void FaceSeams::join(const FacePlane& face, int plane, int from, int to,
                     std::map<int, int>& next) {
  std::vector<int> line =
      seam(from, to, joined_set(complex_, face.set, planes_[plane].set));
  if (line.front() != from) {
    std::reverse(line.begin(), line.end());
  }
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    next[line[k]] = line[k + 1];
  }
}

const std::vector<int>& FaceSeams::seam(int from, int to, int set) {
  const auto [known, is_new] = seams_.try_emplace(edge_key(from, to));
  if (!is_new) {
    return known->second;
  }
  const Vec3 a = complex_.mesh.points[from];
  const Vec3 way = complex_.mesh.points[to] - a;
  const int pieces =
      std::max(1, static_cast<int>(std::lround(way.norm() / edge_)));
  std::vector<int>& line = known->second;
  line.push_back(from);
  for (int k = 1; k < pieces; ++k) {
    line.push_back(add_vertex(a + static_cast<double>(k) / pieces * way, set));
  }
  line.push_back(to);
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    films::ComplexEdge mark;
    mark.a = line[k];
    mark.b = line[k + 1];
    mark.kind = films::VertexKind::InCap;
    mark.constraints = set;
    complex_.edges.push_back(mark);
  }
  return line;
}

int FaceSeams::corner(const FacePlane& face, int p, int q) {
  const int set = joined_set(
      complex_, face.set, joined_set(complex_, planes_[p].set, planes_[q].set));
  if (face.set >= 0) {
    const auto known = corners_.find(complex_.constraint_sets[set]);
    if (known != corners_.end()) {
      return known->second;
    }
  }
  Mat3 normals;
  Vec3 offs;
  int row = 0;
  for (const FacePlane& plane : {face, planes_[p], planes_[q]}) {
    normals.row(row) = plane.normal.transpose();
    offs[row++] = plane.normal.dot(plane.at);
  }
  const int v = add_vertex(solve_lu(normals, offs), set);
  if (face.set >= 0) {
    corners_[complex_.constraint_sets[set]] = v;
  }
  return v;
}

int FaceSeams::add_vertex(const Vec3& place, int set) {
  const auto v = static_cast<int>(complex_.mesh.points.size());
  complex_.mesh.points.push_back(place);
  complex_.vertices.push_back(
      {.kind = films::VertexKind::InCap, .constraints = set});
  return v;
}

}  // namespace meniscus::start
