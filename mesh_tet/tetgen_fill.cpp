#include "mesh_tet/tetgen_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/timer.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus::mesh_tet {

namespace {

/// Largest volume over that of the regular element where sizes vary: the
/// median element then has about the size asked for.
constexpr double kGradedFactor = 3.5;

/// TetGen's switches. Y: the surface stays. F: no list of faces. O9/7o/140:
/// flips, smoothing and new inner points against dihedral angles above 140
/// degrees, as far as TetGen can.
std::string make_switches(const char* work,
                          const TetrahedralizeOptions& options,
                          const std::string& volume) {
  return fmt::format("{}YQFq{:.6f}/{:.3f}{}O9/7o/140", work,
                     options.radius_edge_ratio, options.min_dihedral_deg,
                     volume);
}

/// Points that TetGen may add where sizes vary: ten times what such meshes
/// have. Between some graded facets it splits without end; a time limit alone
/// would make the answer depend on the machine.
int most_new_points(double elements) {
  constexpr double kPointsPerElement = 3.0;
  constexpr double kAtLeast = 2000.0;
  return static_cast<int>(std::max(kAtLeast, kPointsPerElement * elements));
}

/// Runs TetGen with that bound; reaching it is a failure.
TetgenOutput run_bounded(TetgenInput input, double elements,
                         const TetgenLimits& limits) {
  const int most = most_new_points(elements);
  input.switches += fmt::format("S{}", most);
  const std::size_t before = input.points->size();
  TetgenOutput output = run_tetgen(input, limits);
  if (!output.failure &&
      output.nodes.size() >= before + static_cast<std::size_t>(most)) {
    output.failure = fmt::format(
        "TetGen went on splitting elements after {} new points, for {:.0f} "
        "elements asked for; try another size",
        most, elements);
  }
  return output;
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

double first_edge(const SurfaceMesh& surface,
                  const TetrahedralizeOptions& options) {
  return options.edge ? *options.edge : mean_edge_length(surface);
}

/// Smallest size at the centroid, on the faces, on the edges and half way to
/// the corners.
double element_size(const TetrahedralizeOptions& options, const Frame& frame,
                    const TetCorners& x) {
  const Vec3 middle = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  double least = size_at(options, frame.back(middle));
  const auto look = [&](const Vec3& place) {
    least = std::min(least, size_at(options, frame.back(place)));
  };
  for (const Vec3& corner : x) {
    look(0.5 * (middle + corner));
    look((4.0 * middle - corner) / 3.0);
  }
  for (const Edge& edge : kTetEdges) {
    look(0.5 * (x[edge[0]] + x[edge[1]]));
  }
  return least;
}

struct Bounds {
  std::vector<double> largest;  // volume per element, in the frame
  double excess = 0.0;          // part of the elements that is too large
  double expected = 0.0;        // elements after splitting
};

Bounds find_bounds(const TetgenOutput& output, const Frame& frame,
                   const TetrahedralizeOptions& options) {
  Bounds bounds;
  const std::size_t count = output.elements.size() / 4;
  bounds.largest.reserve(count);
  for (std::size_t e = 0; e < count; ++e) {
    const int* ids = output.elements.data() + 4 * e;
    const TetCorners x = {output.nodes[ids[0]], output.nodes[ids[1]],
                          output.nodes[ids[2]], output.nodes[ids[3]]};
    const double edge = frame.scale * element_size(options, frame, x);
    const double largest = kGradedFactor * regular_volume(edge);
    const double volume = std::abs(tet_volume(x));
    bounds.largest.push_back(largest);
    bounds.excess += volume > largest ? 1.0 / static_cast<double>(count) : 0.0;
    bounds.expected += std::max(1.0, volume / largest);
  }
  return bounds;
}

/// What is left of the time limit, for a further child.
TetgenLimits limits_left(const TetrahedralizeOptions& options,
                         const Timer& timer) {
  return {std::max(options.time_limit - timer.seconds(), 1e-3),
          options.memory_limit, options.monitor};
}

/// The second pass sees sizes between the first's nodes; what is too large
/// after it lies at the surface, which keeps its size.
TetgenOutput split_large(TetgenOutput output, const SurfaceMesh& surface,
                         const Frame& frame,
                         const TetrahedralizeOptions& options,
                         const Timer& timer) {
  constexpr std::array<double, 2> kBearable = {0.0, 0.01};
  for (const double bearable : kBearable) {
    const Bounds bounds = find_bounds(output, frame, options);
    if (bounds.excess <= bearable) {
      break;
    }
    if (bounds.expected > kMostElements) {
      return too_many(bounds.expected);
    }
    output = run_bounded({.points = &output.nodes,
                          .facets = &surface.facets,
                          .elements = &output.elements,
                          .largest = &bounds.largest,
                          .switches = make_switches("r", options, "a")},
                         bounds.expected, limits_left(options, timer));
    if (output.failure) {
      break;
    }
  }
  return output;
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

std::string fill_switches(const SurfaceMesh& surface, const Frame& frame,
                          const TetrahedralizeOptions& options) {
  if (!options.edge && options.size) {
    return make_switches("p", options, "");
  }
  const double largest = kVolumeFactor * std::pow(frame.scale, 3) *
                         regular_volume(first_edge(surface, options));
  return make_switches("p", options, fmt::format("a{:.12f}", largest));
}

TetgenOutput fill_surface(const SurfaceMesh& surface, const SurfaceFit& fit,
                          const Frame& frame,
                          const TetrahedralizeOptions& options) {
  const Timer timer;
  const double count =
      fit.volume /
      (kVolumeFactor * regular_volume(first_edge(surface, options)));
  if ((options.edge || !options.size) && count > kMostElements) {
    return too_many(count);
  }
  Points points = frame.into(surface.points);
  const Points inside = frame.into(options.inside);
  points.insert(points.end(), inside.begin(), inside.end());
  const TetgenInput input{.points = &points,
                          .facets = &surface.facets,
                          .holes = frame.into(fit.cavities),
                          .switches = fill_switches(surface, frame, options)};
  if (!options.size) {
    return run_tetgen(input, limits_left(options, timer));
  }
  TetgenOutput output =
      run_bounded(input, count + static_cast<double>(surface.facets.size()),
                  limits_left(options, timer));
  return output.failure
             ? output
             : split_large(std::move(output), surface, frame, options, timer);
}

TetgenOutput split_elements(const SurfaceMesh& surface, const Frame& frame,
                            const TetMesh& mesh,
                            const std::vector<double>& edge,
                            const TetrahedralizeOptions& options) {
  double expected = 0.0;
  std::vector<double> largest;
  largest.reserve(edge.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double volume = kGradedFactor * regular_volume(edge[e]);
    expected += std::max(1.0, corner_volume(mesh, e) / volume);
    largest.push_back(volume * std::pow(frame.scale, 3));
  }
  if (expected > kMostElements) {
    return too_many(expected);
  }
  const Points points = frame.into(mesh.nodes);
  return run_bounded({.points = &points,
                      .facets = &surface.facets,
                      .elements = &mesh.elements,
                      .largest = &largest,
                      .switches = make_switches("r", options, "a")},
                     expected, limits_left(options, Timer()));
}

}  // namespace meniscus::mesh_tet
