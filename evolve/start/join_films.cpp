#include "evolve/start/join_films.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/films/shared_sides.h"
#include "evolve/groom/remesh.h"

namespace meniscus::start {

namespace {

constexpr double kCornerReach = 1e-9;  // x the size
constexpr double kOneEnd = 1e-6;       // of a curve's parameter

double extent_of(const films::FilmComplex& complex) {
  return bounding_diagonal(complex.mesh.points);
}

std::string place_text(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

double off_line(const Points& line, const Vec3& at) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vec3 way = line[k + 1] - line[k];
    const double length2 = way.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((at - line[k]).dot(way) / length2, 0.0, 1.0)
                      : 0.0;
    best = std::min(best, (line[k] + share * way - at).norm());
  }
  return best;
}

int film_number(const films::FilmSystem& system, const std::string& film) {
  const auto at =
      std::find_if(system.films.begin(), system.films.end(),
                   [&](const films::FilmSpec& f) { return f.name == film; });
  if (at == system.films.end()) {
    throw InvalidInput(
        fmt::format("a film joins '{}', which is no film", film));
  }
  return static_cast<int>(at - system.films.begin());
}

}  // namespace

std::map<int, std::vector<double>> cuts_for_joins(
    const films::FilmSystem& system) {
  std::map<int, std::vector<double>> cuts;
  for (const films::JoinEnd& end : films::join_ends(system)) {
    if (end.meets || !end.held) {
      cuts[end.curve].push_back(end.t);
    }
  }
  for (auto& [curve, at] : cuts) {
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end(),
                         [](double a, double b) { return b - a < kOneEnd; }),
             at.end());
  }
  return cuts;
}

FilmJoiner::FilmJoiner(const films::FilmSystem& system, double edge,
                       films::FilmComplex& complex)
    : system_(system),
      edge_(edge),
      complex_(complex),
      sides_(films::joined_sides(system)) {}

void FilmJoiner::refine_joined() {
  std::set<int> labels;
  for (const films::FilmSpec& film : system_.films) {
    for (const std::string& name : film.joins) {
      const int label = film_number(system_, name);
      if (system_.films[static_cast<std::size_t>(label)].joins.empty()) {
        labels.insert(label);
      }
    }
  }
  SurfaceMesh& mesh = complex_.mesh;
  // Films of facets may share vertices off their curves.
  for (bool grows = true; grows;) {
    grows = false;
    std::vector<char> inside(mesh.points.size(), 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      for (const int v : mesh.facets[f]) {
        inside[v] = inside[v] != 0 || (labels.count(mesh.facet_label[f]) > 0 &&
                                       complex_.vertices[v].kind ==
                                           films::VertexKind::Free)
                        ? 1
                        : 0;
      }
    }
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      for (const int v : mesh.facets[f]) {
        grows = (inside[v] != 0 && labels.insert(mesh.facet_label[f]).second) ||
                grows;
      }
    }
  }
  films::FilmComplex part = complex_;
  part.mesh.facets.clear();
  part.mesh.facet_label.clear();
  std::vector<Triangle> others;
  std::vector<int> other_labels;
  std::vector<char> used(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const bool own = labels.count(mesh.facet_label[f]) > 0;
    (own ? part.mesh.facets : others).push_back(mesh.facets[f]);
    (own ? part.mesh.facet_label : other_labels).push_back(mesh.facet_label[f]);
    for (const int v : mesh.facets[f]) {
      used[v] = used[v] != 0 || own ? 1 : 0;
    }
  }
  std::erase_if(part.edges, [&](const films::ComplexEdge& mark) {
    return used[mark.a] == 0 || used[mark.b] == 0;
  });
  std::vector<int> rims;  // held vertices stay, in their order
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] != 0 && complex_.vertices[v].kind != films::VertexKind::Free) {
      rims.push_back(static_cast<int>(v));
    }
  }
  groom::remesh_films(part, {.edge = edge_});
  std::vector<int> number;
  std::size_t next = 0;
  for (std::size_t v = 0; v < part.vertices.size(); ++v) {
    if (part.vertices[v].kind != films::VertexKind::Free) {
      number.push_back(rims.at(next++));
      continue;
    }
    number.push_back(static_cast<int>(mesh.points.size()));
    mesh.points.push_back(part.mesh.points[v]);
    complex_.vertices.push_back(part.vertices[v]);
  }
  mesh.facets = std::move(others);
  mesh.facet_label = std::move(other_labels);
  for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
    const Triangle& t = part.mesh.facets[f];
    mesh.facets.push_back({number[t[0]], number[t[1]], number[t[2]]});
    mesh.facet_label.push_back(part.mesh.facet_label[f]);
  }
}

const FilmJoiner::Net& FilmJoiner::net_of(int label) {
  Net& net = nets_[label];
  const SurfaceMesh& mesh = complex_.mesh;
  bool grew = false;
  for (; net.facets < mesh.facets.size(); ++net.facets) {
    if (mesh.facet_label[net.facets] != label) {
      continue;
    }
    const Triangle& t = mesh.facets[net.facets];
    for (int k = 0; k < 3; ++k) {
      net.next[t[k]].insert({t[(k + 1) % 3], t[(k + 2) % 3]});
    }
    grew = true;
  }
  if (grew) {
    net.vertices.clear();
    for (const auto& [vertex, neighbors] : net.next) {
      net.vertices.push_back(vertex);
    }
  }
  return net;
}

/// -1: none are given.
int FilmJoiner::nearest(const std::vector<int>& vertices,
                        const Vec3& place) const {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const int v : vertices) {
    const double distance = (complex_.mesh.points[v] - place).norm();
    if (distance < least) {
      least = distance;
      best = v;
    }
  }
  return best;
}

/// Of the films that it joins the one along which a side lies.
int FilmJoiner::label_for(int film, const Points& side) {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const std::string& name :
       system_.films[static_cast<std::size_t>(film)].joins) {
    const int label = film_number(system_, name);
    const std::vector<int>& vertices = net_of(label).vertices;
    double sum = 0.0;
    for (const Vec3& p : side) {
      sum += (complex_.mesh.points[nearest(vertices, p)] - p).norm();
    }
    if (sum < least) {
      least = sum;
      best = label;
    }
  }
  return best;
}

/// The vertex of all these films at which a corner of `film` meets them.
int FilmJoiner::corner_on(int film, const Corner& corner,
                          const std::vector<int>& labels) {
  std::vector<int> there = net_of(labels.front()).vertices;
  for (const int label : labels) {
    const std::vector<int>& more = net_of(label).vertices;
    std::erase_if(there, [&](int v) {
      return !std::binary_search(more.begin(), more.end(), v);
    });
  }
  const bool amid = !corner.held && labels.front() == labels.back();
  std::erase_if(there, [&](int v) {
    const bool on_curve =
        complex_.vertices[v].kind == films::VertexKind::OnCurve;
    return amid ? on_curve || taken_[v] != 0 : corner.held && !on_curve;
  });
  const int found = nearest(there, corner.place);
  const std::string& name = system_.films[static_cast<std::size_t>(film)].name;
  const std::string& other = complex_.surfaces[labels.front()].name;
  if (corner.held &&
      (found < 0 ||
       (complex_.mesh.points[found] - corner.place).norm() >
           films::join_reach(system_.curves[static_cast<std::size_t>(
               complex_.vertices[found].curve)]))) {
    throw InvalidInput(fmt::format(
        "film '{}' joins '{}' along a line that ends at {}, where no curve "
        "holds that film; let it end on one of that film's curves or on "
        "another film, and have a corner where it passes from one film to the "
        "next",
        name, other, place_text(corner.place)));
  }
  if (found < 0 && amid) {
    throw NoWayAlong(fmt::format(
        "film '{}' has more corners amid its line on '{}' than there are edges "
        "near {}; take shorter edges, or leave corners out",
        name, other, place_text(corner.place)));
  }
  if (found < 0) {
    throw InvalidInput(fmt::format(
        "film '{}' passes from '{}' to '{}' at {}, and these two meet nowhere; "
        "films that one joins side by side share a curve",
        name, other, complex_.surfaces[labels.back()].name,
        place_text(corner.place)));
  }
  return found;
}

/// The edges of a film from vertex to vertex that are shortest where those off
/// the guess count more (Dijkstra). Both ends are in it.
std::vector<int> FilmJoiner::chain(int film, int label, int from, int to,
                                   const Points& guess) {
  const Points& points = complex_.mesh.points;
  const std::map<int, std::set<int>>& next = net_of(label).next;
  const auto passes = [&](int v) {
    return complex_.vertices[v].kind == films::VertexKind::Free &&
           taken_[v] == 0;
  };
  using Way = std::pair<double, int>;
  std::priority_queue<Way, std::vector<Way>, std::greater<>> queue;
  std::map<int, double> cost;
  std::map<int, int> before;
  queue.push({0.0, from});
  cost[from] = 0.0;
  while (!queue.empty()) {
    const auto [so_far, v] = queue.top();
    queue.pop();
    if (v == to) {
      break;
    }
    if (so_far > cost.at(v)) {
      continue;
    }
    const auto neighbors = next.find(v);
    if (neighbors == next.end()) {
      continue;
    }
    for (const int w : neighbors->second) {
      const bool along_rim =
          complex_.vertices[v].kind == films::VertexKind::OnCurve &&
          complex_.vertices[w].kind == films::VertexKind::OnCurve;
      if ((w != to && !passes(w)) || along_rim) {
        continue;
      }
      const double off = off_line(guess, 0.5 * (points[v] + points[w])) / edge_;
      const double length = (points[w] - points[v]).norm();
      const double total = so_far + length * (1.0 + off * off);
      const auto known = cost.find(w);
      if (known == cost.end() || total < known->second) {
        cost[w] = total;
        before[w] = v;
        queue.push({total, w});
      }
    }
  }
  if (before.count(to) == 0) {
    throw NoWayAlong(fmt::format(
        "film '{}' finds no way along '{}' from {} to {}; take shorter edges, "
        "or let it begin farther from other lines and rims",
        system_.films[static_cast<std::size_t>(film)].name,
        complex_.surfaces[label].name, place_text(points[from]),
        place_text(points[to])));
  }
  std::vector<int> result = {to};
  while (result.back() != from) {
    result.push_back(before.at(result.back()));
  }
  std::reverse(result.begin(), result.end());
  for (const int v : result) {
    taken_[v] = 1;
  }
  return result;
}

/// By way of three vertices, so that it goes around.
std::vector<int> FilmJoiner::closed_chain(int film,
                                          const std::vector<int>& rim) {
  constexpr std::size_t kParts = 3;
  Points guess = points_of(rim);
  guess.push_back(guess.front());
  const int label = label_for(film, guess);
  std::vector<int> inside = net_of(label).vertices;
  std::erase_if(inside, [&](int v) {
    return complex_.vertices[v].kind != films::VertexKind::Free ||
           taken_[v] != 0;
  });
  std::vector<int> stops;
  for (std::size_t k = 0; k < kParts; ++k) {
    stops.push_back(nearest(inside, guess[k * rim.size() / kParts]));
    if (stops.back() >= 0) {
      taken_[stops.back()] = 1;
    }
  }
  if (std::set<int>(stops.begin(), stops.end()).size() < kParts ||
      stops.back() < 0) {
    throw NoWayAlong(fmt::format(
        "film '{}' joins '{}' along a line that is shorter than three edges of "
        "its start, {:.4g} each; take shorter edges",
        system_.films[static_cast<std::size_t>(film)].name,
        complex_.surfaces[label].name, edge_));
  }
  std::vector<int> result;
  for (std::size_t k = 0; k < kParts; ++k) {
    const std::size_t first = k * rim.size() / kParts;
    const std::size_t last = (k + 1) * rim.size() / kParts;
    const std::vector<int> way =
        chain(film, label, stops[k], stops[(k + 1) % kParts],
              Points(guess.begin() + static_cast<std::ptrdiff_t>(first),
                     guess.begin() + static_cast<std::ptrdiff_t>(last) + 1));
    result.insert(result.end(), way.begin(), way.end() - 1);
  }
  return result;
}

void FilmJoiner::replace(int old, int by) {
  if (old == by) {
    return;
  }
  replaced_[old] = by;
  for (Triangle& t : complex_.mesh.facets) {
    std::replace(t.begin(), t.end(), old, by);
  }
  std::erase_if(nets_, [&](const auto& entry) {
    return entry.second.next.count(old) > 0;
  });
  for (films::ComplexEdge& mark : complex_.edges) {
    mark.a = mark.a == old ? by : mark.a;
    mark.b = mark.b == old ? by : mark.b;
  }
}

Points FilmJoiner::points_of(const std::vector<int>& ids) const {
  Points result;
  for (const int v : ids) {
    result.push_back(complex_.mesh.points[v]);
  }
  return result;
}

void FilmJoiner::find_corners(int curve, const std::vector<int>& rim) {
  const std::vector<films::CurveSide> sides =
      films::sides_of(system_.curves[static_cast<std::size_t>(curve)].shape);
  const double reach = kCornerReach * extent_of(complex_);
  std::vector<std::size_t>& corners = corners_[curve];
  if (!corners.empty()) {
    return;  // another of its sides
  }
  for (std::size_t i = 0; i < rim.size() && corners.size() < sides.size();
       ++i) {
    const Vec3& at = complex_.mesh.points[rim[i]];
    if ((at - sides[corners.size()].from).norm() <= reach) {
      corners.push_back(i);
    }
  }
  if (corners.size() < sides.size()) {
    throw InvalidInput(
        fmt::format("curve '{}' has corners closer together than its edges",
                    system_.curves[static_cast<std::size_t>(curve)].name));
  }
}

std::vector<int> FilmJoiner::join_rim(int film, int curve,
                                      const std::vector<int>& rim, bool mark) {
  taken_.resize(complex_.vertices.size(), 0);
  const std::vector<films::CurveSide> sides =
      films::sides_of(system_.curves[static_cast<std::size_t>(curve)].shape);
  const std::size_t n = sides.size();
  std::vector<char> joined(n, 0);
  bool all = false;
  for (const films::JoinedSide& side : sides_) {
    if (side.film == film && side.curve == curve) {
      all = all || side.side < 0;
      if (side.side >= 0) {
        joined[static_cast<std::size_t>(side.side)] = 1;
      }
    }
  }
  if (all) {
    return closed_chain(film, rim);
  }
  if (std::count(joined.begin(), joined.end(), 1) == 0) {
    return rim;
  }
  const std::vector<std::size_t>& corner = corners_.at(curve);
  std::vector<std::vector<int>> along;  // per side: its vertices, both ends
  std::vector<int> label(n, -1);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<int>& ids = along.emplace_back();
    const std::size_t end = k + 1 < n ? corner[k + 1] : rim.size();
    ids.assign(rim.begin() + static_cast<std::ptrdiff_t>(corner[k]),
               rim.begin() + static_cast<std::ptrdiff_t>(end));
    ids.push_back(rim[corner[(k + 1) % n]]);
    label[k] = joined[k] != 0 ? label_for(film, points_of(ids)) : -1;
  }
  const std::vector<char> used(system_.curves.size(), 1);
  const films::FreePlaces free(system_.curves, used);
  std::vector<int> at(n);
  for (std::size_t k = 0; k < n; ++k) {
    const int old = rim[corner[k]];
    at[k] = old;
    std::vector<int> labels;
    for (const int l : {label[(k + n - 1) % n], label[k]}) {
      if (l >= 0) {
        labels.push_back(l);
      }
    }
    if (!labels.empty() && placed_.count(old) == 0) {
      const bool held =
          !free.is_free(curve, static_cast<double>(k) / static_cast<double>(n));
      at[k] = corner_on(film, {complex_.mesh.points[old], held}, labels);
      taken_[at[k]] = 1;
      placed_.insert(at[k]);
      replace(old, at[k]);
    }
  }
  std::vector<int> result;
  for (std::size_t k = 0; k < n; ++k) {
    const int from = at[k];
    const int to = at[(k + 1) % n];
    std::vector<int> way = along[k];
    way.front() = from;
    way.back() = to;
    if (joined[k] != 0) {
      way = chain(film, label[k], from, to, points_of(along[k]));
    } else if (mark) {
      for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        films::ComplexEdge edge;
        edge.a = way[i];
        edge.b = way[i + 1];
        edge.kind = films::VertexKind::OnCurve;
        edge.curve = curve;
        complex_.edges.push_back(edge);
      }
    }
    result.insert(result.end(), way.begin(), way.end() - 1);
  }
  return result;
}

}  // namespace meniscus::start
