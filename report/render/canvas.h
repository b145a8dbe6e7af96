/// A picture's pixels, and flat things drawn onto them: boxes and text.
#pragma once

#include <string>
#include <vector>

#include "report/render/colour_map.h"

namespace meniscus::render {

enum class Justify { Left, Centre, Right };
/// Where text stands to its position's height.
enum class Stand { Below, Centred, Above };

struct TextStyle {
  int size = 20;  // [pixel]
  Colour colour = {0.13, 0.16, 0.20};
  bool bold = false;
  Justify justify = Justify::Left;
  Stand stand = Stand::Above;
};

/// Pixels from the lower left corner of the picture; `right` and `top` are the
/// first beyond.
struct PixelBox {
  int left = 0, bottom = 0, right = 0, top = 0;
};

/// Letters as they cover pixels, in rows from below.
struct TextImage {
  PixelBox box;  // around its position at (0, 0)
  std::vector<unsigned char> cover;
};

/// By VTK's FreeType; nothing for text that cannot be drawn.
TextImage text_image(const std::string& text, const TextStyle& style);

class Canvas {
 public:
  /// White.
  Canvas(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Red, green, blue of each pixel, in rows from below.
  std::vector<unsigned char>& bytes() { return bytes_; }
  const std::vector<unsigned char>& bytes() const { return bytes_; }

  /// A box with its sides anywhere between pixels.
  void fill(double left, double bottom, double right, double top,
            const Colour& colour);
  /// A straight line between two places, with round ends.
  void line(double x0, double y0, double x1, double y1, double width,
            const Colour& colour);
  /// Text with its position at a pixel; what lies beyond the rim is cut off.
  void write(const TextImage& text, int x, int y, const Colour& colour);
  /// Pixels of the box that are not white, or beyond the rim.
  int taken(const PixelBox& box) const;

 private:
  void blend(int x, int y, const Colour& colour, double part);

  int width_, height_;
  std::vector<unsigned char> bytes_;
};

}  // namespace meniscus::render
