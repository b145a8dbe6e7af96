/// The pictures of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "pipeline/forward_model.h"

namespace meniscus {

/// film.png, part.png and overview.png from the mesh files in `folder`.
/// Returns warnings for what could not be drawn.
std::vector<std::string> draw(const Case& input, const EvaluationFields& fields,
                              const std::filesystem::path& folder,
                              Monitor& monitor);

/// film.png from the film.vtp in `folder`; `solids`: its surfaces that are no
/// films.
std::vector<std::string> draw_film(const std::string& title,
                                   const std::vector<std::string>& solids,
                                   const std::filesystem::path& folder,
                                   Monitor& monitor);

}  // namespace meniscus
