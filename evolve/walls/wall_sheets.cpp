#include "evolve/walls/wall_sheets.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"

namespace meniscus::walls {

namespace {

std::string text_of_point(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

class Sheets {
 public:
  Sheets(const WallTopology& topology, const WallFilms& films)
      : topology_(topology), films_(films) {}

  std::vector<SheetFacets> cut() {
    const auto count = static_cast<int>(topology_.facets.size());
    const FacetsAboutEdges users = facets_about_edges(topology_.facets);
    std::vector<int> turned(topology_.facets.size(), -1);  // 0, 1 when known
    std::vector<SheetFacets> sheets;
    for (int first = 0; first < count; ++first) {
      if (turned[first] >= 0) {
        continue;
      }
      turned[first] = 0;
      std::vector<int> open = {first};
      for (std::size_t at = 0; at < open.size(); ++at) {
        spread(open[at], users, turned, open);
      }
      std::sort(open.begin(), open.end());
      SheetFacets sheet{.facets = std::move(open), .flipped = {}};
      for (const int f : sheet.facets) {
        sheet.flipped.push_back(static_cast<char>(turned[f]));
      }
      sheets.push_back(std::move(sheet));
    }
    return sheets;
  }

 private:
  Edge edge(int f, int k) const {
    const Triangle& t = topology_.facets[f].film;
    return edge_key(t[k], t[(k + 1) % 3]);
  }

  bool forward(int f, const Edge& e) const {
    const Triangle& t = topology_.facets[f].film;
    for (int k = 0; k < 3; ++k) {
      if (t[k] == e[0] && t[(k + 1) % 3] == e[1]) {
        return true;
      }
    }
    return false;
  }

  void spread(int f, const FacetsAboutEdges& users, std::vector<int>& turned,
              std::vector<int>& open) const {
    for (int k = 0; k < 3; ++k) {
      const Edge e = edge(f, k);
      const std::vector<int>& there = users.at(e);
      if (there.size() != 2 || is_junction(topology_.facets, there)) {
        continue;
      }
      const int g = there[0] == f ? there[1] : there[0];
      const int turn =
          forward(f, e) == forward(g, e) ? 1 - turned[f] : turned[f];
      if (turned[g] < 0) {
        turned[g] = turn;
        open.push_back(g);
      } else if (turned[g] != turn) {
        const WallFacet& facet = topology_.facets[f];
        throw MeshError(fmt::format(
            "wall: film \"{}\" has one side only (a Moebius band) near {}; it "
            "has no thickness",
            films_.mesh.labels[facet.label],
            text_of_point(films_.mesh.points[facet.film[0]])));
      }
    }
  }

  const WallTopology& topology_;
  const WallFilms& films_;
};

}  // namespace

std::vector<SheetFacets> cut_into_sheets(const WallTopology& topology,
                                         const WallFilms& films) {
  return Sheets(topology, films).cut();
}

}  // namespace meniscus::walls
