#include "evolve/groom/surface_editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/union_find.h"

namespace meniscus::groom {

double EdgeTarget::field_at(const Vec3& place) const {
  const double value = field(place);
  if (!(std::isfinite(value) && value > 0.0)) {
    throw InvalidInput(fmt::format(
        "the edge length wanted at ({:.6g}, {:.6g}, {:.6g}) is {}; it must be "
        "above 0 everywhere on the films",
        place.x(), place.y(), place.z(), value));
  }
  return value;
}

SurfaceEditor::SurfaceEditor(films::FilmComplex complex)
    : complex_(std::move(complex)),
      mesh_(std::move(complex_.mesh)),
      frozen_(mesh_.facets.size(), 0),
      changed_(mesh_.points.size(), 1),
      lines_(mesh_.points.size()),
      star_(mesh_.points.size()) {
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    const films::ComplexSurface& surface =
        complex_.surfaces[mesh_.facet_label[f]];
    frozen_[f] = surface.liquid && surface.refine ? 0 : 1;
    for (const int v : mesh_.facets[f]) {
      star_[v].push_back(f);
    }
  }
  find_lines();
  rank_vertices();
}

void SurfaceEditor::find_lines() {
  const films::EdgeMarks marks(complex_);
  marks_ = marks.all();
  old_marks_ = complex_.edges.size();
  old_and_rim_marks_ = marks_.size();
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh_.facets, edges, facet_edges);
  // Per edge: its facets, the balance of their senses, how many are frozen, and
  // whether surfaces differ.
  struct Use {
    int facets = 0;
    int balance = 0;
    int frozen = 0;
    int label = -1;
    bool mixed = false;
  };
  std::vector<Use> uses(edges.size());
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    const int label = mesh_.facet_label[f];
    for (int k = 0; k < 3; ++k) {
      const int e = facet_edges[f][k];
      Use& use = uses[e];
      use.mixed = use.mixed || (use.facets > 0 && use.label != label);
      use.label = label;
      use.frozen += frozen_[f];
      use.balance += mesh_.facets[f][k] == edges[e][0] ? 1 : -1;
      ++use.facets;
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    const Use& use = uses[e];
    const int mark = marks.find(a, b);
    // An edge inside a film has two facets of one surface, one each way. What
    // is neither that nor wholly frozen is a line, which editing keeps.
    const bool inside = use.facets == 2 && !use.mixed && use.balance == 0;
    if (use.frozen == use.facets || (inside && mark < 0 && use.frozen == 0)) {
      continue;
    }
    // Lines move where films meet or a mark lets them, and nothing beside them
    // is frozen.
    const bool liquid =
        mark < 0 ? use.facets > 2 || use.mixed
                 : marks_[mark].refine &&
                       (marks_[mark].kind == films::VertexKind::Free ||
                        marks_[mark].kind == films::VertexKind::Slides);
    const bool moves = liquid && use.frozen == 0;
    lines_[a].push_back({b, mark, moves});
    lines_[b].push_back({a, mark, moves});
  }
}

void SurfaceEditor::rank_vertices() {
  rank_.resize(mesh_.points.size());
  for (int v = 0; v < static_cast<int>(rank_.size()); ++v) {
    rank_[v] = rank_of(v);
  }
  for (const films::ComplexEdge& mark : marks_) {
    if (line(mark.a, mark.b) == nullptr) {  // a wire, or on solid facets
      rank_[mark.a] = Rank::Held;
      rank_[mark.b] = Rank::Held;
    }
  }
}

SurfaceEditor::Rank SurfaceEditor::rank_of(int v) const {
  const films::ComplexVertex& vertex = complex_.vertices[v];
  const bool slides = vertex.kind == films::VertexKind::Slides;
  const auto is_frozen = [&](int f) { return frozen_[f] != 0; };
  if ((vertex.kind != films::VertexKind::Free && !slides) ||
      std::any_of(star_[v].begin(), star_[v].end(), is_frozen) ||
      !link_is_connected(v)) {
    return Rank::Held;
  }
  if (lines_[v].empty()) {
    return slides ? Rank::Held
                  : (vertex.constraints >= 0 ? Rank::Wall : Rank::Film);
  }
  return lines_[v].size() == 2 && same_line(v) ? Rank::Line : Rank::Held;
}

// True when the two line edges at the vertex belong to one liquid line, and
// the vertex may go along it.
bool SurfaceEditor::same_line(int v) const {
  const LineEnd& one = lines_[v][0];
  const LineEnd& two = lines_[v][1];
  if (!one.moves || !two.moves || (one.mark < 0) != (two.mark < 0)) {
    return false;
  }
  const films::ComplexVertex& vertex = complex_.vertices[v];
  if (one.mark < 0) {
    if (vertex.kind != films::VertexKind::Free || vertex.constraints >= 0) {
      return false;
    }
  } else {
    const films::ComplexEdge& p = marks_[one.mark];
    const films::ComplexEdge& q = marks_[two.mark];
    const bool through = (p.b == v) == (q.a == v);
    if (p.kind != q.kind || p.curve != q.curve ||
        p.constraints != q.constraints || p.integrals != q.integrals ||
        (p.integrals >= 0 && !through) || vertex.kind != p.kind ||
        (p.kind == films::VertexKind::Slides
             ? vertex.curve != p.curve
             : vertex.constraints != p.constraints)) {
      return false;
    }
  }
  return labels_along(v, one.to) == labels_along(v, two.to);
}

std::vector<int> SurfaceEditor::labels_along(int a, int b) const {
  std::vector<int> labels;
  for (const int f : star_[a]) {
    const Triangle& t = mesh_.facets[f];
    if (t[0] == b || t[1] == b || t[2] == b) {
      labels.push_back(mesh_.facet_label[f]);
    }
  }
  std::sort(labels.begin(), labels.end());
  return labels;
}

// False where sheets meet in the vertex only.
bool SurfaceEditor::link_is_connected(int v) const {
  const auto& star = star_[v];
  const int count = static_cast<int>(star.size());
  std::vector<std::pair<int, int>> corners;  // neighbour, position in star
  corners.reserve(2 * star.size());
  for (int i = 0; i < count; ++i) {
    for (const int u : mesh_.facets[star[i]]) {
      if (u != v) {
        corners.emplace_back(u, i);
      }
    }
  }
  std::sort(corners.begin(), corners.end());
  UnionFind sheets(star.size());
  int parts = count;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (corners[i].first == corners[i - 1].first &&
        sheets.join(corners[i].second, corners[i - 1].second)) {
      --parts;
    }
  }
  return parts == 1;
}

bool SurfaceEditor::has_edge(int a, int b) const {
  const bool turn = star_[b].size() < star_[a].size();
  const auto& star = star_[turn ? b : a];
  const int end = turn ? a : b;
  return std::any_of(star.begin(), star.end(), [&](int f) {
    const Triangle& t = mesh_.facets[f];
    return t[0] == end || t[1] == end || t[2] == end;
  });
}

bool SurfaceEditor::has_facet(int a, int b, int c) const {
  return std::any_of(star_[a].begin(), star_[a].end(), [&](int f) {
    const Triangle& t = mesh_.facets[f];
    return (t[0] == b || t[1] == b || t[2] == b) &&
           (t[0] == c || t[1] == c || t[2] == c);
  });
}

const SurfaceEditor::LineEnd* SurfaceEditor::line(int a, int b) const {
  for (const LineEnd& end : lines_[a]) {
    if (end.to == b) {
      return &end;
    }
  }
  return nullptr;
}

SurfaceEditor::LineEnd& SurfaceEditor::line_end(int from, int to) {
  return *std::find_if(lines_[from].begin(), lines_[from].end(),
                       [&](const LineEnd& end) { return end.to == to; });
}

// Finds the facets along the edge; false when there are none or the edge must
// stay as it is.
bool SurfaceEditor::gather(int a, int b) {
  wings_.clear();
  const bool turn = star_[b].size() < star_[a].size();
  const int end = turn ? a : b;
  for (const int f : star_[turn ? b : a]) {
    const Triangle& t = mesh_.facets[f];
    if (t[0] != end && t[1] != end && t[2] != end) {
      continue;
    }
    if (frozen_[f] != 0) {
      return false;
    }
    const auto off = [&](int v) { return v != a && v != b; };
    wings_.push_back({f, *std::find_if(t.begin(), t.end(), off)});
  }
  if (wings_.empty()) {
    return false;
  }
  const LineEnd* on = line(a, b);
  return on == nullptr || on->moves;
}

// The vertex in the middle of an edge, as split and collapse make it.
films::PlacedVertex SurfaceEditor::middle(int a, int b,
                                          const LineEnd* on) const {
  if (on != nullptr && on->mark >= 0) {
    return films::born_on(complex_, marks_[on->mark], placed(a), placed(b));
  }
  films::PlacedVertex made;
  made.place = 0.5 * (mesh_.points[a] + mesh_.points[b]);
  return made;
}

void SurfaceEditor::replace_corner(int facet, int from, int to) {
  for (int& v : mesh_.facets[facet]) {
    if (v == from) {
      v = to;
    }
  }
}

void SurfaceEditor::drop_from_star(int vertex, int facet) {
  auto& star = star_[vertex];
  star.erase(std::find(star.begin(), star.end(), facet));
}

void SurfaceEditor::add_facet(const Triangle& corners, int label) {
  const int id = static_cast<int>(mesh_.facets.size());
  mesh_.facets.push_back(corners);
  mesh_.facet_label.push_back(label);
  frozen_.push_back(0);
  for (const int v : corners) {
    star_[v].push_back(id);
  }
}

int SurfaceEditor::add_vertex(const films::PlacedVertex& made, Rank rank) {
  const int v = static_cast<int>(mesh_.points.size());
  mesh_.points.push_back(made.place);
  complex_.vertices.push_back(made.vertex);
  changed_.push_back(1);
  rank_.push_back(rank);
  star_.emplace_back();
  lines_.emplace_back();
  return v;
}

double SurfaceEditor::ratio(int a, int b, const EdgeTarget& target) const {
  const Vec3& p = mesh_.points[a];
  const Vec3& q = mesh_.points[b];
  return (p - q).norm() / target.at(0.5 * (p + q));
}

films::FilmComplex SurfaceEditor::finish() && {
  // Vertices live while they have facets or marks; marks that only described
  // the old rim are not given back.
  std::vector<int> number(mesh_.points.size(), -1);
  for (std::size_t v = 0; v < number.size(); ++v) {
    number[v] = star_[v].empty() ? -1 : 0;
  }
  std::vector<films::ComplexEdge> edges;
  for (std::size_t m = 0; m < marks_.size(); ++m) {
    const bool rim = m >= old_marks_ && m < old_and_rim_marks_;
    if (!rim && marks_[m].a >= 0) {
      edges.push_back(marks_[m]);
      number[marks_[m].a] = 0;
      number[marks_[m].b] = 0;
    }
  }
  // Survivors keep their order, so a numbering of old points stays monotone.
  int count = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) {
      mesh_.points[count] = mesh_.points[v];
      complex_.vertices[count] = complex_.vertices[v];
      number[v] = count++;
    }
  }
  mesh_.points.resize(count);
  complex_.vertices.resize(count);
  for (films::ComplexEdge& edge : edges) {
    edge.a = number[edge.a];
    edge.b = number[edge.b];
  }
  complex_.edges = std::move(edges);
  // Collapsed facets drop out.
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
    const Triangle& t = mesh_.facets[f];
    if (t[0] >= 0) {
      mesh_.facets[kept] = {number[t[0]], number[t[1]], number[t[2]]};
      mesh_.facet_label[kept++] = mesh_.facet_label[f];
    }
  }
  mesh_.facets.resize(kept);
  mesh_.facet_label.resize(kept);
  complex_.mesh = std::move(mesh_);
  return std::move(complex_);
}

}  // namespace meniscus::groom
