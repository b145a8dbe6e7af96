/// Internal to the helper `meniscus-step`: a file that OpenCASCADE has taken.
#pragma once

#include <filesystem>
#include <string>

#include <STEPControl_Reader.hxx>
#include <TopoDS_Shape.hxx>

#include "core/types.h"

namespace meniscus::occt {

/// In millimetres, whatever the file's own unit.
struct StepFile {
  std::filesystem::path path;
  STEPControl_Reader reader;
  TopoDS_Shape shape;
  double millimetres = 1.0;  // of the unit that is wanted

  /// The name that the file gives to a face or an edge; empty: none.
  std::string name_of(const TopoDS_Shape& part) const;
  Vec3 point(double x, double y, double z) const {
    return Vec3(x, y, z) / millimetres;
  }
};

/// `unit`: mm, m or in. Throws InvalidInput (no STEP, no shape, an unknown
/// unit) and IoError.
void open_step(StepFile& file, const std::filesystem::path& path,
               const std::string& unit);

}  // namespace meniscus::occt
