/// Evolution macros of Surface Evolver datafiles: the part of its command
/// language that such macros use, run with our own operations.
///
///   g [n]  r [n]  u  V  U  hessian  hessian_seek  t length  o  G value  recalc
///   name := {...}   name := value   += -= *= /=   body[i].target := ...
///   set|unset vertices|edges|facets|bodies ... where ...   fix|unfix ...
///   refine edges where ...   if then else   for   while   do while   foreach
///   {...} n   break   continue   print   printf   sum, max, ... of elements
///
/// `g` moves along the film's normals with the best scale, `U` and conj_grad
/// switch to conjugate gradients: results come near those of Evolver, not to
/// its digits. Colours and views are left out; everything else is refused by
/// name and line.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/monitor.h"
#include "evolve/datafile/fe_complex.h"

namespace meniscus::datafile {

struct FeScriptOptions {
  std::optional<std::string> macro;  // none: the `read` section only
  long most_steps = 1'000'000;       // commands and loop rounds in all
  double most_work = 1e10;           // facets x steps in all: about an hour
  Monitor* monitor = nullptr;
};

struct FeScriptResult {
  films::FilmComplex complex;
  std::string output;  // of printf
  int iterations = 0;  // of g and hessian
};

/// Runs the commands of the file's `read` section, then the macro if one is
/// named. Throws
/// InvalidInput "file:line:column: what" for commands and names that are not
/// known, for wrong syntax, endless loops and a macro that is not there.
FeScriptResult run_fe_script(const FeFile& file,
                             const std::map<std::string, double>& parameters,
                             const FeScriptOptions& options);

}  // namespace meniscus::datafile
