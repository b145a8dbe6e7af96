#include "fea/loads/remote_gradient.h"

#include <Eigen/Geometry>

#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/remote_load.h"

namespace meniscus::loads {

namespace {

/// With weights w about their centre c, d = x - c, A = sum w, I the second
/// moment and m = M + (p - c) x F:
///   v . f = F . mean(v) + t . L,  t = I^-1 m,  L = sum w d x v.
struct RemoteParts {
  SurfaceWeights w;
  RemoteMoments moments;
  Vec3 mean;  // of v
  Vec3 t;     // what the moment turns by
  Vec3 s;     // I^-1 L: what v turns by
};

Vec3 at(const VectorX& v, int node) { return v.segment<3>(3L * node); }

/// Through the weights, each the integral of a shape function.
void pull_back_weights(const TetMesh& mesh, const RemoteLoad& load,
                       const VectorX& by_weight, Points& gradient) {
  for (const std::string& surface : load.surfaces) {
    element::pull_back_faces(
        mesh, element::surface_label(mesh, surface), element::FaceRule::Three,
        [&](int f,
            const element::FacePoint& point) -> element::FacePointGradient {
          double sum = 0.0;
          const auto ids = mesh.face(f);
          for (std::size_t a = 0; a < ids.size(); ++a) {
            sum += point.shape[a] * by_weight[ids[a]];
          }
          return {.by_normal = sum * point.normal.normalized()};
        },
        gradient);
  }
}

void add_gradient(const TetMesh& mesh, const RemoteLoad& load,
                  const RemoteParts& parts, const VectorX& v,
                  Points& gradient) {
  const auto& [w, moments, mean, t, s] = parts;
  const Vec3 by_centre = -load.force.cross(s) - moments.area * mean.cross(t);
  VectorX by_weight =
      VectorX::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    const int node = w.nodes[k];
    const Vec3 d = mesh.nodes[node] - moments.centre;
    const Vec3 u = at(v, node);
    const double sd = s.dot(d);
    const double td = t.dot(d);
    by_weight[node] =
        ((u - mean).dot(load.force) + by_centre.dot(d)) / moments.area +
        t.dot(d.cross(u)) - d.squaredNorm() * s.dot(t) + sd * td;
    gradient[node] += w.weights[static_cast<Eigen::Index>(k)] *
                      (u.cross(t) - 2.0 * s.dot(t) * d + td * s + sd * t +
                       by_centre / moments.area);
  }
  pull_back_weights(mesh, load, by_weight, gradient);
}

}  // namespace

RemoteGradient remote_gradient(const TetMesh& mesh, const RemoteLoad& load,
                               const VectorX& v, Points* gradient) {
  RemoteParts parts;
  parts.w = surface_weights(mesh, load.surfaces);
  parts.moments = remote_moments(mesh, parts.w, load.surfaces);
  const RemoteMoments& moments = parts.moments;
  parts.mean.setZero();
  Vec3 L = Vec3::Zero();
  for (std::size_t k = 0; k < parts.w.nodes.size(); ++k) {
    const int node = parts.w.nodes[k];
    const double w = parts.w.weights[static_cast<Eigen::Index>(k)];
    const Vec3 d = mesh.nodes[node] - moments.centre;
    parts.mean += w / moments.area * at(v, node);
    L += w * d.cross(at(v, node));
  }
  const Vec3 arm = load.point - moments.centre;
  parts.t = moments.inverse * (load.moment + arm.cross(load.force));
  parts.s = moments.inverse * L;
  if (gradient != nullptr) {
    add_gradient(mesh, load, parts, v, *gradient);
  }
  return {.value = load.force.dot(parts.mean) + parts.t.dot(L),
          .by_point = load.force.cross(parts.s),
          .by_force = parts.mean + parts.s.cross(arm),
          .by_moment = parts.s};
}

}  // namespace meniscus::loads
