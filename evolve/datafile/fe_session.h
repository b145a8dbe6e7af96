/// Internal to fe_script: the film that commands work on.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/monitor.h"
#include "evolve/datafile/fe_complex.h"

namespace meniscus::datafile {

enum class FeKind { Vertices, Edges, Facets, Bodies };

/// An element at hand; index from 0.
struct FeElementRef {
  FeKind kind = FeKind::Vertices;
  int index = -1;
};

class FeSession {
 public:
  FeSession(const FeFile& file, const std::map<std::string, double>& parameters,
            Monitor* monitor);

  using Filter = std::function<bool(int)>;  // of an element's index

  void descend_steps(int count);
  void newton_step();
  void refine_all();
  void refine_edges(const Filter& chosen);
  void flip();
  void average();
  int remove_tiny(double length);
  void pop_all();
  void conjugate(bool on) { conjugate_ = on; }
  bool is_conjugate() const { return conjugate_; }
  void gravity(double constant);
  /// The parameters' values act: formulas anew, vertices back on their walls.
  void recalculate_all();

  /// A parameter, a variable or a figure of the film, in lower case.
  std::optional<double> value(const std::string& name) const;
  void assign(const std::string& name, double value);
  /// value, target or pressure of a quantity.
  std::optional<double> quantity(const std::string& name,
                                 const std::string& attribute) const;

  int count(FeKind kind) const;
  /// Nothing where such elements have no such attribute; `number` is that of
  /// the constraint or boundary in on_constraint, on_boundary.
  std::optional<double> attribute(const FeElementRef& element,
                                  const std::string& name, int number) const;
  /// False where it cannot be set.
  bool set_attribute(const FeElementRef& element, const std::string& name,
                     double value);
  bool fix(const FeElementRef& element);
  bool unfix(const FeElementRef& element);
  /// `what`: constraint or boundary.
  bool release(const FeElementRef& element, const std::string& what,
               int number);
  /// By the number in the file; nothing where there is none.
  std::optional<FeElementRef> element(FeKind kind, int id) const;

  const films::FilmComplex& complex() const { return complex_; }
  int iterations() const { return iterations_; }

 private:
  void changed();
  const std::vector<Edge>& edges() const;
  int mark_of(int edge) const;  // into complex_.edges, or -1
  bool on_wall(int set, int number) const;
  bool on_curve(int curve, int number) const;
  std::optional<double> vertex_attribute(int v, const std::string& name,
                                         int number) const;
  std::optional<double> edge_attribute(int e, const std::string& name,
                                       int number) const;
  std::optional<double> facet_attribute(int f, const std::string& name) const;
  std::optional<double> body_attribute(int b, const std::string& name) const;
  int surface_with_tension(int surface, double tension);
  void release_vertex(int v, const std::string& what, int number);
  void release_edge(int e, const std::string& what);

  const FeFile& file_;
  films::FilmComplex complex_;
  std::map<std::string, double> parameters_;
  std::map<std::string, double> variables_;
  std::vector<double> pressure_;  // one per functional
  bool conjugate_ = false;
  int iterations_ = 0;
  Monitor* monitor_;
  mutable std::vector<Edge> edges_;
  mutable std::vector<int> edge_mark_;
};

}  // namespace meniscus::datafile
