#include "mesh_tet/tetrahedralize.h"
#include "pipeline/reader/case_reader.h"

int main(int, char** arguments) {
  const meniscus::case_data::Case input =
      meniscus::reader::read_case(arguments[1]);
  meniscus::SurfaceMesh surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  surface.facets = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  surface.facet_label = {0, 0, 0, 0};
  surface.labels = {"skin"};
  return meniscus::mesh_tet::tetrahedralize(surface).failure ? 1 : 0;
}
