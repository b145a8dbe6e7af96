/// Features of a case (feature_shapes.h) at one design.
#pragma once

#include <vector>

#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/feature_shapes.h"

namespace meniscus::case_data {

/// Values, or values with their rates where `values` is made for these.
FeatureNumbers numbers_of(const FeatureEntry& feature,
                          const CaseValues& values);

/// The edges of all features, by feature and as feature_shapes() has them.
std::vector<std::vector<curves::CurveShape>> feature_curves(
    const Case& input, const CaseValues& values);

/// Adds a problem for each size that leaves no such solid: directions without
/// length, walls that are no more, holes that meet or leave their face, rims in
/// the wrong place. Afterwards the curves may be used if there is none.
void check_features(const Case& input, const CaseValues& values);

/// The same of the curves that films grow from on a flange: they must lie in
/// its top face. `curves`: all of the case.
void check_feature_rims(const Case& input,
                        const std::vector<curves::Curve>& curves,
                        const CaseValues& values);

}  // namespace meniscus::case_data
