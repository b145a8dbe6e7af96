#include "evolve/start/raise_disks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Geometry>

#include "evolve/start/cut_start.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr double kUsualHeight = 0.25;  // x the largest distance from the rim
constexpr double kMostHeight = 2.0;    // the same

/// The surfaces of one body that fill one curve, in the body's order.
struct Filling {
  std::string name;
  bool film = false;
  bool holed = false;  // a film that holds other curves, too
};

std::map<std::string, std::vector<Filling>> fillings_of(
    const films::FilmSystem& system, const films::BodySpec& body) {
  std::map<std::string, std::vector<Filling>> result;
  for (const std::string& name : body.enclosed_by) {
    for (const films::FilmSpec& film : system.films) {
      if (film.name == name && film.kind == films::FilmKind::Disk) {
        result[film.curves[0]].push_back({name, true, film.curves.size() > 1});
      }
    }
    for (const films::CapSpec& cap : system.caps) {
      // Films at several rims of a bent wall enclose something as they are.
      const bool between = cap.wall && cap.wall->bent() && !cap.more.empty();
      if (cap.name == name && !cap.start && cap.solid < 0 && !between) {
        result[cap.curve].push_back({name});
      }
    }
  }
  return result;
}

/// A disk's own vertices, and how high each is for a height of 1: round at the
/// middle, with a slope at the rim.
class Bulge {
 public:
  Bulge(const films::FilmComplex& complex, int label) : complex_(complex) {
    std::set<int> inner;
    Points rim;
    for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
      if (complex.mesh.facet_label[f] != label) {
        continue;
      }
      facets_.push_back(complex.mesh.facets[f]);
      for (const int v : facets_.back()) {
        if (complex.vertices[v].kind == films::VertexKind::Free) {
          inner.insert(v);
        } else {
          rim.push_back(complex.mesh.points[v]);
        }
      }
    }
    for (const int v : inner) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& p : rim) {
        nearest = std::min(nearest, (p - complex.mesh.points[v]).norm());
      }
      height_[v] = nearest;
      width_ = std::max(width_, nearest);
    }
    for (auto& [v, height] : height_) {
      const double in = 1.0 - height / width_;
      height = 1.0 - in * in;
    }
  }

  bool empty() const { return height_.empty(); }
  double width() const { return width_; }

  /// Volume under it per height, as seen along `normal`.
  double volume(const Vec3& normal) const {
    double sum = 0.0;
    for (const Triangle& t : facets_) {
      const Points& p = complex_.mesh.points;
      const double area =
          0.5 *
          std::abs((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).dot(normal));
      for (const int v : t) {
        const auto found = height_.find(v);
        sum += found == height_.end() ? 0.0 : area * found->second / 3.0;
      }
    }
    return sum;
  }

  RaisedDisk raise(int label, const Vec3& by,
                   films::FilmComplex& complex) const {
    RaisedDisk raised{.surface = label};
    for (const auto& [v, height] : height_) {
      complex.mesh.points[v] += height * by;
      raised.vertices.push_back(v);
      raised.moves.emplace_back(height * by);
    }
    return raised;
  }

 private:
  const films::FilmComplex& complex_;
  std::vector<Triangle> facets_;
  std::map<int, double> height_;
  double width_ = 0.0;
};

/// What a face has on the side of its flat rim that the normal points to
/// [length^3].
double volume_beyond(const films::FilmComplex& complex,
                     const std::string& surface, const Vec3& at,
                     const Vec3& normal) {
  const int label = complex.mesh.label_of(surface);
  double sum = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.mesh.facet_label[f] == label) {
      const Triangle& t = complex.mesh.facets[f];
      const Points& p = complex.mesh.points;
      const double area2 =
          std::abs((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).dot(normal));
      sum += area2 / 6.0 * normal.dot(p[t[0]] + p[t[1]] + p[t[2]] - 3.0 * at);
    }
  }
  return sum;
}

Points rim_of(const films::FilmComplex& complex, const std::string& curve) {
  Points rim;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = complex.vertices[v];
    if (vertex.kind == films::VertexKind::OnCurve &&
        complex.curves[vertex.curve].name == curve) {
      rim.push_back(complex.mesh.points[v]);
    }
  }
  return rim;
}

/// How many times the body's volume a disk on the curve begins with: it is
/// whole, and each plane of symmetry across it leaves half.
double parts_of(const films::FilmSystem& system, const std::string& curve) {
  double parts = 1.0;
  for (const curves::Curve& c : system.curves) {
    if (c.name == curve) {
      parts = std::pow(2.0, cuts_of(system, c).size() / 2);
    }
  }
  return parts;
}

}  // namespace

std::vector<RaisedDisk> raise_disks(const films::FilmSystem& system,
                                    films::FilmComplex& complex) {
  std::vector<RaisedDisk> result;
  std::set<std::string> raised;
  for (const films::BodySpec& body : system.bodies) {
    for (const auto& [curve, fillings] : fillings_of(system, body)) {
      if (fillings.size() != 2) {
        continue;
      }
      const Points rim = rim_of(complex, curve);
      const Vec3 normal = polygon_area_vector(rim).normalized();
      const Vec3 middle =
          std::accumulate(rim.begin(), rim.end(), Vec3(Vec3::Zero())) /
          static_cast<double>(rim.size());
      double beneath = 0.0;  // of the wall of a face that its film wets
      for (const films::CapSpec& cap : system.caps) {
        if (cap.wall && cap.wall->bent() && cap.curve == curve) {
          beneath = volume_beyond(complex, cap.name, middle, normal);
        }
      }
      const int films = (fillings[0].film ? 1 : 0) + (fillings[1].film ? 1 : 0);
      double side = 1.0;
      for (const Filling& filling : fillings) {
        if (!filling.film || !raised.insert(filling.name).second) {
          continue;
        }
        const int label = complex.mesh.label_of(filling.name);
        const Bulge bulge(complex, label);
        if (bulge.empty()) {
          continue;
        }
        double height = kUsualHeight * bulge.width();
        // Between rims of several heights there is volume below it already.
        if (body.volume && !filling.holed) {
          const double wanted =
              *body.volume * parts_of(system, curve) / films + beneath;
          height = std::min(wanted / bulge.volume(normal),
                            kMostHeight * bulge.width());
        } else {
          height += beneath / bulge.volume(normal);
        }
        result.push_back(bulge.raise(label, side * height * normal, complex));
        side = -side;
      }
    }
  }
  return result;
}

bool turn_shared_disks(const std::vector<RaisedDisk>& raised,
                       films::FilmComplex& complex) {
  bool turned = false;
  for (const RaisedDisk& disk : raised) {
    int sides = 0;
    int balance = 0;  // of signs: 0 where bodies lie on both sides
    for (const films::ComplexBody& body : complex.bodies) {
      for (const films::BodySide& side : body.sides) {
        if (side.surface == disk.surface) {
          ++sides;
          balance += side.sign;
        }
      }
    }
    if (sides != 2 || balance == 0) {
      continue;
    }
    for (std::size_t k = 0; k < disk.vertices.size(); ++k) {
      complex.mesh.points[disk.vertices[k]] -= 2.0 * disk.moves[k];
    }
    turned = true;
  }
  return turned;
}

}  // namespace meniscus::start
