#include "report/render/render_panel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vtkActor.h>
#include <vtkArrowSource.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkConeSource.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkStripper.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace meniscus::render {

namespace {

vtkSmartPointer<vtkPolyData> triangles_of(const PaintedScene& scene) {
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(scene.points.size()));
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(4);
  colours->SetNumberOfTuples(static_cast<vtkIdType>(scene.points.size()));
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), scene.points[i].data());
    colours->SetTypedTuple(static_cast<vtkIdType>(i), scene.colours[i].data());
  }
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(scene.triangles.size()),
                       static_cast<vtkIdType>(3 * scene.triangles.size()));
  for (const Triangle& t : scene.triangles) {
    cells->InsertNextCell({t[0], t[1], t[2]});
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(colours);
  return data;
}

}  // namespace

Panel::Panel(const Box& place, int picture_width, int picture_height)
    : place_(place),
      left_(place.left * picture_width),
      bottom_(place.bottom * picture_height),
      width_((place.right - place.left) * picture_width),
      height_((place.top - place.bottom) * picture_height) {}

void Panel::add_surface(vtkPolyData* data, const SurfaceStyle& style,
                        const std::vector<Paint>& paints) {
  if (data->GetNumberOfPolys() + data->GetNumberOfStrips() > 0) {
    shapes_.push_back(painted(data, style, paints));
  }
}

void Panel::add_tubes(const Points& points, const std::vector<Edge>& edges,
                      double radius, const Colour& colour) {
  if (edges.empty()) {
    return;
  }
  vtkNew<vtkPoints> used;
  vtkNew<vtkCellArray> lines;
  std::map<int, vtkIdType> ids;
  for (const Edge& edge : edges) {
    lines->InsertNextCell(2);
    for (const int point : edge) {
      const auto [at, added] =
          ids.emplace(point, static_cast<vtkIdType>(ids.size()));
      if (added) {
        used->InsertNextPoint(points[static_cast<std::size_t>(point)].data());
      }
      lines->InsertCellPoint(at->second);
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(used);
  data->SetLines(lines);
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(data);
  stripper->JoinContiguousSegmentsOn();
  stripper->SetMaximumLength(100000);
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputConnection(stripper->GetOutputPort());
  tubes->SetRadius(radius);
  tubes->SetNumberOfSides(10);
  tubes->CappingOn();
  tubes->Update();
  add_surface(tubes->GetOutput(), {.colour = colour, .only_front = true});
}

void Panel::add_arrow(const Vec3& tail, const Vec3& tip, const Colour& colour) {
  vtkNew<vtkArrowSource> arrow;
  arrow->SetTipResolution(48);
  arrow->SetShaftResolution(48);
  arrow->SetTipLength(0.34);
  arrow->SetTipRadius(0.11);
  arrow->SetShaftRadius(0.042);
  arrow->Update();
  const Vec3 x = tip - tail;
  const Vec3 other =
      std::abs(x.normalized().z()) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  Mat3 turn;
  turn.col(0) = x;
  turn.col(1) = x.norm() * other.cross(x).normalized();
  turn.col(2) = x.norm() * x.cross(turn.col(1)).normalized();
  vtkNew<vtkPolyData> data;
  data->DeepCopy(arrow->GetOutput());
  data->GetPointData()->SetNormals(nullptr);  // of another length and place
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    const Vec3 at = tail + turn * Vec3(data->GetPoint(i));
    data->GetPoints()->SetPoint(i, at.data());
  }
  add_surface(data, {.colour = colour, .only_front = true});
  show({tail, tip});
}

void Panel::add_cone(const Vec3& base, const Vec3& tip, double radius,
                     const Colour& colour) {
  vtkNew<vtkConeSource> cone;
  const Vec3 middle = 0.5 * (base + tip);
  const Vec3 along = tip - base;
  cone->SetCenter(middle.x(), middle.y(), middle.z());
  cone->SetDirection(along.x(), along.y(), along.z());
  cone->SetHeight(along.norm());
  cone->SetRadius(radius);
  cone->SetResolution(36);
  cone->Update();
  add_surface(cone->GetOutput(), {.colour = colour, .only_front = true});
}

void Panel::add_axes(const std::string& length_unit, int text_size) {
  axes_unit_ = length_unit;
  axes_text_ = text_size;
}

void Panel::add_label(const Vec3& at, const Vec3& away, const std::string& text,
                      const TextStyle& style) {
  labels_.push_back({at, away, text, style});
}

void Panel::add_text(double x, double y, const std::string& text,
                     const TextStyle& style) {
  texts_.push_back({x, y, text, style});
}

void Panel::add_colour_bar(const Box& place, const std::string& title,
                           const BarScale& scale, int text_size) {
  const auto [top, step, clipped] = scale;
  constexpr int kCells = 256;
  const double width = place.right - place.left;
  for (int i = 0; i < kCells; ++i) {
    // A pixel farther, below the next: no seam between them.
    const double right = place.left + width * (i + 1) / kCells;
    boxes_.push_back({{place.left + width * i / kCells, place.bottom,
                       std::min(right + 1.0 / width_, place.right), place.top},
                      viridis((i + 0.5) / kCells)});
  }
  const TextStyle tick_style{.size = text_size, .justify = Justify::Centre};
  const double thick = 1.0 / width_;
  const double tick_height = 0.35 * text_size / height_;
  for (int i = 0; i * step <= top * (1 + 1e-9); ++i) {
    const double x = place.left + width * std::min(1.0, i * step / top);
    boxes_.push_back(
        {{x - thick, place.bottom - tick_height, x + thick, place.bottom},
         tick_style.colour});
    add_text(x, place.bottom - tick_height - 1.25 * text_size / height_,
             fmt::format(
                 "{}{:.6g}",
                 clipped && (i + 1) * step > top * (1 + 1e-9) ? "\u2265 " : "",
                 i * step),
             tick_style);
  }
  TextStyle title_style = tick_style;
  title_style.bold = true;
  add_text(0.5 * (place.left + place.right),
           place.top + 0.4 * text_size / height_, title, title_style);
}

void Panel::add_legend(double y, const std::vector<Key>& keys, int text_size) {
  const double side = 0.8 * text_size;
  double total = 0.0;  // a letter is about half as wide as high
  const auto width_of = [&](const Key& key) {
    return 2.0 * side + text_size * (1.0 + 0.5 * double(key.name.size()));
  };
  for (const Key& key : keys) {
    total += width_of(key);
  }
  double x = 0.5 * (width_ - total + text_size);
  for (const Key& key : keys) {
    boxes_.push_back(
        {{x / width_, y, (x + side) / width_, y + side / height_}, key.colour});
    add_text((x + 1.5 * side) / width_, y - 0.15 * text_size / height_,
             key.name, {.size = text_size});
    x += width_of(key);
  }
}

void Panel::show(const Points& points) {
  shown_.insert(shown_.end(), points.begin(), points.end());
}

void Panel::fit_camera(const Vec3& view, const Box& box) {
  view_ = fit_view(shown_, view, box, width_, height_);
}

vtkRenderer* Panel::renderer() {
  if (renderer_ != nullptr) {
    return renderer_;
  }
  renderer_ = vtkSmartPointer<vtkRenderer>::New();
  renderer_->SetViewport(place_.left, place_.bottom, place_.right, place_.top);
  renderer_->SetBackground(1.0, 1.0, 1.0);
  renderer_->AutomaticLightCreationOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(triangles_of(paint(std::move(shapes_), view_)));
  mapper->StaticOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  // The light is in the colours, the order in the triangles: one simple
  // shader, one pass.
  actor->GetProperty()->LightingOff();
  actor->ForceOpaqueOn();
  renderer_->AddActor(actor);
  vtkCamera* camera = renderer_->GetActiveCamera();
  const Vec3 focus = view_.eye - view_.back;
  camera->SetViewAngle(EyeView::kAngle);
  camera->SetPosition(view_.eye.data());
  camera->SetFocalPoint(focus.data());
  camera->SetViewUp(view_.up.data());
  renderer_->ResetCameraClippingRange();
  return renderer_;
}

void Panel::shift(double x, double y) {
  renderer()->GetActiveCamera()->SetWindowCenter(-2.0 * x / width_,
                                                 -2.0 * y / height_);
}

void Panel::finish(Canvas& canvas) const {
  for (const FlatBox& box : boxes_) {
    canvas.fill(left_ + box.place.left * width_,
                bottom_ + box.place.bottom * height_,
                left_ + box.place.right * width_,
                bottom_ + box.place.top * height_, box.colour);
  }
  std::vector<PixelBox> written;
  for (const Text& text : texts_) {
    const TextImage image = text_image(text.text, text.style);
    const int x = static_cast<int>(std::lround(left_ + text.x * width_));
    const int y = static_cast<int>(std::lround(bottom_ + text.y * height_));
    canvas.write(image, x, y, text.style.colour);
    written.push_back({x + image.box.left, y + image.box.bottom,
                       x + image.box.right, y + image.box.top});
  }
  if (axes_text_ > 0) {
    draw_axes(canvas);
  }
  for (const Label& label : labels_) {
    written.push_back(place_label(label, written, canvas));
  }
}

void Panel::draw_axes(Canvas& canvas) const {
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  constexpr Colour kAxisInk = {0.38, 0.42, 0.48};
  const double length = 2.2 * axes_text_;
  const Eigen::Vector2d origin(left_ + 3.4 * axes_text_,
                               bottom_ + 3.2 * axes_text_);
  const double wide = std::max(1.5, axes_text_ / 9.0);
  for (int k = 0; k < 3; ++k) {
    const Vec3 seen = view_.turned(Vec3::Unit(k));
    const Eigen::Vector2d tip = origin + length * seen.head<2>();
    canvas.line(origin.x(), origin.y(), tip.x(), tip.y(), wide, kAxisInk);
    // An axis that points at the eye has its letter beside the origin.
    const Eigen::Vector2d aside = seen.head<2>().norm() > 0.3
                                      ? seen.head<2>().normalized().eval()
                                      : Eigen::Vector2d(-0.7, -0.7);
    const Eigen::Vector2d at = tip + 0.65 * axes_text_ * aside;
    canvas.write(text_image(kNames[static_cast<std::size_t>(k)],
                            {.size = axes_text_,
                             .colour = kAxisInk,
                             .justify = Justify::Centre,
                             .stand = Stand::Centred}),
                 static_cast<int>(std::lround(at.x())),
                 static_cast<int>(std::lround(at.y())), kAxisInk);
  }
  if (!axes_unit_.empty() && !shown_.empty()) {
    draw_scale(canvas, origin.x() + 2.2 * length, bottom_ + 1.6 * axes_text_);
  }
}

void Panel::draw_scale(Canvas& canvas, double left, double bottom) const {
  constexpr double kShare = 0.16;  // of the panel's width, at most
  constexpr Colour kAxisInk = {0.38, 0.42, 0.48};
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : shown_) {
    middle += p / static_cast<double>(shown_.size());
  }
  const double pixel = view_.pixel_at(middle);
  const double length = round_down_nice(kShare * width_ * pixel);
  const double right = left + length / pixel;
  const double wide = std::max(1.5, axes_text_ / 9.0);
  const double tick = 0.3 * axes_text_;
  canvas.line(left, bottom, right, bottom, wide, kAxisInk);
  canvas.line(left, bottom - tick, left, bottom + tick, wide, kAxisInk);
  canvas.line(right, bottom - tick, right, bottom + tick, wide, kAxisInk);
  canvas.write(
      text_image(
          fmt::format("{:g} {}", length, axes_unit_),
          {.size = axes_text_, .colour = kAxisInk, .justify = Justify::Centre}),
      static_cast<int>(std::lround(0.5 * (left + right))),
      static_cast<int>(std::lround(bottom + 0.4 * axes_text_)), kAxisInk);
}

namespace {

/// Pixels that two boxes share.
int common(const PixelBox& a, const PixelBox& b) {
  return std::max(0, std::min(a.right, b.right) - std::max(a.left, b.left)) *
         std::max(0, std::min(a.top, b.top) - std::max(a.bottom, b.bottom));
}

}  // namespace

/// Pixels of the box that belong to other panels.
int Panel::beyond(const PixelBox& box) const {
  const double across = std::max(0.0, left_ - box.left) +
                        std::max(0.0, box.right - left_ - width_);
  return static_cast<int>(across * (box.top - box.bottom));
}

PixelBox Panel::place_label(const Label& label,
                            const std::vector<PixelBox>& written,
                            Canvas& canvas) const {
  constexpr int kUnreadable = 10;  // x pixels of text that it would cross
  const Eigen::Vector2d at = view_.project(label.at);
  const Vec3 away = view_.turned(label.away);
  Eigen::Vector2d along(away.x(), away.y());
  along = along.norm() > 0.1 * away.norm() ? along.normalized().eval()
                                           : Eigen::Vector2d(0.0, 1.0);
  TextStyle style = label.style;
  style.justify = Justify::Centre;
  style.stand = Stand::Centred;
  const TextImage text = text_image(label.text, style);
  const double half_width = 0.5 * (text.box.right - text.box.left);
  const double half_height = 0.5 * (text.box.top - text.box.bottom);
  // Straight on, then more and more to the sides, then farther out.
  constexpr std::array<double, 8> kTurns = {0, 30, -30, 60, -60, 90, -90, 180};
  constexpr std::array<double, 3> kGaps = {0.6, 1.8, 3.6};  // x text size
  int least = -1;
  Eigen::Vector2i best(0, 0);
  for (const double gap : kGaps) {
    for (const double degrees : kTurns) {
      const Eigen::Vector2d d =
          Eigen::Rotation2Dd(degrees * EIGEN_PI / 180.0) * along;
      const Eigen::Vector2d middle =
          at + gap * style.size * d +
          Eigen::Vector2d(half_width * d.x(), half_height * d.y());
      const Eigen::Vector2i corner = (Eigen::Vector2d(left_, bottom_) + middle)
                                         .array()
                                         .round()
                                         .cast<int>();
      const int room = style.size / 2;
      const PixelBox box = {corner.x() + text.box.left - room,
                            corner.y() + text.box.bottom - room,
                            corner.x() + text.box.right + room,
                            corner.y() + text.box.top + room};
      int taken = canvas.taken(box) + beyond(box);
      for (const PixelBox& other : written) {
        taken += kUnreadable * common(box, other);
      }
      if (least < 0 || taken < least) {
        least = taken;
        best = corner;
      }
    }
  }
  const PixelBox box = {best.x() + text.box.left, best.y() + text.box.bottom,
                        best.x() + text.box.right, best.y() + text.box.top};
  if (least > 0) {  // nowhere free: paper under the letters
    canvas.fill(box.left - 4, box.bottom - 3, box.right + 4, box.top + 3,
                {1.0, 1.0, 1.0});
  }
  canvas.write(text, best.x(), best.y(), style.colour);
  return box;
}

}  // namespace meniscus::render
