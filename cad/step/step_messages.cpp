#include "cad/step/step_messages.h"

#include <algorithm>

namespace meniscus::step {

FrameWriter question(StepQuestion kind) {
  FrameWriter out;
  out.put(kind);
  return out;
}

void refuse_message() {
  throw IoError(
      "the helper meniscus-step answers what makes no shape; install "
      "program and helper from one build");
}

void put_mesh(FrameWriter& out, const SurfaceMesh& mesh) {
  out.put_array(mesh.points);
  out.put_array(mesh.facets);
  out.put_array(mesh.facet_label);
  out.put(static_cast<std::uint64_t>(mesh.labels.size()));
  for (const std::string& label : mesh.labels) {
    out.put_text(label);
  }
}

SurfaceMesh get_mesh(FrameReader& in) {
  SurfaceMesh mesh;
  mesh.points = in.get_array<Vec3>();
  mesh.facets = in.get_array<Triangle>();
  mesh.facet_label = in.get_array<int>();
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    mesh.labels.push_back(in.get_text());
  }
  const auto below = [](int k, std::size_t count) {
    return k >= 0 && static_cast<std::size_t>(k) < count;
  };
  if (mesh.facet_label.size() != mesh.facets.size() ||
      !std::all_of(mesh.facets.begin(), mesh.facets.end(),
                   [&](const Triangle& facet) {
                     return std::all_of(facet.begin(), facet.end(), [&](int v) {
                       return below(v, mesh.points.size());
                     });
                   }) ||
      !std::all_of(mesh.facet_label.begin(), mesh.facet_label.end(),
                   [&](int k) { return below(k, mesh.labels.size()); })) {
    refuse_message();
  }
  return mesh;
}

void put_loop(FrameWriter& out, const StepLoop& loop) {
  Points whole;
  if (loop.whole) {
    whole = {loop.whole->center, loop.whole->u, loop.whole->v};
  }
  out.put_array(whole);
  out.put(static_cast<std::uint64_t>(loop.pieces.size()));
  for (const StepPiece& piece : loop.pieces) {
    out.put(static_cast<std::int32_t>(piece.kind));
    out.put(static_cast<std::int32_t>(piece.edge));
    out.put(piece.length);
    out.put_array(Points{piece.leaves, piece.arrives});
    out.put_array(piece.samples);
  }
}

StepLoop get_loop(FrameReader& in) {
  StepLoop loop;
  if (const Points whole = in.get_array<Vec3>(); whole.size() == 3) {
    loop.whole = solid::EllipseCurve{whole[0], whole[1], whole[2]};
  }
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    StepPiece piece;
    piece.kind = static_cast<StepPiece::Kind>(in.get<std::int32_t>());
    piece.edge = in.get<std::int32_t>();
    piece.length = in.get<double>();
    const Points ends = in.get_array<Vec3>();
    piece.samples = in.get_array<Vec3>();
    if (ends.size() != 2 || piece.samples.size() != StepPiece::kIntervals + 1) {
      refuse_message();
    }
    piece.leaves = ends[0];
    piece.arrives = ends[1];
    loop.pieces.push_back(std::move(piece));
  }
  return loop;
}

void put_report(FrameWriter& out, const StepReport& report) {
  out.put(static_cast<std::int32_t>(report.shells));
  out.put(report.volume);
  out.put_array(Points{report.mass_center});
  out.put(report.tolerance);
}

StepReport get_report(FrameReader& in) {
  StepReport report;
  report.shells = in.get<std::int32_t>();
  report.volume = in.get<double>();
  const Points center = in.get_array<Vec3>();
  report.tolerance = in.get<double>();
  if (center.size() != 1) {
    refuse_message();
  }
  report.mass_center = center[0];
  return report;
}

}  // namespace meniscus::step
