/// First facets of films that end on others which nobody cut there
/// (films::FilmSpec::joins): a free side of such a film becomes a chain of
/// edges of the film that it joins. Where the line comes to rest is the
/// liquid's affair.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include "core/error.h"
#include "evolve/films/film_complex.h"
#include "evolve/films/joined_sides.h"

namespace meniscus::start {

/// A line finds no edges to run along: shorter ones may have them.
class NoWayAlong : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// By curve of a film that others join: the parameters at which it needs a
/// vertex, where the free sides of these end.
std::map<int, std::vector<double>> cuts_for_joins(
    const films::FilmSystem& system);

class FilmJoiner {
 public:
  /// Keeps references. `edge` [length]: of the films that others join.
  FilmJoiner(const films::FilmSystem& system, double edge,
             films::FilmComplex& complex);

  /// Cuts the facets of the films that others join down to about the edge.
  /// Rims keep their vertices, the others are new and come last.
  void refine_joined();

  /// Before the first join_rim(): where along a curve's vertices its corners
  /// are.
  void find_corners(int curve, const std::vector<int>& rim);

  /// The vertices around a curve of `film`, joined sides run along the films
  /// that they join; `rim`: along the curve as it was. Marks the edges
  /// of its other sides where `mark`. A corner that moves onto another film is
  /// another vertex there: of all facets and marks so far, and of replaced().
  /// Throws InvalidInput, naming film and place, where a side ends amid a film,
  /// NoWayAlong where it finds none.
  std::vector<int> join_rim(int film, int curve, const std::vector<int>& rim,
                            bool mark);

  /// Corners that are other vertices now.
  const std::map<int, int>& replaced() const { return replaced_; }

 private:
  struct Corner {
    Vec3 place;
    bool held = true;
  };
  /// A film's vertices, ascending, and their neighbours along its edges.
  struct Net {
    std::size_t facets = 0;  // of the mesh, so far
    std::map<int, std::set<int>> next;
    std::vector<int> vertices;
  };
  const Net& net_of(int label);
  int nearest(const std::vector<int>& vertices, const Vec3& place) const;
  int label_for(int film, const Points& side);
  int corner_on(int film, const Corner& corner, const std::vector<int>& labels);
  std::vector<int> chain(int film, int label, int from, int to,
                         const Points& guess);
  std::vector<int> closed_chain(int film, const std::vector<int>& rim);
  void replace(int old, int by);
  Points points_of(const std::vector<int>& ids) const;

  const films::FilmSystem& system_;
  double edge_;
  films::FilmComplex& complex_;
  std::vector<films::JoinedSide> sides_;
  std::vector<char> taken_;  // per vertex: on a chain
  std::map<int, Net> nets_;  // by label
  std::map<int, int> replaced_;
  std::set<int> placed_;  // what corners were replaced by
  std::map<int, std::vector<std::size_t>> corners_;  // by curve
};

}  // namespace meniscus::start
