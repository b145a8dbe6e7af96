/// Checks of a case beyond the form of its keys: parameters that depend on
/// each other, bodies that close, numbers that make sense.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_problems.h"

namespace meniscus::case_data {

/// Sets `parameter_order`: each after those that it uses. A circle is named.
void order_parameters(Case& input, CaseProblems& problems);

/// Sets `refinements` and makes `film` the nearest fea / 2^k, k from 0 to 4,
/// with a warning when it was off by more than 1 %.
void nest_film(Resolution& resolution, SourceLine line, CaseProblems& problems);

/// Bodies close: each curve of a body's surfaces bounds two of them.
void check_bodies(const Case& input, CaseProblems& problems);

/// Films with a thickness are held on curves: their rims are square to them.
void check_wetted_walls(const Case& input, CaseProblems& problems);

/// When nothing is wrong so far: the numbers at the initial design and at both
/// ends of every design variable, and warnings of what serves nothing.
void check_case(const Case& input, CaseProblems& problems);

/// Tells of films that are joined and are not there, and of such that join with
/// no free side.
void check_joined_films(const Case& input, CaseProblems& problems);

/// Films and solids that start from facets put onto their curves, at the
/// initial design: rims that find no curve, bodies that stay open; features
/// that overlap.
void check_start(const Case& input, const EvaluatedCase& inputs,
                 CaseProblems& problems);

/// The line of the film, solid or body that a message of the start names
/// first; 0: none.
SourceLine line_of_start(const Case& input, const std::string& message);

/// Some film or solid, or one of those that enclose a body, is of facets.
bool has_facets(const Case& input);
bool has_facets(const Case& input, const BodyEntry& body);

/// Films and solids, backs and rims of walls and shells.
std::vector<std::string> surface_names(const Case& input);
/// Of walls, beside their films.
std::vector<std::string> wall_surface_names(const Case& input);

/// Of shells, beside their films.
std::vector<std::string> shell_surface_names(const Case& input);

/// The curves that the films of a wall end on, once for each film.
std::vector<std::string> curves_of_wall(const Case& input,
                                        const WallEntry& wall);
std::vector<std::string> film_names(const Case& input);
std::vector<std::string> body_names(const Case& input);

/// "two_arm" for "cases/two_arm/case.toml", else the file's stem.
std::string case_name(const std::string& path);

}  // namespace meniscus::case_data
