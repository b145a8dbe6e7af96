/// Exceptions for what the caller did wrong or the machine refused, and
/// `Failure` for a design that cannot be evaluated, which is an answer and not
/// an error (the optimizer steps back from it).
///
/// A message says what was broken, the value found, where (file:line of the
/// case, surface name, facet ids, position) and what to try.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace meniscus {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The input (case file, option, argument of a public function) is wrong.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file or folder cannot be read or written.
class IoError : public Error {
 public:
  using Error::Error;
};

/// A surface or a tetrahedral mesh breaks a condition that a stage needs.
class MeshError : public Error {
 public:
  using Error::Error;
};

/// A linear system or a model cannot be solved (too weak supports, memory).
class SolverError : public Error {
 public:
  using Error::Error;
};

/// The user asked to stop (Ctrl-C, termination signal, time limit).
class Interrupted : public Error {
 public:
  using Error::Error;
};

/// What `make` ends with: the message of its MeshError, InvalidInput or
/// SolverError, empty where it was done. For what an answer can do without, as
/// a model of other edges, whatever keeps it from being made (no film, no mesh,
/// more memory than there is). Lets other errors pass, Interrupted too.
std::string what_prevents(const std::function<void()>& make);

/// Why a design cannot be evaluated.
enum class FailureKind {
  FilmUnstable,      // equilibrium found, but the Hessian has negative index
  FilmPinched,       // a neck closes or has closed
  FilmNotFound,      // no equilibrium of this topology found
  FilmRejoins,       // lines where films meet run together, or a film between
                     // them shrinks away: films join in another way there
  SurfaceInvalid,    // the closed surface crosses itself or is not closed, or
                     // a fillet has no room on it
  MeshingFailed,     // the tetrahedral mesher found no mesh or a poor one
  ElementsInverted,  // mesh motion inverted an element
  SolverFailed,      // elasticity did not converge or is singular
  NotANumber         // an expression or a response is not finite
};

/// Stable name of a kind, as written in results and in the study database.
const char* name_of(FailureKind kind);

struct Failure {
  FailureKind kind = FailureKind::FilmNotFound;
  std::string message;  // what, where (position, surface), what would help
};

}  // namespace meniscus
