#include "report/render/render_data.h"

#include <algorithm>
#include <filesystem>
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

namespace meniscus::render {

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

void read_point_fields(vtkPolyData* data, const std::string& ending,
                       picture::PictureSurface& surface) {
  const vtkIdType count = data->GetNumberOfPoints();
  vtkPointData* fields = data->GetPointData();
  if (auto* u = fields->GetArray(("displacement" + ending).c_str());
      u != nullptr && u->GetNumberOfComponents() == 3) {
    surface.length_unit = unit_of(u);
    surface.displacement.resize(static_cast<std::size_t>(count));
    for (vtkIdType i = 0; i < count; ++i) {
      u->GetTuple(i, surface.displacement[static_cast<std::size_t>(i)].data());
    }
  }
  if (auto* stress = fields->GetArray(("von_mises" + ending).c_str());
      stress != nullptr) {
    surface.stress_unit = unit_of(stress);
    for (vtkIdType i = 0; i < count; ++i) {
      surface.von_mises.push_back(stress->GetComponent(i, 0));
    }
  }
}

}  // namespace

picture::PictureSurface load_surface(const std::string& path,
                                     const std::string& ending) {
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
  picture::PictureSurface surface;
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
  read_point_fields(data, ending, surface);
  return surface;
}

picture::PictureTets load_tets(const std::string& path) {
  require_file(path);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  // The fields are nine tenths of the file.
  reader->UpdateInformation();
  reader->GetPointDataArraySelection()->DisableAllArrays();
  reader->GetCellDataArraySelection()->DisableAllArrays();
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  picture::PictureTets tets;
  tets.nodes = points_of(grid);
  bool is_shell = false;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    const int type = grid->GetCellType(c);
    is_shell = is_shell || type == VTK_QUADRATIC_TRIANGLE;
    if (type == VTK_TETRA || type == VTK_QUADRATIC_TETRA) {
      grid->GetCellPoints(c, ids);
      auto& corners = tets.corners.emplace_back();
      for (int k = 0; k < 4; ++k) {
        corners[static_cast<std::size_t>(k)] = static_cast<int>(ids->GetId(k));
      }
    }
  }
  if (reader->GetErrorCode() != 0 || (tets.corners.empty() && !is_shell)) {
    refuse(path, "is no VTK volume or holds no tetrahedra");
  }
  return tets;
}

namespace {

/// A face of an element that is kept, by its corners in order of size.
struct Side {
  Triangle key;
  Triangle corners;
};

constexpr std::array<Triangle, 4> kFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Side side_of(const std::array<int, 4>& tet, const Triangle& face) {
  const Triangle ids = {tet[static_cast<std::size_t>(face[0])],
                        tet[static_cast<std::size_t>(face[1])],
                        tet[static_cast<std::size_t>(face[2])]};
  Side side{ids, ids};
  std::sort(side.key.begin(), side.key.end());
  return side;
}

/// Faces of one kept element only, in order of their keys.
std::vector<Side> bare_sides(const picture::PictureTets& tets,
                             const std::vector<char>& kept) {
  std::vector<Side> sides;
  sides.reserve(4 * tets.corners.size());
  for (std::size_t t = 0; t < kept.size(); ++t) {
    for (const Triangle& face : kFaces) {
      if (kept[t] != 0) {
        sides.push_back(side_of(tets.corners[t], face));
      }
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.key < b.key; });
  std::vector<Side> bare;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i + 1].key == sides[i].key) {
      ++i;
    } else {
      bare.push_back(sides[i]);
    }
  }
  return bare;
}

}  // namespace

SurfaceMesh cut_open(const picture::PictureTets& tets, const CutPlane& plane) {
  std::vector<double> height(tets.nodes.size());
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = plane.normal.dot(tets.nodes[i]);
  }
  std::vector<char> kept(tets.corners.size());
  for (std::size_t t = 0; t < kept.size(); ++t) {
    double sum = 0.0;
    for (const int id : tets.corners[t]) {
      sum += 0.25 * height[static_cast<std::size_t>(id)];
    }
    kept[t] = static_cast<char>(sum <= plane.level);
  }
  const std::vector<Side> bare = bare_sides(tets, kept);
  // Only elements with a bare face's three corners can be its other side.
  std::vector<char> at_bare(tets.nodes.size(), 0);
  for (const Side& side : bare) {
    for (const int id : side.key) {
      at_bare[static_cast<std::size_t>(id)] = 1;
    }
  }
  std::vector<Triangle> gone;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    int near = 0;
    for (const int id : tets.corners[t]) {
      near += at_bare[static_cast<std::size_t>(id)];
    }
    for (const Triangle& face : kFaces) {
      if (kept[t] == 0 && near >= 3) {
        gone.push_back(side_of(tets.corners[t], face).key);
      }
    }
  }
  std::sort(gone.begin(), gone.end());
  SurfaceMesh result;
  result.labels = {"outside", "inside"};
  result.points = tets.nodes;
  for (const Side& side : bare) {
    result.facets.push_back(side.corners);
    result.facet_label.push_back(
        std::binary_search(gone.begin(), gone.end(), side.key) ? 1 : 0);
  }
  return result;
}

SurfaceMesh without(const SurfaceMesh& mesh,
                    const std::vector<std::string>& hidden) {
  if (hidden.empty()) {
    return mesh;
  }
  SurfaceMesh left;
  left.labels = mesh.labels;
  std::vector<int> number(mesh.points.size(), -1);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int label = mesh.facet_label[f];
    if (picture::is_hidden(mesh.labels[static_cast<std::size_t>(label)],
                           hidden)) {
      continue;
    }
    Triangle facet = mesh.facets[f];
    for (int& id : facet) {
      const auto old = static_cast<std::size_t>(id);
      if (number[old] < 0) {
        number[old] = static_cast<int>(left.points.size());
        left.points.push_back(mesh.points[old]);
      }
      id = number[old];
    }
    left.facets.push_back(facet);
    left.facet_label.push_back(label);
  }
  return left;
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

}  // namespace meniscus::render
