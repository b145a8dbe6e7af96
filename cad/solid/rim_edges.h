/// A rim as edges of a solid, cut where faces on either side have corners. Rims
/// of several lines share pieces: a piece of one is a piece of another, and the
/// edges there are the same.
#pragma once

#include <vector>

#include "cad/solid/brep.h"
#include "cad/solid/rim_curve.h"

namespace meniscus::solid {

class RimEdges {
 public:
  explicit RimEdges(const RimCurve& curve)
      : curve_(&curve), owners_(curve.piece_count()) {}

  /// The piece k is the owner's own piece, run the other way where `reversed`.
  /// Before any wish; the owner stays where it is, and is built before this
  /// rim.
  void share(int k, RimEdges& owner, int piece, bool reversed);
  /// Asks for a vertex at place s of the curve.
  void want(double s);
  /// The same; it becomes no other vertex.
  void want_exactly(double s);
  /// Adds vertices and edges; wishes within `tolerance` [length] of each other
  /// or of where pieces meet become one vertex. Corners of rims that share
  /// sides are one vertex within `same` [length].
  void build(double tolerance, Brep& brep, double same = 0.0);

  /// The place of the vertex that a wish became.
  double place(double s) const { return places_[index_of(s)]; }
  int vertex(double s) const { return vertices_[index_of(s)]; }

  /// Part of the way between two vertices. `first`, `last`: shares of the way
  /// at the edge's own first and last.
  struct Step {
    int edge = 0;
    bool forward = true;
    double first = 0.0;
    double last = 1.0;
  };
  /// The edges on the way from one vertex to another, around the whole rim
  /// where they are one.
  std::vector<Step> between(double from, double to, bool growing) const;
  /// Length of that way.
  double way(double from, double to, bool growing) const;
  const RimCurve& curve() const { return *curve_; }

 private:
  /// Whose edges a piece has: none, its own.
  struct Owner {
    RimEdges* rim = nullptr;
    int piece = -1;
    bool reversed = false;
  };
  struct Part {
    int edge = -1;
    bool along = true;  // the edge runs along growing s
  };

  int index_of(double s) const;
  double at_owner(int k, double s) const;
  void add_owners_places(int k);
  double end_of(std::size_t k) const;
  void set_places(double tolerance);
  void take_parts(const Brep& brep);
  int corner(double s, const Brep& brep, double same) const;

  const RimCurve* curve_;
  std::vector<Owner> owners_;  // one per piece
  bool shares_ = false;        // sides of it, with others either way
  std::vector<double> wanted_;
  std::vector<double> exact_;
  std::vector<double> places_;  // rising
  std::vector<int> vertices_;
  std::vector<Part> parts_;  // from each place to the next
};

}  // namespace meniscus::solid
