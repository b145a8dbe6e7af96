#include "mesh_tet/tetgen_fill.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <queue>

#include <fmt/format.h>

#include "core/timer.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus {

namespace {

/// Fillings by sizes after the first mesh, each with the sizes at the nodes of
/// the one before. A third changes little.
constexpr int kPasses = 2;

/// Growth of the target edge per length, at most.
constexpr double kGrowth = 0.3;

/// TetGen's switches. Y: the surface stays. O9/7o/140: flips, smoothing and
/// new inner points against dihedral angles above 140 degrees, as far as
/// TetGen can.
std::string make_switches(const TetrahedralizeOptions& options,
                          const std::string& size) {
  return fmt::format("pY{}q{:.6f}/{:.3f}QO9/7o/140", size,
                     options.radius_edge_ratio, options.min_dihedral_deg);
}

TetgenOutput too_many(double count) {
  TetgenOutput output;
  output.failure = fmt::format(
      "the element edges asked for would make {:.3g} elements, more than "
      "{:.0e}; enlarge them",
      count, kMostElements);
  return output;
}

double size_at(const TetrahedralizeOptions& options, const Vec3& place) {
  const double size = options.size(place);
  if (!std::isfinite(size) || !(size > 0.0)) {
    throw InvalidInput(fmt::format(
        "tetrahedralize: size at ({:.6g}, {:.6g}, {:.6g}) is {}, must be "
        "finite and positive",
        place.x(), place.y(), place.z(), size));
  }
  return std::min(size, options.edge.value_or(size));
}

/// Sizes grow by at most kGrowth x the distance, along the mesh's edges: TetGen
/// only looks at corners, and a large element would not see a small size amid
/// its own. Smallest first, so that every node is settled once.
void limit_growth(BackgroundMesh& sizes) {
  std::vector<int> start(sizes.nodes.size() + 1, 0);
  for (const int node : sizes.elements) {
    ++start[node + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> star(sizes.elements.size());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < sizes.elements.size(); ++i) {
    star[next[sizes.elements[i]]++] = static_cast<int>(i / 4);
  }
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t n = 0; n < sizes.nodes.size(); ++n) {
    queue.emplace(sizes.edges[n], static_cast<int>(n));
  }
  while (!queue.empty()) {
    const auto [size, node] = queue.top();
    queue.pop();
    if (size > sizes.edges[node]) {
      continue;
    }
    for (int s = start[node]; s < start[node + 1]; ++s) {
      for (int k = 0; k < 4; ++k) {
        const int other = sizes.elements[4 * star[s] + k];
        const double bound =
            size + kGrowth * (sizes.nodes[other] - sizes.nodes[node]).norm();
        if (bound < sizes.edges[other]) {
          sizes.edges[other] = bound;
          queue.emplace(bound, other);
        }
      }
    }
  }
}

/// Elements of these sizes in the volume of the background.
double expected_count(const BackgroundMesh& sizes) {
  double count = 0.0;
  for (std::size_t i = 0; i < sizes.elements.size(); i += 4) {
    const int* ids = sizes.elements.data() + i;
    double edge = 0.0;
    for (int k = 0; k < 4; ++k) {
      edge += 0.25 * sizes.edges[ids[k]];
    }
    count += std::abs(tet_volume({sizes.nodes[ids[0]], sizes.nodes[ids[1]],
                                  sizes.nodes[ids[2]], sizes.nodes[ids[3]]})) /
             regular_volume(edge);
  }
  return count;
}

/// What is left of the time limit, for a further child.
TetgenLimits limits_left(const TetrahedralizeOptions& options,
                         const Timer& timer) {
  return {std::max(options.time_limit - timer.seconds(), 1e-3),
          options.memory_limit, options.monitor};
}

/// The surface once more, with elements of the edges asked for.
TetgenOutput fill_again(TetgenInput input, BackgroundMesh sizes,
                        const TetrahedralizeOptions& options,
                        const Timer& timer) {
  limit_growth(sizes);
  const double count = expected_count(sizes);
  if (count > kMostElements) {
    return too_many(count);
  }
  input.background = &sizes;
  input.switches = make_switches(options, "m");
  return run_tetgen(input, limits_left(options, timer));
}

}  // namespace

Frame::Frame(const Points& points, double edge)
    : scale(std::exp2(-std::round(std::log2(edge)))) {
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  center = 0.5 * low + 0.5 * high;
}

Points Frame::into(const Points& points) const {
  Points mapped;
  mapped.reserve(points.size());
  for (const Vec3& p : points) {
    mapped.push_back(into(p));
  }
  return mapped;
}

double regular_volume(double edge) {
  return edge * edge * edge / (6.0 * std::numbers::sqrt2);
}

TetgenOutput fill_surface(const SurfaceMesh& surface, const SurfaceFit& fit,
                          const Frame& frame,
                          const TetrahedralizeOptions& options) {
  const Timer timer;
  std::string volume;
  if (options.edge || !options.size) {
    const double edge = options.edge.value_or(mean_edge_length(surface));
    const double largest = kVolumeFactor * regular_volume(edge);
    if (fit.volume / largest > kMostElements) {
      return too_many(fit.volume / largest);
    }
    volume = fmt::format("a{:.12f}", largest * std::pow(frame.scale, 3));
  }
  const Points points = frame.into(surface.points);
  const TetgenInput input{.points = &points,
                          .facets = &surface.facets,
                          .holes = frame.into(fit.cavities),
                          .switches = make_switches(options, volume)};
  TetgenOutput output = run_tetgen(input, limits_left(options, timer));
  for (int pass = 0; options.size && !output.failure && pass < kPasses;
       ++pass) {
    BackgroundMesh sizes{
        std::move(output.nodes), std::move(output.elements), {}};
    sizes.edges.reserve(sizes.nodes.size());
    for (const Vec3& p : sizes.nodes) {
      sizes.edges.push_back(frame.scale * size_at(options, frame.back(p)));
    }
    output = fill_again(input, std::move(sizes), options, timer);
  }
  return output;
}

TetgenOutput fill_by_sizes(const SurfaceMesh& surface, const SurfaceFit& fit,
                           const Frame& frame, const BackgroundMesh& sizes,
                           const TetrahedralizeOptions& options) {
  const Points points = frame.into(surface.points);
  return fill_again({.points = &points,
                     .facets = &surface.facets,
                     .holes = frame.into(fit.cavities),
                     .switches = {}},
                    sizes, options, Timer());
}

}  // namespace meniscus
