#include "report/render_data.h"

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

void require_file(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw InvalidInput(fmt::format("there is no file '{}'", path));
  }
}

[[noreturn]] void refuse(const std::string& path, const char* what) {
  throw InvalidInput(fmt::format("'{}' {}", path, what));
}

Points points_of(vtkPointSet* data) {
  Points points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    data->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  return points;
}

std::string unit_of(vtkDataArray* array) {
  vtkInformation* information = array->GetInformation();
  const char* unit = information->Get(vtkDataArray::UNITS_LABEL());
  return unit != nullptr ? unit : "";
}

std::vector<std::string> names_in(vtkPolyData* data) {
  std::vector<std::string> names;
  auto* array = vtkStringArray::SafeDownCast(
      data->GetFieldData()->GetAbstractArray("surface_names"));
  for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfValues();
       ++i) {
    names.push_back(array->GetValue(i));
  }
  return names;
}

void read_point_fields(vtkPolyData* data, PictureSurface& surface) {
  const vtkIdType count = data->GetNumberOfPoints();
  vtkPointData* fields = data->GetPointData();
  if (auto* u = fields->GetArray("displacement");
      u != nullptr && u->GetNumberOfComponents() == 3) {
    surface.length_unit = unit_of(u);
    surface.displacement.resize(static_cast<std::size_t>(count));
    for (vtkIdType i = 0; i < count; ++i) {
      u->GetTuple(i, surface.displacement[static_cast<std::size_t>(i)].data());
    }
  }
  if (auto* stress = fields->GetArray("von_mises"); stress != nullptr) {
    surface.stress_unit = unit_of(stress);
    for (vtkIdType i = 0; i < count; ++i) {
      surface.von_mises.push_back(stress->GetComponent(i, 0));
    }
  }
}

}  // namespace

PictureSurface load_surface(const std::string& path) {
  require_file(path);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || data->GetNumberOfPolys() == 0) {
    refuse(path, "is no VTK surface or holds no facets");
  }
  auto* labels = data->GetCellData()->GetArray("surface");
  if (labels == nullptr) {
    refuse(path, "has no cell data 'surface'");
  }
  PictureSurface surface;
  surface.mesh.points = points_of(data);
  surface.mesh.labels = names_in(data);
  const int names = static_cast<int>(surface.mesh.labels.size());
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c) {
    data->GetCellPoints(c, ids);
    const int label = static_cast<int>(labels->GetComponent(c, 0));
    if (ids->GetNumberOfIds() != 3 || label < 0 || label >= names) {
      refuse(path, "has a cell that is no triangle of a named surface");
    }
    surface.mesh.facets.push_back({static_cast<int>(ids->GetId(0)),
                                   static_cast<int>(ids->GetId(1)),
                                   static_cast<int>(ids->GetId(2))});
    surface.mesh.facet_label.push_back(label);
  }
  read_point_fields(data, surface);
  return surface;
}

PictureTets load_tets(const std::string& path) {
  require_file(path);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  // The fields are nine tenths of the file.
  reader->UpdateInformation();
  reader->GetPointDataArraySelection()->DisableAllArrays();
  reader->GetCellDataArraySelection()->DisableAllArrays();
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  PictureTets tets;
  tets.nodes = points_of(grid);
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    const int type = grid->GetCellType(c);
    if (type == VTK_TETRA || type == VTK_QUADRATIC_TETRA) {
      grid->GetCellPoints(c, ids);
      auto& corners = tets.corners.emplace_back();
      for (int k = 0; k < 4; ++k) {
        corners[static_cast<std::size_t>(k)] = static_cast<int>(ids->GetId(k));
      }
    }
  }
  if (reader->GetErrorCode() != 0 || tets.corners.empty()) {
    refuse(path, "is no VTK volume or holds no tetrahedra");
  }
  return tets;
}

SurfaceMesh cut_open(const PictureTets& tets, const Vec3& normal) {
  Vec3 low = tets.nodes.front();
  Vec3 high = low;
  for (const Vec3& p : tets.nodes) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double level = normal.dot(0.5 * (low + high));
  struct Side {
    Triangle key;  // corners, sorted
    Triangle corners;
    bool kept;
  };
  constexpr std::array<Triangle, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::vector<Side> sides;
  sides.reserve(4 * tets.corners.size());
  for (const auto& tet : tets.corners) {
    Vec3 middle = Vec3::Zero();
    for (const int id : tet) {
      middle += 0.25 * tets.nodes[static_cast<std::size_t>(id)];
    }
    const bool kept = normal.dot(middle) <= level;
    for (const Triangle& face : kFaces) {
      const Triangle ids = {tet[static_cast<std::size_t>(face[0])],
                            tet[static_cast<std::size_t>(face[1])],
                            tet[static_cast<std::size_t>(face[2])]};
      Triangle key = ids;
      std::sort(key.begin(), key.end());
      sides.push_back({key, ids, kept});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.key, b.kept) < std::tie(b.key, a.kept);
  });
  SurfaceMesh result;
  result.labels = {"outside", "inside"};
  result.points = tets.nodes;
  // Of a face's two sides the kept one comes first.
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool two = i + 1 < sides.size() && sides[i + 1].key == sides[i].key;
    const bool both_kept = two && sides[i].kept && sides[i + 1].kept;
    if (sides[i].kept && !both_kept) {
      result.facets.push_back(sides[i].corners);
      result.facet_label.push_back(two ? 1 : 0);
    }
    i += two ? 1 : 0;
  }
  return result;
}

std::vector<Edge> rim_edges(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  constexpr int kUnseen = -1;
  std::vector<int> first_label(edges.size(), kUnseen);
  std::vector<int> facets(edges.size(), 0);
  std::vector<char> rim(edges.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int id : facet_edges[f]) {
      const auto e = static_cast<std::size_t>(id);
      ++facets[e];
      if (first_label[e] == kUnseen) {
        first_label[e] = mesh.facet_label[f];
      } else if (first_label[e] != mesh.facet_label[f]) {
        rim[e] = 1;
      }
    }
  }
  std::vector<Edge> result;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (rim[e] != 0 || facets[e] != 2) {
      result.push_back(edges[e]);
    }
  }
  return result;
}

}  // namespace meniscus
