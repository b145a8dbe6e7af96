/// What was measured of faces that leave as STEP, for people.
#pragma once

#include <string>
#include <vector>

#include "cad/solid/film_solid.h"
#include "cad/step/step_writer.h"
#include "pipeline/step_parts/export_step.h"

namespace meniscus::step_parts {

/// Of several solids: all of their faces, the largest of their distances.
solid::FilmSolidReport summed(
    const std::vector<solid::FilmSolidReport>& reports);

/// Says what the file has. `faces`: of other kinds, ", 7 faces of STEP solids"
/// or empty.
void tell_step(const StepExport& options, const solid::FilmSolidReport& film,
               const std::string& faces, std::size_t solids,
               const step::StepReport& step);

}  // namespace meniscus::step_parts
