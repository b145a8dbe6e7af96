/// Rims of one plane face must lie within each other, or beside, as at the
/// initial design.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "pipeline/case_data/case_curves.h"

namespace meniscus::case_data {

namespace {

constexpr int kAround = 64;  // places on a curve

/// How two closed curves of one plane that do not cross lie.
enum class Nesting { Beside, Within, Around };

Points places_on(const curves::CurveShape& shape) {
  std::vector<double> t;
  for (int k = 0; k < kAround; ++k) {
    t.push_back(static_cast<double>(k) / kAround);
  }
  return curves::points_at(shape, t);
}

/// Does the loop wind around the point, both in a plane?
bool winds_around(const Points& loop, const Vec3& at) {
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    area += (loop[k] - at).cross(loop[(k + 1) % loop.size()] - at);
  }
  double turned = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 from = loop[k] - at;
    const Vec3 to = loop[(k + 1) % loop.size()] - at;
    turned += std::atan2(area.normalized().dot(from.cross(to)), from.dot(to));
  }
  return std::abs(turned) > EIGEN_PI;
}

Nesting nesting_of(const curves::CurveShape& one,
                   const curves::CurveShape& other) {
  const Points a = places_on(one);
  const Points b = places_on(other);
  if (winds_around(b, a[0])) {
    return Nesting::Within;
  }
  return winds_around(a, b[0]) ? Nesting::Around : Nesting::Beside;
}

class NestingCheck {
 public:
  NestingCheck(const Case& input, const std::vector<curves::Curve>& initial,
               const std::vector<curves::Curve>& now, const VectorX& design,
               std::vector<std::string>& problems)
      : input_(input),
        initial_(initial),
        now_(now),
        design_(design),
        problems_(problems) {}

  void run(const films::CapSpec& cap) {
    for (std::size_t i = 0; i < cap.more.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        compare(cap, index_of(cap.more[j]), index_of(cap.more[i]));
      }
    }
  }

 private:
  std::size_t index_of(const std::string& curve) const {
    const auto at =
        std::find_if(now_.begin(), now_.end(),
                     [&](const curves::Curve& c) { return c.name == curve; });
    return static_cast<std::size_t>(at - now_.begin());
  }

  void compare(const films::CapSpec& cap, std::size_t a, std::size_t b) {
    if (a == now_.size() || b == now_.size()) {
      return;
    }
    const Nesting found = nesting_of(now_[a].shape, now_[b].shape);
    if (found == nesting_of(initial_[a].shape, initial_[b].shape)) {
      return;
    }
    const auto& [inner, outer] =
        found == Nesting::Around ? std::pair(b, a) : std::pair(a, b);
    problems_.push_back(fmt::format(
        "{}: curves '{}' and '{}', rims of '{}', have merged on the way from "
        "the initial design: '{}' lies {} '{}' at {}; keep them apart",
        place(input_, input_.curves[b].line), now_[a].name, now_[b].name,
        cap.name, now_[inner].name,
        found == Nesting::Beside ? "beside" : "within", now_[outer].name,
        design_text(input_, design_)));
  }

  const Case& input_;
  const std::vector<curves::Curve>& initial_;
  const std::vector<curves::Curve>& now_;
  const VectorX& design_;
  std::vector<std::string>& problems_;
};

}  // namespace

void check_nesting(const Case& input, const films::FilmSystem& system,
                   const VectorX& design, std::vector<std::string>& problems) {
  const VectorX first = initial_design(input);
  const bool may_nest = std::any_of(
      system.caps.begin(), system.caps.end(),
      [](const films::CapSpec& cap) { return cap.more.size() > 1; });
  if (!may_nest || design == first) {
    return;
  }
  std::vector<std::string> of_first;
  const std::vector<curves::Curve> initial =
      curves_of(input, CaseValues(input, first, of_first));
  if (!of_first.empty()) {
    return;  // told there
  }
  NestingCheck check(input, initial, system.curves, design, problems);
  for (const films::CapSpec& cap : system.caps) {
    check.run(cap);
  }
}

}  // namespace meniscus::case_data
