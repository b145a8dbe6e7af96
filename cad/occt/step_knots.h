/// Internal to step_shape and exact_faces: knots as OpenCASCADE has them.
#pragma once

#include <vector>

#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>

namespace meniscus::occt {

/// Each value once, with how often it stands.
struct Knots {
  TColStd_Array1OfReal values;
  TColStd_Array1OfInteger multiplicities;
};

Knots to_knots(const std::vector<double>& knots);

}  // namespace meniscus::occt
