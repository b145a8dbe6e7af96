#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/geometry/exact_shape.h"
#include "core/json.h"

namespace meniscus {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

Json json_of(const Points& points) {
  Json result = Json::array();
  for (const Vec3& p : points) {
    result.push_back(json_of(p));
  }
  return result;
}

Json json_of(const ExactFrame& f) {
  return json_of(Points{f.origin, f.x, f.y, f.z});
}

struct JsonOfCurve {
  Json operator()(const ExactLine& c) const {
    return {{"line", json_of(Points{c.point, c.direction})}};
  }
  Json operator()(const ExactEllipse& c) const {
    return {{"ellipse", json_of(Points{c.center, c.u, c.v})}};
  }
  Json operator()(const ExactSpline& c) const {
    return {{"spline", c.degree},
            {"knots", c.knots},
            {"poles", json_of(c.poles)},
            {"weights", c.weights}};
  }
};

struct JsonOfSurface {
  Json operator()(const ExactPlane& s) const {
    return {{"plane", json_of(s.frame)}};
  }
  Json operator()(const ExactCylinder& s) const {
    return {{"cylinder", json_of(s.frame)}, {"radius", s.radius}};
  }
  Json operator()(const ExactCone& s) const {
    return {
        {"cone", json_of(s.frame)}, {"radius", s.radius}, {"angle", s.angle}};
  }
  Json operator()(const ExactSphere& s) const {
    return {{"sphere", json_of(s.frame)}, {"radius", s.radius}};
  }
  Json operator()(const ExactTorus& s) const {
    return {
        {"torus", json_of(s.frame)}, {"major", s.major}, {"minor", s.minor}};
  }
  Json operator()(const ExactSplineSurface& s) const {
    return {{"splines", Json{s.degree_a, s.degree_b}},
            {"knots_a", s.knots_a},
            {"knots_b", s.knots_b},
            {"poles", json_of(s.poles)},
            {"weights", s.weights}};
  }
};

Vec3 vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(),
          json.at(2).get<double>()};
}

Points points_of(const Json& json) {
  Points result;
  for (const Json& p : json) {
    result.push_back(vector_of(p));
  }
  return result;
}

ExactFrame frame_of(const Json& json) {
  return {vector_of(json.at(0)), vector_of(json.at(1)), vector_of(json.at(2)),
          vector_of(json.at(3))};
}

void require(bool good, const char* what) {
  if (!good) {
    throw InvalidInput(
        fmt::format("the text of a solid has {}; read it from its STEP file "
                    "anew",
                    what));
  }
}

void check_spline(int degree, const std::vector<double>& knots,
                  std::size_t poles) {
  require(degree >= 1 && poles >= std::size_t(degree) + 1 &&
              knots.size() == poles + std::size_t(degree) + 1 &&
              std::is_sorted(knots.begin(), knots.end()) &&
              knots[std::size_t(degree)] < knots[poles],
          "a spline whose knots and poles do not fit");
}

void check_weights(const std::vector<double>& weights) {
  require(std::all_of(weights.begin(), weights.end(),
                      [](double w) { return w > 0.0; }),
          "a weight that is not above 0");
}

ExactCurve curve_of(const Json& json) {
  if (json.contains("line")) {
    const Points p = points_of(json.at("line"));
    return ExactLine{p.at(0), p.at(1)};
  }
  if (json.contains("ellipse")) {
    const Points p = points_of(json.at("ellipse"));
    return ExactEllipse{p.at(0), p.at(1), p.at(2)};
  }
  ExactSpline spline{json.at("spline").get<int>(),
                     json.at("knots").get<std::vector<double>>(),
                     points_of(json.at("poles")),
                     json.at("weights").get<std::vector<double>>()};
  check_spline(spline.degree, spline.knots, spline.poles.size());
  require(spline.weights.size() == spline.poles.size(), "too few weights");
  check_weights(spline.weights);
  return spline;
}

ExactSurface surface_from(const Json& json) {
  const auto above_zero = [&](const char* key) {
    const auto value = json.at(key).get<double>();
    require(value > 0.0, "a radius that is not above 0");
    return value;
  };
  if (json.contains("plane")) {
    return ExactPlane{frame_of(json.at("plane"))};
  }
  if (json.contains("cylinder")) {
    return ExactCylinder{frame_of(json.at("cylinder")), above_zero("radius")};
  }
  if (json.contains("cone")) {
    return ExactCone{frame_of(json.at("cone")), json.at("radius").get<double>(),
                     json.at("angle").get<double>()};
  }
  if (json.contains("sphere")) {
    return ExactSphere{frame_of(json.at("sphere")), above_zero("radius")};
  }
  if (json.contains("torus")) {
    return ExactTorus{frame_of(json.at("torus")), above_zero("major"),
                      above_zero("minor")};
  }
  ExactSplineSurface s;
  s.degree_a = json.at("splines").at(0).get<int>();
  s.degree_b = json.at("splines").at(1).get<int>();
  s.knots_a = json.at("knots_a").get<std::vector<double>>();
  s.knots_b = json.at("knots_b").get<std::vector<double>>();
  s.poles = points_of(json.at("poles"));
  s.weights = json.at("weights").get<std::vector<double>>();
  const auto count = [](const std::vector<double>& knots, int degree) {
    const auto poles = std::ssize(knots) - degree - 1;
    return poles > 0 ? static_cast<std::size_t>(poles) : std::size_t(0);
  };
  const std::size_t a = count(s.knots_a, s.degree_a);
  const std::size_t b = count(s.knots_b, s.degree_b);
  check_spline(s.degree_a, s.knots_a, a);
  check_spline(s.degree_b, s.knots_b, b);
  require(s.poles.size() == a * b && s.weights.size() == a * b,
          "a surface with too few poles");
  check_weights(s.weights);
  return s;
}

void check(const ExactShape& shape) {
  const auto below = [](int k, std::size_t count) {
    return k >= 0 && static_cast<std::size_t>(k) < count;
  };
  for (const ExactEdge& edge : shape.edges) {
    require(below(edge.from, shape.vertices.size()) &&
                below(edge.to, shape.vertices.size()) && edge.last > edge.first,
            "an edge without ends");
  }
  for (const ExactFace& face : shape.faces) {
    for (const auto& loop : face.loops) {
      for (const ExactUse& use : loop) {
        require(below(use.edge, shape.edges.size()), "a loop without its edge");
      }
    }
  }
}

Json json_of(const ExactShape& shape) {
  Json edges = Json::array();
  for (const ExactEdge& edge : shape.edges) {
    Json& json = edges.emplace_back(std::visit(JsonOfCurve(), edge.curve));
    json["name"] = edge.name;
    json["ends"] = {edge.from, edge.to};
    json["range"] = {edge.first, edge.last};
  }
  Json faces = Json::array();
  for (const ExactFace& face : shape.faces) {
    Json& json = faces.emplace_back(std::visit(JsonOfSurface(), face.surface));
    json["name"] = face.name;
    json["outward"] = face.outward;
    Json loops = Json::array();
    for (const auto& loop : face.loops) {
      Json uses = Json::array();
      for (const ExactUse& use : loop) {
        uses.push_back({{"edge", use.edge},
                        {"forward", use.forward},
                        {"start", {use.start[0], use.start[1]}}});
      }
      loops.push_back(std::move(uses));
    }
    json["loops"] = std::move(loops);
  }
  return {{"vertices", json_of(shape.vertices)},
          {"edges", std::move(edges)},
          {"faces", std::move(faces)}};
}

ExactShape shape_of(const Json& json) {
  ExactShape shape;
  shape.vertices = points_of(json.at("vertices"));
  for (const Json& edge : json.at("edges")) {
    shape.edges.push_back({edge.at("name").get<std::string>(),
                           edge.at("ends").at(0).get<int>(),
                           edge.at("ends").at(1).get<int>(), curve_of(edge),
                           edge.at("range").at(0).get<double>(),
                           edge.at("range").at(1).get<double>()});
  }
  for (const Json& face : json.at("faces")) {
    ExactFace& made = shape.faces.emplace_back();
    made.name = face.at("name").get<std::string>();
    made.surface = surface_from(face);
    made.outward = face.at("outward").get<bool>();
    for (const Json& loop : face.at("loops")) {
      auto& uses = made.loops.emplace_back();
      for (const Json& use : loop) {
        uses.push_back({use.at("edge").get<int>(),
                        use.at("forward").get<bool>(),
                        Vec2(use.at("start").at(0).get<double>(),
                             use.at("start").at(1).get<double>())});
      }
    }
  }
  return shape;
}

}  // namespace

std::string exact_shape_text(const ExactShape& shape) {
  return json_line(json_of(shape));
}

ExactShape read_exact_shape_text(const std::string& text) {
  ExactShape shape;
  try {
    shape = shape_of(require_json(text));
  } catch (const nlohmann::json::exception& error) {
    throw InvalidInput(
        fmt::format("the text of a solid is none: {}", error.what()));
  }
  check(shape);
  return shape;
}

}  // namespace meniscus
