#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "evolve/groom/film_cutter.h"
#include "evolve/groom/pop.h"

namespace meniscus::groom {

namespace {

// New lines lie this far off the old one, x the mean edge of the line: far
// enough to be no needles, near enough not to turn facets.
constexpr double kPull = 0.2;
// ... and at most this far along the films pulled.
constexpr double kLeastHeight = 0.35;

// A line of four or more films: its points in order (the first again at the
// end where it is closed) and per edge its sheets in one and the same order.
struct Chain {
  std::vector<int> points;
  std::vector<std::vector<int>> sheets;  // per edge: facets
  bool closed = false;
};

class EdgePopper {
 public:
  explicit EdgePopper(films::FilmComplex& complex) : cut_(complex) {}

  PopReport run() {
    for (int v = 0; v < static_cast<int>(cut_.points().size()); ++v) {
      for (const int u : cut_.neighbours(v)) {
        pop_at(v, u);
      }
    }
    cut_.tidy();
    return std::move(report_);
  }

 private:
  bool crowded(int a, int b) const { return cut_.along(a, b).size() > 3; }

  // Liquid, and nothing says that it must stay.
  bool may_change(int a, int b) const {
    const std::vector<int> sheets = cut_.along(a, b);
    return !cut_.is_marked(a, b) &&
           std::all_of(sheets.begin(), sheets.end(),
                       [&](int f) { return cut_.is_liquid(f); });
  }

  void pop_at(int v, int u) {
    // Each turn takes one film off the line.
    while (crowded(v, u) && !failed_.contains(edge_key(v, u))) {
      const Chain chain = chain_from(v, u);
      // Halves that are lines of one edge again lie in films that coincide.
      if (chain.points.size() == 2 && may_change(v, u) &&
          !halves_.contains(v) && !halves_.contains(u)) {
        halve(v, u);  // popped when its new point's turn comes
        return;
      }
      if (!pull(chain)) {
        ++report_.refused;
        for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
          failed_.insert(edge_key(chain.points[i], chain.points[i + 1]));
        }
      }
    }
  }

  // The facet of edge v-next in which the sheet of f at edge from-v ends.
  int follow(int f, int from, int v, int next) const {
    int corner = cut_.corner_off(f, from, v);
    for (std::size_t step = 0; step <= cut_.star(v).size(); ++step) {
      if (corner == next) {
        return f;
      }
      const std::vector<int> both = cut_.along(v, corner);
      if (both.size() != 2) {
        return -1;
      }
      f = both[0] == f ? both[1] : both[0];
      corner = cut_.corner_off(f, v, corner);
    }
    return -1;
  }

  // The line's next point after edge from-v, if it goes on as the same line.
  std::optional<int> next_of(int from, int v,
                             const std::vector<int>& sheets) const {
    if (!cut_.is_loose(v)) {
      return {};
    }
    int next = -1;
    for (const int u : cut_.neighbours(v)) {
      if (u != from && cut_.along(v, u).size() != 2) {
        if (next >= 0) {
          return {};
        }
        next = u;
      }
    }
    if (next < 0 || cut_.along(v, next).size() != sheets.size()) {
      return {};
    }
    for (const int f : sheets) {
      if (follow(f, from, v, next) < 0) {
        return {};
      }
    }
    return next;
  }

  // Around the axis a-b counter-clockwise, seen from b.
  std::vector<int> in_order(int a, int b) const {
    std::vector<int> sheets = cut_.along(a, b);
    std::map<int, double> angle;
    for (const int f : sheets) {
      angle[f] = angle_of(f, a, b, sheets[0]);
    }
    std::stable_sort(sheets.begin(), sheets.end(),
                     [&](int f, int g) { return angle[f] < angle[g]; });
    return sheets;
  }

  Vec3 out_of(int f, int a, int b) const {
    const Vec3 axis = (cut_.points()[b] - cut_.points()[a]).normalized();
    const Vec3 out = cut_.points()[cut_.corner_off(f, a, b)] - cut_.points()[a];
    return out - axis.dot(out) * axis;
  }

  // From sheet `zero` to f [0, 2 pi).
  double angle_of(int f, int a, int b, int zero) const {
    const Vec3 axis = (cut_.points()[b] - cut_.points()[a]).normalized();
    const Vec3 x = out_of(zero, a, b);
    const Vec3 p = out_of(f, a, b);
    const double angle = std::atan2(axis.dot(x.cross(p)), x.dot(p));
    return f == zero ? 0.0
                     : (angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle);
  }

  void extend(Chain& chain) const {
    while (true) {
      const int from = chain.points[chain.points.size() - 2];
      const int v = chain.points.back();
      const std::vector<int>& sheets = chain.sheets.back();
      const std::optional<int> next = next_of(from, v, sheets);
      if (!next) {
        return;
      }
      std::vector<int> on;
      on.reserve(sheets.size());
      for (const int f : sheets) {
        on.push_back(follow(f, from, v, *next));
      }
      if (v == chain.points.front()) {
        // All around: it must come back with the same sheets.
        chain.closed = on == chain.sheets.front();
        return;
      }
      if (std::count(chain.points.begin(), chain.points.end(), v) > 1) {
        return;  // a loop that the line runs into, where films coincide
      }
      chain.points.push_back(*next);
      chain.sheets.push_back(std::move(on));
    }
  }

  Chain chain_from(int a, int b) const {
    Chain chain;
    chain.points = {a, b};
    chain.sheets = {in_order(a, b)};
    extend(chain);
    if (chain.points.front() == chain.points.back()) {
      return chain;
    }
    std::reverse(chain.points.begin(), chain.points.end());
    std::reverse(chain.sheets.begin(), chain.sheets.end());
    extend(chain);
    std::reverse(chain.points.begin(), chain.points.end());
    std::reverse(chain.sheets.begin(), chain.sheets.end());
    return chain;
  }

  // A line of one edge gets a point that can be doubled.
  void halve(int a, int b) {
    const int m = cut_.add_vertex(0.5 * (cut_.points()[a] + cut_.points()[b]));
    halves_.insert(m);
    for (const int f : cut_.along(a, b)) {
      Triangle other = cut_.facet(f);
      std::replace(other.begin(), other.end(), a, m);
      cut_.replace(f, b, m);
      cut_.add_facet(other, cut_.label(f));
    }
  }

  // The sheet that, with the one after it, is pulled off: mean angle smallest.
  std::size_t best_sheet(const Chain& chain) const {
    const std::size_t count = chain.sheets[0].size();
    std::vector<double> sum(count, 0.0);
    for (std::size_t e = 0; e < chain.sheets.size(); ++e) {
      const int a = chain.points[e];
      const int b = chain.points[e + 1];
      const double length = (cut_.points()[a] - cut_.points()[b]).norm();
      for (std::size_t i = 0; i < count; ++i) {
        sum[i] += length * angle_of(chain.sheets[e][(i + 1) % count], a, b,
                                    chain.sheets[e][i]);
      }
    }
    return std::min_element(sum.begin(), sum.end()) - sum.begin();
  }

  // Where point j of the chain is pulled to.
  Vec3 pulled(const Chain& chain, std::size_t j, std::size_t one,
              std::size_t two) const {
    const std::size_t edges = chain.sheets.size();
    Vec3 way = Vec3::Zero();
    double length = 0.0;
    double height = 1e300;
    for (const std::size_t e : {(j + edges - 1) % edges, j % edges}) {
      const int a = chain.points[e];
      const int b = chain.points[e + 1];
      for (const std::size_t i : {one, two}) {
        const Vec3 out = out_of(chain.sheets[e][i], a, b);
        way += out.normalized();
        height = std::min(height, out.norm());
      }
      length += 0.5 * (cut_.points()[a] - cut_.points()[b]).norm();
    }
    const double step = std::min(kPull * length, kLeastHeight * height);
    return cut_.points()[chain.points[j]] +
           (way.norm() > 1e-9 ? Vec3(step * way.normalized()) : Vec3::Zero());
  }

  bool pull(const Chain& chain) {
    const std::size_t edges = chain.sheets.size();
    const bool ring = chain.closed;
    if (edges < (ring ? 3U : 2U)) {
      return false;
    }
    for (std::size_t e = 0; e < edges; ++e) {
      if (!may_change(chain.points[e], chain.points[e + 1])) {
        return false;
      }
    }
    const std::size_t count = chain.sheets[0].size();
    const std::size_t one = best_sheet(chain);
    const std::size_t two = (one + 1) % count;
    const int film = new_film(chain, one, two);
    // Its fans around the points that are doubled, before anything changes.
    std::vector<int> twin = chain.points;
    std::vector<std::pair<int, std::array<int, 2>>> moves;
    for (std::size_t j = ring ? 0 : 1; j < edges; ++j) {
      const int v = chain.points[j];
      twin[j] = cut_.add_vertex(pulled(chain, j, one, two));
      const std::size_t before = (j + edges - 1) % edges;
      for (const std::size_t i : {one, two}) {
        for (const int f : fan(chain.sheets[before][i], chain.points[before], v,
                               chain.points[j + 1])) {
          moves.push_back({f, {v, twin[j]}});
        }
      }
    }
    if (ring) {
      twin.back() = twin.front();
    }
    for (const auto& [f, change] : moves) {
      cut_.replace(f, change[0], change[1]);
    }
    for (std::size_t e = 0; e < edges; ++e) {
      const int a = chain.points[e];
      const int b = chain.points[e + 1];
      if (twin[e + 1] != b) {
        cut_.add_facet({a, b, twin[e + 1]}, film);
      }
      if (twin[e] != a) {
        cut_.add_facet({a, twin[e + 1], twin[e]}, film);
      }
    }
    ++report_.popped;
    report_.places.push_back(cut_.points()[chain.points[edges / 2]]);
    return true;
  }

  std::vector<int> fan(int f, int from, int v, int next) const {
    std::vector<int> result = {f};
    int corner = cut_.corner_off(f, from, v);
    while (corner != next) {
      const std::vector<int> both = cut_.along(v, corner);
      f = both[0] == f ? both[1] : both[0];
      corner = cut_.corner_off(f, v, corner);
      result.push_back(f);
    }
    return result;
  }

  // Its normal (edge x way of the pull) points to the films after `two`.
  int new_film(const Chain& chain, std::size_t one, std::size_t two) {
    const int a = chain.points[0];
    const int b = chain.points[1];
    const auto faces_on = [&](int f) {  // normal turns as the angle grows
      const Vec3 axis = cut_.points()[b] - cut_.points()[a];
      return area_vector2(cut_.complex().mesh, f)
                 .dot(axis.cross(out_of(f, a, b))) > 0.0;
    };
    using Side = FilmCutter::Side;
    const int last = chain.sheets[0][two];
    const int first = chain.sheets[0][one];
    const int ahead =
        cut_.body_at(last, faces_on(last) ? Side::Ahead : Side::Behind);
    const int behind =
        cut_.body_at(first, faces_on(first) ? Side::Behind : Side::Ahead);
    return cut_.add_surface(cut_.label(first), ahead, behind);
  }

  FilmCutter cut_;
  PopReport report_;
  std::set<Edge> failed_;
  std::set<int> halves_;  // the points that halve() made
};

}  // namespace

PopReport pop_edges(films::FilmComplex& complex) {
  return EdgePopper(complex).run();
}

}  // namespace meniscus::groom
