/// Unit systems of a case, and values written with a unit ("71.7 GPa").
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace meniscus {

enum class Dimension {
  None,
  Length,
  Angle,
  Force,
  Pressure,  // also Young's modulus, stress
  Volume,
  Area,
  Mass,
  Density,
  Tension,  // force per length
  Energy,   // force times length
  Time
};
const char* name_of(Dimension dimension);

/// One consistent system: nothing in the engine converts, so mm-N-MPa means
/// mass in tonne.
struct UnitSystem {
  std::string name;    // "mm-N-MPa", "m-N-Pa", "in-lbf-psi"
  std::string length;  // "mm", "m", "in"
  std::string force;
  std::string pressure;
  std::string mass;

  /// The unit of a quantity in this system, for people: "t/mm3".
  std::string unit_of(Dimension dimension) const;
};

/// The system of that name; nothing for an unknown one.
std::optional<UnitSystem> unit_system(std::string_view name);

/// True for exactly: number, spaces, unit ("20 ft").
bool looks_like_quantity(std::string_view text);

/// The value of such a text in `system`, rounded to 15 digits so that decimal
/// conversions are exact ("71.7 GPa" is 71700 MPa). `dimension`: the one that
/// it must have; when left out, any but None ("20 kN" for a named number that
/// serves wherever a force stands). Throws InvalidInput for an unknown unit,
/// one of another dimension, a value that is not finite, and when the unit
/// database cannot be found. Safe from several threads, in any locale.
double parse_quantity(std::string_view text, std::optional<Dimension> dimension,
                      const UnitSystem& system);

}  // namespace meniscus
