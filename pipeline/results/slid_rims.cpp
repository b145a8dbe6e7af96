#include "pipeline/results/slid_rims.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::results {

namespace {

/// The one rim of a surface, in the direction of its facets; empty where it has
/// several.
Points rim_of(const SurfaceMesh& mesh, int label) {
  std::map<int, int> next;
  std::map<Edge, int> runs;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3 && mesh.facet_label[f] == label; ++k) {
      runs[{mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]}] = 1;
    }
  }
  for (const auto& [run, count] : runs) {
    if (runs.count({run[1], run[0]}) == 0) {
      next[run[0]] = run[1];
    }
  }
  Points rim;
  for (auto at = next.begin(); at != next.end();) {
    rim.push_back(mesh.points[at->first]);
    const int to = at->second;
    next.erase(at);
    at = next.find(to);
  }
  return next.empty() ? rim : Points();
}

}  // namespace

films::FilmSystem held_where_it_slid(films::FilmSystem system,
                                     const frozen::FilmModel& model) {
  const SurfaceMesh mesh = model.fine_mesh(model.reference().points);
  for (films::CapSpec& cap : system.caps) {
    if (!cap.wall) {
      continue;
    }
    Points rim = rim_of(mesh, mesh.label_of(cap.name));
    if (rim.empty() || !cap.more.empty()) {
      throw InvalidInput(fmt::format(
          "the face that '{}' wets has several rims, which smooth STEP faces "
          "cannot follow yet; write it with facets",
          cap.name));
    }
    for (curves::Curve& curve : system.curves) {
      if (curve.name == cap.curve) {
        curve.shape = curves::Spline{std::move(rim)};
        break;
      }
    }
    cap.wall.reset();
  }
  return system;
}

}  // namespace meniscus::results
