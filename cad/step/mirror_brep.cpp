#include "cad/step/mirror_brep.h"

#include <algorithm>
#include <type_traits>

namespace meniscus::step {

namespace {

/// Images of points, directions, curves and surfaces. Where those of a surface
/// turn the other way, its second parameter does (of splines both change
/// places), so that what pointed out still does.
class BrepMirror {
 public:
  explicit BrepMirror(const MirrorPlane& plane) : plane_(plane) {}

  Vec3 point(const Vec3& p) const {
    return p - 2.0 * plane_.normal.dot(p - plane_.at) * plane_.normal;
  }
  Vec3 direction(const Vec3& d) const {
    return d - 2.0 * plane_.normal.dot(d) * plane_.normal;
  }

  solid::EdgeCurve curve(solid::EdgeCurve curve) const {
    if (auto* line = std::get_if<solid::StraightLine>(&curve)) {
      line->start = point(line->start);
      line->direction = direction(line->direction);
    } else if (auto* arc = std::get_if<solid::EllipseCurve>(&curve)) {
      arc->center = point(arc->center);
      arc->u = direction(arc->u);
      arc->v = direction(arc->v);
    } else {
      for (Vec3& pole : std::get<solid::SplineCurve>(curve).poles) {
        pole = point(pole);
      }
    }
    return curve;
  }

  solid::PlaneSurface surface(const solid::PlaneSurface& plane) const {
    return {point(plane.point), direction(plane.normal)};
  }
  solid::SplineSurface surface(const solid::SplineSurface& spline) const {
    solid::SplineSurface image{spline.knots_b, spline.knots_a, {}};
    const std::size_t rows = spline.knots_a.size() - 4;
    const std::size_t columns = spline.knots_b.size() - 4;
    for (std::size_t j = 0; j < columns; ++j) {
      for (std::size_t i = 0; i < rows; ++i) {
        image.poles.push_back(point(spline.poles[i * columns + j]));
      }
    }
    return image;
  }
  template <class Turned>
  Turned surface(Turned turned) const {
    turned.center = point(turned.center);
    turned.axis = -direction(turned.axis);
    turned.zero = direction(turned.zero);
    if constexpr (std::is_same_v<Turned, solid::ConeSurface>) {
      turned.angle = -turned.angle;
    }
    return turned;
  }

 private:
  const MirrorPlane& plane_;
};

bool is_spline(const solid::BrepFace& face) {
  return std::holds_alternative<solid::SplineSurface>(face.surface);
}

/// The same use, run the other way, where `edge` of the image is.
solid::BrepUse image_of(const solid::BrepUse& use, int edge, bool of_spline) {
  const auto place = [of_spline](const solid::Vec2& at) {
    return of_spline ? solid::Vec2(at[1], at[0]) : solid::Vec2(at[0], -at[1]);
  };
  solid::BrepUse image{edge, !use.forward, place(use.at_first),
                       place(use.at_last)};
  if (use.edge == solid::kPole) {
    std::swap(image.at_first, image.at_last);
    image.forward = use.forward;
  }
  return image;
}

/// Those within faces that were left out.
void drop_unused_edges(solid::Brep& brep) {
  std::vector<int> number(brep.edges.size(), -1);
  const auto each_use = [&](const auto& visit) {
    for (solid::BrepFace& face : brep.faces) {
      for (std::vector<solid::BrepUse>& loop : face.loops) {
        for (solid::BrepUse& use : loop) {
          if (use.edge != solid::kPole) {
            visit(use);
          }
        }
      }
    }
  };
  each_use([&](const solid::BrepUse& use) { number[use.edge] = 0; });
  std::vector<solid::BrepEdge> kept;
  for (std::size_t e = 0; e < number.size(); ++e) {
    if (number[e] == 0) {
      number[e] = static_cast<int>(kept.size());
      kept.push_back(std::move(brep.edges[e]));
    }
  }
  brep.edges = std::move(kept);
  each_use([&](solid::BrepUse& use) { use.edge = number[use.edge]; });
}

}  // namespace

solid::Brep with_mirror_image(
    const solid::Brep& brep, const MirrorPlane& plane,
    const std::function<std::string(const std::string&)>& image_name) {
  const BrepMirror mirror(plane);
  const auto is_cut = [&](const solid::BrepFace& face) {
    return std::find(plane.cuts.begin(), plane.cuts.end(), face.name) !=
           plane.cuts.end();
  };
  solid::Brep whole = brep;
  std::vector<int> vertex_image(brep.vertices.size(), -1);
  std::vector<int> edge_image(brep.edges.size(), -1);
  for (const solid::BrepFace& face : brep.faces) {
    for (std::size_t l = 0; is_cut(face) && l < face.loops.size(); ++l) {
      for (const solid::BrepUse& use : face.loops[l]) {
        const solid::BrepEdge& edge = brep.edges[use.edge];
        edge_image[use.edge] = use.edge;
        vertex_image[edge.from] = edge.from;
        vertex_image[edge.to] = edge.to;
      }
    }
  }
  for (std::size_t v = 0; v < vertex_image.size(); ++v) {
    if (vertex_image[v] < 0) {
      vertex_image[v] = static_cast<int>(whole.vertices.size());
      whole.vertices.push_back(mirror.point(brep.vertices[v]));
    }
  }
  for (std::size_t e = 0; e < edge_image.size(); ++e) {
    if (edge_image[e] < 0) {
      edge_image[e] = static_cast<int>(whole.edges.size());
      solid::BrepEdge image = brep.edges[e];
      image.from = vertex_image[image.from];
      image.to = vertex_image[image.to];
      image.curve = mirror.curve(image.curve);
      whole.edges.push_back(std::move(image));
    }
  }
  std::erase_if(whole.faces, is_cut);
  for (const solid::BrepFace& face : brep.faces) {
    if (is_cut(face)) {
      continue;
    }
    solid::BrepFace image{image_name(face.name), {}, {}};
    std::visit([&](const auto& s) { image.surface = mirror.surface(s); },
               face.surface);
    for (const std::vector<solid::BrepUse>& loop : face.loops) {
      std::vector<solid::BrepUse>& back = image.loops.emplace_back();
      for (std::size_t k = loop.size(); k-- > 0;) {
        const int edge = loop[k].edge;
        back.push_back(image_of(
            loop[k], edge == solid::kPole ? solid::kPole : edge_image[edge],
            is_spline(face)));
      }
    }
    whole.faces.push_back(std::move(image));
  }
  drop_unused_edges(whole);
  return whole;
}

}  // namespace meniscus::step
