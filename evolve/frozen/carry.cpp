#include "evolve/frozen/carry.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/union_find.h"
#include "evolve/energy/film_space.h"
#include "evolve/films/solid_frame.h"

namespace meniscus::frozen {

namespace {

/// Unit normals of the walls that a vertex slides on.
std::vector<Vec3> wall_normals_at(const films::FilmComplex& reference, int v) {
  std::vector<Vec3> result;
  const films::ComplexVertex& vertex = reference.vertices[v];
  if ((vertex.kind == films::VertexKind::Free ||
       vertex.kind == films::VertexKind::InCap) &&
      vertex.constraints >= 0) {
    for (const int wall : reference.constraint_sets[vertex.constraints]) {
      result.push_back(
          jet_at(reference.level_sets[wall].formula, reference.mesh.points[v])
              .gradient.normalized());
    }
  }
  return result;
}

/// Orthonormal directions across the normals of walls.
std::vector<Vec3> ways_left(const std::vector<Vec3>& normals) {
  if (normals.empty()) {
    return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  }
  const Vec3& n = normals[0];
  if (normals.size() == 1) {
    const Vec3 first = n.cross(energy::line_axis(n)).normalized();
    return {first, n.cross(first)};
  }
  if (normals.size() == 2) {
    return {n.cross(normals[1]).normalized()};
  }
  return {};
}

}  // namespace

Carry::Part Carry::part_of(const films::ComplexSurface& surface) {
  return surface.liquid ? Part::Films
                        : (surface.wetted ? Part::Wetted : Part::Caps);
}

/// The surface of a facet on a bent wall, else -1.
int Carry::bent_face(const films::FilmComplex& reference, int facet) {
  const int label = reference.mesh.facet_label[facet];
  const auto& wetted = reference.surfaces[label].wetted;
  return wetted && wetted->bent ? label : -1;
}

/// A cone's apex stays.
bool Carry::is_apex(const films::FilmComplex& reference, int facet, int v) {
  const int label = bent_face(reference, facet);
  if (label < 0) {
    return false;
  }
  const films::BentWall& wall = *reference.surfaces[label].wetted->bent;
  return wall.kind == films::WallKind::Cone &&
         reference.mesh.points[v] == wall.at;
}

/// Vertices of a part that facets link to its rim; others, of parts that float,
/// stay where they are. What caps and wetted faces have in common is of caps.
std::vector<char> Carry::carried_vertices(const films::FilmComplex& reference,
                                          Part part,
                                          const std::vector<char>& given) {
  const films::VertexKind kind =
      part == Part::Films ? films::VertexKind::Free : films::VertexKind::InCap;
  UnionFind parts(reference.vertices.size());
  const SurfaceMesh& mesh = reference.mesh;
  std::vector<char> own(parts.size(), 0);
  std::vector<char> of_caps(parts.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Part here = part_of(reference.surfaces[mesh.facet_label[f]]);
    const Triangle& t = mesh.facets[f];
    for (const int v : t) {
      own[v] = own[v] != 0 || here == part ? 1 : 0;
      const bool stays =
          here == Part::Caps || is_apex(reference, static_cast<int>(f), v);
      of_caps[v] = of_caps[v] != 0 || stays ? 1 : 0;
    }
    if (here == part) {
      parts.join(t[0], t[1]);
      parts.join(t[0], t[2]);
    }
  }
  std::vector<char> held(parts.size(), 0);
  std::vector<char> result(parts.size(), 0);
  for (std::size_t v = 0; v < held.size(); ++v) {
    const bool elsewhere = part == Part::Wetted && of_caps[v] != 0;
    const bool moves =
        reference.vertices[v].kind == kind && !elsewhere && given[v] == 0;
    result[v] = moves && (part == Part::Films || own[v] != 0) ? 1 : 0;
    if (!moves) {
      held[parts.root(static_cast<int>(v))] = 1;
    }
  }
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (held[parts.root(static_cast<int>(v))] == 0) {
      result[v] = 0;
    }
  }
  return result;
}

/// With the Laplacian L of one coordinate and the basis B of the ways that are
/// left, the moves are B y, (B' L B) y = B' (outer moves).
void Carry::bind_to_walls(const films::FilmComplex& reference,
                          const SparseMatrix& inner, Extension& extension) {
  std::vector<Eigen::Triplet<double>> entries;
  int count = 0;
  bool walls = false;
  for (std::size_t i = 0; i < extension.vertices.size(); ++i) {
    const std::vector<Vec3> normals =
        wall_normals_at(reference, extension.vertices[i]);
    walls = walls || !normals.empty();
    for (const Vec3& way : ways_left(normals)) {
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(static_cast<int>(3 * i) + k, count, way[k]);
      }
      ++count;
    }
  }
  if (!walls) {
    return;
  }
  const auto rows = static_cast<Eigen::Index>(3 * extension.vertices.size());
  extension.ways.resize(rows, count);
  extension.ways.setFromTriplets(entries.begin(), entries.end());
  entries.clear();
  for (int j = 0; j < inner.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(inner, j); it; ++it) {
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(3 * static_cast<int>(it.row()) + k, 3 * j + k,
                             it.value());
      }
    }
  }
  SparseMatrix lower(rows, rows);
  lower.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix all = lower.selfadjointView<Eigen::Lower>();
  const SparseMatrix left = extension.ways.transpose() * all * extension.ways;
  SparseMatrix system = left.triangularView<Eigen::Lower>();
  system.makeCompressed();
  extension.factor.emplace(system, FactorKind::Cholesky);
  if (!extension.factor->factorize(system)) {
    throw MeshError(
        "the reference film cannot be carried along its walls: its Laplacian "
        "is singular there");
  }
}

/// `right`: three columns, one row per vertex.
Eigen::MatrixXd Carry::Extension::solve(const Eigen::MatrixXd& right) const {
  if (ways.cols() == 0) {
    return factor->solve(right);
  }
  const Eigen::MatrixXd rows = right.transpose();  // 3 to a vertex
  const Eigen::Map<const VectorX> all(rows.data(), rows.size());
  const VectorX found = ways * VectorX(factor->solve(ways.transpose() * all));
  return Eigen::Map<const Eigen::MatrixXd>(found.data(), 3, right.rows())
      .transpose();
}

Carry::Extension Carry::extend(const films::FilmComplex& reference, Part part,
                               const std::vector<char>& given,
                               const std::vector<int>& order) {
  Extension extension;
  std::vector<int> unknown_of(reference.vertices.size(), -1);
  const std::vector<char> carried = carried_vertices(reference, part, given);
  for (std::size_t v = 0; v < reference.vertices.size(); ++v) {
    if (carried[v] != 0) {
      unknown_of[v] = static_cast<int>(extension.vertices.size());
      extension.vertices.push_back(static_cast<int>(v));
    }
  }
  if (extension.vertices.empty()) {
    return extension;
  }
  const bool film = part == Part::Films;
  std::vector<double> weight;
  for (const int label : reference.mesh.facet_label) {
    weight.push_back(part_of(reference.surfaces[label]) == part ? 1.0 : 0.0);
  }
  const auto count = static_cast<int>(extension.vertices.size());
  energy::LaplaceSystem laplace = energy::cotan_laplacian(
      reference.mesh, weight, unknown_of, count,
      film ? energy::CotanWeights::Clamped : energy::CotanWeights::Exact);
  extension.outer.swap(laplace.outer);
  laplace.inner.makeCompressed();
  bind_to_walls(reference, laplace.inner, extension);
  if (extension.factor) {
    return extension;
  }
  std::vector<int> own_order;
  for (const int v : order) {
    if (unknown_of[v] >= 0) {
      own_order.push_back(unknown_of[v]);
    }
  }
  const bool has_all = own_order.size() == extension.vertices.size();
  extension.factor.emplace(laplace.inner, FactorKind::Cholesky,
                           has_all ? own_order : std::vector<int>{});
  if (!extension.factor->factorize(laplace.inner)) {
    throw MeshError(
        "the reference film cannot be carried: its Laplacian is singular at "
        "vertex " +
        std::to_string(extension.vertices[extension.factor->failed_column()]));
  }
  return extension;
}

Carry::Carry(const films::FilmComplex& reference, const std::vector<int>& lines,
             const std::vector<int>& film_order)
    : reference_(reference.mesh.points),
      stands_(reference.curves.size()),
      stands_on_curves_(reference.vertices.size(), 0),
      given_(reference.vertices.size(), 0) {
  const std::vector<char> none(reference.vertices.size(), 0);
  films_ = extend(reference, Part::Films, none, film_order);
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(lines_),
               [&](int v) {  // these are in order
                 return std::binary_search(films_.vertices.begin(),
                                           films_.vertices.end(), v);
               });
  for (const int v : lines_) {
    given_[v] = 1;
  }
  if (!lines_.empty()) {
    over_lines_ = std::move(films_);
    films_ = extend(reference, Part::Films, given_, film_order);
  }
  caps_ = extend(reference, Part::Caps, none, {});
  wetted_ = extend(reference, Part::Wetted, none, {});
  std::vector<int> face(reference.vertices.size(), -1);
  for (std::size_t f = 0; f < reference.mesh.facets.size(); ++f) {
    for (const int v : reference.mesh.facets[f]) {
      face[v] = std::max(face[v], bent_face(reference, static_cast<int>(f)));
    }
  }
  for (const int v : wetted_.vertices) {
    if (face[v] >= 0) {
      on_bent_.push_back({v, *reference.surfaces[face[v]].wetted->bent});
    }
  }
  for (std::size_t v = 0; v < reference.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = reference.vertices[v];
    const auto id = static_cast<int>(v);
    slides_ = slides_ || !wall_normals_at(reference, id).empty();
    if (vertex.kind == films::VertexKind::OnCurve) {
      stands_on_curves_[v] = 1;
      stands_[vertex.curve].push_back({id, vertex.t, 1.0});
    } else if (vertex.kind == films::VertexKind::OnBand) {
      const films::RuledBand& band = reference.bands[vertex.curve];
      stands_on_curves_[v] = 1;
      stands_[band.outer].push_back({id, vertex.t, 1.0 - vertex.share});
      stands_[band.inner].push_back(
          {id, band.partner_of_outer(vertex.t), vertex.share});
    } else if (vertex.kind == films::VertexKind::OnEdge ||
               vertex.kind == films::VertexKind::OnFace) {
      const bool edge = vertex.kind == films::VertexKind::OnEdge;
      add_stands_on_frame(
          reference, id,
          (edge ? reference.solid_edges : reference.solid_faces)[vertex.curve]
              .frame);
    }
    given_[v] = given_[v] != 0 || stands_on_curves_[v] != 0 ? 1 : 0;
  }
}

void Carry::add_stands_on_frame(const films::FilmComplex& reference, int vertex,
                                int frame) {
  if (frame < 0) {
    return;
  }
  stands_on_curves_[vertex] = 1;
  const std::array<double, 4> weights =
      films::frame_weights(films::frame_at(reference.curves[frame].shape),
                           reference.mesh.points[vertex]);
  for (int k = 0; k < 4; ++k) {
    stands_[frame].push_back({vertex, films::frame_parameter(k), weights[k]});
  }
}

Points Carry::rim_moves(const std::vector<curves::Curve>& curves) const {
  Points moves(reference_.size(), Vec3::Zero());
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::vector<double> parameters;
    parameters.reserve(stands_[c].size());
    for (const Stand& stand : stands_[c]) {
      parameters.push_back(stand.t);
    }
    const Points places = curves::points_at(curves[c].shape, parameters);
    for (std::size_t k = 0; k < places.size(); ++k) {
      moves[stands_[c][k].vertex] += stands_[c][k].weight * places[k];
    }
  }
  for (std::size_t v = 0; v < moves.size(); ++v) {
    if (stands_on_curves_[v] != 0) {
      moves[v] -= reference_[v];
    }
  }
  return moves;
}

void Carry::apply(const Extension& extension, Points& moves) {
  if (extension.vertices.empty()) {
    return;
  }
  const Eigen::Map<const Eigen::Matrix3Xd> all(
      moves.front().data(), 3, static_cast<Eigen::Index>(moves.size()));
  const Eigen::MatrixXd right = extension.outer * all.transpose();
  if (right.isZero(0.0)) {
    return;
  }
  const Eigen::MatrixXd found = extension.solve(right);
  for (std::size_t i = 0; i < extension.vertices.size(); ++i) {
    moves[extension.vertices[i]] +=
        found.row(static_cast<Eigen::Index>(i)).transpose();
  }
}

void Carry::add_transposed(const Extension& extension, const Points& by_points,
                           Points& result) {
  if (extension.vertices.empty()) {
    return;
  }
  Eigen::MatrixXd right(static_cast<Eigen::Index>(extension.vertices.size()),
                        3);
  for (std::size_t i = 0; i < extension.vertices.size(); ++i) {
    right.row(static_cast<Eigen::Index>(i)) =
        by_points[extension.vertices[i]].transpose();
  }
  const Eigen::MatrixXd sum =
      extension.outer.transpose() * extension.solve(right);
  for (std::size_t v = 0; v < result.size(); ++v) {
    result[v] += sum.row(static_cast<Eigen::Index>(v)).transpose();
  }
}

Points Carry::transpose_by(const Extension& films,
                           const Points& by_points) const {
  Points result = by_points;
  add_transposed(wetted_, by_points, result);
  const Points by_rims = result;
  add_transposed(films, by_rims, result);
  add_transposed(caps_, by_rims, result);
  const std::vector<char>& given =
      &films == &films_ ? given_ : stands_on_curves_;
  for (std::size_t v = 0; v < reference_.size(); ++v) {
    if (given[v] == 0) {
      result[v].setZero();
    }
  }
  return result;
}

Points Carry::transpose(const Points& by_points) const {
  return transpose_by(films_, by_points);
}

Points Carry::transpose_over_lines(const Points& by_points) const {
  return transpose_by(over_lines_, by_points);
}

Points Carry::rates_by(const Extension& films, const Points& rim_rates) const {
  Points result = rim_rates;
  apply(films, result);
  apply(caps_, result);
  apply(wetted_, result);
  return result;
}

Points Carry::rates(const Points& rim_rates) const {
  return rates_by(films_, rim_rates);
}

Points Carry::rates_over_lines(const Points& rim_rates) const {
  return rates_by(over_lines_, rim_rates);
}

Points Carry::at(const Points& rim_moves, double fraction) const {
  Points moves(reference_.size(), Vec3::Zero());
  for (std::size_t v = 0; v < reference_.size(); ++v) {
    if (given_[v] != 0) {
      moves[v] = rim_moves[v] * fraction;
    }
  }
  apply(films_, moves);
  apply(caps_, moves);
  apply(wetted_, moves);
  Points result = reference_;
  for (std::size_t v = 0; v < reference_.size(); ++v) {
    result[v] += moves[v];
  }
  return result;
}

/// Where wetted faces go by weights alone.
Points Carry::by_weights(const Points& points) const {
  Points moves(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    moves[v] = points[v] - reference_[v];
  }
  for (const int v : wetted_.vertices) {
    moves[v].setZero();
  }
  apply(wetted_, moves);
  for (std::size_t v = 0; v < points.size(); ++v) {
    moves[v] += reference_[v];
  }
  return moves;
}

void Carry::follow_rates(const Points& points, Points& rates) const {
  if (slides_) {
    for (const int v : wetted_.vertices) {
      rates[v].setZero();
    }
    apply(wetted_, rates);
    const Points flat = on_bent_.empty() ? Points() : by_weights(points);
    for (const auto& [v, wall] : on_bent_) {
      rates[v] = films::onto_wall_jet(wall, flat[v]).slope * rates[v];
    }
  }
}

void Carry::follow(Points& points) const {
  if (slides_) {
    const Points flat = by_weights(points);
    for (const int v : wetted_.vertices) {
      points[v] = flat[v];
    }
    for (const auto& [v, wall] : on_bent_) {
      points[v] = films::onto_wall(wall, flat[v]);
      if (!points[v].allFinite()) {
        throw MeshError(fmt::format(
            "the wetted face cannot follow its film at ({:.6g}, {:.6g}, "
            "{:.6g}): its wall has no nearest point there; take another volume "
            "or contact angle, or shorter edges",
            flat[v].x(), flat[v].y(), flat[v].z()));
      }
    }
  }
}

void Carry::fold_caps(const Points& points, Points& by_points) const {
  if (slides_ && !by_points.empty()) {
    const Points flat = on_bent_.empty() ? Points() : by_weights(points);
    for (const auto& [v, wall] : on_bent_) {
      by_points[v] =
          films::onto_wall_jet(wall, flat[v]).slope.transpose() * by_points[v];
    }
    const Points by_caps = by_points;
    add_transposed(wetted_, by_caps, by_points);
    for (const int v : wetted_.vertices) {
      by_points[v].setZero();
    }
  }
}

}  // namespace meniscus::frozen
