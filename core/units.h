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
  Time,
  Acceleration,  // also force per mass
  Rate,          // angle per time
  Inertia,       // mass times length^2
  Frequency,     // cycles per time
  Foundation     // force per length and area
};
const char* name_of(Dimension dimension);

/// A dimension as powers of length, force and time; angles are numbers.
struct UnitPowers {
  double length = 0.0;
  double force = 0.0;
  double time = 0.0;
  /// To the accuracy of powers such as 1 / 3.
  bool operator==(const UnitPowers& other) const;
};
UnitPowers powers_of(Dimension dimension);
/// "a force", or "a quantity of length^2 time^-1" where it has no name.
std::string described(const UnitPowers& powers);

/// How a quantity is shown to people: its number times `factor`, in `unit`.
struct ShownUnit {
  double factor = 1.0;
  std::string unit = {};
  /// "0.485 kg" of 4.85e-4 t, with `digits` significant digits.
  std::string text(double value, int digits = 6) const;
};

/// One consistent system: nothing in the engine converts, so mm-N-MPa means
/// mass in tonne.
struct UnitSystem {
  std::string name;    // "mm-N-MPa", "m-N-Pa", "in-lbf-psi"
  std::string length;  // "mm", "m", "in"
  std::string force;
  std::string pressure;
  std::string mass;

  /// The unit of a quantity in this system: "t/mm3".
  std::string unit_of(Dimension dimension) const;

  /// For people: masses in kg or lb where the system counts in tonnes or
  /// slinches; all else as unit_of().
  ShownUnit shown(Dimension dimension) const;
};

/// The system of that name; nothing for an unknown one.
std::optional<UnitSystem> unit_system(std::string_view name);

/// True for exactly: number, spaces, unit ("20 ft").
bool looks_like_quantity(std::string_view text);

/// The value of such a text in `system`, rounded to 15 digits so that decimal
/// conversions are exact ("71.7 GPa" is 71700 MPa). `dimension`: the one that
/// it must have; when left out, any of length, force and time ("20 kN" for a
/// named number that serves wherever a force stands, "3 N/mm2/s"). Throws
/// InvalidInput for an unknown unit, one of another dimension, a value that is
/// not finite, and when the unit database cannot be found. Safe from several
/// threads, in any locale.
double parse_quantity(std::string_view text, std::optional<Dimension> dimension,
                      const UnitSystem& system);

/// What such a text measures: any powers of length, force and time, whatever
/// the system. Throws as parse_quantity() does.
UnitPowers quantity_powers(std::string_view text);

}  // namespace meniscus
