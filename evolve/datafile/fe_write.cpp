#include "evolve/datafile/fe_write.h"

#include <algorithm>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/curves/curve.h"
#include "evolve/datafile/fe_expression.h"
#include "evolve/datafile/fe_integral_places.h"

namespace meniscus::datafile {

namespace {

constexpr double kTwoPi = 2.0 * 3.14159265358979323846;

class FeWriter {
 public:
  FeWriter(const films::FilmComplex& complex,
           const std::vector<std::string>& comments)
      : complex_(complex), places_(complex) {
    if (comments.empty()) {
      add("// written by Meniscus\n");
    }
    for (const std::string& line : comments) {
      add("// {}\n", one_line(line));
    }
  }

  std::string write() {
    number_edges();
    top();
    for (std::size_t c = 0; c < complex_.curves.size(); ++c) {
      if (fe_is_boundary(complex_, static_cast<int>(c))) {
        curve(static_cast<int>(c));
      }
    }
    for (std::size_t k = 0; k < complex_.level_sets.size(); ++k) {
      level_set(static_cast<int>(k));
    }
    for (const auto& [key, number] : places_.carriers) {
      const auto [level, set] = key;
      add("\nconstraint {}  // carries integrals\nformula: {}\n", number,
          level < 0 ? "0" : text(complex_.level_sets[level].formula));
      integral_set(set, Sign::Same);
    }
    for (std::size_t q = 0; q < complex_.quantities.size(); ++q) {
      quantity(static_cast<int>(q));
    }
    for (std::size_t s = 0; s < complex_.surfaces.size(); ++s) {
      const films::ComplexSurface& surface = complex_.surfaces[s];
      if (has_integral(surface)) {
        add("quantity tension_of_surface_{} energy method {}\n"
            "scalar_integrand: ({}){}\n",
            s + 1,
            surface.drop_shape.empty() ? "facet_scalar_integral"
                                       : "facet_general_integral",
            surface.tension_field ? text(with_numbers(*surface.tension_field))
                                  : fmt::format("{}", surface.tension),
            support(surface.drop_shape));
      }
    }
    elements();
    return std::move(out_);
  }

 private:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format,
                   std::forward<Arguments>(arguments)...);
  }

  static std::string text(const Expression& expression) {
    return fe_expression_text(expression);
  }

  // Marked edges first keep their own direction.
  void number_edges() {
    list_edges(complex_.mesh.facets, edges_, facet_edges_);
    std::map<Edge, int> number;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      number[edges_[e]] = static_cast<int>(e);
    }
    mark_.assign(edges_.size(), -1);
    for (std::size_t m = 0; m < complex_.edges.size(); ++m) {
      const films::ComplexEdge& edge = complex_.edges[m];
      const auto found = number.find(edge_key(edge.a, edge.b));
      if (found == number.end()) {
        throw InvalidInput(fmt::format("marked edge {}-{} belongs to no facet",
                                       edge.a, edge.b));
      }
      mark_[found->second] = static_cast<int>(m);
      edges_[found->second] = {edge.a, edge.b};
    }
  }

  void top() {
    const bool heavy = std::any_of(
        complex_.bodies.begin(), complex_.bodies.end(),
        [](const films::ComplexBody& body) { return body.density != 0.0; });
    if (heavy && (complex_.gravity.x() != 0.0 || complex_.gravity.y() != 0.0)) {
      throw InvalidInput(fmt::format(
          "gravity is ({}, {}, {}); a datafile has it along z only",
          complex_.gravity.x(), complex_.gravity.y(), complex_.gravity.z()));
    }
    add("gravity_constant {}\n", -complex_.gravity.z());
    add("integral_order_1d {}\n", 2 * complex_.line_points - 1);
    add("gap_constant {}\n", complex_.gap_constant);
    if (complex_.volume_rule == films::VolumeRule::Cone) {
      add("symmetric_content\n");
    }
  }

  void curve(int index) {
    const curves::CurveShape& shape = complex_.curves[index].shape;
    add("\nboundary {} parameters 1  // {}\n", index + 1,
        one_line(complex_.curves[index].name));
    if (const auto* own = std::get_if<curves::ParametricCurve>(&shape)) {
      for (int k = 0; k < 3; ++k) {
        add("x{}: {}\n", k + 1, text(own->coordinates[k]));
      }
    } else {
      round(shape);
    }
    // Evolver adds content of boundaries with the other sign.
    integral_set(places_.of_curve[index], Sign::ContentOpposite);
  }

  void round(const curves::CurveShape& shape) {
    // Circles and ellipses: center + u cos + v sin.
    const Vec3 start = curves::point_at(shape, 0.0);
    const Vec3 center = 0.5 * (start + curves::point_at(shape, 0.5));
    const Vec3 u = start - center;
    const Vec3 v = curves::point_at(shape, 0.25) - center;
    for (int k = 0; k < 3; ++k) {
      add("x{0}: ({1}) + ({2})*cos({4}*p1) + ({3})*sin({4}*p1)\n", k + 1,
          center[k], u[k], v[k], kTwoPi);
    }
  }

  void level_set(int index) {
    const films::LevelSet& level = complex_.level_sets[index];
    add("\nconstraint {}{}{}  // {}\nformula: {}\n", index + 1,
        level.convex ? " convex" : "",
        level.side == films::LevelSet::Side::AtLeast  ? " nonnegative"
        : level.side == films::LevelSet::Side::AtMost ? " nonpositive"
                                                      : "",
        one_line(level.name), text(level.formula));
    integral_set(places_.of_level[index], Sign::Same);
  }

  enum class Sign { Same, ContentOpposite };

  // The sum of the set's line integrals.
  void integral_set(int set, Sign sign) {
    if (set < 0) {
      return;
    }
    for (const auto role : {films::LineIntegral::Role::Energy,
                            films::LineIntegral::Role::Content}) {
      const bool energy = role == films::LineIntegral::Role::Energy;
      const char* minus = !energy && sign == Sign::ContentOpposite ? "-" : "";
      std::array<std::string, 3> sum;
      for (const int i : complex_.integral_sets[set]) {
        if (complex_.integrals[i].role != role) {
          continue;
        }
        for (int k = 0; k < 3; ++k) {
          sum[k] += fmt::format("{}({}({}))", sum[k].empty() ? "" : " + ",
                                minus, text(complex_.integrals[i].field[k]));
        }
      }
      if (!sum[0].empty()) {
        add("{}:\n", energy ? "energy" : "content");
        for (int k = 0; k < 3; ++k) {
          add("{}{}: {}\n", energy ? 'e' : 'c', k + 1, sum[k]);
        }
      }
    }
  }

  void quantity(int index) {
    const films::FilmQuantity& quantity = complex_.quantities[index];
    std::string role = "info_only";
    if (quantity.role == films::FilmQuantity::Role::Energy) {
      role = fmt::format("energy modulus {}", quantity.modulus);
    } else if (quantity.role == films::FilmQuantity::Role::Held) {
      role = fmt::format("fixed = {}", quantity.target);
    }
    add("\nquantity quantity_{} {} method ", index + 1, role);
    const char* where = quantity.surfaces.empty() ? " global" : "";
    switch (quantity.kind) {
      case films::FilmQuantity::Kind::VectorIntegral:
        add("facet_vector_integral{}\nvector_integrand:\n", where);
        for (int k = 0; k < 3; ++k) {
          add("q{}: {}\n", k + 1, text(quantity.field[k]));
        }
        break;
      case films::FilmQuantity::Kind::ScalarIntegral:
        add("facet_scalar_integral{}\nscalar_integrand: {}\n", where,
            text(with_numbers(quantity.scalar)));
        break;
      case films::FilmQuantity::Kind::Area:
        add("facet_area{}\n", where);
        break;
      case films::FilmQuantity::Kind::BodyScalarIntegral:
        throw InvalidInput(fmt::format(
            "quantity '{}' is an integral over a body, which datafiles have "
            "not",
            quantity.name));
      case films::FilmQuantity::Kind::BodyPoles:
        throw InvalidInput(
            "the film is held by spines, which datafiles have not");
      case films::FilmQuantity::Kind::BodyVolume:
        throw InvalidInput(fmt::format(
            "quantity '{}' is a body's volume, which a datafile says as the "
            "body's own",
            quantity.name));
    }
  }

  static bool has_integral(const films::ComplexSurface& surface) {
    return surface.tension_field || !surface.drop_shape.empty();
  }

  /// " * g(N)" of a facet's normal x4, x5, x6; nothing where g is 1.
  static std::string support(const films::DropShape& shape) {
    std::string sum;
    for (const films::Spheroid& part : shape) {
      const Vec3 axis = part.axis.normalized();
      const double across = part.across * part.across;
      sum += fmt::format(
          "{}sqrt({}*(x4^2 + x5^2 + x6^2) + ({})*(({})*x4 + ({})*x5 + "
          "({})*x6)^2)",
          sum.empty() ? " * (" : " + ", across,
          part.along * part.along - across, axis.x(), axis.y(), axis.z());
    }
    return sum.empty() ? sum : sum + ")";
  }

  // Names go into comments.
  static std::string one_line(std::string name) {
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return c == '\n' || c == '\r' || c == '\\'; }, ' ');
    return name;
  }

  void elements() {
    add("\nvertices\n");
    for (std::size_t v = 0; v < complex_.vertices.size(); ++v) {
      vertex(static_cast<int>(v));
    }
    add("\nedges\n");
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      add("{} {} {}", e + 1, edges_[e][0] + 1, edges_[e][1] + 1);
      if (mark_[e] >= 0) {
        marks(complex_.edges[mark_[e]]);
      }
      add("\n");
    }
    add("\nfaces\n");
    for (std::size_t f = 0; f < complex_.mesh.facets.size(); ++f) {
      facet(static_cast<int>(f));
    }
    add("\nbodies\n");
    for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
      body(static_cast<int>(b));
    }
  }

  void vertex(int index) {
    const films::ComplexVertex& vertex = complex_.vertices[index];
    const Vec3& p = complex_.mesh.points[index];
    const bool on_curve = vertex.kind == films::VertexKind::OnCurve ||
                          vertex.kind == films::VertexKind::Slides;
    if (on_curve && fe_is_boundary(complex_, vertex.curve)) {
      add("{} {} boundary {}{}\n", index + 1, vertex.t, vertex.curve + 1,
          vertex.kind == films::VertexKind::OnCurve ? " fixed" : "");
      return;
    }
    if (vertex.kind == films::VertexKind::Slides) {
      refuse_sliding(vertex.curve);
    }
    add("{} {} {} {}", index + 1, p.x(), p.y(), p.z());
    if (vertex.kind != films::VertexKind::Free) {
      add(" fixed");
    } else {
      constraints(vertex.constraints);
    }
    add("\n");
  }

  [[noreturn]] void refuse_sliding(int curve) const {
    throw InvalidInput(fmt::format(
        "films slide along '{}': in a datafile that takes a smooth curve with "
        "the same line integrals all along",
        complex_.curves[curve].name));
  }

  void constraints(int set) {
    if (set < 0) {
      return;
    }
    add(" constraint");
    for (const int level : complex_.constraint_sets[set]) {
      add(" {}", level + 1);
    }
  }

  void marks(const films::ComplexEdge& edge) {
    const bool carried = places_.needs_carrier(complex_, edge);
    if (edge.kind == films::VertexKind::Slides &&
        (carried || !fe_is_boundary(complex_, edge.curve))) {
      refuse_sliding(edge.curve);
    }
    if (fe_on_boundary(complex_, edge) && !carried) {
      add(" boundary {}", edge.curve + 1);
    }
    if (edge.kind != films::VertexKind::Free &&
        edge.kind != films::VertexKind::Slides) {
      add(" fixed");
    }
    const std::vector<int> none;
    const std::vector<int>& levels =
        fe_has_levels(edge) ? complex_.constraint_sets[edge.constraints] : none;
    if (carried || !levels.empty()) {
      add(" constraint");
    }
    for (std::size_t k = carried ? 1 : 0; k < levels.size(); ++k) {
      add(" {}", levels[k] + 1);
    }
    if (carried) {
      add(" {}", places_.carriers.at(FeIntegralPlaces::key_of(complex_, edge)));
    }
    if (!edge.refine) {
      add(" no_refine");
    }
  }

  void facet(int index) {
    add("{}", index + 1);
    for (int k = 0; k < 3; ++k) {
      const int e = facet_edges_[index][k];
      const bool forward = edges_[e][0] == complex_.mesh.facets[index][k];
      add(" {}{}", forward ? "" : "-", e + 1);
    }
    const int label = complex_.mesh.facet_label[index];
    const films::ComplexSurface& surface = complex_.surfaces[label];
    const double tension = has_integral(surface) ? 0.0 : surface.tension;
    if (tension != 1.0) {
      add(" tension {}", tension);
    }
    if (!surface.liquid) {
      add(" fixed color {}", label + 1);
    }
    if (!surface.refine) {
      add(" no_refine");
    }
    constraints(surface.constraints);
    if (has_integral(surface)) {
      add(" tension_of_surface_{}", label + 1);
    }
    for (std::size_t q = 0; q < complex_.quantities.size(); ++q) {
      const std::vector<int>& on = complex_.quantities[q].surfaces;
      if (std::find(on.begin(), on.end(), label) != on.end()) {
        add(" quantity_{}", q + 1);
      }
    }
    add("\n");
  }

  void body(int index) {
    const films::ComplexBody& body = complex_.bodies[index];
    std::vector<int> sign(complex_.surfaces.size(), 0);
    for (const films::BodySide& side : body.sides) {
      sign[side.surface] += side.sign;
    }
    add("{}", index + 1);
    int count = 0;
    for (std::size_t f = 0; f < complex_.mesh.facets.size(); ++f) {
      const int s = sign[complex_.mesh.facet_label[f]];
      if (s != 0) {
        constexpr int kLine = 10;
        add("{}{}{}", count++ % kLine == 0 && count > 1 ? " \\\n  " : " ",
            s < 0 ? "-" : "", f + 1);
      }
    }
    if (body.volume) {
      add(" volume {}", *body.volume);
    }
    if (body.pressure) {
      add(" pressure {}", *body.pressure);
    }
    if (body.volume_offset != 0.0) {
      add(" volconst {}", body.volume_offset);
    }
    if (body.density != 0.0) {
      add(" density {}", body.density);
    }
    add("  // {}\n", one_line(body.name));
  }

  const films::FilmComplex& complex_;
  std::string out_;
  std::vector<Edge> edges_;
  std::vector<Triangle> facet_edges_;
  FeIntegralPlaces places_;
  std::vector<int> mark_;  // of edges: index into complex.edges, or -1
};

}  // namespace

std::string fe_text(const films::FilmComplex& complex,
                    const std::vector<std::string>& comments) {
  return FeWriter(complex, comments).write();
}

}  // namespace meniscus::datafile
