#include "evolve/datafile/fe_command_words.h"

namespace meniscus::datafile {

const CommandWords& command_words() {
  static const CommandWords known = {"convert_to_quantities",
                                     "hessian",
                                     "hessian_seek",
                                     "hessian_menu",
                                     "recalc",
                                     "lagrange",
                                     "linear",
                                     "quadratic",
                                     "saddle",
                                     "edgeweed",
                                     "areaweed",
                                     "edgedivide",
                                     "equiangulate",
                                     "longj",
                                     "jiggle",
                                     "rebody",
                                     "eigenprobe",
                                     "dirichlet",
                                     "sobolev",
                                     "vertex_average"};
  return known;
}

const CommandWords& command_toggles() {
  static const CommandWords known = {
      "conj_grad",      "autorecalc",     "autodisplay",
      "quiet",          "hessian_normal", "hessian_normal_perp",
      "hessian_diff",   "check_increase", "normal_motion",
      "gv_binary",      "diffusion",      "metric_conversion",
      "linear_metric",  "hessian_quiet",  "area_normalization",
      "gravity",        "runge_kutta",    "deturck",
      "autopop",        "autochop",       "kusner",
      "effective_area", "estimate",       "approx_curv",
      "post_project",   "jiggle_toggle",  "hessian_special_normal"};
  return known;
}

const CommandWords& element_commands() {
  static const CommandWords known = {"refine", "delete",   "edgeswap", "pop",
                                     "fix",    "dissolve", "list",     "unfix"};
  return known;
}

}  // namespace meniscus::datafile
