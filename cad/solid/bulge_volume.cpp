#include "cad/solid/bulge_volume.h"

#include "cad/solid/film_mesh.h"

namespace meniscus::solid {

std::vector<double> bulge_volumes(const SurfaceMesh& mesh,
                                  const std::vector<char>& flat) {
  std::vector<double> volumes(mesh.labels.size(), 0.0);
  for (std::size_t label = 0; label < mesh.labels.size(); ++label) {
    if (flat[label] != 0) {
      continue;
    }
    FilmMesh film;
    film.points = mesh.points;
    std::vector<int> facets;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (mesh.facet_label[f] == static_cast<int>(label)) {
        film.facets.push_back(mesh.facets[f]);
        facets.push_back(static_cast<int>(f));
      }
    }
    set_normals(film);
    for (std::size_t i = 0; i < facets.size(); ++i) {
      // Offsets are quadratic: the rule of the three mid-sides is exact.
      Vec3 offset = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        Vec3 at = Vec3::Constant(0.5);
        at[k] = 0.0;
        const Triangle& t = film.facets[i];
        offset +=
            smooth_point(film, static_cast<int>(i), at) -
            0.5 * (film.points[t[(k + 1) % 3]] + film.points[t[(k + 2) % 3]]);
      }
      volumes[label] += area_vector2(mesh, facets[i]).dot(offset) / 6.0;
    }
  }
  return volumes;
}

}  // namespace meniscus::solid
