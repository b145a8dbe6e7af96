#include "io/vtk_files.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::vtk_files_test {
namespace {

io::Field ramp(const std::string& name, std::size_t count, int components) {
  io::Field field{name, "MPa", components, {}};
  field.values.resize(count * static_cast<std::size_t>(components));
  std::iota(field.values.begin(), field.values.end(), 0.1);
  return field;
}

template <class Reader>
auto read_back(const std::filesystem::path& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u);
  auto* data = reader->GetOutput();
  data->Register(nullptr);
  return vtkSmartPointer<std::remove_pointer_t<decltype(data)>>::Take(data);
}

std::string text_of(vtkDataSet* data, const char* name, int index = 0) {
  auto* array = vtkStringArray::SafeDownCast(
      data->GetFieldData()->GetAbstractArray(name));
  return array != nullptr ? array->GetValue(index) : "";
}

class VtuTest : public ::testing::TestWithParam<int> {};

TEST_P(VtuTest, ComesBackBitForBit) {
  const TempFolder folder;
  TetMesh mesh = shapes::sheared(shapes::brick(Vec3(2, 1, 3), 2, 3, 2), 0.3);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  io::MeshFields fields;
  fields.points = {ramp("displacement", mesh.nodes.size(), 3),
                   ramp("stress", mesh.nodes.size(), 6),
                   ramp("von_mises", mesh.nodes.size(), 1)};
  fields.cells = {
      ramp("density", static_cast<std::size_t>(mesh.element_count()), 1)};
  fields.notes = {{"title", "Zweiarm-Träger"}, {"length_unit", "mm"}};
  io::write_vtu(folder / "part.vtu", mesh, fields);
  const auto grid =
      read_back<vtkXMLUnstructuredGridReader>(folder / "part.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(),
            static_cast<vtkIdType>(mesh.nodes.size()));
  ASSERT_EQ(grid->GetNumberOfCells(), mesh.element_count());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    EXPECT_EQ(Vec3(grid->GetPoint(static_cast<vtkIdType>(i))), mesh.nodes[i]);
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_EQ(grid->GetCellType(e),
              GetParam() == 1 ? VTK_TETRA : VTK_QUADRATIC_TETRA);
    const auto ids = mesh.element(e);
    for (int k = 0; k < mesh.nodes_per_element(); ++k) {
      EXPECT_EQ(grid->GetCell(e)->GetPointId(k), ids[k]);
    }
  }
  auto* stress = grid->GetPointData()->GetArray("stress");
  ASSERT_NE(stress, nullptr);
  EXPECT_EQ(stress->GetNumberOfComponents(), 6);
  EXPECT_STREQ(stress->GetComponentName(5), "XZ");
  EXPECT_EQ(stress->GetComponent(3, 4), fields.points[1].values[22]);
  EXPECT_STREQ(stress->GetInformation()->Get(vtkDataArray::UNITS_LABEL()),
               "MPa");
  EXPECT_NE(grid->GetCellData()->GetArray("region"), nullptr);
  EXPECT_NE(grid->GetCellData()->GetArray("density"), nullptr);
  EXPECT_EQ(text_of(grid, "title"), "Zweiarm-Träger");
}

TEST_P(VtuTest, BoundaryIsClosedAndKeepsLabelsAndFields) {
  const TempFolder folder;
  TetMesh mesh = shapes::brick(Vec3(2, 1, 3), 2, 3, 2);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  const io::BoundarySurface boundary = io::boundary_surface(mesh);
  constexpr double kRounding = 1e-13;
  EXPECT_NEAR(enclosed_volume(boundary.mesh), 6.0, 6 * kRounding);
  EXPECT_NEAR(surface_area(boundary.mesh, mesh.label_of("z1")), 2.0,
              2 * kRounding);
  io::MeshFields fields;
  fields.points = {ramp("displacement", mesh.nodes.size(), 3)};
  io::write_boundary_vtp(folder / "part_surface.vtp", mesh, fields);
  const auto data =
      read_back<vtkXMLPolyDataReader>(folder / "part_surface.vtp");
  auto* values = data->GetPointData()->GetArray("displacement");
  ASSERT_NE(values, nullptr);
  for (std::size_t p = 0; p < boundary.nodes.size(); ++p) {
    EXPECT_EQ(values->GetComponent(static_cast<vtkIdType>(p), 1),
              fields.points[0].values[3 * boundary.nodes[p] + 1]);
  }
  EXPECT_EQ(text_of(data, "surface_names", 4), "z0");
}

INSTANTIATE_TEST_SUITE_P(Orders, VtuTest, ::testing::Values(1, 2));

TEST(Vtp, FilmComesBackWithLabels) {
  const TempFolder folder;
  const SurfaceMesh mesh = shapes::box(Vec3(1, 2, 3), 2);
  io::MeshFields fields;
  fields.points = {ramp("mean_curvature", mesh.points.size(), 1)};
  io::write_vtp(folder / "film.vtp", mesh, fields);
  const auto data = read_back<vtkXMLPolyDataReader>(folder / "film.vtp");
  ASSERT_EQ(data->GetNumberOfPolys(),
            static_cast<vtkIdType>(mesh.facets.size()));
  auto* labels = data->GetCellData()->GetArray("surface");
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    EXPECT_EQ(labels->GetComponent(static_cast<vtkIdType>(f), 0),
              mesh.facet_label[f]);
    EXPECT_EQ(data->GetCell(static_cast<vtkIdType>(f))->GetPointId(1),
              mesh.facets[f][1]);
  }
  EXPECT_EQ(text_of(data, "surface_names", 5), "z1");
}

TEST(Vtp, FindingsSurviveBrokenSurfaces) {
  const TempFolder folder;
  SurfaceMesh mesh = shapes::box(Vec3(1, 1, 1), 1);
  mesh.facets[2][0] = 400;
  mesh.points[0].x() = std::numeric_limits<double>::quiet_NaN();
  std::vector<Finding> findings(2);
  findings[0] = {FindingKind::BadIndex, {2, -1, 99}, Vec3(1, 1, 1), "bad id"};
  findings[1] = {FindingKind::Crossing,
                 {10, 11},
                 Vec3::Constant(std::nan("")),
                 "crossing"};
  io::write_findings_vtp(folder / "findings.vtp", mesh, findings);
  const auto data = read_back<vtkXMLPolyDataReader>(folder / "findings.vtp");
  EXPECT_EQ(data->GetNumberOfVerts(), 1);
  EXPECT_EQ(data->GetCellData()->GetArray("finding")->GetNumberOfTuples(),
            data->GetNumberOfCells());
  EXPECT_EQ(text_of(data, "messages", 1), "crossing");
}

TEST(Vtp, RefusesFieldsAndIdsThatDoNotFit) {
  const TempFolder folder;
  SurfaceMesh mesh = shapes::box(Vec3(1, 1, 1), 1);
  io::MeshFields fields;
  fields.points = {ramp("u", mesh.points.size() - 1, 3)};
  EXPECT_THROW(io::write_vtp(folder / "a.vtp", mesh, fields), InvalidInput);
  fields.points[0].components = 0;
  EXPECT_THROW(io::write_vtp(folder / "a.vtp", mesh, fields), InvalidInput);
  mesh.facets[0][0] = -3;
  EXPECT_THROW(io::write_vtp(folder / "a.vtp", mesh), InvalidInput);
  mesh.facets[0][0] = 0;
  mesh.facet_label.pop_back();
  EXPECT_THROW(io::write_vtp(folder / "a.vtp", mesh), InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.vtp"));
}

}  // namespace
}  // namespace meniscus::vtk_files_test
