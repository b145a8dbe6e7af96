/// First triangles of the faces of solids from CAD programs.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::start {

/// Edges are cut once, into pieces of about the edge length, twelve to a turn
/// at least; faces are filled between them in the plane (evolve/start/
/// unrolled.h), their vertices on the exact surfaces.
class SolidStart {
 public:
  /// Throws InvalidInput where a rim's curve is not there or is off its edges.
  SolidStart(const films::FilmSystem& system, double edge);

  /// By the curve's index: parameters at which rims are cut, vertices of their
  /// solids among them.
  std::map<int, std::vector<double>> take_cuts();

  /// The points of a curve's cuts, in their order.
  using RimIds =
      std::function<const std::vector<int>&(const std::string& curve)>;
  /// Those of all edges, and their marks; once, after the rims' points.
  void add_edges(const RimIds& rim, films::FilmComplex& complex);

  /// The facets of a face, labelled; its surface is complex.surfaces[label].
  /// Throws InvalidInput, naming it, for one that cannot be filled.
  void add_face(const films::CapSpec& cap, int label,
                films::FilmComplex& complex);

 private:
  /// How an edge lies on a rim.
  struct OnRim {
    const films::SolidSpec::Rim* rim = nullptr;
    int curve = -1;
    std::size_t from = 0;  // its ends among the curve's cuts
    std::size_t to = 0;
    bool up = true;  // runs with the curve
  };
  struct Solid {
    std::shared_ptr<const ExactShape> shape;  // where it is
    int frame = -1;                           // of the system's curves
    std::vector<OnRim> on_rim;                // per edge
    std::vector<int> vertex_ids;              // -1: not yet
    std::vector<std::vector<int>> ids;        // per edge, ends included
    std::vector<int> edges;                   // per edge: index in the complex
  };

  /// A loop of a face: its points and where they are on the surface.
  struct FaceLoop {
    std::vector<int> ids;
    std::vector<Vec2> places;
  };

  /// Of each edge of a rim: its ends, and a point a quarter along it.
  Points places_along(std::size_t solid,
                      const films::SolidSpec::Rim& rim) const;
  std::vector<double> nearest_on_rim(const curves::Curve& curve,
                                     const Points& points,
                                     const std::string& solid) const;
  int curve_named(const std::string& name, const std::string& solid) const;
  void cut_rim(std::size_t solid, const films::SolidSpec::Rim& rim);
  void add_rim_edge(std::size_t solid, int edge, const std::vector<int>& rim);
  int vertex_of(std::size_t solid, int edge, bool last,
                films::FilmComplex& complex);
  void add_edge(std::size_t solid, int edge, films::FilmComplex& complex);
  int pieces_of(const ExactEdge& edge) const;
  /// The outer one first.
  std::vector<FaceLoop> loops_of(const films::CapSpec& cap,
                                 const Points& points) const;
  void fill(const films::CapSpec& cap, const std::vector<FaceLoop>& loops,
            int label, films::FilmComplex& complex);

  const films::FilmSystem& system_;
  double edge_;
  std::map<int, std::vector<double>> cuts_;
  std::map<int, std::size_t> cut_counts_;
  std::vector<Solid> solids_;
  std::set<Edge> taken_;  // between vertices on edges
};

}  // namespace meniscus::start
