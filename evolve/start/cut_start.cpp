#include "evolve/start/cut_start.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/curve_cut.h"
#include "evolve/films/rim_grading.h"
#include "evolve/films/rims.h"
#include "evolve/start/cut_films.h"
#include "evolve/start/face_loops.h"

namespace meniscus::start {

namespace {

/// The planes that cut, each once.
std::vector<FacePlane> planes_of(const films::FilmSystem& system,
                                 const films::FilmComplex& complex) {
  std::vector<FacePlane> planes;
  for (const films::CapSpec& cap : system.caps) {
    if (!cap.wall || !cap.wall->cuts) {
      continue;
    }
    const int label = complex.mesh.label_of(cap.name);
    const int set = complex.surfaces[label].constraints;
    if (std::none_of(planes.begin(), planes.end(),
                     [&](const FacePlane& p) { return p.set == set; })) {
      planes.push_back({cap.wall->at, cap.wall->normal.normalized(), set});
    }
  }
  return planes;
}

class StartCut {
 public:
  StartCut(const films::FilmSystem& system, double edge,
           films::FilmComplex& complex)
      : system_(system),
        edge_(edge),
        complex_(complex),
        planes_(planes_of(system, complex)),
        rounding_(reach_of_planes(complex.mesh.points)) {}

  void run() {
    mark_rims();
    std::vector<Disk> disks;
    for (const films::CapSpec& cap : system_.caps) {
      if (is_cut(cap)) {
        disks.push_back(disk_of(cap));
        drop_facets(disks.back().label);
      } else if (cap.wall) {
        drop_facets(complex_.mesh.label_of(cap.name));
      }
    }
    for (const FacePlane& plane : planes_) {
      cut_films(plane, complex_);
    }
    FaceSeams seams(complex_, planes_, edge_);
    for (const Disk& disk : disks) {
      fill(disk, seams);
    }
    require_facets();
    drop_unused(complex_);
  }

 private:
  /// A flat face before it was cut.
  struct Disk {
    std::string name;
    int label = 0;
    FacePlane plane;
    std::map<int, int> next;  // around what is left
    bool graded = false;
  };

  bool is_left(int v) const {
    const Vec3& p = complex_.mesh.points[v];
    return std::all_of(planes_.begin(), planes_.end(),
                       [&](const FacePlane& plane) {
                         return plane.normal.dot(p - plane.at) <= rounding_;
                       });
  }

  /// A flat disk that ends at a curve that is cut; faces that films wet are
  /// filled last.
  bool is_cut(const films::CapSpec& cap) const {
    const std::vector<std::string> names = cap.curves();
    const bool cut =
        std::any_of(names.begin(), names.end(), [&](const std::string& name) {
          return std::any_of(system_.curves.begin(), system_.curves.end(),
                             [&](const curves::Curve& curve) {
                               return curve.name == name &&
                                      !cuts_of(system_, curve).empty();
                             });
        });
    if (cut && (cap.start || cap.solid >= 0)) {
      throw InvalidInput(fmt::format(
          "a plane of symmetry cuts a curve of '{}', which is of given facets "
          "or of a STEP solid; draw the whole",
          cap.name));
    }
    return cut && !cap.ruled && cap.inner.empty() && !cap.wall;
  }

  Disk disk_of(const films::CapSpec& cap) const {
    const int label = complex_.mesh.label_of(cap.name);
    Disk disk{.name = cap.name, .label = label, .plane = {}, .next = {}};
    const std::vector<std::string> names = cap.curves();
    disk.graded = std::any_of(system_.curves.begin(), system_.curves.end(),
                              [&](const curves::Curve& curve) {
                                return films::is_cut_finely(curve) &&
                                       std::find(names.begin(), names.end(),
                                                 curve.name) != names.end();
                              });
    Vec3 area = Vec3::Zero();
    for (std::size_t f = 0; f < complex_.mesh.facets.size(); ++f) {
      if (complex_.mesh.facet_label[f] == label) {
        area += area_vector2(complex_.mesh, static_cast<int>(f));
        disk.plane.at = complex_.mesh.points[complex_.mesh.facets[f][0]];
      }
    }
    disk.plane.normal = area.normalized();
    for (const Edge& run : open_runs(complex_.mesh, label)) {
      if (is_left(run[0]) && is_left(run[1])) {
        disk.next[run[0]] = run[1];
      }
    }
    return disk;
  }

  void drop_facets(int label) {
    SurfaceMesh& mesh = complex_.mesh;
    std::size_t kept = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (mesh.facet_label[f] != label) {
        mesh.facets[kept] = mesh.facets[f];
        mesh.facet_label[kept++] = mesh.facet_label[f];
      }
    }
    mesh.facets.resize(kept);
    mesh.facet_label.resize(kept);
  }

  /// Rims are found by all vertices of a curve, as if it were closed: those of
  /// cut ones are marked.
  void mark_rims() {
    const std::vector<int> next = films::rim_neighbours(complex_);
    std::vector<char> cut;
    for (const curves::Curve& curve : complex_.curves) {
      cut.push_back(cuts_of(system_, curve).empty() ? 0 : 1);
    }
    for (std::size_t i = 0; i < next.size(); ++i) {
      const auto v = static_cast<int>(i);
      const int curve = complex_.vertices[i].curve;
      if (next[i] >= 0 && cut[curve] != 0 && is_left(v) && is_left(next[i])) {
        films::ComplexEdge mark;
        mark.a = v;
        mark.b = next[i];
        mark.kind = films::VertexKind::OnCurve;
        mark.curve = curve;
        complex_.edges.push_back(mark);
      }
    }
  }

  void fill(const Disk& disk, FaceSeams& seams) {
    fill_loops(seams.loops(disk.plane, disk.next, disk.name), edge_,
               disk.graded, disk.label, complex_);
  }

  void require_facets() const {
    std::vector<char> has(complex_.surfaces.size(), 0);
    for (const int label : complex_.mesh.facet_label) {
      has[label] = 1;
    }
    for (std::size_t s = 0; s < has.size(); ++s) {
      if (has[s] == 0 && !complex_.surfaces[s].wetted) {
        throw InvalidInput(
            fmt::format("'{}' lies beyond a plane of symmetry; leave it out",
                        complex_.surfaces[s].name));
      }
    }
  }

  const films::FilmSystem& system_;
  double edge_;
  films::FilmComplex& complex_;
  std::vector<FacePlane> planes_;
  double rounding_;
};

}  // namespace

bool has_cuts(const films::FilmSystem& system) {
  return std::any_of(
      system.caps.begin(), system.caps.end(),
      [](const films::CapSpec& cap) { return cap.wall && cap.wall->cuts; });
}

std::vector<double> cuts_of(const films::FilmSystem& system,
                            const curves::Curve& curve) {
  std::vector<double> result;
  for (const films::CapSpec& cap : system.caps) {
    if (cap.wall && cap.wall->cuts) {
      const std::vector<double> more = curves::crossings(
          curve.shape, cap.wall->at, cap.wall->normal.normalized());
      result.insert(result.end(), more.begin(), more.end());
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void match_cuts(const films::FilmSystem& system, const std::string& ring,
                films::RuledBand& band) {
  constexpr double kNextTo = 1e-3;  // of a turn
  const std::vector<double> outer = cuts_of(system, system.curves[band.outer]);
  const std::vector<double> inner = cuts_of(system, system.curves[band.inner]);
  if (outer.empty() && inner.empty()) {
    return;
  }
  for (std::size_t k = 0; k < inner.size() && !outer.empty(); ++k) {
    const double off = std::abs(band.partner_of_outer(outer[0]) - inner[k]);
    if (std::min(off, 1.0 - off) < kNextTo) {
      films::make_partners(band, outer[0], inner[k]);
      return;
    }
  }
  throw InvalidInput(fmt::format(
      "a plane of symmetry cuts the ring '{}', whose curves do not meet it at "
      "places that the ring joins; draw the whole",
      ring));
}

void cut_start(const films::FilmSystem& system, double edge,
               films::FilmComplex& complex) {
  if (has_cuts(system)) {
    StartCut(system, edge, complex).run();
  }
}

}  // namespace meniscus::start
