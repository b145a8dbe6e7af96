#include "cad/solid/rim_side.h"

#include <utility>

#include "cad/solid/spline.h"

namespace meniscus::solid {

SideDemand demand(const RimSide& side, bool backwards) {
  SideDemand result{side.rim->way(side.from, side.to, side.growing), side.rim,
                    side.from, side.to, side.growing};
  if (backwards) {
    std::swap(result.from, result.to);
    result.growing = !result.growing;
  }
  return result;
}

SplineCurve fit_rim(const RimSide& side, const std::vector<double>& knots,
                    const Brep& brep) {
  constexpr int kPointsPerSpan = 6;
  CurveFit fit;
  fit.knots = knots;
  const RimCurve& curve = side.rim->curve();
  const double start = side.rim->place(side.from);
  const double way = side.rim->way(side.from, side.to, side.growing);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    for (int i = 0; i < kPointsPerSpan && knots[k + 1] > knots[k]; ++i) {
      const double share =
          knots[k] + (knots[k + 1] - knots[k]) * (i + 0.5) / kPointsPerSpan;
      fit.at.push_back(share);
      fit.points.push_back(curve.point(side.growing ? start + share * way
                                                    : start - share * way));
    }
  }
  fit.start = brep.vertices[side.rim->vertex(side.from)];
  fit.end = brep.vertices[side.rim->vertex(side.to)];
  return fit_curve(fit);
}

}  // namespace meniscus::solid
