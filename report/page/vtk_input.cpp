#include "report/page/vtk_input.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <fmt/format.h>

#include "core/error.h"
#include "report/page/vtk_bounds.h"

namespace meniscus::page {

namespace fs = std::filesystem;

namespace {

/// VTK prints what it finds wrong; here it becomes a message.
class Hushed {
 public:
  Hushed() : before_(vtkObject::GetGlobalWarningDisplay()) {
    vtkObject::SetGlobalWarningDisplay(0);
  }
  ~Hushed() { vtkObject::SetGlobalWarningDisplay(before_); }
  Hushed(const Hushed&) = delete;
  Hushed& operator=(const Hushed&) = delete;

 private:
  int before_;
};

void copy_arrays(vtkFieldData* from, vtkIdType items, const fs::path& path,
                 std::map<std::string, std::vector<double>>& to) {
  for (int a = 0; a < from->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = from->GetArray(a);
    if (array == nullptr || array->GetName() == nullptr) {
      continue;
    }
    if (array->GetNumberOfTuples() != items) {
      refuse_file(path, fmt::format("has {} values of '{}' for {} items",
                                    array->GetNumberOfTuples(),
                                    array->GetName(), items));
    }
    const auto width = static_cast<std::size_t>(array->GetNumberOfComponents());
    std::vector<double>& values = to[array->GetName()];
    values.resize(width * static_cast<std::size_t>(items));
    for (vtkIdType i = 0; i < items; ++i) {
      array->GetTuple(i, values.data() + width * static_cast<std::size_t>(i));
    }
  }
}

void copy_texts(vtkFieldData* from, VtkInput& to) {
  for (int a = 0; a < from->GetNumberOfArrays(); ++a) {
    auto* array = vtkStringArray::SafeDownCast(from->GetAbstractArray(a));
    if (array == nullptr || array->GetName() == nullptr) {
      continue;
    }
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i) {
      to.texts[array->GetName()].push_back(array->GetValue(i));
    }
  }
}

void copy_cells(vtkCellArray* cells, const fs::path& path, VtkInput& to) {
  const vtkIdType count = cells->GetNumberOfCells();
  if (count == 0) {
    return;
  }
  if (!cells->IsValid()) {
    refuse_file(path, "has cells that do not fit their corners");
  }
  to.cell_size = static_cast<int>(cells->GetCellSize(0));
  to.cells.reserve(static_cast<std::size_t>(count * to.cell_size));
  const vtkIdType* ids = nullptr;
  vtkIdType size = 0;
  for (vtkIdType c = 0; c < count; ++c) {
    cells->GetCellAtId(c, size, ids);
    if (size != to.cell_size) {
      refuse_file(path, "mixes cells of several sizes");
    }
    for (vtkIdType k = 0; k < size; ++k) {
      if (ids[k] < 0 || static_cast<std::size_t>(ids[k]) >= to.points.size()) {
        refuse_file(path, fmt::format("has a cell with point {} of {}", ids[k],
                                      to.points.size()));
      }
      to.cells.push_back(static_cast<int>(ids[k]));
    }
  }
}

template <class Reader>
VtkInput read_with(const fs::path& path,
                   const std::vector<std::string>& skipped) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  if (reader->CanReadFile(path.c_str()) == 0) {
    refuse_file(path, "is no such VTK file");
  }
  reader->UpdateInformation();
  for (const std::string& name : skipped) {
    reader->GetPointDataArraySelection()->DisableArray(name.c_str());
    reader->GetCellDataArraySelection()->DisableArray(name.c_str());
  }
  reader->Update();
  vtkPointSet* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || data == nullptr ||
      data->GetNumberOfPoints() == 0) {
    refuse_file(path, "cannot be read");
  }
  VtkInput result;
  result.points.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    data->GetPoint(static_cast<vtkIdType>(i), result.points[i].data());
  }
  if (auto* surface = vtkPolyData::SafeDownCast(data)) {
    copy_cells(surface->GetVerts(), path, result);
    result.vertices = std::move(result.cells);
    result.cells.clear();
    result.cell_size = 0;
    copy_cells(surface->GetPolys(), path, result);
  } else {
    copy_cells(vtkUnstructuredGrid::SafeDownCast(data)->GetCells(), path,
               result);
  }
  copy_arrays(data->GetPointData(), data->GetNumberOfPoints(), path,
              result.point_data);
  copy_arrays(data->GetCellData(), data->GetNumberOfCells(), path,
              result.cell_data);
  copy_texts(data->GetFieldData(), result);
  return result;
}

}  // namespace

void refuse_file(const std::filesystem::path& path, const std::string& what) {
  throw InvalidInput(fmt::format(
      "'{}' {}; it is damaged or none of this program's: run the case again",
      path.string(), what));
}

VtkInput read_vtk(const fs::path& path,
                  const std::vector<std::string>& skipped) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    throw InvalidInput(fmt::format("there is no file '{}'", path.string()));
  }
  check_vtk_bounds(path);
  const Hushed hushed;
  return path.extension() == ".vtu"
             ? read_with<vtkXMLUnstructuredGridReader>(path, skipped)
             : read_with<vtkXMLPolyDataReader>(path, skipped);
}

}  // namespace meniscus::page
