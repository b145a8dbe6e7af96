#include "evolve/start/band_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evolve/curves/curve_shape.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr double kUneven = 2.5;      // longest line over the shortest
constexpr double kRowHeight = 0.87;  // of equilateral facets, in edges
constexpr double kSamePlace = 1e-9;  // of the whole turn

/// Points of the band in order of t, which rises from anywhere and may pass 1.
struct Row {
  std::vector<double> t;
  std::vector<int> ids;

  int count() const { return static_cast<int>(t.size()); }
  /// One past the last is the first, a turn later.
  double t_at(int i) const { return i < count() ? t[i] : t[0] + 1.0; }
  int id_at(int i) const { return ids[i < count() ? i : 0]; }
};

Row sorted_row(const std::vector<double>& t, int first_id, int parts) {
  Row row;
  std::vector<std::pair<double, int>> all;
  for (std::size_t k = 0; k < t.size(); ++k) {
    // A corner is at its own parameter, whatever rounding made of it.
    const double corner = std::round(t[k] * parts) / parts;
    const double at = std::abs(t[k] - corner) < kSamePlace ? corner : t[k];
    all.emplace_back(at >= 1.0 ? at - 1.0 : at, first_id + static_cast<int>(k));
  }
  std::sort(all.begin(), all.end());
  for (const auto& [at, id] : all) {
    row.t.push_back(at);
    row.ids.push_back(id);
  }
  return row;
}

/// The same row from the point nearest to `t` on, its parameters near t's.
Row begun_near(const Row& row, double t) {
  const auto off = [&](double at) {
    return at - t - std::round(at - t);  // in [-0.5, 0.5]
  };
  const auto nearest = std::min_element(
      row.t.begin(), row.t.end(),
      [&](double a, double b) { return std::abs(off(a)) < std::abs(off(b)); });
  const auto first = static_cast<int>(nearest - row.t.begin());
  Row result;
  for (int k = 0; k < row.count(); ++k) {
    const int i = (first + k) % row.count();
    const double turn = i < first ? 1.0 : 0.0;
    result.t.push_back(t + off(*nearest) + (row.t[i] + turn - *nearest));
    result.ids.push_back(row.ids[i]);
  }
  return result;
}

/// The part of a row between t = from and to, `to` included.
std::vector<double> part_of(const Row& row, double from, double to) {
  std::vector<double> part;
  for (int i = 0; i <= row.count(); ++i) {
    const double t = row.t_at(i);
    if (t >= from - kSamePlace && t <= to + kSamePlace) {
      part.push_back(t);
    }
  }
  return part;
}

/// The value at `share` of the way through a list.
double at_share(const std::vector<double>& list, double share) {
  const double place = share * static_cast<double>(list.size() - 1);
  const auto k =
      std::min(static_cast<std::size_t>(std::max(0.0, place)), list.size() - 2);
  return list[k] + (place - static_cast<double>(k)) * (list[k + 1] - list[k]);
}

/// Parameters of a row between two: as many, and as close, as the rims'
/// weighted by how near they are. Corners stay; else every other row is moved
/// by half a piece.
std::vector<double> row_between(const Row& outer, const Row& inner, int parts,
                                double share, bool staggered) {
  std::vector<double> result;
  const double start = parts > 1 ? 0.0 : outer.t[0];
  for (int p = 0; p < parts; ++p) {
    const double from = start + static_cast<double>(p) / parts;
    const double to = start + static_cast<double>(p + 1) / parts;
    const std::vector<double> a = part_of(outer, from, to);
    std::vector<double> b = parts > 1 ? part_of(inner, from, to) : inner.t;
    if (parts == 1) {
      b.push_back(inner.t[0] + 1.0);
    }
    const double pieces = (1.0 - share) * static_cast<double>(a.size() - 1) +
                          share * static_cast<double>(b.size() - 1);
    const int count = std::max(1, static_cast<int>(std::lround(pieces)));
    const double offset = staggered && parts == 1 ? 0.5 : 0.0;
    for (int i = 0; i < count; ++i) {
      const double along = (i + offset) / count;
      const double t =
          (1.0 - share) * at_share(a, along) + share * at_share(b, along);
      result.push_back(t - std::floor(t));
    }
  }
  return result;
}

/// The strip between two rows: always on by the piece whose middle comes first.
void stitch(const Row& low, const Row& above, std::vector<Triangle>& facets) {
  const Row high = begun_near(above, low.t[0]);
  int i = 0;
  int j = 0;
  while (i < low.count() || j < high.count()) {
    const bool on_low =
        j == high.count() ||
        (i < low.count() && low.t_at(i) + low.t_at(i + 1) <=
                                high.t_at(j) + high.t_at(j + 1) + kSamePlace);
    if (on_low) {
      facets.push_back({low.id_at(i), low.id_at(i + 1), high.id_at(j)});
      ++i;
    } else {
      facets.push_back({low.id_at(i), high.id_at(j + 1), high.id_at(j)});
      ++j;
    }
  }
}

std::vector<double> line_lengths(const films::RuledBand& band,
                                 const std::vector<curves::Curve>& curves,
                                 const BandRim& outer, const BandRim& inner) {
  std::vector<double> lengths;
  for (const BandRim* rim : {&outer, &inner}) {
    for (const double t : rim->t) {
      lengths.push_back((films::point_on_band(band, curves, t, 0.0) -
                         films::point_on_band(band, curves, t, 1.0))
                            .norm());
    }
  }
  return lengths;
}

double mean_piece_of(const Points& rim) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    sum += (rim[(i + 1) % rim.size()] - rim[i]).norm();
  }
  return sum / static_cast<double>(rim.size());
}

BandFilling isotropic(const films::RuledBand& band,
                      const std::vector<curves::Curve>& curves,
                      const BandRim& outer, const BandRim& inner, double edge) {
  BandFilling filling;
  filling.mesh = fill_ring(outer.points, inner.points, edge);
  for (std::size_t v = outer.points.size() + inner.points.size();
       v < filling.mesh.points.size(); ++v) {
    Vec3& point = filling.mesh.points[v];
    const films::BandPlace place = films::nearest_on_band(band, curves, point);
    point = films::point_on_band(band, curves, place.t, place.share);
    filling.between.push_back(place);
  }
  return filling;
}

/// Corners that lines of the band join, at equal steps of t; 1: none.
int joined_corners(const films::RuledBand& band,
                   const std::vector<curves::Curve>& curves) {
  return band.outer_shares.t.empty()
             ? curves::curve_shape::part_count(curves[band.outer].shape)
             : 1;
}

}  // namespace

BandFilling fill_band(const films::RuledBand& band,
                      const std::vector<curves::Curve>& curves,
                      const BandRim& outer, const BandRim& inner, double edge) {
  // 1. How many rows the ruling takes; a band of very uneven lines has none.
  const std::vector<double> lengths = line_lengths(band, curves, outer, inner);
  const auto [shortest, longest] =
      std::minmax_element(lengths.begin(), lengths.end());
  if (*longest > kUneven * *shortest) {
    return isotropic(band, curves, outer, inner, edge);
  }
  const double mean = std::accumulate(lengths.begin(), lengths.end(), 0.0) /
                      static_cast<double>(lengths.size());
  const double piece = std::min(
      {edge, mean_piece_of(outer.points), mean_piece_of(inner.points)});
  const int rows =
      std::max(1, static_cast<int>(std::lround(mean / (kRowHeight * piece))));
  // 2. The rims as the first and the last row, begun near each other.
  const int parts = joined_corners(band, curves);
  const auto first_inner = static_cast<int>(outer.points.size());
  const Row first = sorted_row(outer.t, 0, parts);
  const Row last =
      begun_near(sorted_row(inner.t, first_inner, parts), first.t[0]);
  BandFilling filling;
  SurfaceMesh& mesh = filling.mesh;
  mesh.points = outer.points;
  mesh.points.insert(mesh.points.end(), inner.points.begin(),
                     inner.points.end());
  // 3. Rows between, on the ruling, every other one half a piece along; each is
  //    stitched to the one below it.
  Row below = first;
  for (int k = 1; k < rows; ++k) {
    const double share = static_cast<double>(k) / rows;
    const auto first_id = static_cast<int>(mesh.points.size());
    const std::vector<double> t =
        row_between(first, last, parts, share, k % 2 == 1);
    for (const double at : t) {
      filling.between.push_back({at, share});
      mesh.points.push_back(films::point_on_band(band, curves, at, share));
    }
    const Row row = sorted_row(t, first_id, parts);
    stitch(below, row, mesh.facets);
    below = row;
  }
  stitch(below, last, mesh.facets);
  return filling;
}

}  // namespace meniscus::start
