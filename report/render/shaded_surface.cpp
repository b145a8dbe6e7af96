#include "report/render/shaded_surface.h"

#include <algorithm>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>

namespace meniscus::render {

namespace {

/// The facets of the labels in use, label after label.
std::vector<std::size_t> by_label(const SurfaceMesh& mesh,
                                  const std::vector<char>& use_label) {
  std::vector<std::size_t> facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (use_label[static_cast<std::size_t>(mesh.facet_label[f])] != 0) {
      facets.push_back(f);
    }
  }
  std::stable_sort(facets.begin(), facets.end(),
                   [&](std::size_t a, std::size_t b) {
                     return mesh.facet_label[a] < mesh.facet_label[b];
                   });
  return facets;
}

}  // namespace

ShadedSurface shade(const SurfaceMesh& mesh,
                    const std::vector<char>& use_label) {
  ShadedSurface result;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkDoubleArray> sources;  // survives the filter, which splits too
  sources->SetName("source");
  struct Copy {
    int label = -1;
    vtkIdType id = 0;
  };
  std::vector<Copy> copies(mesh.points.size());  // the last label's
  for (const std::size_t f : by_label(mesh, use_label)) {
    const int label = mesh.facet_label[f];
    cells->InsertNextCell(3);
    for (const int point : mesh.facets[f]) {
      Copy& copy = copies[static_cast<std::size_t>(point)];
      if (copy.label != label) {
        copy = {label,
                points->InsertNextPoint(
                    mesh.points[static_cast<std::size_t>(point)].data())};
        sources->InsertNextValue(point);
      }
      cells->InsertCellPoint(copy.id);
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

}  // namespace meniscus::render
