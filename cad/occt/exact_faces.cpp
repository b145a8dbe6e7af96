#include "cad/occt/exact_faces.h"

#include <array>
#include <cmath>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <ShapeFix_Face.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>

#include "cad/occt/step_knots.h"
#include "core/error.h"

namespace meniscus::occt {

namespace {

constexpr double kFine = 1e-7;  // OpenCASCADE's own [mm]
// Edges that are one, at most so far apart [the part's size]: curves through
// the edges of a file miss them by so much (pipeline/files/step_curve.h).
constexpr std::array kSewn = {2e-6, 2e-5, 2e-4};
constexpr double kEqual = 1e-9;  // a circle's radii alike, relative

gp_Pnt scaled_point(const Vec3& p, double scale) {
  return {scale * p[0], scale * p[1], scale * p[2]};
}
gp_Dir direction_of(const Vec3& d) { return {d[0], d[1], d[2]}; }

gp_Ax3 axes_of(const ExactFrame& f, double scale) {
  gp_Ax3 axes(scaled_point(f.origin, scale), direction_of(f.z),
              direction_of(f.x));
  if (f.x.cross(f.y).dot(f.z) < 0.0) {
    axes.YReverse();
  }
  return axes;
}

struct CurveMaker {
  double scale;
  Handle(Geom_Curve) operator()(const ExactLine& c) const {
    return new Geom_Line(scaled_point(c.point, scale),
                         direction_of(c.direction));
  }
  Handle(Geom_Curve) operator()(const ExactEllipse& c) const {
    const Vec3 normal = c.u.cross(c.v);
    const gp_Ax2 axes(scaled_point(c.center, scale), direction_of(normal),
                      direction_of(c.u));
    const double u = scale * c.u.norm();
    const double v = scale * c.v.norm();
    if (u - v <= kEqual * u) {
      return new Geom_Circle(axes, u);
    }
    return new Geom_Ellipse(axes, u, v);
  }
  Handle(Geom_Curve) operator()(const ExactSpline& c) const {
    const auto count = static_cast<int>(c.poles.size());
    TColgp_Array1OfPnt poles(1, count);
    TColStd_Array1OfReal weights(1, count);
    for (int k = 0; k < count; ++k) {
      poles.SetValue(k + 1, scaled_point(c.poles[k], scale));
      weights.SetValue(k + 1, c.weights[k]);
    }
    const Knots knots = to_knots(c.knots);
    return new Geom_BSplineCurve(poles, weights, knots.values,
                                 knots.multiplicities, c.degree);
  }
};

struct SurfaceMaker {
  double scale;
  Handle(Geom_Surface) operator()(const ExactPlane& s) const {
    return new Geom_Plane(axes_of(s.frame, scale));
  }
  Handle(Geom_Surface) operator()(const ExactCylinder& s) const {
    return new Geom_CylindricalSurface(axes_of(s.frame, scale),
                                       scale * s.radius);
  }
  Handle(Geom_Surface) operator()(const ExactCone& s) const {
    return new Geom_ConicalSurface(axes_of(s.frame, scale), s.angle,
                                   scale * s.radius);
  }
  Handle(Geom_Surface) operator()(const ExactSphere& s) const {
    return new Geom_SphericalSurface(axes_of(s.frame, scale), scale * s.radius);
  }
  Handle(Geom_Surface) operator()(const ExactTorus& s) const {
    return new Geom_ToroidalSurface(axes_of(s.frame, scale), scale * s.major,
                                    scale * s.minor);
  }
  Handle(Geom_Surface) operator()(const ExactSplineSurface& s) const {
    const int columns = s.count_b();
    const auto rows = static_cast<int>(s.poles.size()) / columns;
    TColgp_Array2OfPnt poles(1, rows, 1, columns);
    TColStd_Array2OfReal weights(1, rows, 1, columns);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        poles.SetValue(i + 1, j + 1,
                       scaled_point(s.poles[i * columns + j], scale));
        weights.SetValue(i + 1, j + 1, s.weights[i * columns + j]);
      }
    }
    const Knots a = to_knots(s.knots_a);
    const Knots b = to_knots(s.knots_b);
    return new Geom_BSplineSurface(poles, weights, a.values, b.values,
                                   a.multiplicities, b.multiplicities,
                                   s.degree_a, s.degree_b);
  }
};

[[noreturn]] void refuse_free(const BRepBuilderAPI_Sewing& sewing,
                              double scale) {
  const gp_Pnt at =
      BRep_Tool::Pnt(TopExp::FirstVertex(TopoDS::Edge(sewing.FreeEdge(1))));
  throw MeshError(fmt::format(
      "the films do not end at the solid's edges: {} edges of faces are free, "
      "the first from ({:.5g}, {:.5g}, {:.5g})",
      sewing.NbFreeEdges(), at.X() / scale, at.Y() / scale, at.Z() / scale));
}

/// A single face is a shell of its own.
TopoDS_Solid solid_of(const TopoDS_Shape& sewn) {
  BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  if (sewn.ShapeType() == TopAbs_FACE) {
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    builder.Add(shell, sewn);
    shell.Closed(true);
    builder.Add(solid, shell);
  }
  for (TopExp_Explorer at(sewn, TopAbs_SHELL); at.More(); at.Next()) {
    builder.Add(solid, at.Current());
  }
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

}  // namespace

std::vector<TopoDS_Face> exact_faces(const solid::ExactFaces& from,
                                     double scale) {
  BRep_Builder builder;
  std::vector<TopoDS_Vertex> vertices;
  for (const Vec3& p : from.shape.vertices) {
    builder.MakeVertex(vertices.emplace_back(), scaled_point(p, scale), kFine);
  }
  std::vector<TopoDS_Edge> edges;
  for (const ExactEdge& edge : from.shape.edges) {
    const double by =
        std::holds_alternative<ExactLine>(edge.curve) ? scale : 1.0;
    TopoDS_Edge& made = edges.emplace_back();
    builder.MakeEdge(made, std::visit(CurveMaker{scale}, edge.curve), kFine);
    builder.Add(made, vertices[edge.from].Oriented(TopAbs_FORWARD));
    builder.Add(made, vertices[edge.to].Oriented(TopAbs_REVERSED));
    builder.Range(made, by * edge.first, by * edge.last);
  }
  std::vector<TopoDS_Face> faces;
  for (const int f : from.faces) {
    const ExactFace& face = from.shape.faces[f];
    TopoDS_Face made;
    builder.MakeFace(made, std::visit(SurfaceMaker{scale}, face.surface),
                     kFine);
    for (const auto& loop : face.loops) {
      TopoDS_Wire wire;
      builder.MakeWire(wire);
      for (const ExactUse& use : loop) {
        builder.Add(wire, edges[use.edge].Oriented(
                              use.forward ? TopAbs_FORWARD : TopAbs_REVERSED));
      }
      wire.Closed(true);
      builder.Add(made, wire);
    }
    // The edges' lines in the surface's parameters, seams and poles.
    ShapeFix_Face fix(made);
    fix.FixOrientationMode() = 0;
    fix.Perform();
    const TopoDS_Face whole = fix.Face();
    faces.push_back(face.outward ? whole : TopoDS::Face(whole.Reversed()));
  }
  return faces;
}

TopoDS_Shape sewn_solid(std::vector<TopoDS_Face>& faces, double scale) {
  Bnd_Box box;
  for (const TopoDS_Face& face : faces) {
    BRepBndLib::Add(face, box);
  }
  const double size = std::sqrt(box.SquareExtent());
  Handle(BRepBuilderAPI_Sewing) sewing;
  for (const double share : kSewn) {
    sewing = new BRepBuilderAPI_Sewing(share * size);  // it never starts anew
    for (const TopoDS_Face& face : faces) {
      sewing->Add(face);
    }
    sewing->Perform();
    if (sewing->NbFreeEdges() == 0) {
      break;
    }
  }
  if (sewing->NbFreeEdges() > 0) {
    refuse_free(*sewing, scale);
  }
  for (TopoDS_Face& face : faces) {
    const TopoDS_Shape now = sewing->Modified(face);
    if (!now.IsNull() && now.ShapeType() == TopAbs_FACE) {
      face = TopoDS::Face(now);
    }
  }
  return solid_of(sewing->SewedShape());
}

}  // namespace meniscus::occt
