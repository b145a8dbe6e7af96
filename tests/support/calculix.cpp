#include "tests/support/calculix.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/child_process.h"
#include "core/find_program.h"
#include "tests/support/temp_folder.h"

namespace meniscus {

bool have_calculix() { return find_program("ccx").has_value(); }

namespace {

/// What ccx wrote into its .dat file.
std::string run_for_dat(const std::string& deck,
                        const CalculixOptions& calculix = {}) {
  const TempFolder folder;
  std::ofstream(folder / "job.inp") << deck;
  ChildOptions options;
  options.argv = {"ccx", "-i", "job"};
  options.folder = folder.path();
  options.environment = {{"OMP_NUM_THREADS", std::to_string(calculix.threads)}};
  options.time_limit = calculix.time_limit;
  const ChildResult result = run_child(options);
  std::ifstream file(folder / "job.dat");
  std::stringstream text;
  text << file.rdbuf();
  const bool bad = result.output.find("*ERROR") != std::string::npos;
  if (!result.succeeded() || bad || text.str().empty()) {
    const std::size_t shown = std::min<std::size_t>(result.output.size(), 2000);
    throw std::runtime_error(
        "ccx " + describe_end(result) + ":\n" +
        result.output.substr(result.output.size() - shown) + result.error_tail);
  }
  return text.str();
}

}  // namespace

std::vector<CalculixStep> run_calculix(const std::string& deck, int node_count,
                                       const CalculixOptions& options) {
  return read_calculix_dat(run_for_dat(deck, options), node_count);
}

std::vector<double> run_calculix_eigenvalues(std::string deck,
                                             const std::string& procedure) {
  const std::string card = "*STATIC, SOLVER=SPOOLES\n";
  const std::size_t at = deck.find(card);
  if (at == std::string::npos || deck.find(card, at + 1) != std::string::npos) {
    throw std::runtime_error("the deck must have one step by SPOOLES");
  }
  deck.replace(at, card.size(), procedure + "\n");
  std::istringstream lines(run_for_dat(deck));
  std::vector<double> values;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("P A R T I C I P A T I O N") != std::string::npos) {
      break;
    }
    if (line.find("O U T P U T") != std::string::npos) {
      inside = true;
      continue;
    }
    std::istringstream numbers(line);
    int mode = 0;
    double value = 0.0;
    if (inside && numbers >> mode >> value) {
      values.push_back(value);
    }
  }
  return values;
}

std::vector<CalculixStep> read_calculix_dat(const std::string& text,
                                            int node_count) {
  enum class Block { None, Displacement, Reaction, Stress };
  std::vector<CalculixStep> steps;
  Block block = Block::None;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("displacements") != std::string::npos) {
      block = Block::Displacement;
      steps.emplace_back().displacement =
          VectorX::Zero(Eigen::Index{3} * node_count);
      continue;
    }
    if (line.find("total force") != std::string::npos) {
      block = Block::Reaction;
      continue;
    }
    if (line.find("stresses") != std::string::npos) {
      block = Block::Stress;
      continue;
    }
    std::istringstream numbers(line);
    if (steps.empty() || block == Block::None) {
      continue;
    }
    if (block == Block::Stress) {
      int element = 0;
      int point = 0;
      std::array<double, 6> t{};  // xx yy zz xy xz yz
      if (numbers >> element >> point >> t[0] >> t[1] >> t[2] >> t[3] >> t[4] >>
          t[5]) {
        std::swap(t[4], t[5]);
        steps.back().stress.push_back(t);
      }
      continue;
    }
    Vec3 v;
    if (block == Block::Reaction) {
      if (numbers >> v.x() >> v.y() >> v.z()) {
        steps.back().reaction = v;
        block = Block::None;
      }
      continue;
    }
    int node = 0;
    if (numbers >> node >> v.x() >> v.y() >> v.z()) {
      steps.back().displacement.segment<3>(Eigen::Index{3} * (node - 1)) = v;
    }
  }
  return steps;
}

double relative_difference(const VectorX& ours, const VectorX& theirs) {
  if (ours.size() != theirs.size()) {
    return HUGE_VAL;
  }
  return (ours - theirs).lpNorm<Eigen::Infinity>() /
         theirs.lpNorm<Eigen::Infinity>();
}

double relative_difference(const std::vector<std::array<double, 6>>& ours,
                           const std::vector<std::array<double, 6>>& theirs) {
  const auto flat = [](const std::vector<std::array<double, 6>>& rows) {
    return Eigen::Map<const VectorX>(
        rows.front().data(), static_cast<Eigen::Index>(6 * rows.size()));
  };
  if (ours.size() != theirs.size() || ours.empty()) {
    return HUGE_VAL;
  }
  return relative_difference(VectorX(flat(ours)), VectorX(flat(theirs)));
}

}  // namespace meniscus
