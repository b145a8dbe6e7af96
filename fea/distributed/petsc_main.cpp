// meniscus-petsc FOLDER: solves one elastic system, this process a part of it.
// Programs of its own, started by mpirun: neither MPI nor PETSc is in the
// program that asks (fea/distributed/petsc_protocol.h).
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <petscsys.h>
#include <signal.h>
#include <stdexcept>
#include <unistd.h>

#include <sys/prctl.h>
#include <sys/resource.h>

#include "fea/distributed/petsc_solve.h"

namespace {

using namespace meniscus::distributed::petsc;

double peak_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void write_result(const std::filesystem::path& path, const Piece& piece,
                  const SolvedPiece& solved) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](const void* data, std::size_t size) {
    out.write(static_cast<const char*>(data),
              static_cast<std::streamsize>(size));
  };
  const auto put_list = [&](const std::vector<double>& list) {
    put(list.data(), sizeof(double) * list.size());
  };
  ResultHeader header;
  header.own = piece.header.own;
  header.peak_bytes = peak_bytes();
  header.setup_seconds = solved.setup_seconds;
  header.solve_seconds = solved.solve_seconds;
  put(&header, sizeof header);
  for (const SolvedGroup& group : solved.groups) {
    put_list(group.diagonal);
    for (const SolvedColumn& column : group.columns) {
      put(&column.result, sizeof column.result);
      put_list(column.u);
    }
  }
  put(&kEndMark, sizeof kEndMark);
  out.close();
  if (!out) {
    throw std::runtime_error(path.string() + " cannot be written");
  }
}

void run(const std::filesystem::path& folder) {
  int process = 0;
  int processes = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &process);
  MPI_Comm_size(PETSC_COMM_WORLD, &processes);
  const Piece piece = read_piece(folder / piece_name(process));
  if (piece.header.process != process || piece.header.processes != processes) {
    throw std::runtime_error(
        "the system was cut for another number of "
        "processes");
  }
  write_result(folder / result_name(process), piece, solve_piece(piece));
}

}  // namespace

int main(int argc, char** argv) {
  // Killed with mpirun, however that ends.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const std::filesystem::path folder = argc == 2 ? argv[1] : "";
  int count = 1;
  if (PetscOptionsSetValue(nullptr, "-skip_petscrc", nullptr) != 0 ||
      PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr) != 0 ||
      PetscInitialize(&count, &argv, nullptr, nullptr) != 0) {
    return 1;
  }
  try {
    if (folder.empty()) {
      throw std::runtime_error("usage: meniscus-petsc FOLDER");
    }
    run(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "meniscus-petsc: %s\n", error.what());
    MPI_Abort(PETSC_COMM_WORLD, 1);
  }
  return PetscFinalize() == 0 ? 0 : 1;
}
