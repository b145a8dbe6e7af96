#include "evolve/energy/pole_field.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "evolve/energy/facet_terms.h"
#include "evolve/energy/flux_jet.h"

namespace meniscus::energy {

namespace {

constexpr int kLanes = 4;
constexpr int kNumbers = 5;  // of a pole
// A pole is near a facet at less than so many of the facet's radii, squared,
// far at more than so many and more than so many cores: 7, 3 and 1 places.
constexpr double kNear = 3.0 * 3.0;
constexpr double kFar = 12.0 * 12.0;
constexpr double kFarCores = 6.0 * 6.0;

using Lanes = Eigen::Array<double, kLanes, 1>;

Eigen::Index padded(std::size_t poles) {
  return static_cast<Eigen::Index>((poles + kLanes - 1) / kLanes * kLanes);
}

/// Four poles seen from a place, with their kernels by the squared distance,
///   g = a / (3 e) s^(-3/2), g' and g'', s = r^2 + e (e: core2).
struct FourPoles {
  Lanes x, y, z;  // place - pole
  Lanes e, a;
  Lanes s, root;  // s and s^(-1/2)

  FourPoles(const double* numbers, Eigen::Index count, Eigen::Index first,
            const Vec3& at) {
    const auto part = [&](int k) {
      return Eigen::Map<const Lanes>(numbers + k * count + first);
    };
    x = at.x() - part(0);
    y = at.y() - part(1);
    z = at.z() - part(2);
    a = part(3);
    e = part(4);
    s = x * x + y * y + z * z + e;
    root = 1.0 / s.sqrt();
  }
  Lanes kernel() const { return a * root / (3.0 * e * s); }
};

Eigen::Index pole_count(Numbers numbers) {
  return static_cast<Eigen::Index>(numbers.size()) / kNumbers;
}

VectorX packed(const std::vector<films::Pole>& poles, double core2) {
  const Eigen::Index count = padded(poles.size());
  VectorX numbers = VectorX::Zero(kNumbers * count);
  numbers.tail(count).setConstant(core2);
  for (std::size_t k = 0; k < poles.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    for (int m = 0; m < 3; ++m) {
      numbers[m * count + at] = poles[k].at[m];
    }
    numbers[3 * count + at] = poles[k].strength;
    numbers[4 * count + at] = poles[k].core2;
  }
  return numbers;
}

/// F of some of the poles, by fours.
FieldJet sum_of(Numbers numbers, std::span<const int> fours, const Vec3& at,
                JetOrder order) {
  const Eigen::Index count = pole_count(numbers);
  Lanes fx = Lanes::Zero(), fy = Lanes::Zero(), fz = Lanes::Zero();
  Lanes g_sum = Lanes::Zero();
  Lanes hx = Lanes::Zero(), hy = Lanes::Zero(), hz = Lanes::Zero();
  Lanes xx = Lanes::Zero(), xy = Lanes::Zero(), xz = Lanes::Zero(),
        yy = Lanes::Zero(), yz = Lanes::Zero(), zz = Lanes::Zero();
  Lanes xxx = Lanes::Zero(), xxy = Lanes::Zero(), xxz = Lanes::Zero(),
        xyy = Lanes::Zero(), xyz = Lanes::Zero(), xzz = Lanes::Zero(),
        yyy = Lanes::Zero(), yyz = Lanes::Zero(), yzz = Lanes::Zero(),
        zzz = Lanes::Zero();
  for (const int four : fours) {
    const FourPoles p(numbers.data(), count, kLanes * four, at);
    const Lanes g = p.kernel();
    fx += g * p.x;
    fy += g * p.y;
    fz += g * p.z;
    if (order == JetOrder::Value) {
      continue;
    }
    const Lanes over = 1.0 / p.s;
    const Lanes g1 = -3.0 * g * over;  // 2 g'
    g_sum += g;
    const Lanes gx = g1 * p.x;
    const Lanes gy = g1 * p.y;
    const Lanes gz = g1 * p.z;
    xx += gx * p.x;
    xy += gx * p.y;
    xz += gx * p.z;
    yy += gy * p.y;
    yz += gy * p.z;
    zz += gz * p.z;
    if (order == JetOrder::Gradient) {
      continue;
    }
    hx += gx;
    hy += gy;
    hz += gz;
    const Lanes g2 = -5.0 * over;  // 4 g'' / (2 g')
    const Lanes kx = g2 * gx;
    const Lanes ky = g2 * gy;
    const Lanes kz = g2 * gz;
    xxx += kx * p.x * p.x;
    xxy += kx * p.x * p.y;
    xxz += kx * p.x * p.z;
    xyy += kx * p.y * p.y;
    xyz += kx * p.y * p.z;
    xzz += kx * p.z * p.z;
    yyy += ky * p.y * p.y;
    yyz += ky * p.y * p.z;
    yzz += ky * p.z * p.z;
    zzz += kz * p.z * p.z;
  }
  FieldJet jet;
  jet.value = {fx.sum(), fy.sum(), fz.sum()};
  if (order == JetOrder::Value) {
    return jet;
  }
  const double g = g_sum.sum();
  jet.slope << xx.sum() + g, xy.sum(), xz.sum(), xy.sum(), yy.sum() + g,
      yz.sum(), xz.sum(), yz.sum(), zz.sum() + g;
  if (order == JetOrder::Gradient) {
    return jet;
  }
  // d2F_m/dx_j dx_k = 2g' (m=j: d_k, m=k: d_j, j=k: d_m) + 4g'' d_m d_j d_k.
  jet.bend[0] << xxx.sum(), xxy.sum(), xxz.sum(), xxy.sum(), xyy.sum(),
      xyz.sum(), xxz.sum(), xyz.sum(), xzz.sum();
  jet.bend[1] << xxy.sum(), xyy.sum(), xyz.sum(), xyy.sum(), yyy.sum(),
      yyz.sum(), xyz.sum(), yyz.sum(), yzz.sum();
  jet.bend[2] << xxz.sum(), xyz.sum(), xzz.sum(), xyz.sum(), yyz.sum(),
      yzz.sum(), xzz.sum(), yzz.sum(), zzz.sum();
  const Vec3 h(hx.sum(), hy.sum(), hz.sum());
  for (int m = 0; m < 3; ++m) {
    jet.bend[m] += h[m] * Eigen::Matrix3d::Identity();
    jet.bend[m].row(m) += h.transpose();
    jet.bend[m].col(m) += h;
  }
  return jet;
}

/// Derivatives of u . F + v . (dF/dx) w by the numbers of four poles, added.
void add_four(Numbers numbers, Eigen::Index k, const Vec3& at, const Vec3& u,
              const Vec3& v, const Vec3& w, VectorX& sum) {
  // u.F = g u.d,  v.(dF/dx)w = g v.w + 2 g' (v.d)(d.w).
  const Eigen::Index count = pole_count(numbers);
  const FourPoles p(numbers.data(), count, k, at);
  const Lanes g = p.kernel();
  const Lanes g1 = -1.5 * g / p.s;
  const Lanes g2 = -2.5 * g1 / p.s;
  const Lanes ud = u.x() * p.x + u.y() * p.y + u.z() * p.z;
  const Lanes vd = v.x() * p.x + v.y() * p.y + v.z() * p.z;
  const Lanes wd = w.x() * p.x + w.y() * p.y + w.z() * p.z;
  const double vw = v.dot(w);
  // By d, with the sign of the pole's own place.
  const Lanes along = 2.0 * g1 * (ud + vw) + 4.0 * g2 * vd * wd;
  const Lanes of_v = 2.0 * g1 * wd;
  const Lanes of_w = 2.0 * g1 * vd;
  const std::array<const Lanes*, 3> d = {&p.x, &p.y, &p.z};
  for (int m = 0; m < 3; ++m) {
    Eigen::Map<Lanes>(sum.data() + m * count + k) -=
        along * *d[m] + g * u[m] + of_v * v[m] + of_w * w[m];
  }
  // By the strength: g / a, and where a is 0 the same kernel.
  const Lanes unit = p.root / (3.0 * p.e * p.s);
  const Lanes unit1 = -1.5 * unit / p.s;
  Eigen::Map<Lanes>(sum.data() + 3 * count + k) +=
      unit * (ud + vw) + 2.0 * unit1 * vd * wd;
  // By e: of g it is g' - g / e, of g' likewise g'' - g' / e.
  Eigen::Map<Lanes>(sum.data() + 4 * count + k) +=
      (g1 - g / p.e) * (ud + vw) + 2.0 * (g2 - g1 / p.e) * vd * wd;
}

/// Adds how fast F and dF/dx change at a place, of four poles.
void add_four_rates(Numbers numbers, Numbers rates, Eigen::Index first,
                    const Vec3& at, FieldJet& jet) {
  const Eigen::Index count = pole_count(numbers);
  for (Eigen::Index k = first; k < first + kLanes; ++k) {
    const auto number = [&](int m) { return numbers[m * count + k]; };
    const auto rate = [&](int m) { return rates[m * count + k]; };
    const Vec3 d = at - Vec3(number(0), number(1), number(2));
    const Vec3 d_rate = -Vec3(rate(0), rate(1), rate(2));
    const double e = number(4);
    const double s = d.squaredNorm() + e;
    const double unit = 1.0 / (3.0 * e * s * std::sqrt(s));
    const double s_rate = 2.0 * d.dot(d_rate) + rate(4);
    const double g = number(3) * unit;
    const double g1 = -1.5 * g / s;
    const double g_rate = rate(3) * unit + g1 * s_rate - g / e * rate(4);
    const double g1_rate = -1.5 * (g_rate / s - g / (s * s) * s_rate);
    jet.value += g_rate * d + g * d_rate;
    jet.slope += g_rate * Eigen::Matrix3d::Identity() +
                 2.0 * g1_rate * d * d.transpose() +
                 2.0 * g1 * (d_rate * d.transpose() + d * d_rate.transpose());
  }
}

/// Rules of a facet, from near poles to far ones.
constexpr int kRules = 3;

std::span<const QuadraturePoint> rule_of(int rule) {
  return rule == 0   ? std::span<const QuadraturePoint>(facet_rule())
         : rule == 1 ? std::span<const QuadraturePoint>(three_points())
                     : std::span<const QuadraturePoint>(middle_rule());
}

class PoleTerm : public FilmTerm {
 public:
  PoleTerm(const SurfaceMesh& mesh, const std::vector<films::Pole>& poles,
           const std::vector<Element>& elements)
      : rules_of_(mesh.facets.size(), -1) {
    starts_.push_back(0);
    for (const Element& e : elements) {
      int& rules = rules_of_[e.facet];
      if (rules >= 0) {
        continue;  // between two bodies
      }
      rules = static_cast<int>(starts_.size()) - 1;
      const Corners c = corners_of(mesh.points, mesh.facets[e.facet]);
      const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
      double size2 = 0.0;
      for (const Vec3& corner : c) {
        size2 = std::max(size2, (corner - middle).squaredNorm());
      }
      // The nearest of four decides.
      std::array<std::vector<int>, kRules> fours;
      for (std::size_t first = 0; first < poles.size(); first += kLanes) {
        int rule = kRules - 1;
        for (std::size_t k = first; k < std::min(first + kLanes, poles.size());
             ++k) {
          const double square = (poles[k].at - middle).squaredNorm();
          rule = std::min(rule, rule_for(square, poles[k].core2, size2));
        }
        fours[rule].push_back(static_cast<int>(first / kLanes));
      }
      for (const std::vector<int>& of_rule : fours) {
        fours_.insert(fours_.end(), of_rule.begin(), of_rule.end());
        starts_.push_back(static_cast<std::ptrdiff_t>(fours_.size()));
      }
    }
  }

  FacetJet jet(const Element& element, const Corners& c, JetOrder order,
               Numbers numbers) const override {
    FacetJet sum;
    over_rules(element, [&](int rule, std::span<const int> fours) {
      add_flux(
          rule_of(rule), element.sign, c, order,
          [&](const Vec3& at, JetOrder n) {
            return sum_of(numbers, fours, at, n);
          },
          sum);
    });
    return sum;
  }

  bool has_numbers() const override { return true; }

  void add_by_numbers(const Element& element, const Corners& c,
                      const Corners& motion, double factor, Numbers numbers,
                      VectorX& sum) const override {
    const NormalJet n(c);
    Vec3 turn = Vec3::Zero();  // of N in the motion
    for (int i = 0; i < 3; ++i) {
      turn += n.slope[i] * motion[i];
    }
    over_places(element, [&](const QuadraturePoint& q, int four) {
      const double w = 0.5 * factor * element.sign * q.weight;
      add_four(numbers, kLanes * four, q.at(c), w * turn, w * n.normal,
               q.at(motion), sum);
    });
  }

  void add_value_by_numbers(const Element& element, const Corners& c,
                            double factor, Numbers numbers,
                            VectorX& sum) const override {
    const NormalJet n(c);
    over_places(element, [&](const QuadraturePoint& q, int four) {
      const double w = 0.5 * factor * element.sign * q.weight;
      add_four(numbers, kLanes * four, q.at(c), w * n.normal, Vec3::Zero(),
               Vec3::Zero(), sum);
    });
  }

  Vector9 gradient_rate(const Element& element, const Corners& c,
                        Numbers numbers, Numbers rates) const override {
    const NormalJet n(c);
    Vector9 sum = Vector9::Zero();
    over_places(element, [&](const QuadraturePoint& q, int four) {
      const double w = 0.5 * element.sign * q.weight;
      FieldJet f;
      add_four_rates(numbers, rates, kLanes * four, q.at(c), f);
      const Vec3 pull = f.slope.transpose() * n.normal;
      for (int i = 0; i < 3; ++i) {
        sum.segment<3>(3 * i) +=
            w * (q.weight_of[i] * pull + n.slope[i].transpose() * f.value);
      }
    });
    return sum;
  }

 private:
  static int rule_for(double square, double core2, double size2) {
    const double soft = square + core2;
    return soft < kNear * size2                                ? 0
           : square < kFarCores * core2 || soft < kFar * size2 ? 1
                                                               : 2;
  }

  /// each(rule, fours of poles) where there are some.
  template <class Each>
  void over_rules(const Element& element, const Each& each) const {
    const std::ptrdiff_t* start = &starts_[rules_of_[element.facet]];
    for (int rule = 0; rule < kRules; ++rule, ++start) {
      if (start[0] < start[1]) {
        each(rule, std::span<const int>(fours_.data() + start[0],
                                        fours_.data() + start[1]));
      }
    }
  }

  /// each(quadrature point, four of poles).
  template <class Each>
  void over_places(const Element& element, const Each& each) const {
    over_rules(element, [&](int rule, std::span<const int> fours) {
      for (const int four : fours) {
        for (const QuadraturePoint& q : rule_of(rule)) {
          each(q, four);
        }
      }
    });
  }

  std::vector<int> rules_of_;           // per facet: into starts_; -1: none
  std::vector<std::ptrdiff_t> starts_;  // of its rules, into fours_
  std::vector<int> fours_;              // of poles
};

}  // namespace

VectorX pole_numbers(const std::vector<films::Pole>& poles) {
  return packed(poles, 1.0);
}

VectorX pole_rate_numbers(const std::vector<films::Pole>& rates) {
  return packed(rates, 0.0);
}

FieldJet pole_field(Numbers numbers, const Vec3& at, JetOrder order) {
  std::vector<int> all(pole_count(numbers) / kLanes);
  std::iota(all.begin(), all.end(), 0);
  return sum_of(numbers, all, at, order);
}

std::unique_ptr<FilmTerm> pole_term(
    const SurfaceMesh& mesh, const std::vector<films::Pole>& poles,
    const std::vector<FilmTerm::Element>& elements) {
  return std::make_unique<PoleTerm>(mesh, poles, elements);
}

}  // namespace meniscus::energy
