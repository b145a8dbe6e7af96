#include "cad/occt/tessellate_step.h"

#include <BOPAlgo_Builder.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <fmt/format.h>

#include "cad/occt/step_file.h"
#include "cad/occt/step_session.h"
#include "core/error.h"

namespace meniscus::occt {

namespace {

constexpr double kChordInEdges = 0.02;
constexpr double kChordAngle = 0.35;  // between facets of a bend [rad]

void open(StepFile& file, const std::filesystem::path& path,
          const step::ReadStepOptions& options) {
  if (!(options.edge > 0.0)) {
    throw InvalidInput(
        fmt::format("the edge length to read '{}' at is {:g}, not above 0",
                    path.string(), options.edge));
  }
  open_step(file, path, options.unit);
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

/// Solids as they are meshed: those that touch share the faces on which they
/// do, cut out of the larger ones.
struct Solids {
  TopoDS_Shape shape;
  TopTools_DataMapOfShapeInteger name_of;  // of each face, into names
  std::vector<std::string> names;
};

Solids solids_of(const StepFile& file) {
  Solids solids{.shape = file.shape, .name_of = {}, .names = {}};
  BOPAlgo_Builder builder;
  int count = 0;
  for (TopExp_Explorer solid(file.shape, TopAbs_SOLID); solid.More();
       solid.Next()) {
    builder.AddArgument(solid.Current());
    ++count;
  }
  if (count > 1) {
    builder.SetRunParallel(Standard_False);
    builder.Perform();
  }
  const bool cut = count > 1 && !builder.HasErrors();
  if (cut) {
    solids.shape = builder.Shape();
  }
  for (TopExp_Explorer solid(file.shape, TopAbs_SOLID); solid.More();
       solid.Next()) {
    for (TopExp_Explorer at(solid.Current(), TopAbs_FACE); at.More();
         at.Next()) {
      const std::string name = file.name_of(at.Current());
      const int number = static_cast<int>(solids.names.size());
      solids.names.push_back(name.empty() ? fmt::format("face_{}", number + 1)
                                          : name);
      if (cut) {
        for (const TopoDS_Shape& piece : builder.Modified(at.Current())) {
          solids.name_of.Bind(piece, number);
        }
      }
      if (!solids.name_of.IsBound(at.Current())) {
        solids.name_of.Bind(at.Current(), number);
      }
    }
  }
  return solids;
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

SurfaceMesh tessellate_step(const std::filesystem::path& path,
                            const step::ReadStepOptions& options) {
  const StepSilence silence;
  StepFile file;
  open(file, path, options);
  const Solids solids = solids_of(file);
  BRepMesh_IncrementalMesh(solids.shape,
                           kChordInEdges * options.edge * file.millimetres,
                           Standard_False, kChordAngle);
  SurfaceMesh mesh;
  Tessellation tessellation(file, mesh);
  for (TopExp_Explorer solid(solids.shape, TopAbs_SOLID); solid.More();
       solid.Next()) {
    for (TopExp_Explorer at(solid.Current(), TopAbs_FACE); at.More();
         at.Next()) {
      const int* const name = solids.name_of.Seek(at.Current());
      tessellation.add_face(
          TopoDS::Face(at.Current()),
          label_named(mesh, name != nullptr ? solids.names[*name] : "cut"));
    }
  }
  if (mesh.facets.empty()) {
    throw InvalidInput(fmt::format("{}: holds no solid; a part must be closed",
                                   path.string()));
  }
  return mesh;
}

}  // namespace meniscus::occt
