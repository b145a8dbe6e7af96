/// A rim as edges of a solid, cut where faces on either side have corners.
#pragma once

#include <vector>

#include "cad/solid/brep.h"
#include "cad/solid/rim_curve.h"

namespace meniscus::solid {

class RimEdges {
 public:
  explicit RimEdges(const RimCurve& curve) : curve_(&curve) {}

  /// Asks for a vertex at place s of the curve.
  void want(double s) { wanted_.push_back(s); }
  /// The same; it becomes no other vertex.
  void want_exactly(double s) { exact_.push_back(s); }
  /// Adds vertices and edges; wishes within `tolerance` [length] of each other
  /// or of where pieces meet become one vertex.
  void build(double tolerance, Brep& brep);

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
  int index_of(double s) const;

  const RimCurve* curve_;
  std::vector<double> wanted_;
  std::vector<double> exact_;
  std::vector<double> places_;  // rising
  std::vector<int> vertices_;
  std::vector<int> edges_;  // from each place to the next
};

}  // namespace meniscus::solid
