/// One view in a picture: shapes, text and a colour bar in a renderer, with a
/// camera that fits what was added. Drawn at kSupersampling times the final
/// size; all pixel sizes given here are final ones. At print resolution edges
/// are smoothed in the picture (FXAA): four times the pixels cost four times
/// the seconds and cannot be told apart on paper.
#pragma once

#include <string>
#include <vector>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/surface_mesh.h"
#include "report/colour_map.h"

class vtkPolyData;

namespace meniscus {

inline constexpr int kSupersampling = 1;

/// Fractions of the panel, from its lower left corner.
struct Box {
  double left, bottom, right, top;
};

enum class Justify { Left, Centre, Right };
/// Where text stands to its position's height.
enum class Stand { Below, Centred, Above };

struct TextStyle {
  int size = 20;  // [pixel]
  Colour colour = {0.13, 0.16, 0.20};
  bool bold = false;
  Justify justify = Justify::Left;
  Stand stand = Stand::Centred;  // of labels
};

struct SurfaceStyle {
  Colour colour = {0.8, 0.8, 0.8};
  double opacity = 1.0;
  double specular = 0.25;
  double ambient = 0.15;  // light from everywhere, 0..1
  bool flat = false;
  bool only_front = false;  // facets that face the eye
  bool edges = false;       // thin lines along facets
  Colour edge_colour = {0.2, 0.25, 0.3};
  double edge_width = 1.0;  // [pixel]
};

class Panel {
 public:
  /// `place`: the part of the picture, whose final size is given [pixel].
  Panel(const Box& place, int picture_width, int picture_height);

  vtkRenderer* renderer() const { return renderer_; }

  void add_surface(vtkPolyData* data, const SurfaceStyle& style);
  /// Colours per point, 4 x 0..1 (the last: opacity).
  void add_coloured(vtkPolyData* data,
                    const std::vector<std::array<double, 4>>& colours,
                    const SurfaceStyle& style);
  /// Tubes along edges; radius [length].
  void add_tubes(const Points& points, const std::vector<Edge>& edges,
                 double radius, const Colour& colour, double opacity = 1.0);
  void add_arrow(const Vec3& tail, const Vec3& tip, const Colour& colour);
  /// Text at a place of the model, always upright.
  void add_label(const Vec3& at, const std::string& text, const TextStyle&);
  /// Text at a place of the panel.
  void add_text(double x, double y, const std::string& text, const TextStyle&);
  /// Horizontal, from 0 to `top`, a tick every `step`.
  void add_colour_bar(const Box& place, const std::string& title, double top,
                      double step, int text_size);

  /// A row of colours with their names, over the panel's width.
  struct Key {
    Colour colour;
    std::string name;
  };
  void add_legend(double y, const std::vector<Key>& keys, int text_size);

  /// Blends several translucent layers in their true order; costs time.
  void sort_layers();

  /// Points that must be seen.
  void show(const Points& points);
  const Points& shown() const { return shown_; }
  /// Looks from `view` (from the model to the eye), z up, all shown points
  /// inside `box`.
  void fit_camera(const Vec3& view, const Box& box);

 private:
  vtkSmartPointer<vtkRenderer> renderer_;
  double width_, height_;  // [final pixel]
  Points shown_;
};

}  // namespace meniscus
