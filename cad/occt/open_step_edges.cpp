#include "cad/occt/open_step_edges.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Geometry>
#include <GCPnts_AbscissaPoint.hxx>
#include <GCPnts_QuasiUniformAbscissa.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cad/occt/step_file.h"
#include "cad/occt/step_session.h"
#include "core/error.h"
#include "core/nearest_name.h"

namespace meniscus::occt {

using step::StepLoop;
using step::StepPiece;

namespace {

constexpr std::size_t kNamesShown = 24;  // edges that a message lists
constexpr double kClosed = 1e-6;         // gap between edges [their length]

std::string text_of(const Vec3& p) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", p[0], p[1], p[2]);
}

/// All of `text`, from 1; 0 when it is no such number.
int number_of(const std::string& text) {
  int number = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && at == end && number > 0 ? number : 0;
}

const char* kind_of(const BRepAdaptor_Curve& curve) {
  switch (curve.GetType()) {
    case GeomAbs_Line:
      return "line";
    case GeomAbs_Circle:
      return "circle";
    case GeomAbs_Ellipse:
      return "ellipse";
    default:
      return "curve";
  }
}

void reverse(StepPiece& piece) {
  std::reverse(piece.samples.begin(), piece.samples.end());
  std::swap(piece.leaves, piece.arrives);
  piece.leaves = -piece.leaves;
  piece.arrives = -piece.arrives;
}

const Vec3& start_of(const StepPiece& piece) { return piece.samples.front(); }
const Vec3& end_of(const StepPiece& piece) { return piece.samples.back(); }

double length_of(const std::vector<StepPiece>& pieces) {
  double sum = 0.0;
  for (const StepPiece& piece : pieces) {
    sum += piece.length;
  }
  return sum;
}

/// Twice the area within the loop, along its mean normal.
Vec3 area_vector(const std::vector<StepPiece>& pieces) {
  const Vec3 origin = start_of(pieces.front());
  Vec3 sum = Vec3::Zero();
  for (const StepPiece& piece : pieces) {
    for (std::size_t k = 1; k < piece.samples.size(); ++k) {
      sum += (piece.samples[k - 1] - origin).cross(piece.samples[k] - origin);
    }
  }
  return sum;
}

void reverse(StepLoop& loop) {
  std::reverse(loop.pieces.begin(), loop.pieces.end());
  for (StepPiece& piece : loop.pieces) {
    reverse(piece);
  }
  if (loop.whole) {
    loop.whole->v = -loop.whole->v;
  }
}

}  // namespace

struct OpenStepEdges::Impl {
  StepFile file;
  TopTools_IndexedMapOfShape edges;
  TopTools_IndexedMapOfShape faces;

  BRepAdaptor_Curve curve(int edge) const {
    return BRepAdaptor_Curve(TopoDS::Edge(edges(edge)));
  }
  Vec3 to_point(const gp_Pnt& p) const {
    return file.point(p.X(), p.Y(), p.Z());
  }
  StepPiece piece(int edge) const;
  std::optional<solid::EllipseCurve> conic(int edge) const;
  std::optional<solid::EllipseCurve> whole(
      const std::vector<StepPiece>& pieces) const;
  std::string described(int edge) const;
  /// All that have a length: what a film may begin at alone comes first.
  std::vector<int> likely_rims() const;
  int find(const std::string& edge) const;
  int find_face(const std::string& face) const;
  std::vector<StepPiece> chained(std::vector<StepPiece> pieces) const;
};

StepPiece OpenStepEdges::Impl::piece(int edge) const {
  const BRepAdaptor_Curve shape = curve(edge);
  StepPiece piece{.edge = edge};
  piece.kind = shape.GetType() == GeomAbs_Line     ? StepPiece::Kind::Line
               : shape.GetType() == GeomAbs_Circle ? StepPiece::Kind::Arc
                                                   : StepPiece::Kind::Free;
  const GCPnts_QuasiUniformAbscissa at(shape, StepPiece::kIntervals + 1);
  if (BRep_Tool::Degenerated(TopoDS::Edge(edges(edge))) || !at.IsDone() ||
      at.NbPoints() != StepPiece::kIntervals + 1) {
    throw InvalidInput(
        fmt::format("{}: edge {} has no length", file.path.string(), edge));
  }
  for (int k = 1; k <= at.NbPoints(); ++k) {
    piece.samples.push_back(to_point(shape.Value(at.Parameter(k))));
  }
  const auto tangent = [&](double t) {
    gp_Pnt p;
    gp_Vec d;
    shape.D1(t, p, d);
    return Vec3(Vec3(d.X(), d.Y(), d.Z()).normalized());
  };
  piece.leaves = tangent(shape.FirstParameter());
  piece.arrives = tangent(shape.LastParameter());
  piece.length = GCPnts_AbscissaPoint::Length(shape) / file.millimetres;
  return piece;
}

/// The circle or ellipse that an edge lies on.
std::optional<solid::EllipseCurve> OpenStepEdges::Impl::conic(int edge) const {
  const BRepAdaptor_Curve shape = curve(edge);
  gp_Ax2 axes;
  double u = 0.0;
  double v = 0.0;
  if (shape.GetType() == GeomAbs_Circle) {
    axes = shape.Circle().Position();
    u = v = shape.Circle().Radius();
  } else if (shape.GetType() == GeomAbs_Ellipse) {
    axes = shape.Ellipse().Position();
    u = shape.Ellipse().MajorRadius();
    v = shape.Ellipse().MinorRadius();
  } else {
    return std::nullopt;
  }
  const gp_Dir x = axes.XDirection();
  const gp_Dir y = axes.YDirection();
  return solid::EllipseCurve{to_point(axes.Location()),
                             u * file.point(x.X(), x.Y(), x.Z()),
                             v * file.point(y.X(), y.Y(), y.Z())};
}

/// The circle or ellipse that all pieces lie on, when they go around it once.
std::optional<solid::EllipseCurve> OpenStepEdges::Impl::whole(
    const std::vector<StepPiece>& pieces) const {
  auto first = conic(pieces.front().edge);
  if (!first) {
    return std::nullopt;
  }
  const double size = first->u.norm();
  Vec3 normal = first->u.cross(first->v).normalized();
  for (const StepPiece& piece : pieces) {
    const auto other = conic(piece.edge);
    if (!other || (other->center - first->center).norm() > kClosed * size ||
        std::abs(other->u.norm() - size) > kClosed * size ||
        std::abs(other->v.norm() - first->v.norm()) > kClosed * size ||
        other->u.cross(other->v).normalized().cross(normal).norm() > kClosed) {
      return std::nullopt;
    }
    const bool round = std::abs(size - first->v.norm()) <= kClosed * size;
    if (!round &&
        other->u.normalized().cross(first->u.normalized()).norm() > kClosed) {
      return std::nullopt;
    }
  }
  const double area = std::numbers::pi * size * first->v.norm();
  const Vec3 twice = area_vector(pieces);
  if (std::abs(0.5 * twice.norm() / area - 1.0) > 1e-3) {
    return std::nullopt;  // back and forth
  }
  if (twice.dot(normal) < 0.0) {
    first->v = -first->v;
  }
  return first;
}

std::string OpenStepEdges::Impl::described(int edge) const {
  const BRepAdaptor_Curve shape = curve(edge);
  const std::string name = file.name_of(edges(edge));
  const double middle = 0.5 * (shape.FirstParameter() + shape.LastParameter());
  const bool round = shape.GetType() == GeomAbs_Circle;
  return fmt::format("{}{}: {} of length {:.5g} about {}", edge,
                     name.empty() ? "" : fmt::format(" '{}'", name),
                     kind_of(shape),
                     GCPnts_AbscissaPoint::Length(shape) / file.millimetres,
                     text_of(to_point(round ? shape.Circle().Location()
                                            : shape.Value(middle))));
}

int OpenStepEdges::Impl::find(const std::string& edge) const {
  std::vector<std::string> names;
  for (int k = 1; k <= edges.Extent(); ++k) {
    names.push_back(file.name_of(edges(k)));
    if (!names.back().empty() && names.back() == edge) {
      return k;
    }
  }
  const int number = number_of(edge);
  if (number > 0 && number <= edges.Extent()) {
    return number;
  }
  std::erase(names, "");
  const std::string near = nearest_name(edge, names);
  std::vector<std::string> there;
  for (const int k : likely_rims()) {
    if (there.size() == kNamesShown) {
      there.emplace_back("...");
      break;
    }
    there.push_back(described(k));
  }
  throw InvalidInput(fmt::format(
      "{} has no edge '{}'{}; it has {}, those that close by themselves first, "
      "the longest first, by number: {}",
      file.path.string(), edge,
      near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
      edges.Extent(), fmt::join(there, "; ")));
}

std::vector<int> OpenStepEdges::Impl::likely_rims() const {
  struct Edge {
    int number = 0;
    bool open = false;
    double length = 0.0;
  };
  std::vector<Edge> found;
  for (int k = 1; k <= edges.Extent(); ++k) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(k));
    if (!BRep_Tool::Degenerated(edge)) {
      found.push_back(
          {k, !TopExp::FirstVertex(edge).IsSame(TopExp::LastVertex(edge)),
           GCPnts_AbscissaPoint::Length(curve(k))});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Edge& a, const Edge& b) {
                     return a.open != b.open ? b.open : a.length > b.length;
                   });
  std::vector<int> numbers;
  numbers.reserve(found.size());
  for (const Edge& edge : found) {
    numbers.push_back(edge.number);
  }
  return numbers;
}

int OpenStepEdges::Impl::find_face(const std::string& face) const {
  std::vector<std::string> names;
  std::vector<int> found;
  for (int k = 1; k <= faces.Extent(); ++k) {
    std::string name = file.name_of(faces(k));
    if (name.empty()) {
      name = fmt::format("face_{}", k);
    }
    if (name == face) {
      found.push_back(k);
    }
    names.push_back(std::move(name));
  }
  if (found.size() > 1) {
    throw InvalidInput(fmt::format(
        "{} has {} faces '{}', by number: {}; expected one of these",
        file.path.string(), found.size(), face, fmt::join(found, ", ")));
  }
  if (!found.empty()) {
    return found.front();
  }
  const int number = number_of(face);
  if (number > 0 && number <= faces.Extent()) {
    return number;
  }
  const std::string near = nearest_name(face, names);
  if (names.size() > kNamesShown) {
    names.resize(kNamesShown);
    names.emplace_back("...");
  }
  throw InvalidInput(fmt::format(
      "{} has no face '{}'; {}, or a number from 1 to {}", file.path.string(),
      face,
      near.empty() ? fmt::format("known are {}", fmt::join(names, ", "))
                   : fmt::format("did you mean '{}'?", near),
      faces.Extent()));
}

/// In the order and direction in which they follow the first.
std::vector<StepPiece> OpenStepEdges::Impl::chained(
    std::vector<StepPiece> pieces) const {
  const double near = kClosed * length_of(pieces);
  const auto refuse = [&](const Vec3& end, int edge, double gap, int nearest) {
    throw InvalidInput(fmt::format(
        "{}: the edges do not close: edge {} ends at {}, and the nearest end, "
        "of edge {}, is {:.3g} away; name the edges between them too",
        file.path.string(), edge, text_of(end), nearest, gap));
  };
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const Vec3 end = end_of(pieces[k]);
    double least = std::numeric_limits<double>::infinity();
    std::size_t next = k + 1;
    bool turn = false;
    for (std::size_t j = k + 1; j < pieces.size(); ++j) {
      for (const bool back : {false, true}) {
        const Vec3& from = back ? end_of(pieces[j]) : start_of(pieces[j]);
        if ((from - end).norm() < least) {
          least = (from - end).norm();
          next = j;
          turn = back;
        }
      }
    }
    if (least > near) {
      refuse(end, pieces[k].edge, least, pieces[next].edge);
    }
    std::swap(pieces[k + 1], pieces[next]);
    if (turn) {
      reverse(pieces[k + 1]);
    }
  }
  const double gap = (start_of(pieces.front()) - end_of(pieces.back())).norm();
  if (gap > near) {
    refuse(end_of(pieces.back()), pieces.back().edge, gap, pieces.front().edge);
  }
  return pieces;
}

OpenStepEdges::OpenStepEdges(const std::filesystem::path& path,
                             const std::string& unit)
    : impl_(std::make_unique<Impl>()) {
  const StepSilence silence;
  open_step(impl_->file, path, unit);
  TopExp::MapShapes(impl_->file.shape, TopAbs_EDGE, impl_->edges);
  TopExp::MapShapes(impl_->file.shape, TopAbs_FACE, impl_->faces);
}
OpenStepEdges::OpenStepEdges(OpenStepEdges&&) noexcept = default;
OpenStepEdges& OpenStepEdges::operator=(OpenStepEdges&&) noexcept = default;
OpenStepEdges::~OpenStepEdges() = default;

StepLoop OpenStepEdges::loop(const std::vector<std::string>& edges) const {
  const StepSilence silence;
  std::vector<StepPiece> pieces;
  for (const std::string& edge : edges) {
    const int number = impl_->find(edge);
    for (const StepPiece& piece : pieces) {
      if (piece.edge == number) {
        throw InvalidInput(fmt::format("{}: edge '{}' is named twice",
                                       impl_->file.path.string(), edge));
      }
    }
    pieces.push_back(impl_->piece(number));
  }
  StepLoop loop;
  loop.pieces = impl_->chained(std::move(pieces));
  loop.whole = impl_->whole(loop.pieces);
  return loop;
}

StepLoop OpenStepEdges::rim(const std::string& face) const {
  const StepSilence silence;
  const int number = impl_->find_face(face);
  const TopoDS_Face shape = TopoDS::Face(impl_->faces(number));
  std::vector<StepPiece> pieces;
  for (BRepTools_WireExplorer at(BRepTools::OuterWire(shape)); at.More();
       at.Next()) {
    const TopoDS_Edge& edge = at.Current();
    if (BRep_Tool::IsClosed(edge, shape)) {
      throw InvalidInput(fmt::format(
          "{}: face '{}' goes around and has no single rim; name the edge with "
          "'edge'",
          impl_->file.path.string(), face));
    }
    if (!BRep_Tool::Degenerated(edge)) {
      pieces.push_back(impl_->piece(impl_->edges.FindIndex(edge)));
    }
  }
  if (pieces.empty()) {
    throw InvalidInput(fmt::format("{}: face '{}' has no rim",
                                   impl_->file.path.string(), face));
  }
  StepLoop loop;
  loop.pieces = impl_->chained(std::move(pieces));
  loop.whole = impl_->whole(loop.pieces);
  const BRepAdaptor_Surface surface(shape);
  if (surface.GetType() == GeomAbs_Plane) {
    const gp_Dir axis = surface.Plane().Axis().Direction();
    // A plane with a left-handed frame runs the other way.
    const double out = (shape.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0) *
                       (surface.Plane().Direct() ? 1.0 : -1.0);
    if (out * area_vector(loop.pieces).dot(Vec3(axis.X(), axis.Y(), axis.Z())) <
        0.0) {
      reverse(loop);
    }
  }
  return loop;
}

}  // namespace meniscus::occt
