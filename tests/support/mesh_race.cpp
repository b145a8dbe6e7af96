#include "tests/support/mesh_race.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <regex>

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/find_program.h"
#include "mesh_tet/tetgen_fill.h"
#include "tests/support/measured_child.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus {

namespace {

constexpr double kTimeLimit = 300.0;  // [s]

double children_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

MeshRun measured(const MeasuredChild& child) {
  MeshRun run;
  run.succeeded = child.succeeded;
  run.seconds = child.user_seconds + child.system_seconds;
  run.wall_seconds = child.wall_seconds;
  run.peak_bytes = child.peak_bytes;
  return run;
}

/// Keeps the faster; false when the run failed.
bool keep_faster(MeshRun& best, const MeshRun& run) {
  if (!run.succeeded || best.seconds == 0.0 || run.seconds < best.seconds) {
    best = run;
  }
  return run.succeeded;
}

/// Two bent arms on a foot: the proportions of the two-arm bracket.
SurfaceMesh bracket(int levels) {
  SurfaceMesh mesh = shapes::sphere(1.0, levels);
  for (Vec3& p : mesh.points) {
    const double arm = 0.8 + 0.4 * p.x() * p.x();
    p = Vec3(150 * p.x(), 80 * arm * p.y(),
             70 * arm * p.z() + 50 * p.x() * p.x());
  }
  return mesh;
}

void write_smesh(const std::filesystem::path& path, const SurfaceMesh& surface,
                 const mesh_tet::Frame& frame) {
  std::ofstream file(path);
  file << fmt::format("{} 3 0 0\n", surface.points.size());
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vec3 p = frame.into(surface.points[i]);
    file << fmt::format("{} {:.17g} {:.17g} {:.17g}\n", i, p.x(), p.y(), p.z());
  }
  file << fmt::format("{} 0\n", surface.facets.size());
  for (const Triangle& t : surface.facets) {
    file << fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  }
  file << "0\n0\n";
}

double number_after(const std::string& text, const std::string& words) {
  std::smatch match;
  const std::regex pattern(words + "\\s*([0-9.]+)");
  return std::regex_search(text, match, pattern) ? std::stod(match[1]) : 0.0;
}

}  // namespace

std::vector<MeshWork> mesh_works(int coarser) {
  const double wider = std::exp2(coarser);
  return {
      {"ball", shapes::sphere(74.0, 4 - coarser), 4.95 * wider},
      {"bracket", bracket(5 - coarser), 6.0 * wider},
      {"box", shapes::box(Vec3(300, 100, 60), 40 >> coarser), 5.25 * wider}};
}

MeshRun run_mesher(const MeshWork& work) {
  const MeasuredChild child = measure_forked([&] {
    const auto result =
        mesh_tet::tetrahedralize(work.surface, {.edge = work.edge});
    if (result.failure) {
      throw MeshError(result.failure->message);
    }
    return fmt::format("{} {} {}", result.mesh.element_count(),
                       result.quality.min_dihedral_deg, children_seconds());
  });
  MeshRun run = measured(child);
  run.message = child.output;
  if (run.succeeded) {
    std::sscanf(child.output.c_str(), "%d %lf %lf", &run.elements,
                &run.min_dihedral_deg, &run.tetgen_seconds);
  }
  return run;
}

bool have_tetgen() { return find_program("tetgen").has_value(); }

MeshRun run_tetgen_program(const MeshWork& work) {
  const TempFolder folder;
  const mesh_tet::Frame frame(work.surface.points, work.edge);
  write_smesh(folder / "part.smesh", work.surface, frame);
  const mesh_tet::TetrahedralizeOptions options{.edge = work.edge};
  std::string switches =
      "-" + mesh_tet::fill_switches(work.surface, frame, options) + "NEF";
  std::erase(switches, 'Q');  // so that it prints its time
  const MeasuredChild child = measure_program(
      {"tetgen", switches, "part.smesh"}, folder.path(), kTimeLimit);
  MeshRun run = measured(child);
  run.message = child.output;
  run.elements =
      static_cast<int>(number_after(child.output, "Mesh tetrahedra:"));
  run.tetgen_seconds = number_after(child.output, "Total running seconds:");
  return run;
}

MeshRace race_mesher(const MeshWork& work, int runs) {
  MeshRace race;
  std::vector<double> ratios;
  for (int i = 0; i < runs; ++i) {
    const MeshRun own = run_mesher(work);
    const MeshRun peer = run_tetgen_program(work);
    if (!keep_faster(race.own, own) || !keep_faster(race.peer, peer)) {
      return race;
    }
    ratios.push_back(own.seconds / peer.seconds);
  }
  std::sort(ratios.begin(), ratios.end());
  race.ratio = ratios[ratios.size() / 2];
  return race;
}

}  // namespace meniscus
