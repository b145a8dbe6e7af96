/// What VTK's own reader finds in a .vtu file, one line each: points, cells
/// with their types, arrays with their least
/// and greatest values. For tests/regression/export_test.py.
#include <cstdio>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace {

void list(const char* of, vtkFieldData* data) {
  for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
    vtkDataArray* array = data->GetArray(k);
    if (array == nullptr) {
      continue;  // text
    }
    double range[2] = {0.0, 0.0};
    array->GetRange(range, -1);  // of the magnitude
    std::printf("%s|%s|%lld|%d|%.17g|%.17g\n", of, array->GetName(),
                static_cast<long long>(array->GetNumberOfTuples()),
                array->GetNumberOfComponents(), range[0], range[1]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    return 2;
  }
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  if (reader->CanReadFile(argv[1]) == 0) {
    std::fputs("VTK cannot read it\n", stderr);
    return 1;
  }
  reader->SetFileName(argv[1]);
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  std::printf("points|%lld\ncells|%lld\n",
              static_cast<long long>(grid->GetNumberOfPoints()),
              static_cast<long long>(grid->GetNumberOfCells()));
  vtkNew<vtkCellTypes> types;
  grid->GetCellTypes(types);
  for (vtkIdType k = 0; k < types->GetNumberOfTypes(); ++k) {
    std::printf("type|%d\n", static_cast<int>(types->GetCellType(k)));
  }
  list("point", grid->GetPointData());
  list("cell", grid->GetCellData());
  return reader->GetErrorCode() == 0 ? 0 : 1;
}
