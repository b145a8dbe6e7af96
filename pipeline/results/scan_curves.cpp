#include "pipeline/results/scan_curves.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/files/part_file.h"
#include "pipeline/results/imported_part.h"

namespace meniscus::results {

namespace {

std::string vector_text(const Vec3& v, int digits) {
  return fmt::format("[{:.{}f}, {:.{}f}, {:.{}f}]", v.x(), digits, v.y(),
                     digits, v.z(), digits);
}

/// Digits behind the point that tell a thousandth of the rim's size.
int digits_of(const scan::ScanRim& rim) {
  constexpr double kPart = 1e-3;
  return std::max(0, static_cast<int>(std::ceil(
                         -std::log10(kPart * std::max(rim.radius, 1e-12)))));
}

}  // namespace

std::string curves_text(const scan::ScanRimReport& report,
                        const std::string& scan) {
  std::string text = fmt::format(
      "# {} closed lines along which {} bends most; it falls into {} parts,\n"
      "# normals averaged over {:.3g}. Keep those that films should hang on.\n",
      report.rims.size(), scan, report.parts, report.radius);
  int number = 0;
  for (const scan::ScanRim& rim : report.rims) {
    const int digits = digits_of(rim);
    text += fmt::format(
        "\n[curves.rim_{}] # length {:.4g}, the surface turns by {:.0f} "
        "degrees\n# center {}, normal {},\n# mean radius {:.4g}; {:.2g} off "
        "its plane, {:.2g} off the line (rms)\nkind = \"spline\"\npoints = "
        "[\n",
        ++number, rim.length, rim.turn, vector_text(rim.center, digits),
        vector_text(rim.normal, 3), rim.radius, rim.off_plane, rim.deviation);
    for (const Vec3& point : rim.points) {
      text += "  " + vector_text(point, digits) + ",\n";
    }
    text += "]\n";
  }
  return text;
}

scan::ScanRimReport rims_of_scan(const std::filesystem::path& scan,
                                 const scan::ScanRimOptions& options) {
  const std::string ending = scan.extension().string();
  if (!files::is_part_file(scan) || ending == ".step" || ending == ".stp") {
    throw InvalidInput(
        fmt::format("{}: expected a scan, a file that ends in .stl or .obj",
                    scan.string()));
  }
  return scan::find_rims(files::read_part_file(scan, {}), options);
}

}  // namespace meniscus::results
