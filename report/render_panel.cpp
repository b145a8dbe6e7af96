#include "report/render_panel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vtkActor.h>
#include <vtkArrowSource.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkStripper.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>

namespace meniscus {

namespace {

constexpr double kViewAngle = 20.0;  // vertical [deg]: mild perspective

void set_colour(vtkProperty* property, const SurfaceStyle& style) {
  property->SetColor(style.colour[0], style.colour[1], style.colour[2]);
  property->SetOpacity(style.opacity);
  property->SetAmbient(style.ambient);
  property->SetDiffuse(1.0 - 0.5 * style.ambient);
  property->SetSpecular(style.specular);
  property->SetSpecularPower(40.0);
  if (style.flat) {
    property->SetInterpolationToFlat();
  } else {
    property->SetInterpolationToPhong();
  }
  property->SetBackfaceCulling(style.only_front ? 1 : 0);
  if (style.edges) {
    property->EdgeVisibilityOn();
    property->SetEdgeColor(style.edge_colour[0], style.edge_colour[1],
                           style.edge_colour[2]);
    property->SetLineWidth(
        static_cast<float>(style.edge_width * kSupersampling));
  }
}

void set_text(vtkTextProperty* property, const TextStyle& style) {
  property->SetFontFamilyToArial();
  property->SetFontSize(style.size * kSupersampling);
  property->SetColor(style.colour[0], style.colour[1], style.colour[2]);
  property->SetBold(style.bold ? 1 : 0);
  switch (style.justify) {
    case Justify::Left:
      property->SetJustificationToLeft();
      break;
    case Justify::Centre:
      property->SetJustificationToCentered();
      break;
    case Justify::Right:
      property->SetJustificationToRight();
      break;
  }
  property->SetVerticalJustificationToBottom();
}

struct FlatBox {
  Box place;  // fractions of the panel
  Colour colour;
};

unsigned char to_byte(double value) {
  return static_cast<unsigned char>(
      std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

vtkSmartPointer<vtkActor2D> flat_boxes(const std::vector<FlatBox>& boxes,
                                       double width, double height) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  for (const auto& [at, colour] : boxes) {
    cells->InsertNextCell(4);
    for (const auto& [x, y] :
         {std::pair(at.left, at.bottom), std::pair(at.right, at.bottom),
          std::pair(at.right, at.top), std::pair(at.left, at.top)}) {
      cells->InsertCellPoint(
          points->InsertNextPoint(x * width, y * height, 0.0));
    }
    colours->InsertNextTuple3(to_byte(colour[0]), to_byte(colour[1]),
                              to_byte(colour[2]));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetCellData()->SetScalars(colours);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  return actor;
}

}  // namespace

Panel::Panel(const Box& place, int picture_width, int picture_height)
    : renderer_(vtkSmartPointer<vtkRenderer>::New()),
      width_((place.right - place.left) * picture_width),
      height_((place.top - place.bottom) * picture_height) {
  renderer_->SetViewport(place.left, place.bottom, place.right, place.top);
  renderer_->SetBackground(1.0, 1.0, 1.0);
  renderer_->UseFXAAOn();
  renderer_->AutomaticLightCreationOff();
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.95);
  lights->SetKeyLightWarmth(0.52);
  lights->SetFillLightWarmth(0.48);
  lights->SetKeyToFillRatio(2.2);
  lights->SetKeyToHeadRatio(4.0);
  lights->AddLightsToRenderer(renderer_);
}

void Panel::add_surface(vtkPolyData* data, const SurfaceStyle& style) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor->GetProperty(), style);
  renderer_->AddActor(actor);
}

void Panel::add_coloured(vtkPolyData* data,
                         const std::vector<std::array<double, 4>>& colours,
                         const SurfaceStyle& style) {
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetNumberOfComponents(4);
  bool translucent = false;
  for (const auto& c : colours) {
    bytes->InsertNextTuple4(to_byte(c[0]), to_byte(c[1]), to_byte(c[2]),
                            to_byte(c[3]));
    translucent = translucent || c[3] < 1.0;
  }
  vtkNew<vtkPolyData> copy;
  copy->ShallowCopy(data);
  copy->GetPointData()->SetScalars(bytes);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(copy);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor->GetProperty(), style);
  if (translucent) {
    actor->ForceTranslucentOn();
  }
  renderer_->AddActor(actor);
}

void Panel::add_tubes(const Points& points, const std::vector<Edge>& edges,
                      double radius, const Colour& colour, double opacity) {
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
  tubes->SetNumberOfSides(12);
  tubes->CappingOn();
  tubes->Update();
  SurfaceStyle style;
  style.colour = colour;
  style.opacity = opacity;
  add_surface(tubes->GetOutput(), style);
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
  const Vec3 y = x.norm() * other.cross(x).normalized();
  const Vec3 z = x.norm() * x.cross(y).normalized();
  vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 3; ++row) {
    matrix->SetElement(row, 0, x[row]);
    matrix->SetElement(row, 1, y[row]);
    matrix->SetElement(row, 2, z[row]);
    matrix->SetElement(row, 3, tail[row]);
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(arrow->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->SetUserMatrix(matrix);
  SurfaceStyle style;
  style.colour = colour;
  set_colour(actor->GetProperty(), style);
  renderer_->AddActor(actor);
  show({tail, tip});
}

void Panel::add_label(const Vec3& at, const std::string& text,
                      const TextStyle& style) {
  vtkNew<vtkBillboardTextActor3D> actor;
  actor->SetInput(text.c_str());
  actor->SetPosition(at.x(), at.y(), at.z());
  set_text(actor->GetTextProperty(), style);
  vtkTextProperty* property = actor->GetTextProperty();
  switch (style.stand) {
    case Stand::Below:
      property->SetVerticalJustificationToTop();
      break;
    case Stand::Centred:
      property->SetVerticalJustificationToCentered();
      break;
    case Stand::Above:
      property->SetVerticalJustificationToBottom();
      break;
  }
  renderer_->AddActor(actor);
}

void Panel::add_text(double x, double y, const std::string& text,
                     const TextStyle& style) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->SetTextScaleModeToNone();
  set_text(actor->GetTextProperty(), style);
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(x, y);
  renderer_->AddViewProp(actor);
}

void Panel::add_colour_bar(const Box& place, const std::string& title,
                           double top, double step, int text_size) {
  constexpr int kCells = 256;
  std::vector<FlatBox> boxes;
  boxes.reserve(kCells);
  const double width = place.right - place.left;
  for (int i = 0; i < kCells; ++i) {
    boxes.push_back({{place.left + width * i / kCells, place.bottom,
                      place.left + width * (i + 1) / kCells, place.top},
                     viridis((i + 0.5) / kCells)});
  }
  const TextStyle tick_style{.size = text_size, .justify = Justify::Centre};
  const double thick = 1.0 / width_;
  const double tick_height = 0.35 * text_size / height_;
  for (int i = 0; i * step <= top * (1 + 1e-9); ++i) {
    const double x = place.left + width * std::min(1.0, i * step / top);
    boxes.push_back(
        {{x - thick, place.bottom - tick_height, x + thick, place.bottom},
         tick_style.colour});
    add_text(x, place.bottom - tick_height - 1.25 * text_size / height_,
             fmt::format("{:.6g}", i * step), tick_style);
  }
  TextStyle title_style = tick_style;
  title_style.bold = true;
  add_text(0.5 * (place.left + place.right),
           place.top + 0.4 * text_size / height_, title, title_style);
  renderer_->AddActor2D(
      flat_boxes(boxes, width_ * kSupersampling, height_ * kSupersampling));
}

void Panel::add_legend(double y, const std::vector<Key>& keys, int text_size) {
  std::vector<FlatBox> boxes;
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
    boxes.push_back(
        {{x / width_, y, (x + side) / width_, y + side / height_}, key.colour});
    add_text((x + 1.5 * side) / width_, y - 0.15 * text_size / height_,
             key.name, {.size = text_size});
    x += width_of(key);
  }
  renderer_->AddActor2D(
      flat_boxes(boxes, width_ * kSupersampling, height_ * kSupersampling));
}

void Panel::sort_layers() {
  constexpr int kPeels = 4;  // two layers each
  renderer_->UseDepthPeelingOn();
  renderer_->SetMaximumNumberOfPeels(kPeels);
  renderer_->SetOcclusionRatio(0.0);
}

void Panel::show(const Points& points) {
  shown_.insert(shown_.end(), points.begin(), points.end());
}

void Panel::fit_camera(const Vec3& view, const Box& box) {
  const Vec3 back = view.normalized();
  const Vec3 up_hint =
      std::abs(back.z()) < 0.99 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  const Vec3 right = up_hint.cross(back).normalized();
  const Vec3 up = back.cross(right);
  const double half = std::tan(0.5 * kViewAngle * EIGEN_PI / 180.0);
  const double aspect = width_ / height_;
  Vec3 focus = Vec3::Zero();
  for (const Vec3& p : shown_) {
    focus += p / static_cast<double>(shown_.size());
  }
  double distance = std::max(bounding_diagonal(shown_), 1e-30) / half;
  const double middle_x = box.left + box.right - 1.0;  // in -1..1
  const double middle_y = box.bottom + box.top - 1.0;
  constexpr int kRounds = 30;  // a contraction: perspective is mild
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Array2d low(1e300, 1e300), high(-1e300, -1e300);
    for (const Vec3& p : shown_) {
      const Vec3 d = p - focus;
      const double depth = half * (distance - back.dot(d));
      const Eigen::Array2d at(right.dot(d) / depth / aspect, up.dot(d) / depth);
      low = low.min(at);
      high = high.max(at);
    }
    const double grow =
        std::max((high.x() - low.x()) / (2 * (box.right - box.left)),
                 (high.y() - low.y()) / (2 * (box.top - box.bottom)));
    focus +=
        right * ((0.5 * (low.x() + high.x()) - middle_x * grow) * distance *
                 half * aspect) +
        up * ((0.5 * (low.y() + high.y()) - middle_y * grow) * distance * half);
    distance *= grow;
  }
  vtkCamera* camera = renderer_->GetActiveCamera();
  camera->SetViewAngle(kViewAngle);
  const Vec3 eye = focus + distance * back;
  camera->SetFocalPoint(focus.data());
  camera->SetPosition(eye.data());
  camera->SetViewUp(up.data());
  renderer_->ResetCameraClippingRange();
}

}  // namespace meniscus
