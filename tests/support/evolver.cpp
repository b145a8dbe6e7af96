#include "tests/support/evolver.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "core/find_program.h"
#include "tests/support/measured_child.h"
#include "tests/support/temp_folder.h"

namespace meniscus {

namespace {

// Newton's last step from near rest changes the energy by rounding only.
constexpr double kSettledEnergy = 1e-12;  // relative

std::string hessians(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "hessian; ";
  }
  return text;
}

// The force of the pressure on a vertex: a third of its facets' area vectors.
// Films of one body only, all with their normals outward.
std::string residual_commands(const films::FilmComplex& start) {
  const bool one_body = start.bodies.size() == 1 && start.integrals.empty();
  if (!start.bodies.empty() && !one_body) {
    return "";
  }
  std::string push = "0";
  std::string text;
  if (one_body) {
    text +=
        "define vertex attribute push real[3];\n"
        "foreach facet ff do foreach ff.vertex vv do {\n"
        "  vv.push[1] += ff.facet_normal[1] / 3;\n"
        "  vv.push[2] += ff.facet_normal[2] / 3;\n"
        "  vv.push[3] += ff.facet_normal[3] / 3; };\n";
    push = "body[1].pressure";
  }
  std::string sum;
  for (int k = 1; k <= 3; ++k) {
    const std::string force =
        one_body ? fmt::format("(__force[{}] + {} * push[{}])", k, push, k)
                 : fmt::format("__force[{}]", k);
    sum += fmt::format("{}{} * vertexnormal[{}]", k > 1 ? " + " : "", force, k);
  }
  return text +
         "printf \"done_residual %.6g\\n\", max(vertex where not fixed, "
         "abs(" +
         sum + "));\n";
}

// The number after `key` at the start of a line; the last one counts.
std::optional<double> printed(const std::string& output,
                              const std::string& key) {
  const std::size_t at = output.rfind("\n" + key + " ");
  if (at == std::string::npos) {
    return std::nullopt;
  }
  return std::stod(output.substr(at + key.size() + 2));
}

}  // namespace

bool have_evolver() { return find_program("evolver").has_value(); }

std::string evolver_commands(const films::FilmComplex& start,
                             const EvolverJob& job) {
  std::string text =
      "before := total_energy; printf \"\\nstart_energy %.15g\\n\", before;\n";
  for (std::size_t b = 0; b < start.bodies.size(); ++b) {
    text += fmt::format(
        "printf \"start_volume_{} %.15g\\n\", body[{}].volume;\n", b, b + 1);
  }
  text += job.descent + " " + hessians(2) + "\n";
  for (int level = 1; level <= job.refinements; ++level) {
    text += "r; ";
    for (std::size_t b = 0; b < start.bodies.size(); ++b) {
      text += fmt::format("body[{}].volconst := {:.17g}; ", b + 1,
                          evolver_cap_volume(start, start.bodies[b], level));
    }
    const bool fine = level + 2 > job.refinements;
    const bool finest = level == job.refinements;
    text +=
        job.script == EvolverScript::Typical || !fine ? job.descent + " " : "";
    text += finest ? hessians(job.last_hessians - 1) +
                         "before := total_energy; hessian;\n"
                   : hessians(2) + "\n";
  }
  // Measured from here on, so that it can be taken off the time.
  text +=
      "printf \"\\ndone_clock %.6f\\n\", clock;\n"
      "printf \"done_change %.6g\\n\", "
      "abs(total_energy - before) / total_energy;\n"
      "printf \"done_facets %d\\n\", facet_count;\n"
      "printf \"done_energy %.15g\\n\", total_energy;\n"
      "printf \"done_edge %.6g\\n\", avg(edge, length);\n"
      "m 0; g 1;\n" +
      residual_commands(start) + "printf \"done_end %.6f\\n\", clock;\nq\nq\n";
  return text;
}

EvolverRun run_evolver(const films::FilmComplex& start, const EvolverJob& job) {
  const TempFolder folder;
  std::ofstream(folder / "start.fe") << evolver_datafile(start);
  std::ofstream(folder / "job.cmd") << evolver_commands(start, job);
  const MeasuredChild child =
      measure_program({"evolver", "-x", "-f", "job.cmd", "start.fe"},
                      folder.path(), job.time_limit);
  EvolverRun run;
  run.output = child.output;
  run.peak_bytes = child.peak_bytes;
  run.user_seconds = child.user_seconds;
  run.system_seconds = child.system_seconds;
  run.start_energy = printed(run.output, "start_energy").value_or(NAN);
  for (std::size_t b = 0; b < start.bodies.size(); ++b) {
    run.start_volumes.push_back(
        printed(run.output, fmt::format("start_volume_{}", b)).value_or(NAN));
  }
  const auto done = printed(run.output, "done_clock");
  const auto end = printed(run.output, "done_end");
  if (!child.succeeded || !done || !end) {
    return run;
  }
  run.ended = true;
  run.user_seconds -= *end - *done;
  run.facets = static_cast<int>(printed(run.output, "done_facets").value_or(0));
  run.energy = printed(run.output, "done_energy").value_or(NAN);
  run.mean_edge = printed(run.output, "done_edge").value_or(NAN);
  run.residual = printed(run.output, "done_residual");
  run.converged =
      printed(run.output, "done_change").value_or(1.0) < kSettledEnergy;
  return run;
}

}  // namespace meniscus
