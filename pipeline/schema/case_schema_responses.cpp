#include "pipeline/schema/case_schema.h"

namespace meniscus {

namespace {

using D = Dimension;
using K = KeyType;
using N = TableNeed;

}  // namespace

std::vector<TableSpec> response_tables() {
  return {
      {"responses",
       true,
       N::ForParts,
       "A number that the solver reports",
       {{"kind", K::Choice, D::None, true,
         "mean_displacement: area-weighted over a surface along a direction; "
         "displacement_norm: its p-norm, nearly the largest for a large power; "
         "rotation: of a surface about an axis, in radians; compliance: work "
         "of the loads, twice strain_energy where only forces act; "
         "centre_of_mass: its place along a direction; max_von_mises: of "
         "nodal stresses, without derivatives; von_mises_norm, von_mises_ks: "
         "smooth ones by volume (p-norm, Kreisselmeier-Steinhauser); "
         "uniformity, energy_uniformity: coefficients of variation of von "
         "Mises stress and of strain energy density by volume; film_area, "
         "film_energy: of the films; pressure: of a body; collapse_margin: a "
         "smooth lower bound of the film's smallest eigenvalue, force per "
         "length cubed; radius: the films' smallest one, smooth; thickness: "
         "the solid's smallest one, smooth; distance: how far the solid "
         "reaches into a region to keep out of, or out of one to keep in, "
         "below 0 where it keeps clear, smooth; gap: the least distance of two "
         "films, smooth; films that cross have none: a design that fails; "
         "scan_distance: of films to a scan, over their vertices; expression: "
         "of the responses above it",
         "mean_displacement|displacement_norm|rotation|compliance|"
         "strain_energy|mass|volume|centre_of_mass|max_von_mises|"
         "von_mises_norm|von_mises_ks|uniformity|energy_uniformity|film_area|"
         "film_energy|pressure|collapse_margin|radius|thickness|distance|"
         "gap|scan_distance|expression"},
        {"on", K::Name, D::None, false,
         "of displacements and rotations: the surface"},
        {"direction", K::Vector, D::None, false,
         "of displacements and centre_of_mass; any length but 0"},
        {"axis", K::Vector, D::None, false,
         "of rotation, right-handed; any length but 0"},
        {"load_case", K::Name, D::None, false,
         "of what depends on loads; the first when left out"},
        {"weight", K::Place, D::None, false,
         "of mean_displacement: what each place counts, an expression of x, y, "
         "z; the mean is still by area, so that a weight may change its sign"},
        {"power", K::Constant, D::None, false,
         "of norms, above 1, of displacements 2 or above, 8 when left out; of "
         "radius, even, 16 when left out"},
        {"sharpness", K::Constant, D::None, false,
         "of von_mises_ks; above 0; 50 when left out"},
        {"scale", K::Constant, D::Pressure, false,
         "of von_mises_ks: the stress that its sharpness is measured by; the "
         "least yield strength when left out"},
        {"keep_out", K::Place, D::Length, false,
         "of distance: an expression of x, y, z: how deep a place lies in the "
         "region, below 0 outside; or"},
        {"keep_in", K::Place, D::Length, false,
         "of distance: the same of a region that the solid must stay within"},
        {"smoothing", K::Constant, D::Length, false,
         "of thickness, distance, gap: all places within about as much of the "
         "worst one count, and the value is on the safe side of it by no more "
         "than this times the logarithm of their number; a tenth of "
         "resolution.fea when left out, of gap a fiftieth"},
        {"film", K::Name, D::None, false,
         "of film_area: one film; all when left out"},
        {"films", K::Names, D::None, false,
         "of gap: the two; of scan_distance: all when left out"},
        {"scan", K::Text, D::None, false,
         "of scan_distance: an STL or OBJ file in the units and axes of the "
         "case, its path relative to the case file"},
        {"measure", K::Choice, D::None, false,
         "of scan_distance: root of the mean square, mean, what 95 % of the "
         "vertices do not exceed, largest; rms when left out",
         "rms|mean|p95|largest"},
        {"body", K::Name, D::None, false, "of pressure"},
        {"value", K::Quantity, std::nullopt, false,
         "of expression: over the case's names and the responses above"}}},
  };
}

}  // namespace meniscus
