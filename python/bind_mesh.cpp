#include <fmt/format.h>

#include "python/call.h"
#include "python/errors.h"
#include "python/stage_properties.h"

namespace meniscus::python {

namespace {

const TetMesh& mesh_of(const MeshStage& self) {
  self.work->require(Stage::Mesh);
  return self.work->staged().fields.mesh;
}
const TetMesh& mesh_of(const py::object& self) {
  return mesh_of(self.cast<const MeshStage&>());
}

void bind_mesh_arrays(py::class_<MeshStage>& type) {
  type.def_property_readonly(
          "nodes",
          [](const py::object& self) {
            return view(mesh_of(self).nodes, self);
          },
          "Nodes, corners before mid-sides, float64 (nodes, 3) [length]; a "
          "read-only view.")
      .def_property_readonly(
          "elements",
          [](const py::object& self) {
            return view(mesh_of(self).elements, 10, self);
          },
          "Node numbers of each ten-node tetrahedron in VTK's order: corners, "
          "then mid-sides (01) (12) (02) (03) (13) (23), int32 (elements, 10); "
          "a read-only view.")
      .def_property_readonly(
          "regions",
          [](const py::object& self) {
            return view(mesh_of(self).element_region, self);
          },
          "Per element the number of its body, int32 (elements,); a read-only "
          "view.")
      .def_property_readonly(
          "faces",
          [](const py::object& self) {
            return view(mesh_of(self).faces, 6, self);
          },
          "Node numbers of each boundary face, counter-clockwise from outside: "
          "corners, then mid-sides (01) (12) (20), int32 (faces, 6); a "
          "read-only view.")
      .def_property_readonly(
          "face_labels",
          [](const py::object& self) {
            return view(mesh_of(self).face_label, self);
          },
          "Per face the position of its surface in `labels`, int32 (faces,); a "
          "read-only view.")
      .def_property_readonly(
          "labels", [](const MeshStage& self) { return mesh_of(self).labels; },
          "Names of the surfaces that faces belong to.");
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::class_<MeshStage> type(module, "Mesh",
                             "Ten-node tetrahedra in the part at one design.");
  bind_failure<MeshStage, Stage::Mesh>(type);
  bind_mesh_arrays(type);
  type.def_property_readonly(
          "min_dihedral",
          [](const MeshStage& self) {
            return self.work->staged().evaluation.tet.min_dihedral_deg;
          },
          "Smallest angle between two faces of an element [degree].")
      .def_property_readonly(
          "max_dihedral",
          [](const MeshStage& self) {
            return self.work->staged().evaluation.tet.max_dihedral_deg;
          },
          "Largest angle between two faces of an element [degree].")
      .def(
          "solve",
          [](const MeshStage& self) {
            Call().run([&] { self.work->advance(Stage::Solution); });
            refuse_failed(self.work->failure(Stage::Mesh));
            return SolutionStage{self.work};
          },
          "Displacements under all load cases (Solution). Raises DesignFailed "
          "where there is no mesh.")
      .def("__repr__", [](const MeshStage& self) {
        const forward::TetFigures& tet = self.work->staged().evaluation.tet;
        return fmt::format("<meniscus.Mesh {} nodes, {} elements>", tet.nodes,
                           tet.elements);
      });
}

}  // namespace meniscus::python
