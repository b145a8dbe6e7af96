/// Agreed benchmarks of shells, each as one number over its target, and the
/// elements that were weighed (decision 0034).
#pragma once

#include <vector>

#include "fea/shell/facet_rule.h"
#include "fea/shell/shell_system.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_benchmarks {

using shell_shapes::GridOptions;

/// What stands at a facet's points; `corners_only`: the middles are no nodes.
struct Element {
  const char* name;
  const shell::FacetRule* rule;
  bool corners_only = false;
};

Element program();
/// Strains of the six nodes as they are: all points, or three.
Element plain_quadratic();
Element reduced_quadratic();
/// Corners alone: shear by one tangential moment an edge (MITC3: Lee and Bathe,
/// Comput. Struct. 82, 2004), constant membrane strain.
Element three_nodes();

/// MacNeal and Harder, Finite Elem. Anal. Des. 1, 1985: roof 0.3024, pinched
/// cylinder with diaphragms 1.8248e-5 (Lindberg, Olson, Cowper 1969),
/// hemisphere with a hole 0.0924 (Simo, Fox, Rifai 1989: 0.093), `options`: of
/// a quarter.
double scordelis_lo(const GridOptions& options, const Element& element);
double pinched_cylinder(const GridOptions& options, const Element& element);
double holed_hemisphere(const GridOptions& options, const Element& element);
/// The same a tenth as thick under a thousandth of the force.
double thin_hemisphere(const GridOptions& options, const Element& element);
/// NAFEMS LE3, 0.185 m: the whole hemisphere, options.m cells along a side.
double nafems_le3(const GridOptions& options, const Element& element);
/// Middle of a square plate under even pressure, over q a^4 / D.
double square_plate(double thickness, bool clamped, const GridOptions& options,
                    const Element& element);
/// Energy of a supported unit square under sin pi x sin pi y, over Navier's
/// with transverse shear; `options` of a quarter.
double sine_plate_energy(double thickness, const GridOptions& options,
                         const Element& element);
/// MacNeal and Harder's twisted beam along the force, in the plane of the tip
/// or across it: 0.005424, 0.001754; with t = 0.0032 and a force of 1e-6
/// 5.256e-3, 1.294e-3 (Belytschko, Wong, Stolarski 1989).
double twisted_beam(double thickness, double force, bool in_plane,
                    const GridOptions& options, const Element& element);
/// A cylinder R = 1, L = 2 with free ends under p = cos 2 phi, an eighth: all
/// bending. Its strain energy times t^3 tends to a constant.
double free_cylinder_energy(double thickness, const GridOptions& options,
                            const Element& element);

/// The lowest natural frequencies above those of rigid motions [1/time]; none
/// where they were not found.
std::vector<double> frequencies(const shell::ShellMesh& mesh,
                                const std::vector<shell::Section>& sections,
                                const std::vector<shell::NodeSupport>& supports,
                                int count);

/// The least factors of a system's loads under which it buckles, ascending.
std::vector<double> buckling_factors(const shell::ShellSystem& system,
                                     const shell::ShellLoads& loads, int count);

}  // namespace meniscus::shell_benchmarks
