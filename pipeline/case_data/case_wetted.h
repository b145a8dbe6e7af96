/// Faces that films wet on walls: solids of kind wetted.
#pragma once

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// A cell: the curve that wetted faces name and planes of symmetry have sides
/// of, two or more of them. Each side lies in one of their planes, where the
/// film slides; a body's faces end where these planes meet.
bool is_cell(const Case& input, const std::string& curve);

/// Does a film begin at the curve and slide, on a wetted face, in a plane of
/// symmetry or in a cell?
bool slides_at(const Case& input, const std::string& curve);

/// The wall of a wetted face and -T cos(contact angle), its energy per area, or
/// the rate of that; what is wrong with them is told.
films::FilmWall wall_of(const Case& input, const CapEntry& cap,
                        const CaseValues& values);

/// Makes the walls of cells planes that cut, their normals away from what the
/// curve bounds, and the curve free.
void make_cells(const Case& input, films::FilmSystem& system);

/// Tells of curves that do not lie on the wall on which their film slides, or,
/// where it is bent, near it.
void check_on_walls(const Case& input, const films::FilmSystem& system,
                    const CaseValues& values);

}  // namespace meniscus::case_data
