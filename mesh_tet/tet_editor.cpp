#include "mesh_tet/tet_editor.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"

namespace meniscus::mesh_tet {

namespace {

constexpr double kNoVolume = -1.0;

}  // namespace

double tet_merit(const TetCorners& x) {
  const Vec3 a = x[1] - x[0];
  const Vec3 b = x[2] - x[0];
  const Vec3 c = x[3] - x[0];
  const Vec3 ab = a.cross(b);
  const double volume = ab.dot(c);
  const std::array<Vec3, 4> normal = {ab, b.cross(c), c.cross(a),
                                      (b - a).cross(c - a)};
  // The outward normals are -ab, -bc, -ca and the last: signs drop out.
  std::array<double, 4> norm2;
  for (int f = 0; f < 4; ++f) {
    norm2[f] = normal[f].squaredNorm();
  }
  double largest = 0.0;  // squared cosine
  for (int f = 0; f < 4; ++f) {
    for (int g = f + 1; g < 4; ++g) {
      const double dot = normal[f].dot(normal[g]);
      const double norms = norm2[f] * norm2[g];
      largest = std::max(largest, norms > 0.0 ? dot * dot / norms : 1.0);
    }
  }
  const double merit = 1.0 - std::min(1.0, largest);
  return volume > 0.0 ? merit : kNoVolume - merit;
}

TetEditor::TetEditor(TetMesh& mesh, int fixed)
    : mesh_(mesh), fixed_(fixed), star_(mesh.nodes.size()) {
  const int count = mesh.element_count();
  std::vector<int> size(mesh.nodes.size(), 0);
  for (const int node : mesh.elements) {
    ++size[node];
  }
  for (std::size_t n = 0; n < size.size(); ++n) {
    star_[n].reserve(static_cast<std::size_t>(size[n]));
  }
  alive_.assign(count, 1);
  merit_.reserve(count);
  for (int e = 0; e < count; ++e) {
    for (const int node : mesh.element(e)) {
      star_[node].push_back(e);
    }
    merit_.push_back(merit_of(nodes(e)));
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    std::array<int, 3> t = {mesh.face(f)[0], mesh.face(f)[1], mesh.face(f)[2]};
    std::sort(t.begin(), t.end());
    surface_faces_.push_back(t);
    surface_edges_.insert(
        surface_edges_.end(),
        {Edge{t[0], t[1]}, Edge{t[1], t[2]}, Edge{t[0], t[2]}});
  }
  std::sort(surface_faces_.begin(), surface_faces_.end());
  std::sort(surface_edges_.begin(), surface_edges_.end());
}

TetNodes TetEditor::nodes(int e) const {
  const auto ids = mesh_.element(e);
  return {ids[0], ids[1], ids[2], ids[3]};
}

TetCorners TetEditor::corners(const TetNodes& nodes) const {
  return {mesh_.nodes[nodes[0]], mesh_.nodes[nodes[1]], mesh_.nodes[nodes[2]],
          mesh_.nodes[nodes[3]]};
}

double TetEditor::merit_of(const TetNodes& nodes) const {
  ++evaluations_;
  return tet_merit(corners(nodes));
}

double TetEditor::star_merit(int node) const {
  double least = 2.0;
  for (const int e : star_[node]) {
    least = std::min(least, merit_[e]);
  }
  return least;
}

double TetEditor::star_merit_at(int node, const Vec3& place,
                                double floor) const {
  const std::vector<int>& star = star_[node];
  const std::size_t first = std::min(last_short_, star.size() - 1);
  double least = 2.0;
  for (std::size_t k = 0; k < star.size(); ++k) {
    const std::size_t i = k == 0 ? first : k - (k <= first ? 1 : 0);
    const TetNodes ids = nodes(star[i]);
    TetCorners x = corners(ids);
    x[std::find(ids.begin(), ids.end(), node) - ids.begin()] = place;
    ++evaluations_;
    least = std::min(least, tet_merit(x));
    if (!(least > floor)) {
      last_short_ = i;
      break;
    }
  }
  return least;
}

void TetEditor::move(int node, const Vec3& place) {
  mesh_.nodes[node] = place;
  for (const int e : star_[node]) {
    merit_[e] = merit_of(nodes(e));
  }
}

bool TetEditor::is_surface_edge(int a, int b) const {
  return std::max(a, b) < fixed_ &&
         std::binary_search(surface_edges_.begin(), surface_edges_.end(),
                            edge_key(a, b));
}

bool TetEditor::is_surface_face(std::array<int, 3> face) const {
  std::sort(face.begin(), face.end());
  return face[2] < fixed_ &&
         std::binary_search(surface_faces_.begin(), surface_faces_.end(), face);
}

std::optional<TetEditor::Ring> TetEditor::ring(int a, int b) const {
  if (is_surface_edge(a, b)) {
    return std::nullopt;
  }
  Ring ring;
  ring.merit = 2.0;
  std::vector<Edge> sides;  // per element: from and to, about a -> b
  for (const int e : star_[a]) {
    const TetNodes ids = nodes(e);
    int i = -1;
    int j = -1;
    for (int k = 0; k < 4; ++k) {
      i = ids[k] == a ? k : i;
      j = ids[k] == b ? k : j;
    }
    if (j < 0) {
      continue;
    }
    ring.elements.push_back(e);
    ring.merit = std::min(ring.merit, merit_[e]);
    // The other two corners k, l so that (i, j, k, l) is an even order.
    static constexpr std::array<std::array<Edge, 4>, 4> kOthers = {
        {{{{0, 0}, {2, 3}, {3, 1}, {1, 2}}},
         {{{3, 2}, {0, 0}, {0, 3}, {2, 0}}},
         {{{1, 3}, {3, 0}, {0, 0}, {0, 1}}},
         {{{2, 1}, {0, 2}, {1, 0}, {0, 0}}}}};
    const Edge& others = kOthers[i][j];
    sides.push_back({ids[others[0]], ids[others[1]]});
  }
  if (sides.size() < 3) {
    return std::nullopt;
  }
  ring.nodes.push_back(sides[0][0]);
  for (std::size_t step = 0; step < sides.size(); ++step) {
    const auto next = std::find_if(
        sides.begin(), sides.end(),
        [&](const Edge& side) { return side[0] == ring.nodes.back(); });
    if (next == sides.end()) {
      return std::nullopt;
    }
    ring.nodes.push_back((*next)[1]);
  }
  if (ring.nodes.back() != ring.nodes.front()) {
    return std::nullopt;
  }
  ring.nodes.pop_back();
  return ring;
}

bool TetEditor::has(std::span<const int> nodes) const {
  return std::ranges::any_of(star_[nodes[0]], [&](int e) {
    const auto ids = mesh_.element(e);
    return std::ranges::all_of(nodes, [&](int node) {
      return std::ranges::find(ids, node) != ids.end();
    });
  });
}

int TetEditor::neighbour(int e, int corner) const {
  const TetNodes ids = nodes(e);
  const auto& face = kTetFaces[corner];
  const std::array<int, 3> ends = {ids[face[0]], ids[face[1]], ids[face[2]]};
  if (is_surface_face(ends)) {
    return -1;
  }
  for (const int other : star_[ends[0]]) {
    const TetNodes there = nodes(other);
    if (other != e &&
        std::find(there.begin(), there.end(), ends[1]) != there.end() &&
        std::find(there.begin(), there.end(), ends[2]) != there.end()) {
      return other;
    }
  }
  return -1;
}

int TetEditor::add_node(const Vec3& place) {
  mesh_.nodes.push_back(place);
  star_.emplace_back();
  return static_cast<int>(mesh_.nodes.size()) - 1;
}

void TetEditor::drop_last_node() {
  mesh_.nodes.pop_back();
  star_.pop_back();
}

void TetEditor::put(int e, const TetNodes& nodes) {
  std::copy(nodes.begin(), nodes.end(),
            mesh_.elements.begin() + 4 * static_cast<std::ptrdiff_t>(e));
  merit_[e] = merit_of(nodes);
  alive_[e] = 1;
  for (const int node : nodes) {
    star_[node].push_back(e);
  }
}

void TetEditor::replace(std::span<const int> old,
                        std::span<const TetNodes> fresh) {
  const int region = mesh_.element_region[old[0]];
  for (const int e : old) {
    for (const int node : nodes(e)) {
      std::erase(star_[node], e);
    }
    alive_[e] = 0;
  }
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    int e = i < old.size() ? old[i] : element_count();
    if (i >= old.size()) {
      mesh_.elements.resize(mesh_.elements.size() + 4);
      mesh_.element_region.push_back(region);
      merit_.push_back(0.0);
      alive_.push_back(1);
    }
    put(e, fresh[i]);
  }
}

void TetEditor::finish() {
  std::size_t kept = 0;
  for (int e = 0; e < element_count(); ++e) {
    if (alive_[e] != 0) {
      const TetNodes ids = nodes(e);
      std::copy(ids.begin(), ids.end(),
                mesh_.elements.begin() + 4 * static_cast<std::ptrdiff_t>(kept));
      mesh_.element_region[kept++] = mesh_.element_region[e];
    }
  }
  mesh_.elements.resize(4 * kept);
  mesh_.element_region.resize(kept);
  mesh_.corner_count = static_cast<int>(mesh_.nodes.size());
}

}  // namespace meniscus::mesh_tet
