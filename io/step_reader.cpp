#include "io/step_reader.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>

#include <BRepAdaptor_Curve.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_QuasiUniformDeflection.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/step_session.h"

namespace meniscus {

namespace {

constexpr double kChordInEdges = 0.02;
constexpr double kChordAngle = 0.35;  // between facets of a bend [rad]

/// A file that has been read, in millimetres.
struct StepFile {
  std::filesystem::path path;
  STEPControl_Reader reader;
  TopoDS_Shape shape;
  double millimetres = 1.0;
  double chord = 0.1;  // [mm]

  /// The name that the file gives to a face or an edge.
  std::string name_of(const TopoDS_Shape& part) const {
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(
        reader.WS()->TransferReader()->EntityFromShapeResult(part, 1));
    return item.IsNull() || item->Name().IsNull() ? ""
                                                  : item->Name()->ToCString();
  }
};

void open(StepFile& file, const std::filesystem::path& path,
          const ReadStepOptions& options) {
  const StepUnit unit = step_unit(options.unit);
  if (!(options.edge > 0.0)) {
    throw InvalidInput(
        fmt::format("the edge length to read '{}' at is {:g}, not above 0",
                    path.string(), options.edge));
  }
  // OpenCASCADE does not say why it cannot; this does.
  if (read_file(path).substr(0, 13) != "ISO-10303-21;") {
    throw InvalidInput(fmt::format(
        "{}:1: found no 'ISO-10303-21;'; expected a STEP file", path.string()));
  }
  file.path = path;
  file.millimetres = unit.millimetres;
  file.chord = kChordInEdges * options.edge * unit.millimetres;
  if (file.reader.ReadFile(path.c_str()) != IFSelect_RetDone ||
      file.reader.TransferRoots() == 0) {
    throw InvalidInput(
        fmt::format("{}: OpenCASCADE finds no shape in it; is the file whole?",
                    path.string()));
  }
  file.shape = file.reader.OneShape();
}

/// Points of a tessellated shape, those on edges and vertices once.
class Tessellation {
 public:
  Tessellation(const StepFile& file, SurfaceMesh& mesh)
      : file_(file), mesh_(mesh) {}

  void add_face(const TopoDS_Face& face, int label);

 private:
  int new_point(const gp_Pnt& p) {
    mesh_.points.emplace_back(Vec3(p.X(), p.Y(), p.Z()) / file_.millimetres);
    return static_cast<int>(mesh_.points.size()) - 1;
  }
  int point_of(const TopoDS_Vertex& vertex);
  void add_edge(const TopoDS_Edge& edge,
                const Handle(Poly_Triangulation) & triangles,
                const TopLoc_Location& place, std::vector<int>& ids);

  const StepFile& file_;
  SurfaceMesh& mesh_;
  TopTools_IndexedMapOfShape vertices_;
  std::vector<int> vertex_points_;
  TopTools_IndexedMapOfShape edges_;
  std::vector<std::vector<int>> edge_points_;
};

int Tessellation::point_of(const TopoDS_Vertex& vertex) {
  const int at = vertices_.Add(vertex);
  if (at > static_cast<int>(vertex_points_.size())) {
    vertex_points_.push_back(new_point(BRep_Tool::Pnt(vertex)));
  }
  return vertex_points_[at - 1];
}

/// Numbers of the points that a face's triangles have on one of its edges.
void Tessellation::add_edge(const TopoDS_Edge& edge,
                            const Handle(Poly_Triangulation) & triangles,
                            const TopLoc_Location& place,
                            std::vector<int>& ids) {
  const Handle(Poly_PolygonOnTriangulation) polygon =
      BRep_Tool::PolygonOnTriangulation(edge, triangles, place);
  if (polygon.IsNull()) {
    throw InvalidInput(
        fmt::format("{}: an edge cannot be tessellated", file_.path.string()));
  }
  TopoDS_Vertex first;
  TopoDS_Vertex last;
  TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), first, last);
  const int count = polygon->NbNodes();
  const int at = edges_.Add(edge);
  if (at > static_cast<int>(edge_points_.size())) {
    std::vector<int> points(count);
    for (int k = 0; k < count; ++k) {
      const bool whole = BRep_Tool::Degenerated(edge);
      points[k] = k == 0 || whole ? point_of(first)
                  : k + 1 == count
                      ? point_of(last)
                      : new_point(triangles->Node(polygon->Node(k + 1))
                                      .Transformed(place.Transformation()));
    }
    edge_points_.push_back(std::move(points));
  }
  for (int k = 0; k < count; ++k) {
    ids[polygon->Node(k + 1) - 1] = edge_points_[at - 1].at(k);
  }
}

void Tessellation::add_face(const TopoDS_Face& face, int label) {
  TopLoc_Location place;
  const Handle(Poly_Triangulation) triangles =
      BRep_Tool::Triangulation(face, place);
  if (triangles.IsNull()) {
    throw InvalidInput(fmt::format("{}: face '{}' cannot be tessellated",
                                   file_.path.string(), mesh_.labels[label]));
  }
  std::vector<int> ids(triangles->NbNodes(), -1);
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    add_edge(TopoDS::Edge(at.Current()), triangles, place, ids);
  }
  for (int k = 0; k < triangles->NbNodes(); ++k) {
    if (ids[k] < 0) {
      ids[k] =
          new_point(triangles->Node(k + 1).Transformed(place.Transformation()));
    }
  }
  for (int k = 1; k <= triangles->NbTriangles(); ++k) {
    int a = 0;
    int b = 0;
    int c = 0;
    triangles->Triangle(k).Get(a, b, c);
    if (face.Orientation() == TopAbs_REVERSED) {
      std::swap(b, c);
    }
    const Triangle facet{ids[a - 1], ids[b - 1], ids[c - 1]};
    if (facet[0] != facet[1] && facet[1] != facet[2] && facet[2] != facet[0]) {
      mesh_.facets.push_back(facet);
      mesh_.facet_label.push_back(label);
    }
  }
}

int label_named(SurfaceMesh& mesh, const std::string& name) {
  const int label = mesh.label_of(name);
  if (label >= 0) {
    return label;
  }
  mesh.labels.push_back(name);
  return static_cast<int>(mesh.labels.size()) - 1;
}

}  // namespace

SurfaceMesh read_step_part(const std::filesystem::path& path,
                           const ReadStepOptions& options) {
  const StepSilence silence;
  StepFile file;
  open(file, path, options);
  BRepMesh_IncrementalMesh(file.shape, file.chord, Standard_False, kChordAngle);
  SurfaceMesh mesh;
  Tessellation tessellation(file, mesh);
  int number = 0;
  for (TopExp_Explorer solid(file.shape, TopAbs_SOLID); solid.More();
       solid.Next()) {
    for (TopExp_Explorer at(solid.Current(), TopAbs_FACE); at.More();
         at.Next()) {
      const TopoDS_Face& face = TopoDS::Face(at.Current());
      const std::string name = file.name_of(face);
      ++number;
      tessellation.add_face(
          face, label_named(mesh, name.empty() ? fmt::format("face_{}", number)
                                               : name));
    }
  }
  if (mesh.facets.empty()) {
    throw InvalidInput(fmt::format("{}: holds no solid; a part must be closed",
                                   path.string()));
  }
  return mesh;
}

Points read_step_curve(const std::filesystem::path& path,
                       const std::string& edge,
                       const ReadStepOptions& options) {
  const StepSilence silence;
  StepFile file;
  open(file, path, options);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(file.shape, TopAbs_EDGE, edges);
  int number = 0;
  const char* end = edge.data() + edge.size();
  if (std::from_chars(edge.data(), end, number).ptr != end) {
    number = 0;
  }
  std::vector<std::string> names;
  for (int k = 1; k <= edges.Extent(); ++k) {
    const std::string name = file.name_of(edges(k));
    if (!name.empty()) {
      names.push_back(name);
    }
    if (name == edge && number == 0) {
      number = k;
    }
  }
  if (number < 1 || number > edges.Extent()) {
    throw InvalidInput(fmt::format(
        "{}: has no edge '{}'; expected a number from 1 to {} or one of the "
        "names [{}]",
        path.string(), edge, edges.Extent(), fmt::join(names, ", ")));
  }
  const TopoDS_Edge& shape = TopoDS::Edge(edges(number));
  const BRepAdaptor_Curve curve(shape);
  const GCPnts_QuasiUniformDeflection samples(curve, file.chord);
  Points points;
  for (int k = 1; samples.IsDone() && k <= samples.NbPoints(); ++k) {
    const gp_Pnt p = samples.Value(k);
    points.emplace_back(Vec3(p.X(), p.Y(), p.Z()) / file.millimetres);
  }
  if (points.size() < 2) {
    throw InvalidInput(
        fmt::format("{}: edge '{}' has no length", path.string(), edge));
  }
  if (BRep_Tool::IsClosed(shape)) {
    points.pop_back();
  }
  return points;
}

}  // namespace meniscus
