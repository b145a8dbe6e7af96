#include "evolve/start/face_loops.h"

#include <algorithm>
#include <cmath>
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
  std::set<int> reached;
  for (const auto& [from, to] : next) {
    reached.insert(to);
  }
  std::vector<End> ends;
  for (const auto& [from, to] : next) {
    if (reached.count(from) == 0) {
      ends.push_back({from, true});
    }
  }
  for (const int to : reached) {
    if (next.count(to) == 0) {
      ends.push_back({to, false});
    }
  }
  if (!ends.empty()) {
    close(face, ends, next);
  }
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
          "of symmetry that could close it",
          name, p.x(), p.y(), p.z()));
    }
  }
  return loops;
}

/// Along each plane the ends are joined in pairs, as a line runs in and out of
/// a face; where one is left over, seams of two planes meet in a corner.
void FaceSeams::close(const FacePlane& face, const std::vector<End>& ends,
                      std::map<int, int>& next) {
  struct Seam {
    std::size_t plane;
    Vec3 along;
    std::vector<std::pair<double, End>> on;  // by the way along
  };
  std::vector<Seam> seams;
  std::vector<std::size_t> odd;
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const FacePlane& plane = planes_[p];
    Seam seam{p, face.normal.cross(plane.normal), {}};
    if (plane.set == face.set || seam.along.norm() < kParallel) {
      continue;  // its own, or that of a solid's face that lies in it
    }
    for (const End& end : ends) {
      const Vec3& at = complex_.mesh.points[end.vertex];
      if (std::abs(plane.normal.dot(at - plane.at)) <= reach_) {
        seam.on.emplace_back(seam.along.dot(at), end);
      }
    }
    std::sort(seam.on.begin(), seam.on.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    if (seam.on.size() % 2 == 1) {
      odd.push_back(seams.size());
    }
    seams.push_back(std::move(seam));
  }
  if (odd.size() == 2) {
    const int middle = corner(face, seams[odd[0]].plane, seams[odd[1]].plane);
    for (const std::size_t s : odd) {
      Seam& seam = seams[s];
      const double there = seam.along.dot(complex_.mesh.points[middle]);
      const auto nearest = std::min_element(
          seam.on.begin(), seam.on.end(), [&](const auto& a, const auto& b) {
            return std::abs(a.first - there) < std::abs(b.first - there);
          });
      const End end = nearest->second;
      seam.on.erase(nearest);
      join(face, seam.plane, end, {middle, !end.starts}, next);
    }
  }
  for (const Seam& seam : seams) {
    for (std::size_t k = 0; k + 1 < seam.on.size(); k += 2) {
      join(face, seam.plane, seam.on[k].second, seam.on[k + 1].second, next);
    }
  }
}

void FaceSeams::join(const FacePlane& face, std::size_t plane, const End& a,
                     const End& b, std::map<int, int>& next) {
  const int from = a.starts ? b.vertex : a.vertex;
  const int to = a.starts ? a.vertex : b.vertex;
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

int FaceSeams::corner(const FacePlane& face, std::size_t p, std::size_t q) {
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
