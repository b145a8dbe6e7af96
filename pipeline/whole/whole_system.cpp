#include "pipeline/whole/whole_system.h"

#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/case_wetted.h"

namespace meniscus::whole {

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw InvalidInput(what +
                     " cannot be written with smooth faces where a plane of "
                     "symmetry cuts curves; write it with facets");
}

/// The system with its image in one plane that cuts.
class SystemMirror {
 public:
  /// `number`: of the plane, from 1.
  SystemMirror(const case_data::SymmetryPlane& plane, std::size_t number,
               std::set<std::string> own, films::FilmSystem& system)
      : plane_(plane),
        suffix_(number == 1 ? "/image" : fmt::format("/image_{}", number)),
        own_(std::move(own)),
        system_(system) {}

  void run() {
    for (const curves::Curve& curve : system_.curves) {
      (lies_across(curve) ? across_ : beside_).insert(curve.name);
    }
    mirror_curves();
    mirror_films();
    mirror_caps();
    mirror_bodies();
  }

 private:
  bool lies_across(const curves::Curve& curve) const {
    return !case_data::cut_by(plane_, {curve}).empty();
  }

  /// Of images in several planes each has a name.
  std::string image(const std::string& name) const { return name + suffix_; }

  bool all_beside(const std::vector<std::string>& curves) const {
    return std::all_of(curves.begin(), curves.end(), [&](const auto& name) {
      return beside_.count(name) > 0;
    });
  }

  std::vector<std::string> images(std::vector<std::string> names) const {
    for (std::string& name : names) {
      name = beside_.count(name) > 0 ? image(name) : name;
    }
    return names;
  }

  /// With the images of those beside the plane.
  std::vector<std::string> with_images(std::vector<std::string> names) const {
    for (const std::string& name : images(names)) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
    return names;
  }

  void mirror_curves() {
    const std::vector<curves::Curve> drawn = system_.curves;
    for (const curves::Curve& curve : drawn) {
      if (beside_.count(curve.name) > 0) {
        curves::CurveCopy copy;
        copy.of = std::make_shared<const curves::Curve>(curve);
        copy.mirror = plane_.normal;
        copy.about = plane_.at;
        system_.curves.push_back(
            {image(curve.name), copy, curve.fineness, curve.free, {}});
      }
    }
  }

  void mirror_films() {
    const std::vector<films::FilmSpec> drawn = system_.films;
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      films::FilmSpec other = drawn[k];
      if (all_beside(other.curves)) {
        other.name = image(other.name);
        other.curves = images(other.curves);
        system_.films.push_back(other);
        imaged_.insert(drawn[k].name);
        continue;
      }
      films::FilmSpec& film = system_.films[k];
      film.curves = with_images(film.curves);
      if (film.kind == films::FilmKind::Loft && film.curves.size() != 2) {
        film.kind = films::FilmKind::Branch;
      }
    }
  }

  void mirror_caps() {
    std::erase_if(system_.caps, [&](const films::CapSpec& cap) {
      return own_.count(cap.name) > 0;
    });
    const std::vector<films::CapSpec> drawn = system_.caps;
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      films::CapSpec other = drawn[k];
      if (other.curves().empty()) {
        continue;  // another plane's face
      }
      if (other.wall &&
          with_images(other.curves()).size() > other.curves().size()) {
        refuse(fmt::format("'{}', on which films slide,", other.name));
      }
      if (all_beside(other.curves())) {
        other.name = image(other.name);
        other.curve = image(other.curve);
        other.inner = other.inner.empty() ? "" : image(other.inner);
        other.more = images(other.more);
        system_.caps.push_back(other);
        imaged_.insert(drawn[k].name);
      } else if (beside_.count(other.curve) > 0 ||
                 beside_.count(other.inner) > 0) {
        refuse(fmt::format("'{}', between curves across and beside it,",
                           other.name));
      } else {
        system_.caps[k].more = with_images(other.more);
      }
    }
  }

  void mirror_bodies() {
    const std::vector<films::BodySpec> drawn = system_.bodies;
    for (std::size_t b = 0; b < drawn.size(); ++b) {
      films::BodySpec& body = system_.bodies[b];
      const std::size_t before = body.enclosed_by.size();
      std::erase_if(body.enclosed_by, [&](const std::string& name) {
        return own_.count(name) > 0;
      });
      std::vector<std::string> more;
      for (const std::string& name : body.enclosed_by) {
        if (imaged_.count(name) > 0) {
          more.push_back(image(name));
        }
      }
      if (body.enclosed_by.size() == before) {
        films::BodySpec other = body;  // beside the plane
        other.name = image(other.name);
        for (std::string& name : other.enclosed_by) {
          name = imaged_.count(name) > 0 ? image(name) : name;
        }
        system_.bodies.push_back(other);
        continue;
      }
      body.enclosed_by.insert(body.enclosed_by.end(), more.begin(), more.end());
      if (body.volume) {
        *body.volume *= 2.0;
      }
    }
  }

  const case_data::SymmetryPlane& plane_;
  std::string suffix_;
  std::set<std::string> own_;  // names of the faces in the plane
  films::FilmSystem& system_;
  std::set<std::string> across_, beside_;  // names of curves
  std::set<std::string> imaged_;           // of surfaces
};

}  // namespace

WholeSystem whole_system(const case_data::Case& input,
                         const films::FilmSystem& drawn) {
  for (const case_data::CurveEntry& curve : input.curves) {
    if (case_data::is_cell(input, curve.name)) {
      throw InvalidInput(fmt::format(
          "the film on '{}', which slides on the planes of a cell, cannot be "
          "written with smooth faces; write it with facets",
          curve.name));
    }
  }
  WholeSystem result{drawn, {}};
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    std::set<std::string> own;
    bool cuts = false;
    bool others = false;
    for (const case_data::CapEntry& cap : input.caps) {
      if (cap.symmetry == static_cast<int>(p)) {
        const bool cut = cap.wetted && cap.wetted->cuts;
        cuts = cuts || cut;
        others = others || !cut || !cap.spec.curves().empty();
        own.insert(cap.spec.name);
      }
    }
    if (!cuts) {
      result.mirrors.push_back(p);
      continue;
    }
    if (others) {
      refuse("films or solids that end in it, too,");
    }
    if (!drawn.fields.empty() || !drawn.pressures.empty()) {
      refuse("fields");
    }
    SystemMirror(input.symmetry[p], p + 1, std::move(own), result.system).run();
  }
  return result;
}

}  // namespace meniscus::whole
