/// The meshes that the report page shows, as read from a run's VTK files, and
/// made small enough for it.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/surface_mesh.h"
#include "fea/element/material.h"

namespace meniscus::page {

/// A part with its fields at the nodes that a page can show: those of the
/// surface, and the corners inside. Fields are empty where the files have none.
struct PageMesh {
  Points nodes;                     // [length]
  std::vector<Triangle> triangles;  // of the surface
  std::vector<int> labels;          // per triangle: index into names
  std::vector<std::string> names;   // of the surfaces
  /// Triangles are a face of four each: three at its corners, in order, then
  /// the middle one; else each is a face of its own.
  bool four_a_face = false;
  std::vector<std::array<int, 4>> tets;  // corners; may be empty
  std::vector<double> displacement;      // 3 per node [length]
  std::vector<double> von_mises;         // [pressure]
  std::vector<double> energy_density;    // [pressure], of the strain energy
  std::vector<double> stress_error;      // [pressure], see load_page_part
  std::string load_case;                 // of the fields; may be empty
  /// Von Mises stress of each load case by name, where the files have several.
  std::vector<std::pair<std::string, std::vector<double>>> case_von_mises;
};

/// part_surface.vtp and, where `part` exists, part.vtu of the same run.
/// `materials`: one per region, for the energy density (stress : compliance :
/// stress / 2 of nodal stresses) and the error of the stress (square root of E
/// |e|^2 / volume of each element, E its modulus or the largest of an
/// orthotropic one, averaged at the nodes); without any, both are left out.
/// Throws InvalidInput, naming the file, for one that is damaged or is of
/// another part.
PageMesh load_page_part(const std::filesystem::path& surface,
                        const std::filesystem::path& part,
                        const std::vector<element::Material>& materials);

/// Drops the nodes that no triangle or element names.
void keep_used_nodes(PageMesh& mesh);

/// The same with fewer numbers: faces cut once, not in four.
PageMesh without_midsides(const PageMesh& mesh);
/// ... and without elements inside; a section is then hollow.
PageMesh without_inside(const PageMesh& mesh);
/// ... and without_inside, nodes in cubes of the side `cell` [length] put
/// together (Rossignac and Borrel, Multi-resolution 3D approximations, 1993).
PageMesh clustered(const PageMesh& mesh, double cell);

/// About as many bytes as to_json() makes of it.
double page_bytes(const PageMesh& mesh);

nlohmann::ordered_json to_json(const PageMesh& mesh);

}  // namespace meniscus::page
