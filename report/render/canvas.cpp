#include "report/render/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

namespace meniscus::render {

namespace {

constexpr int kDotsPerInch = 72;  // a size is then in pixels
constexpr unsigned char kWhite = 255;

void set_text(vtkTextProperty* property, const TextStyle& style) {
  property->SetFontFamilyToArial();
  property->SetFontSize(style.size);
  property->SetColor(1.0, 1.0, 1.0);
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
}

}  // namespace

TextImage text_image(const std::string& text, const TextStyle& style) {
  TextImage result;
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  if (renderer == nullptr || text.empty()) {
    return result;
  }
  renderer->SetScaleToPowerOfTwo(false);
  vtkNew<vtkTextProperty> property;
  set_text(property, style);
  vtkNew<vtkImageData> image;
  std::array<int, 2> size{};
  if (!renderer->RenderString(property, text, image, size.data(),
                              kDotsPerInch)) {
    return result;
  }
  const int* extent = image->GetExtent();
  result.box = {extent[0], extent[2], extent[1] + 1, extent[3] + 1};
  for (int y = extent[2]; y <= extent[3]; ++y) {
    for (int x = extent[0]; x <= extent[1]; ++x) {
      const auto* pixel =
          static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      result.cover.push_back(pixel[3]);
    }
  }
  return result;
}

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      bytes_(3 * static_cast<std::size_t>(width) *
                 static_cast<std::size_t>(height),
             kWhite) {}

void Canvas::blend(int x, int y, const Colour& colour, double part) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) {
    return;
  }
  unsigned char* pixel = &bytes_[3 * (static_cast<std::size_t>(y) *
                                          static_cast<std::size_t>(width_) +
                                      static_cast<std::size_t>(x))];
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<unsigned char>(
        std::lround((1.0 - part) * pixel[c] + part * 255.0 * colour[c]));
  }
}

void Canvas::fill(double left, double bottom, double right, double top,
                  const Colour& colour) {
  const auto part = [](double low, double high, int at) {
    return std::clamp(std::min(high, at + 1.0) - std::max(low, double(at)), 0.0,
                      1.0);
  };
  for (int y = static_cast<int>(std::floor(bottom)); y < top; ++y) {
    for (int x = static_cast<int>(std::floor(left)); x < right; ++x) {
      blend(x, y, colour, part(left, right, x) * part(bottom, top, y));
    }
  }
}

void Canvas::line(double x0, double y0, double x1, double y1, double width,
                  const Colour& colour) {
  const double half = 0.5 * width;
  const double dx = x1 - x0;
  const double dy = y1 - y0;
  const double square = dx * dx + dy * dy;
  const auto low = [&](double a, double b) {
    return static_cast<int>(std::floor(std::min(a, b) - half - 1.0));
  };
  const auto high = [&](double a, double b) {
    return static_cast<int>(std::ceil(std::max(a, b) + half + 1.0));
  };
  for (int y = low(y0, y1); y <= high(y0, y1); ++y) {
    for (int x = low(x0, x1); x <= high(x0, x1); ++x) {
      const double px = x + 0.5 - x0;
      const double py = y + 0.5 - y0;
      const double t = square > 0.0
                           ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0)
                           : 0.0;
      const double away = std::hypot(px - t * dx, py - t * dy);
      blend(x, y, colour, std::clamp(half + 0.5 - away, 0.0, 1.0));
    }
  }
}

void Canvas::write(const TextImage& text, int x, int y, const Colour& colour) {
  std::size_t at = 0;
  for (int v = text.box.bottom; v < text.box.top; ++v) {
    for (int u = text.box.left; u < text.box.right; ++u) {
      blend(x + u, y + v, colour, text.cover[at++] / 255.0);
    }
  }
}

int Canvas::taken(const PixelBox& box) const {
  int count = 0;
  for (int y = box.bottom; y < box.top; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      if (x < 0 || y < 0 || x >= width_ || y >= height_) {
        ++count;
        continue;
      }
      const unsigned char* pixel =
          &bytes_[3 * (static_cast<std::size_t>(y) *
                           static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x))];
      count += pixel[0] != kWhite || pixel[1] != kWhite || pixel[2] != kWhite;
    }
  }
  return count;
}

}  // namespace meniscus::render
