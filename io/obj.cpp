#include "io/obj.h"

#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "io/body_surfaces.h"

namespace meniscus::io {

void write_obj(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const ObjOptions& options) {
  check_for_file(mesh, path, std::numeric_limits<double>::infinity());
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const std::string& line : comment_lines(options.notes)) {
    fmt::format_to(out, "# {}\n", line);
  }
  for (const Vec3& p : mesh.points) {
    fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
  }
  const std::vector<BodyFacets> bodies = facets_by_body(mesh);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    fmt::format_to(out, "o {}\n", one_word(body_name(options.bodies, b)));
    for (const BodyFacets::Group& group : bodies[b].groups) {
      fmt::format_to(
          out, "g {}\n",
          one_word(mesh.labels[static_cast<std::size_t>(group.label)]));
      for (const Triangle& t : group.facets) {
        fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
      }
    }
  }
  write_file(path, {text.data(), text.size()});
}

}  // namespace meniscus::io
