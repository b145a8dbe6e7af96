#include "fea/supports/pins.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "fea/loads/loads.h"
#include "fea/loads/remote_load.h"

namespace meniscus::supports {

namespace {

void check_pin(const loads::RigidPin& pin, const loads::LoadCase& load_case) {
  const auto refuse = [&](const char* what) {
    throw InvalidInput(fmt::format("load case '{}': the rigid pin on '{}' {}",
                                   load_case.name, pin.surfaces.text(), what));
  };
  if (pin.axes && !element::span_a_plane(*pin.axes)) {
    refuse(
        "has axes without length or parallel ones; give two that span a "
        "plane");
  }
  if (!pin.point.allFinite() ||
      !loads::value_of(pin.displacement).allFinite() ||
      !loads::value_of(pin.rotation).allFinite()) {
    refuse("has a point, displacement or rotation that is not finite");
  }
}

PinFrame frame_of(const TetMesh& mesh, const loads::RigidPin& pin,
                  const loads::LoadCase& load_case) {
  PinFrame frame;
  // The weights' check of names and areas; of the nodes the same as a moment's.
  const loads::SurfaceWeights w = loads::surface_weights(mesh, pin.surfaces);
  loads::remote_moments(mesh, w, pin.surfaces);
  frame.nodes = w.nodes;
  check_pin(pin, load_case);
  for (int k = 0; k < 3; ++k) {
    frame.fixed[k] = pin.fix[k];
    frame.fixed[k + 3] = pin.fix_rotation[k];
  }
  if (frame.is_free()) {
    for (const int node : frame.nodes) {
      frame.point += mesh.nodes[node] / static_cast<double>(frame.nodes.size());
    }
    return frame;
  }
  frame.point = pin.point;
  if (pin.axes) {
    frame.axes = element::unit_axes(*pin.axes);
  }
  return frame;
}

}  // namespace

std::vector<PinFrame> pin_frames(const TetMesh& mesh,
                                 const loads::LoadCase& load_case) {
  std::vector<PinFrame> frames;
  std::vector<int> pin_of(load_case.pins.empty() ? 0 : mesh.nodes.size(), -1);
  for (std::size_t p = 0; p < load_case.pins.size(); ++p) {
    const loads::RigidPin& pin = load_case.pins[p];
    frames.push_back(frame_of(mesh, pin, load_case));
    for (const int node : frames.back().nodes) {
      if (pin_of[node] >= 0) {
        const Vec3& x = mesh.nodes[node];
        throw InvalidInput(fmt::format(
            "load case '{}': the rigid pins on '{}' and on '{}' share the node "
            "at ({:.4g}, {:.4g}, {:.4g}); put all these surfaces into one pin",
            load_case.name, load_case.pins[pin_of[node]].surfaces.text(),
            pin.surfaces.text(), x.x(), x.y(), x.z()));
      }
      pin_of[node] = static_cast<int>(p);
    }
  }
  return frames;
}

double pin_value(const loads::RigidPin& pin, int k) {
  return k < 3 ? loads::value_of(pin.displacement)[k]
               : loads::value_of(pin.rotation)[k - 3];
}

PinMotion motion_of(const PinFrame& pin, const Points& x, const VectorX& u) {
  Vec3 centre = Vec3::Zero();
  Vec3 mean = Vec3::Zero();
  const double share = 1.0 / static_cast<double>(pin.nodes.size());
  for (const int node : pin.nodes) {
    centre += share * x[node];
    mean += share * u.segment<3>(3L * node);
  }
  // Least squares: sum d x u = (sum |d|^2 I - d d^T) w, d from the middle.
  Mat3 inertia = Mat3::Zero();
  Vec3 turn = Vec3::Zero();
  for (const int node : pin.nodes) {
    const Vec3 d = x[node] - centre;
    inertia += d.squaredNorm() * Mat3::Identity() - d * d.transpose();
    turn += d.cross(u.segment<3>(3L * node));
  }
  const Vec3 w = solve_lu(inertia, turn);
  return {mean + w.cross(pin.point - centre), w};
}

}  // namespace meniscus::supports
