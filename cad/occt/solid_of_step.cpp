#include "cad/occt/solid_of_step.h"

#include <algorithm>
#include <map>
#include <set>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>

#include "cad/occt/step_file.h"
#include "cad/occt/step_session.h"
#include "core/error.h"

namespace meniscus::occt {

namespace {

Vec3 vector_of(const gp_Dir& d) { return {d.X(), d.Y(), d.Z()}; }

class ShapeReader {
 public:
  explicit ShapeReader(const StepFile& file) : file_(file) {
    TopExp::MapShapes(file.shape, TopAbs_EDGE, edges_);
    TopExp::MapShapes(file.shape, TopAbs_FACE, faces_);
    TopExp::MapShapes(file.shape, TopAbs_VERTEX, vertices_);
  }

  ExactShape read() {
    require_one_solid();
    for (int k = 1; k <= vertices_.Extent(); ++k) {
      shape_.vertices.push_back(
          to_point(BRep_Tool::Pnt(TopoDS::Vertex(vertices_(k)))));
    }
    for (int k = 1; k <= edges_.Extent(); ++k) {
      shape_.edges.push_back(edge_of(TopoDS::Edge(edges_(k))));
    }
    std::map<std::string, int> known;
    std::set<std::string> numbers;  // "face_7" is the seventh
    for (int k = 1; k <= faces_.Extent(); ++k) {
      ++known[file_.name_of(faces_(k))];
      numbers.insert(fmt::format("face_{}", k));
    }
    for (int k = 1; k <= faces_.Extent(); ++k) {
      const std::string name = file_.name_of(faces_(k));
      const std::string number = fmt::format("face_{}", k);
      const bool own =
          !name.empty() && known[name] == 1 && !numbers.contains(name);
      shape_.faces.push_back(
          face_of(TopoDS::Face(faces_(k)), own ? name : number));
    }
    require_closed();
    return std::move(shape_);
  }

 private:
  Vec3 to_point(const gp_Pnt& p) const {
    return file_.point(p.X(), p.Y(), p.Z());
  }
  double to_length(double x) const { return x / file_.millimetres; }
  ExactFrame frame_of(const gp_Ax3& axes) const {
    return {to_point(axes.Location()), vector_of(axes.XDirection()),
            vector_of(axes.YDirection()), vector_of(axes.Direction())};
  }
  void require_one_solid() const;
  void require_closed() const;
  ExactEdge edge_of(const TopoDS_Edge& edge) const;
  ExactSpline spline_of(const BRepAdaptor_Curve& curve) const;
  ExactSurface surface_of(const TopoDS_Face& face) const;
  ExactSplineSurface splines_of(const TopoDS_Face& face) const;
  ExactFace face_of(const TopoDS_Face& face, const std::string& name) const;

  const StepFile& file_;
  TopTools_IndexedMapOfShape edges_;
  TopTools_IndexedMapOfShape faces_;
  TopTools_IndexedMapOfShape vertices_;
  ExactShape shape_;
};

void ShapeReader::require_one_solid() const {
  int solids = 0;
  int faces = 0;
  for (TopExp_Explorer at(file_.shape, TopAbs_SOLID); at.More(); at.Next()) {
    ++solids;
    TopTools_IndexedMapOfShape own;
    TopExp::MapShapes(at.Current(), TopAbs_FACE, own);
    faces += own.Extent();
  }
  if (solids == 1 && faces == faces_.Extent()) {
    return;
  }
  throw InvalidInput(fmt::format(
      "{}: {} solids and {} faces outside of them; expected one closed solid: "
      "{}",
      file_.path.string(), solids, std::max(0, faces_.Extent() - faces),
      solids > 1    ? "write each into a file of its own"
      : solids == 1 ? "take the other faces out in its CAD program"
                    : "close its faces to a solid in its CAD program"));
}

/// Every edge of a face but those without length is used twice; a file may have
/// others.
void ShapeReader::require_closed() const {
  std::vector<int> uses(shape_.edges.size(), 0);
  for (const ExactFace& face : shape_.faces) {
    for (const auto& loop : face.loops) {
      for (const ExactUse& use : loop) {
        ++uses[static_cast<std::size_t>(use.edge)];
      }
    }
  }
  for (std::size_t k = 0; k < uses.size(); ++k) {
    const auto number = static_cast<int>(k) + 1;
    if (uses[k] == 2 || uses[k] == 0 ||
        BRep_Tool::Degenerated(TopoDS::Edge(edges_(number)))) {
      continue;
    }
    const Vec3& at = shape_.vertices[shape_.edges[k].from];
    throw InvalidInput(fmt::format(
        "{}: the solid is not closed: {} faces meet at edge {} from ({:.5g}, "
        "{:.5g}, {:.5g}), expected two; mend it in its CAD program",
        file_.path.string(), uses[k], number, at[0], at[1], at[2]));
  }
}

/// Knots as often as they count.
std::vector<double> flat_knots(const TColStd_Array1OfReal& knots,
                               const TColStd_Array1OfInteger& counts) {
  std::vector<double> result;
  for (int k = knots.Lower(); k <= knots.Upper(); ++k) {
    result.insert(result.end(), static_cast<std::size_t>(counts(k)), knots(k));
  }
  return result;
}

ExactSpline ShapeReader::spline_of(const BRepAdaptor_Curve& curve) const {
  const Handle(Geom_Curve) whole = Handle(Geom_Curve)::DownCast(
      curve.Curve().Curve()->Transformed(curve.Trsf()));
  const Handle(Geom_BSplineCurve) spline =
      GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(
          whole, curve.FirstParameter(), curve.LastParameter()));
  spline->SetNotPeriodic();
  ExactSpline result;
  result.degree = spline->Degree();
  result.knots = flat_knots(spline->Knots(), spline->Multiplicities());
  for (int k = 1; k <= spline->NbPoles(); ++k) {
    result.poles.push_back(to_point(spline->Pole(k)));
    result.weights.push_back(spline->Weight(k));
  }
  return result;
}

ExactEdge ShapeReader::edge_of(const TopoDS_Edge& given) const {
  const TopoDS_Edge edge = TopoDS::Edge(given.Oriented(TopAbs_FORWARD));
  ExactEdge result{.name = file_.name_of(given), .curve = ExactLine()};
  result.from = vertices_.FindIndex(TopExp::FirstVertex(edge)) - 1;
  result.to = vertices_.FindIndex(TopExp::LastVertex(edge)) - 1;
  if (BRep_Tool::Degenerated(edge)) {
    return result;
  }
  const BRepAdaptor_Curve curve(edge);
  result.first = curve.FirstParameter();
  result.last = curve.LastParameter();
  const auto ellipse = [&](const gp_Ax2& axes, double u, double v) {
    return ExactEllipse{to_point(axes.Location()),
                        to_length(u) * vector_of(axes.XDirection()),
                        to_length(v) * vector_of(axes.YDirection())};
  };
  switch (curve.GetType()) {
    case GeomAbs_Line:
      result.curve = ExactLine{to_point(curve.Line().Location()),
                               vector_of(curve.Line().Direction())};
      result.first = to_length(result.first);
      result.last = to_length(result.last);
      break;
    case GeomAbs_Circle:
      result.curve = ellipse(curve.Circle().Position(), curve.Circle().Radius(),
                             curve.Circle().Radius());
      break;
    case GeomAbs_Ellipse:
      result.curve =
          ellipse(curve.Ellipse().Position(), curve.Ellipse().MajorRadius(),
                  curve.Ellipse().MinorRadius());
      break;
    default: {
      ExactSpline spline = spline_of(curve);
      result.first = spline.knots.front();
      result.last = spline.knots.back();
      result.curve = std::move(spline);
    }
  }
  return result;
}

ExactSplineSurface ShapeReader::splines_of(const TopoDS_Face& face) const {
  TopLoc_Location place;
  Handle(Geom_Surface) whole = BRep_Tool::Surface(face, place);
  whole = Handle(Geom_Surface)::DownCast(
      whole->Transformed(place.Transformation()));
  Handle(Geom_BSplineSurface) spline =
      Handle(Geom_BSplineSurface)::DownCast(whole);
  if (spline.IsNull()) {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    double d = 0.0;
    BRepTools::UVBounds(face, a, b, c, d);
    spline = GeomConvert::SurfaceToBSplineSurface(
        new Geom_RectangularTrimmedSurface(whole, a, b, c, d));
  }
  // SetUNotPeriodic of OpenCASCADE 7.6 leaves weights of 0.
  if (spline->IsUPeriodic() || spline->IsVPeriodic()) {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    double d = 0.0;
    spline->Bounds(a, b, c, d);
    spline->Segment(a, b, c, d);
  }
  ExactSplineSurface result;
  result.degree_a = spline->UDegree();
  result.degree_b = spline->VDegree();
  result.knots_a = flat_knots(spline->UKnots(), spline->UMultiplicities());
  result.knots_b = flat_knots(spline->VKnots(), spline->VMultiplicities());
  for (int i = 1; i <= spline->NbUPoles(); ++i) {
    for (int j = 1; j <= spline->NbVPoles(); ++j) {
      result.poles.push_back(to_point(spline->Pole(i, j)));
      result.weights.push_back(spline->Weight(i, j));
    }
  }
  return result;
}

ExactSurface ShapeReader::surface_of(const TopoDS_Face& face) const {
  const BRepAdaptor_Surface surface(face);
  switch (surface.GetType()) {
    case GeomAbs_Plane:
      return ExactPlane{frame_of(surface.Plane().Position())};
    case GeomAbs_Cylinder:
      return ExactCylinder{frame_of(surface.Cylinder().Position()),
                           to_length(surface.Cylinder().Radius())};
    case GeomAbs_Cone:
      return ExactCone{frame_of(surface.Cone().Position()),
                       to_length(surface.Cone().RefRadius()),
                       surface.Cone().SemiAngle()};
    case GeomAbs_Sphere:
      return ExactSphere{frame_of(surface.Sphere().Position()),
                         to_length(surface.Sphere().Radius())};
    case GeomAbs_Torus:
      return ExactTorus{frame_of(surface.Torus().Position()),
                        to_length(surface.Torus().MajorRadius()),
                        to_length(surface.Torus().MinorRadius())};
    default:
      return splines_of(face);
  }
}

ExactFace ShapeReader::face_of(const TopoDS_Face& given,
                               const std::string& name) const {
  const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
  ExactFace result{.name = name, .surface = surface_of(face)};
  // Tangents along a and b make the normal of a FORWARD face, whatever the
  // hand of its frame.
  result.outward = given.Orientation() != TopAbs_REVERSED;
  for (TopExp_Explorer at(face, TopAbs_WIRE); at.More(); at.Next()) {
    const TopoDS_Wire wire = TopoDS::Wire(at.Current());
    std::vector<ExactUse> loop;
    int used = 0;
    for (BRepTools_WireExplorer step(wire, face); step.More(); step.Next()) {
      const TopoDS_Edge& edge = step.Current();
      ++used;
      if (BRep_Tool::Degenerated(edge)) {
        continue;
      }
      ExactUse use{.edge = edges_.FindIndex(edge) - 1,
                   .forward = edge.Orientation() == TopAbs_FORWARD};
      double first = 0.0;
      double last = 0.0;
      const Handle(Geom2d_Curve) curve =
          BRep_Tool::CurveOnSurface(edge, face, first, last);
      if (!curve.IsNull()) {
        const gp_Pnt2d start = curve->Value(use.forward ? first : last);
        use.start = Vec2(start.X(), start.Y());
      }
      loop.push_back(use);
    }
    int there = 0;
    for (TopExp_Explorer edge(wire, TopAbs_EDGE); edge.More(); edge.Next()) {
      ++there;
    }
    if (used != there) {
      throw InvalidInput(fmt::format(
          "{}: the edges of face '{}' are no closed loops; mend it in its CAD "
          "program",
          file_.path.string(), name));
    }
    result.loops.push_back(std::move(loop));
  }
  return result;
}

}  // namespace

ExactShape solid_of_step(const std::filesystem::path& path,
                         const std::string& unit) {
  const StepSilence silence;
  StepFile file;
  open_step(file, path, unit);
  return ShapeReader(file).read();
}

}  // namespace meniscus::occt
