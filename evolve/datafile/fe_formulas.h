/// Internal to fe_complex: the formulas of a datafile, evaluated or compiled.
#pragma once

#include "evolve/datafile/fe_complex.h"

namespace meniscus::datafile {

[[noreturn]] void fe_fail(const FeFile& file, const FePlace& place,
                          const std::string& what);

/// Parameters and the gravity constant "g".
FeValues fe_values(const FeFile& file,
                   const std::map<std::string, double>& parameters);

/// Fills curves, level_sets, integrals and quantities (but their surfaces) of
/// `complex`, in an order that depends on the file alone. Returns per edge of
/// the file what is integrated along it: ascending indices into integrals.
std::vector<std::vector<int>> fe_formulas(const FeFile& file,
                                          const FeValues& values,
                                          films::FilmComplex& complex);

}  // namespace meniscus::datafile
