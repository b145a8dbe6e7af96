/// Internal to fe_script: the film that commands work on.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "core/monitor.h"
#include "evolve/fe_complex.h"

namespace meniscus {

class FeSession {
 public:
  FeSession(const FeFile& file, const std::map<std::string, double>& parameters,
            Monitor* monitor);

  enum class Kind { Vertex, Edge, Facet, Body };
  using Filter = std::function<bool(int)>;  // of an element's index

  // Commands of one letter or word.
  void descend_steps(int count);
  void newton_step();
  void refine_all();
  void refine_edges(const Filter& chosen);
  void flip();
  void average();
  void remove_tiny(double length);
  void pop_all();
  void toggle_conjugate() { conjugate_ = !conjugate_; }
  void conjugate(bool on) { conjugate_ = on; }
  void gravity(double constant);

  // Values.
  bool has_name(const std::string& name) const;
  double value(const std::string& name) const;
  void assign(const std::string& name, double value);
  int count(Kind kind) const;
  /// False where the element has no such attribute.
  bool attribute(Kind kind, int index, const std::string& name, int number,
                 double& result) const;
  bool set_attribute(Kind kind, int index, const std::string& name,
                     double value);
  /// constraint, boundary, fixed; `on` false takes it away.
  bool mark(Kind kind, int index, const std::string& name, int number, bool on);
  int body_of(int id) const;  // index, or -1

  const FilmComplex& complex() const { return complex_; }
  int iterations() const { return iterations_; }

 private:
  void changed();
  const std::vector<Edge>& edges() const;
  int mark_of(int edge) const;  // into complex_.edges, or -1
  int split_surface(int surface, double tension);

  const FeFile& file_;
  FilmComplex complex_;
  std::map<std::string, double> parameters_;
  std::map<std::string, double> variables_;
  std::vector<double> pressure_;  // one per functional
  bool conjugate_ = false;
  int iterations_ = 0;
  Monitor* monitor_;
  mutable std::vector<Edge> edges_;
  mutable std::vector<int> edge_mark_;
};

}  // namespace meniscus
