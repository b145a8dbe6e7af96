#include "cad/occt/step_shape.h"

#include <algorithm>

#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>

#include "cad/occt/exact_faces.h"
#include "cad/occt/step_knots.h"
#include "core/error.h"
#include "core/math/union_find.h"

namespace meniscus::occt {

namespace {

constexpr double kPrecision = 1e-7;  // OpenCASCADE's own [mm]
constexpr double kRound = 1e-9;      // a circle's radii alike, relative

gp_Pnt to_point(const Vec3& p) { return {p[0], p[1], p[2]}; }
gp_Dir to_direction(const Vec3& d) { return {d[0], d[1], d[2]}; }

class ShapeBuilder {
 public:
  ShapeBuilder(const solid::Brep& brep, double scale)
      : brep_(brep), scale_(scale) {}
  StepShape build();

 private:
  StepShape build_sewn();
  void add_faces(StepShape& result);
  void add_vertices();
  void add_edges();
  Handle(Geom_Curve)
      curve_of(const solid::BrepEdge& edge, double& first, double& last) const;
  Handle(Geom_Surface) surface_of(const solid::BrepFace& face) const;
  void add_line(const solid::BrepFace& face, const solid::BrepUse& use,
                const TopoDS_Face& shape);
  TopoDS_Edge pole_edge(const solid::BrepUse& use, int vertex,
                        const TopoDS_Face& shape);
  TopoDS_Face face_of(const solid::BrepFace& face);
  std::vector<int> shells_of_faces() const;

  const solid::Brep& brep_;
  double scale_;
  BRep_Builder builder_;
  std::vector<TopoDS_Vertex> vertices_;
  std::vector<TopoDS_Edge> edges_;
};

void ShapeBuilder::add_vertices() {
  for (const Vec3& p : brep_.vertices) {
    TopoDS_Vertex vertex;
    builder_.MakeVertex(vertex, to_point(scale_ * p), kPrecision);
    vertices_.push_back(vertex);
  }
}

Handle(Geom_Curve) ShapeBuilder::curve_of(const solid::BrepEdge& edge,
                                          double& first, double& last) const {
  first = edge.first;
  last = edge.last;
  if (const auto* line = std::get_if<solid::StraightLine>(&edge.curve)) {
    first *= scale_;
    last *= scale_;
    return new Geom_Line(to_point(scale_ * line->start),
                         to_direction(line->direction));
  }
  if (const auto* arc = std::get_if<solid::EllipseCurve>(&edge.curve)) {
    Vec3 u = scale_ * arc->u;
    Vec3 v = scale_ * arc->v;
    if (v.norm() > u.norm() * (1.0 + kRound)) {  // the long axis comes first
      std::swap(u, v);
      v = -v;
      first -= M_PI_2;
      last -= M_PI_2;
    }
    const Vec3 n = Eigen::Vector3d(u.cross(v));
    const gp_Ax2 frame(to_point(scale_ * arc->center), to_direction(n),
                       to_direction(u));
    if (u.norm() - v.norm() <= kRound * u.norm()) {
      return new Geom_Circle(frame, u.norm());
    }
    return new Geom_Ellipse(frame, u.norm(), v.norm());
  }
  const auto& spline = std::get<solid::SplineCurve>(edge.curve);
  const int count = static_cast<int>(spline.poles.size());
  TColgp_Array1OfPnt poles(1, count);
  for (int k = 0; k < count; ++k) {
    poles.SetValue(k + 1, to_point(scale_ * spline.poles[k]));
  }
  const Knots knots = to_knots(spline.knots);
  Handle(Geom_BSplineCurve) curve =
      new Geom_BSplineCurve(poles, knots.values, knots.multiplicities, 3);
  // Closed ones go on beyond their ends, where a reader that looks for a vertex
  // finds it twice.
  curve->Segment(first, last);
  return {curve};
}

void ShapeBuilder::add_edges() {
  for (const solid::BrepEdge& edge : brep_.edges) {
    double first = 0.0;
    double last = 1.0;
    const Handle(Geom_Curve) curve = curve_of(edge, first, last);
    const double tolerance =
        std::max(kPrecision, 1.2 * scale_ * edge.gap + kPrecision);
    TopoDS_Edge shape;
    builder_.MakeEdge(shape, curve, tolerance);
    builder_.Add(shape, vertices_[edge.from].Oriented(TopAbs_FORWARD));
    builder_.Add(shape, vertices_[edge.to].Oriented(TopAbs_REVERSED));
    builder_.Range(shape, first, last);
    edges_.push_back(shape);
    for (const int v : {edge.from, edge.to}) {
      builder_.UpdateVertex(vertices_[v], tolerance);
    }
  }
}

Handle(Geom_Surface)
    ShapeBuilder::surface_of(const solid::BrepFace& face) const {
  if (const auto* plane = std::get_if<solid::PlaneSurface>(&face.surface)) {
    return new Geom_Plane(to_point(scale_ * plane->point),
                          to_direction(plane->normal));
  }
  const auto frame = [&](const auto& turned) {
    return gp_Ax3(to_point(scale_ * turned.center), to_direction(turned.axis),
                  to_direction(turned.zero));
  };
  if (const auto* tube = std::get_if<solid::CylinderSurface>(&face.surface)) {
    return new Geom_CylindricalSurface(frame(*tube), scale_ * tube->radius);
  }
  if (const auto* cone = std::get_if<solid::ConeSurface>(&face.surface)) {
    return new Geom_ConicalSurface(frame(*cone), cone->angle,
                                   scale_ * cone->radius);
  }
  if (const auto* ball = std::get_if<solid::SphereSurface>(&face.surface)) {
    return new Geom_SphericalSurface(frame(*ball), scale_ * ball->radius);
  }
  const auto& spline = std::get<solid::SplineSurface>(face.surface);
  const int columns = static_cast<int>(spline.knots_b.size()) - 4;
  const int rows = static_cast<int>(spline.knots_a.size()) - 4;
  TColgp_Array2OfPnt poles(1, rows, 1, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      poles.SetValue(i + 1, j + 1,
                     to_point(scale_ * spline.poles[i * columns + j]));
    }
  }
  const Knots a = to_knots(spline.knots_a);
  const Knots b = to_knots(spline.knots_b);
  return new Geom_BSplineSurface(poles, a.values, b.values, a.multiplicities,
                                 b.multiplicities, 3, 3);
}

/// A straight line in the surface's parameters, run from `first` to `last`.
/// `b_scale`: of the second parameter, where that is a length.
Handle(Geom2d_Curve) parameter_line(const solid::BrepUse& use, double first,
                                    double last, double b_scale) {
  TColgp_Array1OfPnt2d poles(1, 2);
  poles.SetValue(1, gp_Pnt2d(use.at_first[0], b_scale * use.at_first[1]));
  poles.SetValue(2, gp_Pnt2d(use.at_last[0], b_scale * use.at_last[1]));
  TColStd_Array1OfReal knots(1, 2);
  knots.SetValue(1, first);
  knots.SetValue(2, last);
  TColStd_Array1OfInteger multiplicities(1, 2);
  multiplicities.Init(2);
  return new Geom2d_BSplineCurve(poles, knots, multiplicities, 1);
}

bool is_inward(const solid::BrepFace& face) {
  const auto* tube = std::get_if<solid::CylinderSurface>(&face.surface);
  const auto* cone = std::get_if<solid::ConeSurface>(&face.surface);
  const auto* ball = std::get_if<solid::SphereSurface>(&face.surface);
  return (tube != nullptr && tube->inward) ||
         (cone != nullptr && cone->inward) || (ball != nullptr && ball->inward);
}

/// The use's edge with its line in the surface's parameters; of a seam, used
/// both ways, with both.
void ShapeBuilder::add_line(const solid::BrepFace& face,
                            const solid::BrepUse& use,
                            const TopoDS_Face& shape) {
  const bool b_is_length =
      std::holds_alternative<solid::CylinderSurface>(face.surface) ||
      std::holds_alternative<solid::ConeSurface>(face.surface);
  const double b_scale = b_is_length ? scale_ : 1.0;
  double first = 0.0;
  double last = 1.0;
  curve_of(brep_.edges[use.edge], first, last);
  const solid::BrepUse* back = nullptr;
  for (const std::vector<solid::BrepUse>& loop : face.loops) {
    for (const solid::BrepUse& other : loop) {
      if (other.edge == use.edge && other.forward != use.forward) {
        back = &other;
      }
    }
  }
  const auto line = parameter_line(use, first, last, b_scale);
  if (back == nullptr) {
    builder_.UpdateEdge(edges_[use.edge], line, shape, kPrecision);
  } else if (use.forward != is_inward(face)) {
    builder_.UpdateEdge(edges_[use.edge], line,
                        parameter_line(*back, first, last, b_scale), shape,
                        kPrecision);
  }
}

/// The edge without length at a sphere's pole.
TopoDS_Edge ShapeBuilder::pole_edge(const solid::BrepUse& use, int vertex,
                                    const TopoDS_Face& shape) {
  TopoDS_Edge edge;
  builder_.MakeEdge(edge);
  const double turn = (use.at_last - use.at_first).norm();
  builder_.UpdateEdge(edge, parameter_line(use, 0.0, turn, 1.0), shape,
                      kPrecision);
  builder_.Add(edge, vertices_[vertex].Oriented(TopAbs_FORWARD));
  builder_.Add(edge, vertices_[vertex].Oriented(TopAbs_REVERSED));
  builder_.Range(edge, 0.0, turn);
  builder_.Degenerated(edge, true);
  return edge;
}

TopoDS_Face ShapeBuilder::face_of(const solid::BrepFace& face) {
  TopoDS_Face shape;
  builder_.MakeFace(shape, surface_of(face), kPrecision);
  // Wires lie about the surface's own normal; against it the whole face is
  // turned.
  const bool inward = is_inward(face);
  for (const std::vector<solid::BrepUse>& loop : face.loops) {
    TopoDS_Wire wire;
    builder_.MakeWire(wire);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const solid::BrepUse& use = loop[k];
      if (use.edge == solid::kPole) {
        const solid::BrepUse& before =
            loop[(k + loop.size() - 1) % loop.size()];
        const solid::BrepEdge& end = brep_.edges[before.edge];
        const int vertex = before.forward ? end.to : end.from;
        builder_.Add(wire,
                     pole_edge(use, vertex, shape)
                         .Oriented(inward ? TopAbs_REVERSED : TopAbs_FORWARD));
        continue;
      }
      if (!std::holds_alternative<solid::PlaneSurface>(face.surface)) {
        add_line(face, use, shape);
      }
      builder_.Add(wire, edges_[use.edge].Oriented(use.forward != inward
                                                       ? TopAbs_FORWARD
                                                       : TopAbs_REVERSED));
    }
    wire.Closed(true);
    builder_.Add(shape, wire);
  }
  return inward ? TopoDS::Face(shape.Reversed()) : shape;
}

/// The shell of each face: faces that hang together by edges. Throws where an
/// edge is not used once each way.
std::vector<int> ShapeBuilder::shells_of_faces() const {
  std::vector<std::vector<std::pair<int, bool>>> users(brep_.edges.size());
  for (std::size_t f = 0; f < brep_.faces.size(); ++f) {
    for (const auto& loop : brep_.faces[f].loops) {
      for (const solid::BrepUse& use : loop) {
        if (use.edge != solid::kPole) {
          users[use.edge].emplace_back(static_cast<int>(f), use.forward);
        }
      }
    }
  }
  UnionFind shells(brep_.faces.size());
  for (std::size_t e = 0; e < users.size(); ++e) {
    const auto& both = users[e];
    if (both.size() != 2 || both[0].second == both[1].second) {
      throw MeshError(fmt::format(
          "the solid is not closed: edge {} of face '{}' is used {} times; "
          "settle it with another --edge, or export it as step-faceted",
          e, both.empty() ? "" : brep_.faces[both[0].first].name, both.size()));
    }
    shells.join(both[0].first, both[1].first);
  }
  return shells.roots();
}

void ShapeBuilder::add_faces(StepShape& result) {
  add_vertices();
  add_edges();
  for (const solid::BrepFace& face : brep_.faces) {
    result.faces.push_back(face_of(face));
    result.names.push_back(face.name);
  }
  for (const TopoDS_Edge& edge : edges_) {
    builder_.SameRange(edge, true);
    builder_.SameParameter(edge, true);
  }
}

/// With the exact faces, which have edges of their own.
StepShape ShapeBuilder::build_sewn() {
  StepShape result;
  add_faces(result);
  for (const solid::ExactFaces& exact : brep_.exact) {
    for (const TopoDS_Face& face : exact_faces(exact, scale_)) {
      result.faces.push_back(face);
    }
    result.names.insert(result.names.end(), exact.names.begin(),
                        exact.names.end());
  }
  result.solid = sewn_solid(result.faces, scale_);
  for (TopExp_Explorer at(result.solid, TopAbs_SHELL); at.More(); at.Next()) {
    result.shells += 1;
  }
  return result;
}

StepShape ShapeBuilder::build() {
  if (!brep_.exact.empty()) {
    return build_sewn();
  }
  const std::vector<int> shell_of = shells_of_faces();
  StepShape result;
  add_faces(result);
  TopoDS_Solid solid;
  builder_.MakeSolid(solid);
  int outer = 0;
  for (std::size_t first = 0; first < shell_of.size(); ++first) {
    if (shell_of[first] != static_cast<int>(first)) {
      continue;
    }
    TopoDS_Shell shell;
    builder_.MakeShell(shell);
    for (std::size_t f = 0; f < shell_of.size(); ++f) {
      if (shell_of[f] == static_cast<int>(first)) {
        builder_.Add(shell, result.faces[f]);
      }
    }
    shell.Closed(true);
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shell, properties);
    outer += properties.Mass() > 0.0 ? 1 : 0;
    builder_.Add(solid, shell);
    result.shells += 1;
  }
  if (outer != 1) {
    throw MeshError(fmt::format(
        "the part has {} outer shells; a STEP solid has one", outer));
  }
  result.solid = solid;
  return result;
}

}  // namespace

Knots to_knots(const std::vector<double>& knots) {
  std::vector<double> values;
  std::vector<int> counts;
  for (const double knot : knots) {
    if (values.empty() || knot > values.back()) {
      values.push_back(knot);
      counts.push_back(1);
    } else {
      counts.back() += 1;
    }
  }
  const int n = static_cast<int>(values.size());
  Knots result{TColStd_Array1OfReal(1, n), TColStd_Array1OfInteger(1, n)};
  for (int k = 0; k < n; ++k) {
    result.values.SetValue(k + 1, values[k]);
    result.multiplicities.SetValue(k + 1, counts[k]);
  }
  return result;
}

StepShape step_shape(const solid::Brep& brep, double scale) {
  return ShapeBuilder(brep, scale).build();
}

}  // namespace meniscus::occt
