/// The views that pictures are made of. Each adds to a panel what is to be
/// seen; the caller then fits the camera.
#pragma once

#include "report/picture/picture_job.h"
#include "report/render/render_data.h"
#include "report/render/render_panel.h"

namespace meniscus::render {

/// Text sizes [pixel] and the place for the model, by picture.
struct ViewLayout {
  int text = 22;
  Box model = {0.04, 0.18, 0.96, 0.88};
  Box bar = {0.27, 0.095, 0.73, 0.12};
};

/// Films translucent, the more opaque the flatter the eye looks at them;
/// solids opaque; rims as tubes. Returns whether there is any film: a part of
/// plane faces alone has none.
bool draw_film(Panel& panel, const picture::PictureJob& job,
               const picture::PictureSurface& film);

/// The near half taken away, element by element.
void draw_cut_mesh(Panel& panel, const picture::PictureJob& job,
                   const picture::PictureTets& tets);

/// Deflected by a round factor, coloured by von Mises stress, with the shape
/// at rest, supports, loads and a colour bar.
struct PartFigures {
  double factor = 1.0;   // of the deflection as drawn
  double largest = 0.0;  // displacement [length]
  double peak = 0.0;     // von Mises stress [pressure]
};
PartFigures draw_part(Panel& panel, const picture::PictureJob& job,
                      const picture::PictureSurface& part,
                      const ViewLayout& layout);

inline constexpr Colour kFilmColour = {0.36, 0.70, 0.93};
inline constexpr Colour kRimColour = {0.07, 0.20, 0.42};
inline constexpr Colour kCapColour = {0.96, 0.68, 0.28};
inline constexpr Colour kOutsideColour = {0.62, 0.73, 0.84};
inline constexpr Colour kInsideColour = {0.97, 0.80, 0.52};

}  // namespace meniscus::render
