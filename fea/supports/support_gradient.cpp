#include "fea/supports/support_gradient.h"

#include <algorithm>
#include <array>

#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/supports/springs.h"
#include "fea/supports/supports.h"

namespace meniscus::supports {

namespace {

/// The derivative by held directions: one vector per direction of each support
/// and node that counts.
struct ByDirection {
  int support;
  int node;
  Vec3 derivative;
};

Vec3 at_node(const VectorX& v, int node) { return v.segment<3>(3L * node); }

/// With directions D at a node, Q = D D^+:
///   lambda . dQ r + r' . dQ u = lambda . dD D^+ r + u . dD D^+ r',
/// lambda across all of D, and D^T u kept at what is enforced.
std::vector<ByDirection> by_directions(const TetMesh& mesh,
                                       const loads::LoadCase& load_case,
                                       const loads::AdjointPair& pair) {
  const SpringBlocks springs = spring_blocks(mesh, load_case, mesh.order);
  const VectorX r =
      reactions_of_supports(pair.reactions, springs, pair.displacement);
  const VectorX adjoint_r =
      reactions_of_supports(pair.adjoint_reactions, springs, pair.lambda);
  std::vector<ByDirection> result;
  over_held_nodes(held_directions(mesh, load_case),
                  [&](const HeldDirection* first, const HeldDirection*,
                      const HeldSpan& span) {
                    const Vec3 u = at_node(pair.displacement, first->node);
                    if (span.rank == 3 && u.isZero(0.0)) {
                      return;  // held fast, however the directions turn
                    }
                    const std::array<Vec3, 3> dual =
                        dual_directions(first, span);
                    for (int k = 0; k < span.rank; ++k) {
                      const HeldDirection& held = first[span.index[k]];
                      result.push_back(
                          {held.support, held.node,
                           dual[k].dot(at_node(r, held.node)) *
                                   at_node(pair.lambda, held.node) +
                               dual[k].dot(at_node(adjoint_r, held.node)) * u});
                    }
                  });
  return result;
}

/// Through the mean normal of a plane: its area vectors' sum made unit.
void pull_back_plane(const TetMesh& mesh, int label, const Vec3& by_normal,
                     Points& gradient) {
  Vec3 sum = Vec3::Zero();
  element::over_face_points(
      mesh, label, element::FaceRule::Three,
      [&](int, const element::FacePoint& point) { sum += point.normal; });
  const Vec3 n = sum.normalized();
  const element::FacePointGradient each{
      .by_normal = (by_normal - n.dot(by_normal) * n) / sum.norm()};
  element::pull_back_faces(
      mesh, label, element::FaceRule::Three,
      [&](int, const element::FacePoint&) { return each; }, gradient);
}

/// Through the normals at nodes: each its faces' area vectors' sum made unit.
/// `by_normal`: 3 per node of the mesh.
void pull_back_normals(const TetMesh& mesh, int label, const VectorX& by_normal,
                       Points& gradient) {
  const element::FaceQuadrature quadrature(mesh.order,
                                           element::FaceRule::Nodes);
  VectorX sums = VectorX::Zero(by_normal.size());
  const auto over_nodes = [&](const auto& visit) {
    for (int f = 0; f < mesh.face_count(); ++f) {
      if (mesh.face_label[f] == label) {
        const auto ids = mesh.face(f);
        for (std::size_t a = 0; a < ids.size(); ++a) {
          visit(f, static_cast<int>(a), 3L * ids[a]);
        }
      }
    }
  };
  over_nodes([&](int f, int a, Eigen::Index at) {
    sums.segment<3>(at) += quadrature.at(mesh, f, a).normal;
  });
  over_nodes([&](int f, int a, Eigen::Index at) {
    const Vec3 sum = sums.segment<3>(at);
    const Vec3 n = sum.normalized();
    const Vec3 g = by_normal.segment<3>(at);
    quadrature.pull_back(mesh, f, a, Vec3::Zero(),
                         (g - n.dot(g) * n) / sum.norm(), gradient);
  });
}

}  // namespace

void add_support_gradient(const TetMesh& mesh, const loads::LoadCase& load_case,
                          const loads::AdjointPair& pair, Points& gradient) {
  const auto turns = [](const loads::Support& support) {
    return support.kind != loads::SupportKind::Components;
  };
  const std::vector<loads::Support>& supports = load_case.supports;
  if (std::none_of(supports.begin(), supports.end(), turns)) {
    return;
  }
  const std::vector<ByDirection> all = by_directions(mesh, load_case, pair);
  for (std::size_t s = 0; s < supports.size(); ++s) {
    if (!turns(supports[s])) {
      continue;
    }
    const int label = element::surface_label(mesh, supports[s].surface);
    VectorX by_normal = VectorX::Zero(pair.lambda.size());
    Vec3 sum = Vec3::Zero();
    for (const ByDirection& direction : all) {
      if (direction.support == static_cast<int>(s)) {
        by_normal.segment<3>(3L * direction.node) += direction.derivative;
        sum += direction.derivative;
      }
    }
    if (supports[s].kind == loads::SupportKind::Symmetry) {
      pull_back_plane(mesh, label, sum, gradient);
    } else {
      pull_back_normals(mesh, label, by_normal, gradient);
    }
  }
}

}  // namespace meniscus::supports
