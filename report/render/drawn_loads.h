/// Loads and supports as they are drawn on a part.
#pragma once

#include "core/geometry/surface_mesh.h"
#include "report/picture/picture_job.h"
#include "report/render/render_panel.h"

namespace meniscus::render {

/// Arrows on the outside of the part: straight ones for forces, about their
/// axis for moments, many small ones for pressures and tractions, one beside
/// the part for gravity. What several surfaces carry together is one arrow at
/// its point, with a line to each of them. `diagonal`: the part's size
/// [length]; `text`: size of labels [pixel].
void draw_loads(Panel& panel, const picture::PictureJob& job,
                const SurfaceMesh& mesh, double diagonal, int text);

/// A block under flat surfaces that are held, a coat on others, with what is
/// held as a label.
void draw_supports(Panel& panel, const picture::PictureJob& job,
                   const SurfaceMesh& mesh, double diagonal, int text);

}  // namespace meniscus::render
