/// From panels to a file.
#pragma once

#include <string>
#include <vector>

#include "report/render/render_panel.h"

namespace meniscus::render {

/// The panels as a PNG file. Throws IoError.
void save_picture(const std::vector<Panel*>& panels, int width, int height,
                  const std::string& path);

}  // namespace meniscus::render
