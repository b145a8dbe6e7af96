#include "core/error.h"

namespace meniscus {

const char* name_of(FailureKind kind) {
  switch (kind) {
    case FailureKind::FilmUnstable:
      return "film_unstable";
    case FailureKind::FilmPinched:
      return "film_pinched";
    case FailureKind::FilmNotFound:
      return "film_not_found";
    case FailureKind::FilmRejoins:
      return "film_rejoins";
    case FailureKind::SurfaceInvalid:
      return "surface_invalid";
    case FailureKind::MeshingFailed:
      return "meshing_failed";
    case FailureKind::ElementsInverted:
      return "elements_inverted";
    case FailureKind::SolverFailed:
      return "solver_failed";
    case FailureKind::NotANumber:
      return "not_a_number";
  }
  return "unknown";
}

std::string what_prevents(const std::function<void()>& make) {
  try {
    make();
  } catch (const MeshError& error) {
    return error.what();
  } catch (const InvalidInput& error) {
    return error.what();
  } catch (const SolverError& error) {
    return error.what();
  }
  return {};
}

}  // namespace meniscus
