/// The pictures of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "pipeline/forward/forward_model.h"
#include "report/picture/picture_job.h"

namespace meniscus::output {

/// film.png, part.png and overview.png in `folder`, of a design whose stresses
/// are known, under its worst load case; of several load cases a part_NAME.png
/// each. They need no other file.
std::vector<picture::PictureJob> run_pictures(
    const case_data::Case& input, const forward::EvaluationFields& fields,
    const std::filesystem::path& folder);

/// The same of what stands in `folder`: film.vtp, part.vtu, part_surface.vtp;
/// `numbers`: of the run's answer; `worst`: the load case that the files' plain
/// fields are of; empty: the first, and they have no others (of older
/// versions).
std::vector<picture::PictureJob> stored_run_pictures(
    const case_data::Case& input, const case_data::EvaluatedCase& numbers,
    const std::string& worst, const std::filesystem::path& folder);

/// film.png from the film.vtp in `folder`; `solids`: its surfaces that are no
/// films; `hidden`: those left out (PictureJob::hidden). Returns warnings for
/// what could not be drawn, as below.
std::vector<std::string> draw_film(const std::string& title,
                                   const std::vector<std::string>& solids,
                                   const std::vector<std::string>& hidden,
                                   const std::filesystem::path& folder,
                                   Monitor& monitor);

/// frames/film_NNNN.png, one of each frame that write_frames() left in
/// `folder`, all from one fixed camera; `captions`: a line for each.
std::vector<std::string> draw_frames(
    const std::string& title, const std::vector<std::string>& solids,
    const std::vector<forward::FilmFrame>& frames,
    const std::vector<std::string>& captions,
    const std::filesystem::path& folder, Monitor& monitor);

}  // namespace meniscus::output
