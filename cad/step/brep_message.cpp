#include "cad/step/brep_message.h"

#include <algorithm>
#include <concepts>
#include <type_traits>
#include <utility>

#include "cad/step/step_messages.h"

namespace meniscus::step {

namespace {

// What each part of a Brep consists of, one list for both ways: `at` puts the
// values into a message, or takes them out of it.

template <class Given, class Type>
concept Of = std::same_as<std::remove_const_t<Given>, Type>;

void fields(auto& at, Of<solid::StraightLine> auto& line) {
  at(line.start, line.direction);
}
void fields(auto& at, Of<solid::EllipseCurve> auto& arc) {
  at(arc.center, arc.u, arc.v);
}
void fields(auto& at, Of<solid::SplineCurve> auto& spline) {
  at(spline.knots, spline.poles);
}
void fields(auto& at, Of<solid::BrepEdge> auto& edge) {
  at(edge.from, edge.to, edge.curve, edge.first, edge.last, edge.gap);
}
void fields(auto& at, Of<solid::PlaneSurface> auto& plane) {
  at(plane.point, plane.normal);
}
void fields(auto& at, Of<solid::CylinderSurface> auto& tube) {
  at(tube.center, tube.axis, tube.zero, tube.radius, tube.inward);
}
void fields(auto& at, Of<solid::ConeSurface> auto& cone) {
  at(cone.center, cone.axis, cone.zero, cone.radius, cone.angle, cone.inward);
}
void fields(auto& at, Of<solid::SphereSurface> auto& ball) {
  at(ball.center, ball.axis, ball.zero, ball.radius, ball.inward);
}
void fields(auto& at, Of<solid::SplineSurface> auto& spline) {
  at(spline.knots_a, spline.knots_b, spline.poles);
}
void fields(auto& at, Of<solid::BrepUse> auto& use) {
  at(use.edge, use.forward, use.at_first, use.at_last);
}
void fields(auto& at, Of<solid::BrepFace> auto& face) {
  at(face.name, face.surface, face.loops);
}
void fields(auto& at, Of<solid::ExactFaces> auto& exact) {
  at(exact.shape, exact.faces, exact.names);
}
void fields(auto& at, Of<solid::Brep> auto& brep) {
  at(brep.vertices, brep.edges, brep.faces, brep.exact);
}

class Put {
 public:
  explicit Put(FrameWriter& out) : out_(out) {}

  template <class... Values>
  void operator()(const Values&... values) {
    (one(values), ...);
  }

 private:
  template <class Value>
  void one(const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      out_.put(value);
    } else {
      fields(*this, value);
    }
  }
  template <int Size>
  void one(const Eigen::Matrix<double, Size, 1>& v) {
    for (const double x : v) {
      out_.put(x);
    }
  }
  void one(const std::string& text) { out_.put_text(text); }
  void one(const ExactShape& shape) { out_.put_text(exact_shape_text(shape)); }
  template <class Value>
  void one(const std::vector<Value>& values) {
    out_.put(static_cast<std::uint64_t>(values.size()));
    for (const Value& value : values) {
      one(value);
    }
  }
  template <class... Kinds>
  void one(const std::variant<Kinds...>& value) {
    out_.put(static_cast<std::int32_t>(value.index()));
    std::visit([this](const auto& kind) { one(kind); }, value);
  }

  FrameWriter& out_;
};

class Get {
 public:
  explicit Get(FrameReader& in) : in_(in) {}

  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

 private:
  template <class Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      value = in_.get<Value>();
    } else {
      fields(*this, value);
    }
  }
  template <int Size>
  void one(Eigen::Matrix<double, Size, 1>& v) {
    for (double& x : v) {
      x = in_.get<double>();
    }
  }
  void one(std::string& text) { text = in_.get_text(); }
  void one(ExactShape& shape) { shape = read_exact_shape_text(in_.get_text()); }
  template <class Value>
  void one(std::vector<Value>& values) {
    for (auto left = in_.get<std::uint64_t>(); left > 0; --left) {
      one(values.emplace_back());
    }
  }
  template <class... Kinds>
  void one(std::variant<Kinds...>& value) {
    const auto index = in_.get<std::int32_t>();
    std::int32_t k = 0;
    const bool known =
        ((k++ == index && (one(value.template emplace<Kinds>()), true)) || ...);
    if (!known) {
      refuse_message();
    }
  }

  FrameReader& in_;
};

bool is_below(int k, std::size_t count) {
  return k >= 0 && static_cast<std::size_t>(k) < count;
}

void require_within(const solid::Brep& brep) {
  bool within = true;
  for (const solid::BrepEdge& edge : brep.edges) {
    within = within && is_below(edge.from, brep.vertices.size()) &&
             is_below(edge.to, brep.vertices.size());
  }
  for (const solid::BrepFace& face : brep.faces) {
    for (const std::vector<solid::BrepUse>& loop : face.loops) {
      for (const solid::BrepUse& use : loop) {
        within = within && (use.edge == solid::kPole ||
                            is_below(use.edge, brep.edges.size()));
      }
    }
  }
  for (const solid::ExactFaces& exact : brep.exact) {
    within = within && exact.faces.size() == exact.names.size();
    for (const int f : exact.faces) {
      within = within && is_below(f, exact.shape.faces.size());
    }
  }
  if (!within) {
    refuse_message();
  }
}

}  // namespace

void put_brep(FrameWriter& out, const solid::Brep& brep) { Put{out}(brep); }

solid::Brep get_brep(FrameReader& in) {
  solid::Brep brep;
  Get{in}(brep);
  require_within(brep);
  return brep;
}

}  // namespace meniscus::step
