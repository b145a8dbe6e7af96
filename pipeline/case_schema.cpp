#include "pipeline/case_schema.h"

#include <algorithm>
#include <array>

namespace meniscus {

namespace {

using D = Dimension;
using K = KeyType;

std::vector<TableSpec> make_tables() {
  return {
      {"",
       false,
       true,
       "Above the first table",
       {{"title", K::Text, D::None, true, "one line for people"},
        {"units", K::Choice, D::None, true,
         "consistent unit system of every number in the file",
         "mm-N-MPa|m-N-Pa|in-lbf-psi"}}},
      {"parameters",
       false,
       false,
       "Named numbers for expressions, `name = value`; override from outside "
       "with --set name=value",
       {}},
      {"design",
       true,
       false,
       "A design variable: what the optimizer moves",
       {{"initial", K::Constant, std::nullopt, true,
         "value at which the model freezes and the study starts"},
        {"bounds", K::Bounds, std::nullopt, true, "[least, largest]"}}},
      {"curves",
       true,
       true,
       "A closed boundary curve that holds films; counter-clockwise seen from "
       "the tip of its normal",
       {{"kind", K::Choice, D::None, true, "its shape",
         "circle|ellipse|rectangle|polygon", "arc|polyline|spline|file|copy"},
        {"center", K::Vector, D::Length, false,
         "of circle, ellipse, rectangle"},
        {"normal", K::Vector, D::None, false,
         "of circle, ellipse, rectangle; any length but 0"},
        {"axis", K::Vector, D::None, false,
         "of ellipse, rectangle: direction of radius_1 or width"},
        {"radius", K::Quantity, D::Length, false, "of circle"},
        {"radius_1", K::Quantity, D::Length, false, "of ellipse, along axis"},
        {"radius_2", K::Quantity, D::Length, false, "of ellipse, across axis"},
        {"width", K::Quantity, D::Length, false, "of rectangle, along axis"},
        {"height", K::Quantity, D::Length, false, "of rectangle, across axis"},
        {"corner_radius", K::Quantity, D::Length, false,
         "of rectangle; 0 when left out"},
        {"points", K::Vectors, D::Length, false, "of polygon, in order"}}},
      {"films",
       true,
       true,
       "A liquid film between curves",
       {{"kind", K::Choice, D::None, true,
         "how the liquid starts: branch (convex hull of any number of curves "
         "less their caps), loft (band between two), disk (across one)",
         "branch|loft|disk", "facets|file"},
        {"curves", K::Names, D::None, true, "the curves that hold it"},
        {"tension", K::Quantity, D::Tension, false,
         "energy per area of the whole film; 1 when left out"}}},
      {"solids",
       true,
       false,
       "A solid surface, named so that loads find it",
       {{"kind", K::Choice, D::None, true,
         "cap: flat disk across a planar "
         "curve",
         "cap", "plate|pad|faces|file"},
        {"curve", K::Name, D::None, true, "the cap's rim"}}},
      {"bodies",
       true,
       true,
       "A chamber that films and solids enclose; it becomes solid material",
       {{"enclosed_by", K::Names, D::None, true,
         "films and solids that close it"},
        {"volume", K::Quantity, D::Volume, false, "enclosed volume"},
        {"pressure", K::Quantity, D::Pressure, false,
         "inside minus outside, instead of a volume"},
        {"material", K::Name, D::None, true, "what fills it"}}},
      {"resolution",
       false,
       true,
       "Edge lengths",
       {{"fea", K::Constant, D::Length, true,
         "of the settled film that is filled with elements"},
        {"film", K::Constant, D::Length, false,
         "of its nested refinement: fea, fea / 2, fea / 4, ... (the nearest is "
         "taken); fea / 2 when left out"},
        {"export", K::Constants, D::Length, false,
         "of the STL files, each settled again; the film's own when left "
         "out"}}},
      {"materials",
       true,
       true,
       "An isotropic linear-elastic material",
       {{"youngs_modulus", K::Quantity, D::Pressure, true, "above 0"},
        {"poisson_ratio", K::Quantity, D::None, true, "above -1 and below 0.5"},
        {"density", K::Quantity, D::Density, true, "mass per volume"},
        {"yield_strength", K::Quantity, D::Pressure, false,
         "stress above it is warned of"}}},
      {"load_cases",
       true,
       true,
       "Supports and loads that act together",
       {{"supports", K::Supports, D::None, true, "at least one"},
        {"loads", K::Loads, D::None, true, "at least one"}}},
      {"support",
       false,
       false,
       "A surface that is held",
       {{"on", K::Name, D::None, true, "the surface that is held"},
        {"fix", K::Text, D::None, true,
         "components held at 0: some of \"xyz\""}}},
      {"load",
       false,
       false,
       "A surface that is loaded, by a force or a pressure",
       {{"on", K::Name, D::None, true, "the surface that is loaded"},
        {"force", K::Vector, D::Force, false,
         "total, spread as uniform traction"},
        {"pressure", K::Quantity, D::Pressure, false,
         "positive into the material"}}},
      {"responses",
       true,
       true,
       "A number that the solver reports",
       {{"kind", K::Choice, D::None, true,
         "mean_displacement: area-weighted over a surface along a direction; "
         "strain_energy: of a load case, half the compliance; film_area: of "
         "all "
         "films",
         "mean_displacement|mass|volume|max_von_mises|strain_energy|"
         "film_area",
         "rotation|compliance|centre_of_mass|von_mises_norm|uniformity|"
         "pressure|collapse_margin|thickness|radius|distance|expression"},
        {"on", K::Name, D::None, false, "of mean_displacement: the surface"},
        {"direction", K::Vector, D::None, false,
         "of mean_displacement; any length but 0"},
        {"load_case", K::Name, D::None, false,
         "of mean_displacement, max_von_mises, strain_energy; the first when "
         "left out"}}},
      {"study",
       false,
       false,
       "What to do; analyse the initial design when left out",
       {{"kind", K::Choice, D::None, true, "analyse or match", "analyse|match",
         "minimize|sweep|family|pareto|tolerance"},
        {"equal", K::Names, D::None, false,
         "of match: responses to make equal; mismatch |a-b| / ((|a|+|b|)/2)"},
        {"targets", K::ConstantMap, std::nullopt, false,
         "of match: response = value; mismatch |a-v| / |v|, for v = 0 relative "
         "to the initial response"},
        {"tolerance", K::Constant, D::None, false,
         "largest mismatch accepted; 1e-3 when left out"},
        {"method", K::Text, D::None, false,
         "\"ceres\" (when left out) or one of NLopt's: bobyqa, cobyla, sbplx, "
         "neldermead, direct_l"},
        {"max_evaluations", K::Integer, D::None, false,
         "limit, finite-difference ones included; 100 when left out"}}},
  };
}

}  // namespace

const std::vector<TableSpec>& case_tables() {
  static const std::vector<TableSpec> tables = make_tables();
  return tables;
}

const TableSpec& case_table(const std::string& name) {
  const auto& tables = case_tables();
  return *std::find_if(tables.begin(), tables.end(),
                       [&](const TableSpec& t) { return name == t.name; });
}

const KeySpec* find_key(const TableSpec& table, const std::string& key) {
  const auto at = std::find_if(table.keys.begin(), table.keys.end(),
                               [&](const KeySpec& k) { return key == k.key; });
  return at == table.keys.end() ? nullptr : &*at;
}

std::vector<std::string> split_choices(const char* choices) {
  std::vector<std::string> parts;
  std::string rest = choices;
  while (!rest.empty()) {
    const std::size_t bar = rest.find('|');
    parts.push_back(rest.substr(0, bar));
    rest = bar == std::string::npos ? "" : rest.substr(bar + 1);
  }
  return parts;
}

bool is_later_table(const std::string& name) {
  constexpr std::array<const char*, 6> kLater = {"walls",  "fields", "regions",
                                                 "family", "sweep",  "process"};
  return std::find(kLater.begin(), kLater.end(), name) != kLater.end();
}

}  // namespace meniscus
