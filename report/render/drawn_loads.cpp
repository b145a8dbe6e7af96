#include "report/render/drawn_loads.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "report/render/render_data.h"
#include "report/render/shaded_surface.h"
#include "report/render/surface_patch.h"

namespace meniscus::render {

namespace {

// x the part's diagonal:
constexpr double kArrowLength = 0.17;  // of the largest force
constexpr double kSmallArrow = 0.055;  // of pressures and tractions
constexpr double kArrowGap = 0.008;
constexpr double kTurnRadius = 0.065;  // of a moment's arrow
constexpr double kLine = 0.0022;       // to surfaces that share a load
constexpr double kBlockDepth = 0.035;  // of a support
constexpr double kCoatDepth = 0.014;
constexpr Colour kLoadColour = {0.80, 0.18, 0.22};
constexpr Colour kGroundColour = {0.42, 0.45, 0.50};

/// The facets of one surface and the edges around it, by the mesh's points.
struct HeldSurface {
  std::vector<Triangle> facets;
  std::set<Edge> rim;
  std::map<int, Vec3> normals;  // unit, out of the part
};

HeldSurface held_surface(const SurfaceMesh& mesh, const SurfacePatch& patch) {
  HeldSurface held;
  SurfaceMesh only;
  only.labels = {"surface"};
  for (const int f : patch.facets) {
    const Triangle& facet = mesh.facets[static_cast<std::size_t>(f)];
    only.facets.push_back(facet);
    only.facet_label.push_back(0);
    for (const int id : facet) {
      held.normals.try_emplace(id, Vec3::Zero()).first->second +=
          area_vector2(mesh, f);
    }
  }
  for (auto& [id, normal] : held.normals) {
    normal = patch.is_round() || patch.flatness < 0.97 ? normal.normalized()
                                                       : patch.normal;
  }
  const std::vector<Edge> edges = rim_edges(only);
  held.rim.insert(edges.begin(), edges.end());
  held.facets = std::move(only.facets);
  return held;
}

/// A block on which a flat surface stands, a little wider than it; a coat on a
/// surface that is curved, thin enough for a bore.
SurfaceMesh support_block(const SurfaceMesh& mesh, const SurfacePatch& patch,
                          double diagonal) {
  constexpr double kWider = 1.14;
  const bool flat = patch.flatness >= 0.97;
  const double wider = flat ? kWider : 1.0;
  const double gap = 0.001 * diagonal;
  double depth = (flat ? kBlockDepth : kCoatDepth) * diagonal;
  if (patch.is_round()) {
    depth = std::min(depth, 0.25 * patch.radius);
  }
  const HeldSurface held = held_surface(mesh, patch);
  SurfaceMesh block;
  block.labels = {"bottom", "top", "wall"};
  std::map<int, int> number;
  for (const auto& [id, normal] : held.normals) {
    number.emplace(id, static_cast<int>(number.size()));
    const Vec3& p = mesh.points[static_cast<std::size_t>(id)];
    block.points.push_back(patch.centre + wider * (p - patch.centre) +
                           gap * normal);
  }
  const int count = static_cast<int>(number.size());
  for (const auto& [id, normal] : held.normals) {
    const Vec3& p = mesh.points[static_cast<std::size_t>(id)];
    block.points.push_back(patch.centre + wider * (p - patch.centre) +
                           depth * normal);
  }
  const auto add = [&](int a, int b, int c, int which) {
    block.facets.push_back({a, b, c});
    block.facet_label.push_back(which);
  };
  for (const Triangle& facet : held.facets) {
    const int a = number[facet[0]];
    const int b = number[facet[1]];
    const int c = number[facet[2]];
    add(a + count, b + count, c + count, 0);
    add(a, c, b, 1);
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = facet[k];
      const int to = facet[(k + 1) % 3];
      if (held.rim.count(edge_key(from, to)) != 0) {
        add(number[from], number[to], number[to] + count, 2);
        add(number[from], number[to] + count, number[from] + count, 2);
      }
    }
  }
  return block;
}

/// For a label, wherever it finds its place.
void make_room(Panel& panel, const Vec3& at, const Vec3& away,
               const Vec3& to_eye, double diagonal) {
  const Vec3 aside = Vec3::UnitZ().cross(to_eye).normalized();
  const Vec3 middle = at + 3.0 * kArrowGap * diagonal * away;
  const Vec3 half(0, 0, 0.045 * diagonal);
  panel.show({middle + half, middle - half, middle + 0.05 * diagonal * aside,
              middle - 0.05 * diagonal * aside});
}

/// What a job's loads are drawn by.
class LoadDrawing {
 public:
  LoadDrawing(Panel& panel, const picture::PictureJob& job,
              const SurfaceMesh& mesh, double diagonal, int text)
      : panel_(panel),
        mesh_(mesh),
        diagonal_(diagonal),
        gap_(kArrowGap * diagonal),
        to_eye_(job.view.normalized()),
        load_count_(std::max<std::size_t>(job.loads.size(), 1)),
        text_{.size = text, .colour = kLoadColour, .bold = true} {
    for (const picture::PictureLoad& load : job.loads) {
      double& most = largest_[load.kind];
      most = std::max(most, load.direction.norm());
    }
  }

  void draw(const picture::PictureLoad& load) {
    using Kind = picture::PictureLoadKind;
    if (load.direction.norm() == 0.0) {
      return;
    }
    if (load.kind == Kind::Body) {
      draw_beside(load);
      return;
    }
    std::vector<SurfacePatch> patches;
    for (const std::string& surface : load.surfaces) {
      SurfacePatch patch = surface_patch(mesh_, surface);
      if (patch.found()) {
        patches.push_back(std::move(patch));
      }
    }
    const bool spread =
        load.kind == Kind::Pressure || load.kind == Kind::Traction;
    if (!spread && patches.size() > 1) {
      draw_shared(load, patches);
      return;
    }
    for (const SurfacePatch& patch : patches) {
      if (load.kind == Kind::Force) {
        draw_force(load, patch);
      } else if (load.kind == Kind::Moment) {
        draw_moment(load, anchor_of(patch, to_eye_));
      } else {
        draw_spread(load, patch);
      }
    }
  }

 private:
  /// Small loads stay visible: an arrow is at least half the largest.
  double share(const picture::PictureLoad& load) const {
    return 0.5 + 0.5 * load.direction.norm() / largest_.at(load.kind);
  }

  void label(const Vec3& at, const Vec3& away, const std::string& text) {
    if (!text.empty()) {
      panel_.add_label(at, away, text, text_);
      make_room(panel_, at, away, to_eye_, diagonal_);
    }
  }

  void draw_force(const picture::PictureLoad& load, const SurfacePatch& patch) {
    const Vec3 along = load.direction.normalized();
    const Anchor anchor = anchor_of(patch, to_eye_);
    draw_arrow(load, anchor.at,
               place_arrow(mesh_, anchor, along,
                           kArrowLength * diagonal_ * share(load), gap_));
  }

  /// What several surfaces carry together.
  void draw_shared(const picture::PictureLoad& load,
                   const std::vector<SurfacePatch>& patches) {
    Vec3 middle = Vec3::Zero();
    for (const SurfacePatch& patch : patches) {
      middle += patch.centre / static_cast<double>(patches.size());
    }
    const Vec3 at = load.point.value_or(middle);
    Points ends = {at};
    std::vector<Edge> lines;
    for (const SurfacePatch& patch : patches) {
      lines.push_back({0, static_cast<int>(ends.size())});
      ends.push_back(patch.centre);
    }
    if (load.kind == picture::PictureLoadKind::Moment) {
      draw_moment(load, {at, Vec3::Zero()});
    } else {
      const ArrowPlace arrow =
          place_free_arrow(mesh_, at, load.direction.normalized(), to_eye_,
                           kArrowLength * diagonal_ * share(load), gap_);
      draw_arrow(load, at, arrow);
      lines.push_back({0, static_cast<int>(ends.size())});
      ends.push_back(arrow.tail);
    }
    panel_.add_tubes(ends, lines, kLine * diagonal_, kLoadColour);
    panel_.show(ends);
  }

  /// `at`: where it acts; the label is at the arrow's other end.
  void draw_arrow(const picture::PictureLoad& load, const Vec3& at,
                  const ArrowPlace& arrow) {
    const Vec3 along = load.direction.normalized();
    panel_.add_arrow(arrow.tail, arrow.tip, kLoadColour);
    const bool ends_there = (arrow.tip - at).norm() < (arrow.tail - at).norm();
    label(ends_there ? arrow.tail : arrow.tip,
          ends_there ? Vec3(-along) : along, load.label);
  }

  /// Three quarters of a turn about the axis, right-handed.
  void draw_moment(const picture::PictureLoad& load, const Anchor& anchor) {
    constexpr int kSteps = 48;
    constexpr double kTurn = 1.5 * EIGEN_PI;
    const Vec3 axis = load.direction.normalized();
    const double radius = kTurnRadius * diagonal_ * share(load);
    // Outside the part even where it stands upright.
    const double upright = axis.cross(anchor.out).norm();
    const Vec3 centre =
        anchor.at + (2.0 * gap_ + 1.1 * radius * upright) * anchor.out;
    const Vec3 u = axis.unitOrthogonal();
    const Vec3 v = axis.cross(u);
    Points points;
    std::vector<Edge> edges;
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = kTurn * k / kSteps;
      points.push_back(centre +
                       radius * (std::cos(angle) * u + std::sin(angle) * v));
      if (k > 0) {
        edges.push_back({k - 1, k});
      }
    }
    const double thick = 0.0055 * diagonal_;
    panel_.add_tubes(points, edges, thick, kLoadColour);
    // The axis, so that the sense can be read.
    panel_.add_tubes(
        {centre - 0.6 * radius * axis, centre + 0.6 * radius * axis}, {{0, 1}},
        0.3 * thick, kLoadColour);
    const Vec3 ahead =
        (-std::sin(kTurn) * u + std::cos(kTurn) * v).normalized();
    panel_.add_cone(points.back(), points.back() + 5.0 * thick * ahead,
                    2.6 * thick, kLoadColour);
    panel_.show(points);
    label(centre + radius * u, u, load.label);
  }

  void draw_spread(const picture::PictureLoad& load,
                   const SurfacePatch& patch) {
    // Windows of a barrel: a few arrows each, and not each a label.
    constexpr std::size_t kMost = 48;
    constexpr std::size_t kMostOfAll = 480;
    constexpr int kMostAlike = 3;
    const std::size_t most =
        std::clamp<std::size_t>(kMostOfAll / load_count_, 1, kMost);
    constexpr double kRoom = 0.45;  // of what is free across a bore
    const double usual = kSmallArrow * diagonal_;
    const bool pressure = load.kind == picture::PictureLoadKind::Pressure;
    double best = -2.0;
    Vec3 label_at = patch.centre;
    Vec3 label_out = patch.normal;
    for (const int f : spread_facets(mesh_, patch, 0.9 * usual, most)) {
      const Vec3 n = area_vector2(mesh_, f).normalized();
      const Vec3 at = facet_middle(mesh_, f) + 0.3 * gap_ * n;
      const Vec3 along = !pressure ? load.direction.normalized()
                         : load.direction.x() > 0.0 ? Vec3(-n)
                                                    : n;
      const bool ends_there = along.dot(n) < 0.0;
      const std::vector<double> hits =
          crossings(mesh_, at, ends_there ? Vec3(-along) : along);
      const double length =
          hits.empty() ? usual : std::min(usual, kRoom * hits.front());
      const Vec3 other = at + (ends_there ? -length : length) * along;
      panel_.add_arrow(ends_there ? other : at, ends_there ? at : other,
                       kLoadColour);
      if (n.dot(to_eye_) > best) {
        best = n.dot(to_eye_);
        label_at = other;
        label_out = n;
      }
    }
    if (++alike_[load.label] <= kMostAlike) {
      label(label_at, label_out, load.label);
    }
  }

  void draw_beside(const picture::PictureLoad& load) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh_.points) {
      box.extend(p);
    }
    const Vec3 aside = Vec3::UnitZ().cross(to_eye_).normalized();
    const double half = 0.5 * box.sizes().dot(aside.cwiseAbs());
    const Vec3 along = load.direction.normalized();
    const double length = kArrowLength * diagonal_;
    const Vec3 middle = box.center() + (half + 0.12 * diagonal_) * aside;
    panel_.add_arrow(middle - 0.5 * length * along,
                     middle + 0.5 * length * along, kLoadColour);
    label(middle + 0.5 * length * along, along, load.label);
  }

  Panel& panel_;
  const SurfaceMesh& mesh_;
  double diagonal_;
  double gap_;
  Vec3 to_eye_;
  std::size_t load_count_;
  TextStyle text_;
  std::map<picture::PictureLoadKind, double> largest_;
  std::map<std::string, int> alike_;  // labels of spread loads, so far
};

}  // namespace

void draw_loads(Panel& panel, const picture::PictureJob& job,
                const SurfaceMesh& mesh, double diagonal, int text) {
  LoadDrawing drawing(panel, job, mesh, diagonal, text);
  for (const picture::PictureLoad& load : job.loads) {
    drawing.draw(load);
  }
}

void draw_supports(Panel& panel, const picture::PictureJob& job,
                   const SurfaceMesh& mesh, double diagonal, int text) {
  for (std::size_t k = 0; k < job.supports.size(); ++k) {
    const SurfacePatch patch = surface_patch(mesh, job.supports[k]);
    if (!patch.found()) {
      continue;
    }
    const SurfaceMesh block = support_block(mesh, patch, diagonal);
    SurfaceStyle style;
    style.colour = kGroundColour;
    const ShadedSurface shaded =
        shade(block, std::vector<char>(block.labels.size(), 1));
    panel.add_surface(shaded.data, style);
    Points seen;
    for (const int id : shaded.source) {
      seen.push_back(block.points[static_cast<std::size_t>(id)]);
    }
    panel.show(seen);
    if (k < job.support_labels.size() && !job.support_labels[k].empty()) {
      const Vec3 to_eye = job.view.normalized();
      const Anchor anchor = anchor_of(patch, to_eye);
      const Vec3 at = anchor.at + kBlockDepth * diagonal * anchor.out;
      panel.add_label(at, anchor.out, job.support_labels[k],
                      {.size = text, .colour = kGroundColour, .bold = true});
      make_room(panel, at, anchor.out, to_eye, diagonal);
    }
  }
}

}  // namespace meniscus::render
