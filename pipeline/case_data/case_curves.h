/// From the curves of a case to their numbers at one design.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "evolve/films/film_system.h"
#include "pipeline/case_data/case_problems.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// One per entry, in order; values, or rates. A value that makes no curve is
/// told in the problems of `values`.
std::vector<curves::Curve> curves_of(const Case& input,
                                     const CaseValues& values);

/// One after the other; expressions are not looked at: false.
bool have_equal_shapes(const std::vector<curves::Curve>& a,
                       const std::vector<curves::Curve>& b);

/// The names of curves that films and solids end at.
std::set<std::string> held_curves(const Case& input);

/// Tells of curves that hold films or caps and touch or cross each other.
void check_meetings(const Case& input, const films::FilmSystem& system,
                    const CaseValues& values);

/// Tells of rims of one plane face that at the initial design lay beside each
/// other and at this one within, or the other way around: between the two they
/// have merged. `first`: the curves of the initial design; `design`: that of
/// `system`.
void check_nesting(const Case& input, const films::FilmSystem& system,
                   const std::vector<curves::Curve>& first,
                   const VectorX& design, std::vector<std::string>& problems);

/// Finds curves of films and solids that lie on each other at the initial
/// design, and makes these name the first of them. Tells which were found in
/// the case's remarks; notes a film that names both.
void merge_curves(Case& input, CaseProblems& problems);

/// Notes merged curves that part at another design.
void check_merged(const Case& input, const EvaluatedCase& initial,
                  const EvaluatedCase& other, CaseProblems& problems);

}  // namespace meniscus::case_data
