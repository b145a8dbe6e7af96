#include "fea/distributed/petsc_cut.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "fea/distributed/petsc_protocol.h"

namespace meniscus::distributed {

namespace {

namespace fs = std::filesystem;

/// Nodes first .. last - 1 of process `process`.
struct Range {
  int first;
  int last;
  bool holds(int node) const { return node >= first && node < last; }
  int count() const { return last - first; }
};

Range own_nodes(int nodes, int processes, int process) {
  const auto cut = [&](int p) {
    return static_cast<int>(static_cast<std::int64_t>(nodes) * p / processes);
  };
  return {cut(process), cut(process + 1)};
}

class Writer {
 public:
  explicit Writer(fs::path path)
      : path_(std::move(path)), out_(path_, std::ios::binary) {}

  template <class T>
  void one(const T& value) {
    out_.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void list(const std::vector<T>& values) {
    out_.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(sizeof(T) * values.size()));
  }
  void nodes(const VectorX& v, const Range& range) {
    out_.write(
        reinterpret_cast<const char*>(v.data() + 3L * range.first),
        static_cast<std::streamsize>(3 * sizeof(double)) * range.count());
  }
  void close() {
    out_.close();
    if (!out_) {
      throw IoError(fmt::format(
          "the part of the elastic system for one process cannot be written "
          "to {}; is the disk full? TMPDIR chooses another",
          path_.string()));
    }
  }

 private:
  fs::path path_;
  std::ofstream out_;
};

petsc::Law law_record(const element::ElasticLaw& law) {
  petsc::Law record;
  record.isotropic = law.isotropic ? 1.0 : 0.0;
  record.lambda = law.lame.lambda;
  record.mu = law.lame.mu;
  if (!law.isotropic) {
    std::copy_n(law.tensor.data(), 81, record.tensor);
  }
  return record;
}

/// One process's piece; `local` is scratch of one entry per node, all -1.
class Cut {
 public:
  Cut(const PetscSystem& system, Range own, std::vector<int>& local)
      : system_(system), own_(own), local_(local) {
    const solver::BlockPattern& p = system.table.pattern;
    const auto width = static_cast<std::size_t>(p.nodes_per_element);
    for (int e = 0; e < p.element_count(); ++e) {
      const int* ids = p.element_nodes.data() + e * width;  // ascending
      if (ids[0] >= own.last) {
        break;  // elements ascend by their lowest node
      }
      if (std::none_of(ids, ids + width,
                       [&](int node) { return own.holds(node); })) {
        continue;
      }
      elements_.push_back(e);
      std::copy_if(ids, ids + width, std::back_inserter(ghosts_),
                   [&](int node) { return !own.holds(node); });
    }
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
    for (int node = own.first; node < own.last; ++node) {
      local_[node] = node - own.first;
    }
    for (std::size_t g = 0; g < ghosts_.size(); ++g) {
      local_[ghosts_[g]] = own.count() + static_cast<int>(g);
    }
  }
  ~Cut() {
    std::fill(local_.begin() + own_.first, local_.begin() + own_.last, -1);
    for (const int node : ghosts_) {
      local_[node] = -1;
    }
  }
  Cut(const Cut&) = delete;
  Cut& operator=(const Cut&) = delete;

  void write(int process, int processes, Writer& out) const {
    const solver::BlockPattern& p = system_.table.pattern;
    petsc::PieceHeader header;
    header.process = process;
    header.processes = processes;
    header.nodes = p.nodes;
    header.first = own_.first;
    header.own = own_.count();
    header.ghosts = static_cast<std::int64_t>(ghosts_.size());
    header.elements = static_cast<std::int64_t>(elements_.size());
    header.nodes_per_element = p.nodes_per_element;
    header.regions = static_cast<std::int64_t>(system_.laws.size());
    header.groups = static_cast<std::int64_t>(system_.groups.size());
    header.max_iterations = system_.max_iterations;
    header.tolerance = system_.tolerance;
    out.one(header);
    out.list(ghosts_);
    write_mesh(out);
    for (const element::ElasticLaw& law : system_.laws) {
      out.one(law_record(law));
    }
    for (const PetscGroup& group : system_.groups) {
      write_group(group, out);
    }
    out.one(petsc::kEndMark);
  }

 private:
  void write_mesh(Writer& out) const {
    for (int node = own_.first; node < own_.last; ++node) {
      out.one(system_.x[node]);
    }
    for (const int node : ghosts_) {
      out.one(system_.x[node]);
    }
    const solver::ElementTable& table = system_.table;
    const auto width =
        static_cast<std::size_t>(table.pattern.nodes_per_element);
    for (const int e : elements_) {
      const std::size_t first = e * width;
      for (std::size_t a = 0; a < width; ++a) {
        out.one(
            local_[table.pattern.element_nodes[first + table.slot[first + a]]]);
      }
    }
    for (const int e : elements_) {
      out.one(table.region[e]);
    }
  }

  void write_group(const PetscGroup& group, Writer& out) const {
    const solver::NodeFreedom& freedom = group.restraints->freedom;
    const supports::SpringBlocks& springs = group.restraints->springs;
    std::vector<int> held;
    std::vector<double> projectors;
    for (std::size_t h = 0; h < freedom.held.size(); ++h) {
      if (local_[freedom.held[h]] >= 0) {
        held.push_back(local_[freedom.held[h]]);
        append(freedom.projector[h], projectors);
      }
    }
    std::vector<int> at;
    std::vector<double> blocks;
    for (std::size_t k = 0; k < springs.at.size(); ++k) {
      const auto [row, column] = springs.at[k];
      if (own_.holds(row) || own_.holds(column)) {
        at.insert(at.end(), {local_[row], local_[column]});
        append(springs.block[k], blocks);
      }
    }
    petsc::GroupHeader header;
    header.held = static_cast<std::int64_t>(held.size());
    header.springs = static_cast<std::int64_t>(at.size() / 2);
    header.cases = static_cast<std::int64_t>(group.f.size());
    header.start = group.start.empty() ? 0 : 1;
    out.one(header);
    out.list(held);
    out.list(projectors);
    out.list(at);
    out.list(blocks);
    for (std::size_t c = 0; c < group.f.size(); ++c) {
      out.nodes(*group.f[c], own_);
      if (!group.start.empty()) {
        out.nodes(*group.start[c], own_);
      }
    }
  }

  static void append(const RowMat3& block, std::vector<double>& list) {
    list.insert(list.end(), block.data(), block.data() + 9);
  }

  const PetscSystem& system_;
  const Range own_;
  std::vector<int>& local_;
  std::vector<int> elements_;
  std::vector<int> ghosts_;
};

class ResultReader {
 public:
  explicit ResultReader(const fs::path& path)
      : path_(path), in_(path, std::ios::binary) {}

  template <class T>
  T one() {
    T value{};
    in_.read(reinterpret_cast<char*>(&value), sizeof value);
    check(static_cast<bool>(in_));
    return value;
  }
  void nodes(const Range& range, VectorX& v) {
    in_.read(reinterpret_cast<char*>(v.data() + 3L * range.first),
             static_cast<std::streamsize>(3 * sizeof(double)) * range.count());
    check(static_cast<bool>(in_));
  }
  void check(bool good) const {
    if (!good) {
      throw SolverError(
          fmt::format("meniscus-petsc ended well, but its result {} is "
                      "missing, cut off or of another version; install "
                      "program and helper from one build, and let all "
                      "machines see TMPDIR",
                      path_.filename().string()));
    }
  }

 private:
  fs::path path_;
  std::ifstream in_;
};

solver::CgColumn column_of(const petsc::CaseResult& result) {
  solver::CgColumn column;
  column.iterations = static_cast<int>(result.iterations);
  column.error = result.error;
  switch (result.end) {
    case petsc::CaseEnd::Converged:
      column.end = solver::CgEnd::Converged;
      break;
    case petsc::CaseEnd::TooManyIterations:
      column.end = solver::CgEnd::TooManyIterations;
      break;
    case petsc::CaseEnd::NotPositive:
      column.end = solver::CgEnd::NotPositive;
      break;
    default:
      column.end = solver::CgEnd::NotFinite;
  }
  return column;
}

}  // namespace

void write_pieces(const PetscSystem& system, int processes,
                  const fs::path& folder) {
  const int nodes = system.table.pattern.nodes;
  std::vector<int> local(nodes, -1);
  for (int p = 0; p < processes; ++p) {
    const Cut cut(system, own_nodes(nodes, processes, p), local);
    Writer out(folder / petsc::piece_name(p));
    cut.write(p, processes, out);
    out.close();
  }
}

PetscSolution read_results(const PetscSystem& system, int processes,
                           const fs::path& folder) {
  const int nodes = system.table.pattern.nodes;
  PetscSolution solution;
  for (const PetscGroup& group : system.groups) {
    PetscGroupSolution& solved = solution.groups.emplace_back();
    solved.diagonal = VectorX::Zero(3L * nodes);
    solved.u.assign(group.f.size(), VectorX::Zero(3L * nodes));
    solved.columns.resize(group.f.size());
  }
  for (int p = 0; p < processes; ++p) {
    const Range own = own_nodes(nodes, processes, p);
    ResultReader in(folder / petsc::result_name(p));
    const auto header = in.one<petsc::ResultHeader>();
    in.check(header.magic == petsc::kMagic && header.own == own.count());
    solution.process_memory.push_back(header.peak_bytes);
    solution.setup_seconds =
        std::max(solution.setup_seconds, header.setup_seconds);
    solution.solve_seconds =
        std::max(solution.solve_seconds, header.solve_seconds);
    for (PetscGroupSolution& group : solution.groups) {
      in.nodes(own, group.diagonal);
      for (std::size_t c = 0; c < group.u.size(); ++c) {
        group.columns[c] = column_of(in.one<petsc::CaseResult>());
        in.nodes(own, group.u[c]);
      }
    }
    in.check(in.one<std::uint64_t>() == petsc::kEndMark);
  }
  return solution;
}

}  // namespace meniscus::distributed
