#include "pipeline/case_data/response_kinds.h"
#include "pipeline/reader/case_reader_responses.h"

namespace meniscus::reader {

const std::vector<case_data::Named<scan::ScanMeasure>>& scan_measures() {
  static const std::vector<case_data::Named<scan::ScanMeasure>> measures = {
      {"rms", scan::ScanMeasure::Rms},
      {"mean", scan::ScanMeasure::Mean},
      {"p95", scan::ScanMeasure::P95},
      {"largest", scan::ScanMeasure::Largest}};
  return measures;
}

TableSpec response_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "responses",
      true,
      TableNeed::ForParts,
      "A number that the solver reports",
      {{"kind", K::Choice, D::None, true,
        case_data::meanings_of(case_data::response_kinds()),
        case_data::choices_of(case_data::response_kinds())},
       {"on", K::Name, D::None, false,
        "of displacements and rotations: the surface"},
       {"direction", K::Vector, std::nullopt, false,
        "of displacements and centre_of_mass; any length but 0"},
       {"angle", K::Constant, D::Angle, false,
        "of overhang: between surface and build plate, from which on it needs "
        "no supports, \"45 deg\" when left out; of draft: what it is to have "
        "at least, \"2 deg\" when left out"},
       {"width", K::Constant, D::Angle, false,
        "of overhang, draft: about how far on either side of the angle the "
        "surface counts in part, below the angle; a tenth of it when left out, "
        "of draft half of it"},
       {"base", K::Names, D::None, false,
        "of overhang: surfaces that stand on the build plate"},
       {"through", K::Vector, D::Length, false,
        "of inertia: a point on the axis; the centre of mass when left out"},
       {"axis", K::Vector, std::nullopt, false,
        "of rotation, right-handed, and of inertia; any length but 0"},
       {"load_case", K::Name, D::None, false,
        "of what depends on loads; the first when left out; of frequency the "
        "one whose supports and springs hold the part, or free, "
        "analysis.supports_of when left out"},
       {"number", K::Integer, D::None, false,
        "of buckling_factor and frequency: which mode, 1 to 50, counted at the "
        "initial design and followed from there by its shape; 1 when left "
        "out"},
       {"cluster", K::Constant, D::None, false,
        "of mode 1: factors or frequencies within so much of the least, as a "
        "part of it, count, so that the value is smooth where they cross; 0: "
        "that mode alone, followed by its shape; 0.1 when left out"},
       {"load_cases", K::Names, D::None, false,
        "of fatigue: the two that loads go to and fro between; of envelope "
        "with `of`: all when left out; of stress_ratio in place of load_case: "
        "an envelope over them"},
       {"of", K::Name, D::None, false,
        "of envelope: a response above, of one load case, asked of each"},
       {"responses", K::Names, D::None, false,
        "of envelope in place of `of`: two or more responses above, of one "
        "unit"},
       {"least", K::Flag, D::None, false,
        "of envelope: true for the smallest of them, from below"},
       {"allowable", K::Constant, D::Pressure, false,
        "of stress_ratio: the stress that is 1; each body's yield strength "
        "when left out"},
       {"criterion", K::Choice, D::None, false,
        "of fatigue: Goodman's line (endurance_limit, tensile_strength) or "
        "Crossland's (endurance_limit, torsion_limit); goodman when left out",
        case_data::choices_of(fatigue_criteria())},
       {"excess", K::Constant, D::None, false,
        "of stress_ratio, fatigue, envelope: the part by which the bound lies "
        "above the largest value at most, below 1; 0.02 when left out, of "
        "envelope 0.01. Smaller is tighter and less smooth"},
       {"weight", K::Place, std::nullopt, false,
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
        "resolution.fea when left out, of gap a hundredth, of thickness what "
        "keeps the value within 5 % of the least one"},
       {"film", K::Name, D::None, false,
        "of film_area: one film; all when left out"},
       {"films", K::Names, D::None, false,
        "of gap: the two; of scan_distance: all when left out"},
       {"scan", K::Text, D::None, false,
        "of scan_distance: an STL or OBJ file in the units and axes of the "
        "case, its path relative to the case file"},
       {"measure", K::Choice, D::None, false,
        "of scan_distance: root of the mean square, mean, what 95 % of the "
        "vertices do not exceed, largest; rms when left out; of stress_ratio: "
        "von Mises stress or the largest principal one, von_mises when left "
        "out",
        case_data::choices_of(scan_measures()) + "|" +
            case_data::choices_of(stress_measures())},
       {"body", K::Name, D::None, false, "of pressure"},
       {"value", K::Quantity, std::nullopt, false,
        "of expression: over the case's names and the responses above"}}};
}

}  // namespace meniscus::reader
