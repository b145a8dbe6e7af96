#include "io/vtk_files.h"

#include <algorithm>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtkZLibDataCompressor.h>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace meniscus::io {

namespace fs = std::filesystem;

namespace {

// Level 1 takes a third of the time of VTK's default for a tenth more bytes.
constexpr int kCompression = 1;
constexpr std::array<const char*, 6> kTensorNames = {"XX", "YY", "ZZ",
                                                     "XY", "YZ", "XZ"};

vtkNew<vtkPoints> make_points(const Points& points) {
  vtkNew<vtkPoints> result;
  result->SetDataTypeToDouble();
  result->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    result->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  return result;
}

void add_field(vtkDataSetAttributes* data, const Field& field,
               std::size_t count, const char* what, const fs::path& path) {
  if (field.components < 1 ||
      field.values.size() !=
          count * static_cast<std::size_t>(std::max(field.components, 1))) {
    throw InvalidInput(fmt::format(
        "field '{}' for '{}' has {} values; {} {} x {} components need {}",
        field.name, path.string(), field.values.size(), count, what,
        field.components, count * std::max(field.components, 0)));
  }
  vtkNew<vtkDoubleArray> array;
  array->SetName(field.name.c_str());
  array->SetNumberOfComponents(field.components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
  if (field.components == 6) {
    for (int c = 0; c < 6; ++c) {
      array->SetComponentName(c, kTensorNames[c]);
    }
  }
  if (!field.unit.empty()) {
    array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(),
                                 field.unit.c_str());
  }
  data->AddArray(array);
}

void add_ints(vtkDataSet* set, const char* name, const std::vector<int>& values,
              const fs::path& path) {
  if (static_cast<vtkIdType>(values.size()) != set->GetNumberOfCells()) {
    throw InvalidInput(fmt::format("'{}' for '{}' has {} values for {} cells",
                                   name, path.string(), values.size(),
                                   set->GetNumberOfCells()));
  }
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  set->GetCellData()->AddArray(array);
}

void add_texts(vtkFieldData* data, const std::string& name,
               const std::vector<std::string>& texts) {
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  for (const std::string& text : texts) {
    array->InsertNextValue(text);
  }
  data->AddArray(array);
}

void add_numbers(vtkFieldData* data, const Field& field) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(field.name.c_str());
  for (const double value : field.values) {
    array->InsertNextValue(value);
  }
  data->AddArray(array);
}

void add_fields(vtkDataSet* data, const MeshFields& fields,
                const fs::path& path) {
  for (const Field& field : fields.points) {
    add_field(data->GetPointData(), field,
              static_cast<std::size_t>(data->GetNumberOfPoints()), "points",
              path);
  }
  for (const Field& field : fields.cells) {
    add_field(data->GetCellData(), field,
              static_cast<std::size_t>(data->GetNumberOfCells()), "cells",
              path);
  }
  for (const auto& [name, text] : fields.notes) {
    add_texts(data->GetFieldData(), name, {text});
  }
  for (const auto& [name, texts] : fields.lists) {
    add_texts(data->GetFieldData(), name, texts);
  }
  for (const Field& field : fields.numbers) {
    add_numbers(data->GetFieldData(), field);
  }
}

/// Written into memory first: VTK's writers overlook some short writes.
template <class Writer>
void write(const fs::path& path, vtkDataObject* data) {
  vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->WriteToOutputStringOn();
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  vtkNew<vtkZLibDataCompressor> compressor;
  compressor->SetCompressionLevel(kCompression);
  writer->SetCompressor(compressor);
  if (writer->Write() != 1 || writer->GetOutputString().empty()) {
    throw IoError(fmt::format(
        "VTK's writer failed on '{}'; there may be too little memory",
        path.string()));
  }
  write_file(path, writer->GetOutputString());
}

void check_ids(const std::vector<int>& ids, std::size_t count,
               const fs::path& path) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] < 0 || static_cast<std::size_t>(ids[i]) >= count) {
      throw InvalidInput(fmt::format(
          "the mesh for '{}' names point {} at place {}, but has {} points",
          path.string(), ids[i], i, count));
    }
  }
}

/// Cells of `size` points each.
vtkNew<vtkCellArray> make_cells(const std::vector<int>& ids, int size) {
  vtkNew<vtkCellArray> cells;
  const std::size_t count = ids.size() / static_cast<std::size_t>(size);
  cells->AllocateExact(static_cast<vtkIdType>(count),
                       static_cast<vtkIdType>(ids.size()));
  std::vector<vtkIdType> cell(static_cast<std::size_t>(size));
  for (std::size_t c = 0; c < count; ++c) {
    std::copy_n(ids.begin() + static_cast<std::ptrdiff_t>(c * cell.size()),
                cell.size(), cell.begin());
    cells->InsertNextCell(size, cell.data());
  }
  return cells;
}

vtkNew<vtkCellArray> make_triangles(const std::vector<Triangle>& facets) {
  std::vector<int> ids;
  ids.reserve(3 * facets.size());
  for (const Triangle& facet : facets) {
    ids.insert(ids.end(), facet.begin(), facet.end());
  }
  return make_cells(ids, 3);
}

bool drawable(const SurfaceMesh& mesh, int facet) {
  if (facet < 0 || facet >= static_cast<int>(mesh.facets.size())) {
    return false;
  }
  const Triangle& ids = mesh.facets[static_cast<std::size_t>(facet)];
  return std::all_of(ids.begin(), ids.end(), [&](int id) {
    return id >= 0 && id < static_cast<int>(mesh.points.size()) &&
           mesh.points[static_cast<std::size_t>(id)].allFinite();
  });
}

}  // namespace

void write_vtu(const fs::path& path, const TetMesh& mesh,
               const MeshFields& fields) {
  check_ids(mesh.elements, mesh.nodes.size(), path);
  check_ids(mesh.faces, mesh.nodes.size(), path);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(make_points(mesh.nodes));
  if (mesh.elements.empty()) {
    grid->SetCells(mesh.order == 1 ? VTK_TRIANGLE : VTK_QUADRATIC_TRIANGLE,
                   make_cells(mesh.faces, mesh.nodes_per_face()));
    add_ints(grid, "surface", mesh.face_label, path);
    add_texts(grid->GetFieldData(), "surface_names", mesh.labels);
    add_fields(grid, fields, path);
    write<vtkXMLUnstructuredGridWriter>(path, grid);
    return;
  }
  // Faces of shells have no elements behind them: cells behind the elements.
  std::vector<int> region = mesh.element_region;
  std::vector<int> types(region.size(),
                         mesh.order == 1 ? VTK_TETRA : VTK_QUADRATIC_TETRA);
  vtkNew<vtkCellArray> cells =
      make_cells(mesh.elements, mesh.nodes_per_element());
  for (int f = 0; f < std::ssize(mesh.face_element); ++f) {
    if (mesh.face_element[f] < 0) {
      const auto face = mesh.face(f);
      const std::vector<vtkIdType> ids(face.begin(), face.end());
      cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
      types.push_back(mesh.order == 1 ? VTK_TRIANGLE : VTK_QUADRATIC_TRIANGLE);
      region.push_back(-1);
    }
  }
  grid->SetCells(types.data(), cells);
  add_ints(grid, "region", region, path);
  add_fields(grid, fields, path);
  write<vtkXMLUnstructuredGridWriter>(path, grid);
}

void write_vtp(const fs::path& path, const SurfaceMesh& mesh,
               const MeshFields& fields) {
  for (const Triangle& facet : mesh.facets) {
    check_ids({facet.begin(), facet.end()}, mesh.points.size(), path);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(make_points(mesh.points));
  data->SetPolys(make_triangles(mesh.facets));
  add_ints(data, "surface", mesh.facet_label, path);
  add_texts(data->GetFieldData(), "surface_names", mesh.labels);
  add_fields(data, fields, path);
  write<vtkXMLPolyDataWriter>(path, data);
}

BoundarySurface boundary_surface(const TetMesh& mesh) {
  BoundarySurface result;
  result.mesh.labels = mesh.labels;
  std::vector<int> point_of(mesh.nodes.size(), -1);
  const auto point = [&](int node) {
    int& id = point_of[static_cast<std::size_t>(node)];
    if (id < 0) {
      id = static_cast<int>(result.nodes.size());
      result.nodes.push_back(node);
      result.mesh.points.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    }
    return id;
  };
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto ids = mesh.face(f);
    const auto add = [&](int a, int b, int c) {
      result.mesh.facets.push_back(
          {point(ids[a]), point(ids[b]), point(ids[c])});
      result.mesh.facet_label.push_back(mesh.face_label[f]);
      result.faces.push_back(f);
    };
    if (mesh.order == 1) {
      add(0, 1, 2);
    } else {
      add(0, 3, 5);
      add(3, 1, 4);
      add(5, 4, 2);
      add(3, 4, 5);
    }
  }
  return result;
}

void write_boundary_vtp(const fs::path& path, const TetMesh& mesh,
                        const MeshFields& fields) {
  check_ids(mesh.faces, mesh.nodes.size(), path);
  const BoundarySurface boundary = boundary_surface(mesh);
  MeshFields kept;
  kept.notes = fields.notes;
  for (const Field& field : fields.points) {
    const auto size = static_cast<std::size_t>(std::max(field.components, 1));
    if (field.values.size() != size * mesh.nodes.size()) {
      throw InvalidInput(fmt::format(
          "field '{}' for '{}' has {} values; {} nodes x {} components need {}",
          field.name, path.string(), field.values.size(), mesh.nodes.size(),
          size, size * mesh.nodes.size()));
    }
    Field& on_boundary = kept.points.emplace_back(
        Field{field.name, field.unit, field.components, {}});
    for (const int node : boundary.nodes) {
      const auto from =
          field.values.begin() + static_cast<std::ptrdiff_t>(size) * node;
      on_boundary.values.insert(on_boundary.values.end(), from,
                                from + static_cast<std::ptrdiff_t>(size));
    }
  }
  write_vtp(path, boundary.mesh, kept);
}

void write_findings_vtp(const fs::path& path, const SurfaceMesh& mesh,
                        const std::vector<Finding>& findings) {
  Points points;
  std::vector<int> verts, polys;
  std::vector<int> vert_finding, poly_finding;
  std::vector<std::string> messages;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const Finding& finding = findings[i];
    messages.push_back(finding.message);
    if (finding.position.allFinite()) {
      verts.push_back(static_cast<int>(points.size()));
      vert_finding.push_back(static_cast<int>(i));
      points.push_back(finding.position);
    }
    for (const int facet : finding.facets) {
      if (!drawable(mesh, facet)) {
        continue;
      }
      poly_finding.push_back(static_cast<int>(i));
      for (const int id : mesh.facets[static_cast<std::size_t>(facet)]) {
        polys.push_back(static_cast<int>(points.size()));
        points.push_back(mesh.points[static_cast<std::size_t>(id)]);
      }
    }
  }
  std::vector<int> finding_ids = vert_finding;  // VTK's order: verts, polys
  finding_ids.insert(finding_ids.end(), poly_finding.begin(),
                     poly_finding.end());
  std::vector<int> kinds;
  kinds.reserve(finding_ids.size());
  for (const int id : finding_ids) {
    kinds.push_back(
        static_cast<int>(findings[static_cast<std::size_t>(id)].kind));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(make_points(points));
  data->SetVerts(make_cells(verts, 1));
  data->SetPolys(make_cells(polys, 3));
  add_ints(data, "finding", finding_ids, path);
  add_ints(data, "kind", kinds, path);
  add_texts(data->GetFieldData(), "messages", messages);
  write<vtkXMLPolyDataWriter>(path, data);
}

}  // namespace meniscus::io
