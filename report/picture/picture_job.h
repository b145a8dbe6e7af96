/// What a picture shows, as handed from the program to its helper.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "report/picture/picture_data.h"

namespace meniscus::picture {

enum class PictureKind {
  Part,     // the deflected part coloured by von Mises stress
  Film,     // the liquid films with their rims and caps
  Overview  // film, cut mesh and stressed part side by side
};

enum class PictureLoadKind {
  Force,     // an arrow
  Moment,    // an arrow about its axis
  Pressure,  // many on the surface, along its normal: into the part where
             // direction.x is above 0
  Traction,  // many on the surface, along the direction
  Body       // an arrow beside the part: gravity
};

/// What acts on surfaces together, or on the whole part.
struct PictureLoad {
  std::vector<std::string> surfaces;
  Vec3 direction = Vec3::Zero();  // its length is relative to the others' of
                                  // its kind
  std::string label;              // "40 kN"
  PictureLoadKind kind = PictureLoadKind::Force;
  /// Of forces and moments of several surfaces: where they act; without it the
  /// middle of these [length].
  std::optional<Vec3> point = {};
};

/// A shape of a picture: in memory, else in a file (UTF-8).
template <class Data>
struct PictureSource {
  std::shared_ptr<const Data> data;  // may be shared between jobs
  std::string file;
};

/// Part needs `part_surface` with displacement and von Mises stress (in a
/// file: the point fields `displacement` and `von_mises`, with `field_ending`
/// at their names' end, and the cell data `surface`); Film needs `film`;
/// Overview needs both and `part`.
struct PictureJob {
  PictureKind kind = PictureKind::Part;
  std::string output;                          // PNG, replaced whole; UTF-8
  PictureSource<PictureTets> part;             // part.vtu
  PictureSource<PictureSurface> part_surface;  // part_surface.vtp
  PictureSource<PictureSurface> film;          // film.vtp
  std::string title;                           // one line, may be empty
  int width = 1600;                            // [pixel], 200 to 8000
  int height = 1000;                           // [pixel], 200 to 8000
  std::vector<std::string> supports;           // surfaces that are held
  std::vector<std::string> support_labels;     // of the same, may be shorter
  std::vector<std::string> solids;             // of the film: caps, plates
  std::vector<PictureLoad> loads;
  std::string load_case;     // of the loads, "lift (the worst of 3)"; may be
                             // empty
  std::string field_ending;  // "_lift"; see above
  Vec3 view = Vec3(0.26, -1.0, 0.62);  // from the part to the eye; z is up
  bool facet_edges = false;            // Film: thin lines along facets
  std::vector<std::string> hidden;     // Film: surfaces left out
  std::string length_unit;             // of the scale; empty: no scale
  // Film, of a series seen by one fixed camera:
  Points seen;          // what must be in view; empty: the film
  std::string caption;  // a line below the title
};

/// Whether a surface is one of `hidden`; a * at the end of one of these stands
/// for anything.
bool is_hidden(const std::string& surface,
               const std::vector<std::string>& hidden);

/// Jobs with their shapes as bytes for the helper on this machine, and back;
/// the latter throws InvalidInput.
std::string to_bytes(const std::vector<PictureJob>& jobs);
std::vector<PictureJob> picture_jobs_from_bytes(const std::string& bytes);

}  // namespace meniscus::picture
