#include "pipeline/schema/case_schema.h"

namespace meniscus {

namespace {

using D = Dimension;
using K = KeyType;
using N = TableNeed;

}  // namespace

std::vector<TableSpec> study_tables() {
  return {
      {"study",
       false,
       N::Optional,
       "What to do; analyse the initial design when left out",
       {{"kind", K::Choice, D::None, true,
         "analyse, match, minimize, sweep, tolerance or pareto; family: one of "
         "these for each member",
         "analyse|match|minimize|sweep|tolerance|pareto|family"},
        {"each", K::Choice, D::None, false,
         "of family: what each member's own study is, with the keys of that "
         "kind; minimize when left out",
         "minimize|match|analyse"},
        {"members", K::Members, D::None, false,
         "of family: a table [study.members.NAME] of values by the names of "
         "--set for each, or the path of a csv file, relative to the case"},
        {"equal", K::Names, D::None, false,
         "of match: responses to make equal; mismatch |a-b| / ((|a|+|b|)/2)"},
        {"targets", K::ConstantMap, std::nullopt, false,
         "of match: response = value; mismatch |a-v| / |v|, for v = 0 relative "
         "to the initial response"},
        {"fit", K::Name, D::None, false,
         "of match, instead of equal and targets: a response of kind "
         "scan_distance and measure rms; the films are brought as near to its "
         "scan as the design variables can, in the sense of least squares"},
        {"objective", K::Name, D::None, false,
         "of minimize: the response to make small; of sweep: the one that "
         "makes a design the best, the initial one when left out"},
        {"objectives", K::Names, D::None, false,
         "of pareto: the two responses to make small"},
        {"constraints", K::Constraints, D::None, false,
         "of minimize, sweep and pareto: responses to keep within bounds"},
        {"levels", K::IntegerMap, D::None, false,
         "of sweep by grid: design variable = number of values, ends of its "
         "bounds included; one that is left out stays at its initial value"},
        {"deviations", K::ConstantMap, std::nullopt, false,
         "of tolerance: design variable = standard deviation"},
        {"count", K::Integer, D::None, false,
         "of sweep by latin_hypercube or sobol: number of designs; of "
         "tolerance: samples that confirm it, none when left out; of pareto: "
         "points of the front, 7 when left out"},
        {"seed", K::Integer, D::None, false,
         "of latin_hypercube: another seed is another sample; 1 when left "
         "out"},
        {"tolerance", K::Constant, D::None, false,
         "of match: largest mismatch accepted, 1e-3 when left out, with fit "
         "the distance that is near enough, as near as it gets when left out; "
         "of minimize and pareto: first-order residual accepted, about the "
         "relative gain "
         "that is left, 1e-4 when left out"},
        {"method", K::Text, D::None, false,
         "of match: ceres (when left out), bobyqa, cobyla, sbplx, neldermead, "
         "direct_l; of minimize and pareto: slsqp (when left out), mma, ccsa "
         "with exact "
         "gradients, bobyqa, cobyla, sbplx, neldermead without, isres, crs2, "
         "direct_l globally; of sweep: grid, latin_hypercube, sobol (when left "
         "out); of tolerance: latin_hypercube (when left out), sobol"},
        {"coarse_first", K::Constant, D::None, false,
         "of match and minimize: the study is done first on a model with edges "
         "so many times as long (above 1, 2 is usual), and its answer is where "
         "the case's own model starts; no such stage when left out"},
        {"max_evaluations", K::Integer, D::None, false,
         "of match, minimize and each minimum of pareto: limit, "
         "finite-difference ones included; 100 when left out"},
        {"time_limit", K::Constant, D::Time, false,
         "of the whole study, in seconds or as \"10 min\": it stops then and "
         "keeps the best design; --time-limit counts too, the smaller of the "
         "two; no limit when left out"},
        {"refreeze", K::Flag, D::None, false,
         "of match and minimize: where the frozen mesh no longer follows, "
         "freeze a new model at the best design and go on from there, three "
         "times at most; true when left out"}}},
      {"constraint",
       false,
       N::Optional,
       "A bound on a response",
       {{"response", K::Name, D::None, true, "its name"},
        {"min", K::Constant, std::nullopt, false, "least value"},
        {"max", K::Constant, std::nullopt, false,
         "largest value; as min for an equation"}}},
  };
}

}  // namespace meniscus
