/// The views that pictures are made of.
#pragma once

#include "report/picture_job.h"
#include "report/render_data.h"
#include "report/render_panel.h"

namespace meniscus {

/// Text sizes [pixel] and the place for the model, by picture.
struct ViewLayout {
  int text = 22;
  Box model = {0.05, 0.20, 0.95, 0.84};
  Box bar = {0.27, 0.095, 0.73, 0.12};
};

/// Films translucent, the more opaque the flatter the eye looks at them;
/// solids opaque; rims as tubes.
void draw_film(Panel& panel, const PictureJob& job, const PictureSurface& film,
               const ViewLayout& layout);

/// The near half taken away, element by element.
void draw_cut_mesh(Panel& panel, const PictureJob& job, const PictureTets& tets,
                   const ViewLayout& layout);

/// Deflected by a round factor, coloured by von Mises stress, with the shape
/// at rest, supports, loads and a colour bar. Returns one line that states
/// factor, largest displacement and peak stress.
std::string draw_part(Panel& panel, const PictureJob& job,
                      const PictureSurface& part, const ViewLayout& layout);

}  // namespace meniscus
