/// One view in a picture: shapes seen by a camera that fits what was added,
/// text and a colour bar. All pixel sizes are those of the picture.
#pragma once

#include <string>
#include <vector>
#include <vtkSmartPointer.h>

#include "core/geometry/surface_mesh.h"
#include "report/render/canvas.h"
#include "report/render/eye_view.h"
#include "report/render/painted_shape.h"

class vtkPolyData;
class vtkRenderer;

namespace meniscus::render {

class Panel {
 public:
  /// `place`: the part of the picture, whose size is given [pixel].
  Panel(const Box& place, int picture_width, int picture_height);

  void add_surface(vtkPolyData* data, const SurfaceStyle& style,
                   const std::vector<Paint>& paints = {});
  /// Tubes along edges; radius [length].
  void add_tubes(const Points& points, const std::vector<Edge>& edges,
                 double radius, const Colour& colour);
  void add_arrow(const Vec3& tail, const Vec3& tip, const Colour& colour);
  void add_cone(const Vec3& base, const Vec3& tip, double radius,
                const Colour& colour);
  /// Text near a place of the model, where the picture is free: best on the
  /// side that `away` points to, else around; never across another label.
  void add_label(const Vec3& at, const Vec3& away, const std::string& text,
                 const TextStyle& style);
  /// Text at a place of the panel.
  void add_text(double x, double y, const std::string& text, const TextStyle&);
  struct BarScale {
    double top = 1.0;
    double step = 0.5;
    bool clipped = false;  // the last tick reads "≥ top"
  };
  /// Horizontal, from 0 to the top, a tick every step.
  void add_colour_bar(const Box& place, const std::string& title,
                      const BarScale& scale, int text_size);
  /// Directions x, y, z in the lower left corner and, with a unit, a bar of a
  /// round length beside them, true in the middle of the model.
  void add_axes(const std::string& length_unit, int text_size);

  /// A row of colours with their names, over the panel's width.
  struct Key {
    Colour colour;
    std::string name;
  };
  void add_legend(double y, const std::vector<Key>& keys, int text_size);

  /// Points that must be seen.
  void show(const Points& points);
  const Points& shown() const { return shown_; }
  /// Looks from `view` (from the model to the eye), z up, all shown points
  /// inside `box`.
  void fit_camera(const Vec3& view, const Box& box);

  /// The shapes as the camera sees them, shifted by a part of a pixel; the
  /// panel must outlive it.
  vtkRenderer* renderer();
  void shift(double x, double y);
  /// Text and flat things, once the shapes are on the canvas.
  void finish(Canvas& canvas) const;

 private:
  struct FlatBox {
    Box place;  // fractions of the panel
    Colour colour;
  };
  struct Text {
    double x, y;  // fractions of the panel
    std::string text;
    TextStyle style;
  };
  struct Label {
    Vec3 at, away;
    std::string text;
    TextStyle style;
  };

  int beyond(const PixelBox& box) const;
  /// `written`: where text stands already, which it is not to cross. Returns
  /// where the label stands.
  PixelBox place_label(const Label& label, const std::vector<PixelBox>& written,
                       Canvas& canvas) const;
  void draw_axes(Canvas& canvas) const;
  void draw_scale(Canvas& canvas, double left, double bottom) const;

  Box place_;
  double left_, bottom_, width_, height_;  // [pixel]
  EyeView view_;
  Points shown_;
  std::vector<PaintedShape> shapes_;
  std::vector<FlatBox> boxes_;
  std::vector<Text> texts_;
  std::vector<Label> labels_;
  int axes_text_ = 0;  // [pixel]; 0: no axes
  std::string axes_unit_;
  vtkSmartPointer<vtkRenderer> renderer_;
};

}  // namespace meniscus::render
