#include "report/shaded_surface.h"

#include <map>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>

namespace meniscus {

namespace {

constexpr double kCreaseAngle = 50.0;  // sharper is drawn as a crease [deg]

}  // namespace

ShadedSurface shade(const SurfaceMesh& mesh,
                    const std::vector<char>& use_label) {
  ShadedSurface result;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkDoubleArray> sources;  // survives the filter, which splits too
  sources->SetName("source");
  std::map<std::array<int, 2>, vtkIdType> ids;  // (label, point)
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int label = mesh.facet_label[f];
    if (use_label[static_cast<std::size_t>(label)] == 0) {
      continue;
    }
    cells->InsertNextCell(3);
    for (const int point : mesh.facets[f]) {
      const auto [at, added] =
          ids.emplace(std::array<int, 2>{label, point}, ids.size());
      if (added) {
        points->InsertNextPoint(
            mesh.points[static_cast<std::size_t>(point)].data());
        sources->InsertNextValue(point);
      }
      cells->InsertCellPoint(at->second);
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->AddArray(sources);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(data);
  normals->SetFeatureAngle(kCreaseAngle);
  normals->ConsistencyOff();
  normals->Update();
  result.data = normals->GetOutput();
  auto* kept = result.data->GetPointData()->GetArray("source");
  for (vtkIdType i = 0; i < result.data->GetNumberOfPoints(); ++i) {
    result.source.push_back(static_cast<int>(kept->GetComponent(i, 0)));
  }
  return result;
}

}  // namespace meniscus
