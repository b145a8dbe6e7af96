#include "core/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <locale.h>
#include <memory>
#include <mutex>

#include <fmt/format.h>
#include <udunits2.h>

#include "core/count_text.h"
#include "core/error.h"

namespace meniscus {

namespace {

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;
using Converter = std::unique_ptr<cv_converter, decltype(&cv_free)>;

constexpr std::size_t kLongestUnit = 64;

// In the order of Dimension.
struct DimensionRow {
  Dimension dimension;
  const char* name;
  UnitPowers powers;
};
constexpr std::array<DimensionRow, 17> kDimensions = {{
    {Dimension::None, "number", {}},
    {Dimension::Length, "length", {.length = 1}},
    {Dimension::Angle, "angle", {}},
    {Dimension::Force, "force", {.force = 1}},
    {Dimension::Pressure, "pressure", {.length = -2, .force = 1}},
    {Dimension::Volume, "volume", {.length = 3}},
    {Dimension::Area, "area", {.length = 2}},
    {Dimension::Mass, "mass", {.length = -1, .force = 1, .time = 2}},
    {Dimension::Density, "density", {.length = -4, .force = 1, .time = 2}},
    {Dimension::Tension,
     "tension (force per length)",
     {.length = -1, .force = 1}},
    {Dimension::Energy, "energy", {.length = 1, .force = 1}},
    {Dimension::Time, "time", {.time = 1}},
    {Dimension::Acceleration, "acceleration", {.length = 1, .time = -2}},
    {Dimension::Rate, "rate (angle per time)", {.time = -1}},
    {Dimension::Inertia,
     "moment of inertia",
     {.length = 1, .force = 1, .time = 2}},
    {Dimension::Frequency, "frequency", {.time = -1}},
    {Dimension::Foundation, "stiffness per area", {.length = -3, .force = 1}},
}};
const DimensionRow& row_of(Dimension dimension) {
  return kDimensions[static_cast<std::size_t>(dimension)];
}

/// UDUNITS reads numbers in units by the thread's locale, where the decimal
/// sign may be a comma; this holds the thread in the C locale.
class PlainLocale {
 public:
  PlainLocale()
      : plain_(newlocale(LC_ALL_MASK, "C", nullptr)),
        before_(plain_ == nullptr ? nullptr : uselocale(plain_)) {}
  ~PlainLocale() {
    if (plain_ != nullptr) {
      uselocale(before_);
      freelocale(plain_);
    }
  }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  locale_t plain_;
  locale_t before_;
};

/// A unit as UDUNITS' base units make it up.
struct BasePowers {
  double metre = 0.0;
  double kilogram = 0.0;
  double second = 0.0;
  double angle = 0.0;
  bool plain = true;  // of no other, with its zero at zero
};

void add_power(BasePowers& powers, const ut_unit* unit, int power) {
  const char* symbol = ut_get_symbol(unit, UT_ASCII);
  const std::string_view name = symbol == nullptr ? "" : symbol;
  if (name == "m") {
    powers.metre += power;
  } else if (name == "kg") {
    powers.kilogram += power;
  } else if (name == "s") {
    powers.second += power;
  } else if (name == "rad") {
    powers.angle += power;
  } else {
    powers.plain = false;
  }
}

ut_status visit_basic(const ut_unit* unit, void* found) {
  add_power(*static_cast<BasePowers*>(found), unit, 1);
  return UT_SUCCESS;
}

ut_status visit_product(const ut_unit* /*unit*/, int count,
                        const ut_unit* const* basics, const int* powers,
                        void* found) {
  for (int k = 0; k < count; ++k) {
    add_power(*static_cast<BasePowers*>(found), basics[k], powers[k]);
  }
  return UT_SUCCESS;
}

ut_status visit_galilean(const ut_unit* unit, double scale, const ut_unit* of,
                         double origin, void* found);

// Of times since a date, and of decibels.
ut_status visit_other(const ut_unit* /*unit*/, const ut_unit* /*of*/,
                      double /*origin*/, void* found) {
  static_cast<BasePowers*>(found)->plain = false;
  return UT_SUCCESS;
}
ut_status visit_logarithmic(const ut_unit* unit, double /*base*/,
                            const ut_unit* of, void* found) {
  return visit_other(unit, of, 0.0, found);
}

constexpr ut_visitor kVisitor = {visit_basic, visit_product, visit_galilean,
                                 visit_other, visit_logarithmic};

ut_status visit_galilean(const ut_unit* /*unit*/, double /*scale*/,
                         const ut_unit* of, double origin, void* found) {
  if (origin != 0.0) {
    static_cast<BasePowers*>(found)->plain = false;
  }
  return ut_accept_visitor(of, &kVisitor, found);
}

/// Nothing for units of temperature, current and the like.
std::optional<BasePowers> base_powers(const ut_unit* unit) {
  BasePowers found;
  if (ut_accept_visitor(unit, &kVisitor, &found) != UT_SUCCESS ||
      !found.plain) {
    return std::nullopt;
  }
  return found;
}

UnitPowers powers_in_force(const BasePowers& base) {
  // kg = N s^2 / m
  return {.length = base.metre - base.kilogram,
          .force = base.kilogram,
          .time = base.second + 2.0 * base.kilogram};
}

/// The unit that UDUNITS understands for these powers in the system.
std::string definition(const UnitSystem& system, const UnitPowers& powers) {
  std::string text;
  const auto add = [&](const std::string& unit, double power) {
    for (double k = 0.0; k < std::abs(power); ++k) {
      text += fmt::format("{}{}", power < 0.0 ? "/" : ".", unit);
    }
  };
  add(system.length, powers.length);
  add(system.force, powers.force);
  add("s", powers.time);
  return "1" + text;
}

/// UDUNITS' database, read once. The library keeps its status in a global, so
/// callers hold the lock.
class Database {
 public:
  static Database& get() {
    static Database database;
    return database;
  }
  Unit parse(const std::string& text) const {
    return {ut_parse(system_, text.c_str(), UT_UTF8), &ut_free};
  }
  /// The system's unit that `from` converts to; none for no such one.
  Unit target(const Unit& from, std::optional<Dimension> dimension,
              const UnitSystem& system) const {
    const std::optional<BasePowers> base = base_powers(from.get());
    if (!base) {
      return {nullptr, &ut_free};
    }
    const UnitPowers powers = powers_in_force(*base);
    const bool counts_turns = dimension == Dimension::Frequency;
    if (powers == powers_of(Dimension::Rate) &&
        (base->angle == 0.0) != counts_turns) {
      return {nullptr, &ut_free};  // turns or radians? "50 Hz" does not say
    }
    if (dimension && !(powers == powers_of(*dimension))) {
      return {nullptr, &ut_free};
    }
    return parse(definition(system, powers));
  }
  std::mutex& lock() { return lock_; }

 private:
  Database() {
    ut_set_error_message_handler(&ut_ignore);
    system_ = ut_read_xml(nullptr);
    if (system_ == nullptr) {
      throw InvalidInput(
          "values with units cannot be read: the unit database of UDUNITS is "
          "missing; install the package libudunits2-data or write plain "
          "numbers");
    }
    // Expressions call it so, UDUNITS does not.
    const Unit degree = parse("degree");
    ut_map_name_to_unit("deg", UT_ASCII, degree.get());
  }
  std::mutex lock_;
  ut_system* system_ = nullptr;  // lives as long as the program
};

struct Parts {
  double number = 0.0;
  std::string unit;
};

std::optional<Parts> split(std::string_view text) {
  Parts parts;
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') {
    ++begin;
  }
  const auto [after, error] = std::from_chars(begin, end, parts.number);
  if (error != std::errc() || after == end || *after != ' ') {
    return std::nullopt;
  }
  const char* unit = after;
  while (unit != end && *unit == ' ') {
    ++unit;
  }
  const auto first = static_cast<unsigned char>(unit == end ? ' ' : *unit);
  const bool letter = (first >= 'a' && first <= 'z') ||
                      (first >= 'A' && first <= 'Z') || first == '%' ||
                      first >= 0x80;  // degree and micro signs
  if (!letter) {
    return std::nullopt;
  }
  while (end != unit && end[-1] == ' ') {
    --end;
  }
  parts.unit.assign(unit, end);
  return parts;
}

/// What a value of that dimension may stand in.
std::string advised_unit(std::optional<Dimension> dimension,
                         const UnitSystem& system) {
  if (!dimension) {
    return fmt::format("a number, in units of {}", system.name);
  }
  return "a value in " + (*dimension == Dimension::None
                              ? std::string("plain numbers")
                              : system.unit_of(*dimension));
}

std::string no_such_dimension(std::string_view text, const ut_unit* found,
                              std::optional<Dimension> dimension,
                              const UnitSystem& system) {
  if (!dimension) {
    return fmt::format(
        "'{}' is no quantity of a case; there are powers of length, force, "
        "mass and time, angles, and angles per time (rad/s, rpm)",
        text);
  }
  const std::optional<BasePowers> base = base_powers(found);
  const UnitPowers powers =
      base ? powers_in_force(*base) : powers_of(*dimension);
  const std::string but =
      powers == powers_of(*dimension) ? "" : " but " + described(powers);
  return fmt::format("'{}' is no {}{}; try {}", text, name_of(*dimension), but,
                     advised_unit(dimension, system));
}

}  // namespace

const char* name_of(Dimension dimension) { return row_of(dimension).name; }

bool UnitPowers::operator==(const UnitPowers& other) const {
  constexpr double kRounding = 1e-9;
  return std::abs(length - other.length) < kRounding &&
         std::abs(force - other.force) < kRounding &&
         std::abs(time - other.time) < kRounding;
}

UnitPowers powers_of(Dimension dimension) { return row_of(dimension).powers; }

std::string described(const UnitPowers& powers) {
  for (const DimensionRow& row : kDimensions) {
    if (row.powers == powers) {
      const bool vowel =
          std::string_view("aeiou").find(row.name[0]) != std::string_view::npos;
      return fmt::format("{} {}", vowel ? "an" : "a", row.name);
    }
  }
  std::string text;
  const auto add = [&](const char* base, double power) {
    if (power != 0.0) {
      text += fmt::format(" {}{}", base,
                          power == 1.0 ? "" : fmt::format("^{:g}", power));
    }
  };
  add("length", powers.length);
  add("force", powers.force);
  add("time", powers.time);
  return "a quantity of" + text;
}

std::string ShownUnit::text(double value, int digits) const {
  return quantity_text(factor * value, unit, digits);
}

std::string UnitSystem::unit_of(Dimension dimension) const {
  switch (dimension) {
    case Dimension::None:
      return "";
    case Dimension::Length:
      return length;
    case Dimension::Angle:
      return "rad";
    case Dimension::Force:
      return force;
    case Dimension::Pressure:
      return pressure;
    case Dimension::Volume:
      return length + "3";
    case Dimension::Area:
      return length + "2";
    case Dimension::Mass:
      return mass;
    case Dimension::Density:
      return mass + "/" + length + "3";
    case Dimension::Tension:
      return force + "/" + length;
    case Dimension::Energy:
      return force + " " + length;
    case Dimension::Time:
      return "s";
    case Dimension::Acceleration:
      return length + "/s2";
    case Dimension::Rate:
      return "rad/s";
    case Dimension::Inertia:
      return mass + " " + length + "2";
    case Dimension::Frequency:
      return "Hz";
    case Dimension::Foundation:
      return force + "/" + length + "3";
  }
  return "";
}

ShownUnit UnitSystem::shown(Dimension dimension) const {
  constexpr double kKilograms = 1e3;  // in a tonne
  constexpr double kPounds = 386.0885826771654;
  const std::string times =
      dimension == Dimension::Inertia ? " " + length + "2" : "";
  if (dimension == Dimension::Mass || dimension == Dimension::Inertia) {
    if (mass == "t") {
      return {kKilograms, "kg" + times};
    }
    if (mass == "lbf s2/in") {
      return {kPounds, "lb" + times};
    }
  }
  return {1.0, unit_of(dimension)};
}

std::optional<UnitSystem> unit_system(std::string_view name) {
  if (name == "mm-N-MPa") {
    return UnitSystem{"mm-N-MPa", "mm", "N", "MPa", "t"};
  }
  if (name == "m-N-Pa") {
    return UnitSystem{"m-N-Pa", "m", "N", "Pa", "kg"};
  }
  if (name == "in-lbf-psi") {
    return UnitSystem{"in-lbf-psi", "in", "lbf", "psi", "lbf s2/in"};
  }
  return std::nullopt;
}

bool looks_like_quantity(std::string_view text) {
  return split(text).has_value();
}

namespace {

/// The parts of a text that looks like a quantity.
Parts parts_of(std::string_view text) {
  std::optional<Parts> parts = split(text);
  if (!parts) {
    throw InvalidInput(
        fmt::format("'{}' is not a number, a space and a unit", text));
  }
  if (parts->unit.size() > kLongestUnit || !std::isfinite(parts->number)) {
    throw InvalidInput(
        fmt::format("'{}' is no finite number with a unit of at most {} "
                    "characters",
                    text.substr(0, kLongestUnit), kLongestUnit));
  }
  return *std::move(parts);
}

/// "0.4 N/mm / ring^2": what is not a unit and looks like an expression.
bool has_operators(std::string_view unit) {
  return unit.find_first_of("*^()+") != std::string_view::npos ||
         unit.find(" / ") != std::string_view::npos ||
         unit.find(" - ") != std::string_view::npos;
}

/// Of a text's unit; the caller holds the database's lock.
Unit unit_in(const Database& database, const Parts& parts,
             std::string_view text, std::optional<Dimension> dimension,
             const UnitSystem& system) {
  Unit unit = database.parse(parts.unit);
  if (!unit) {
    throw InvalidInput(fmt::format(
        "unknown unit '{}' in '{}'; {}", parts.unit, text,
        has_operators(parts.unit)
            ? "an expression holds no units: give the quantity a name in "
              "[parameters] and write that here"
            : "try " + advised_unit(dimension, system)));
  }
  return unit;
}

}  // namespace

UnitPowers quantity_powers(std::string_view text) {
  const Parts parts = parts_of(text);
  const UnitSystem system = *unit_system("mm-N-MPa");
  const PlainLocale plain;
  Database& database = Database::get();
  const std::lock_guard<std::mutex> guard(database.lock());
  const Unit unit = unit_in(database, parts, text, std::nullopt, system);
  if (!database.target(unit, std::nullopt, system)) {
    throw InvalidInput(
        no_such_dimension(text, unit.get(), std::nullopt, system));
  }
  return powers_in_force(*base_powers(unit.get()));
}

double parse_quantity(std::string_view text, std::optional<Dimension> dimension,
                      const UnitSystem& system) {
  const Parts parts = parts_of(text);
  const PlainLocale plain;
  Database& database = Database::get();
  const std::lock_guard<std::mutex> guard(database.lock());
  const Unit from = unit_in(database, parts, text, dimension, system);
  const Unit to = database.target(from, dimension, system);
  if (!to) {
    throw InvalidInput(no_such_dimension(text, from.get(), dimension, system));
  }
  const Converter converter(ut_get_converter(from.get(), to.get()), &cv_free);
  const double value = converter == nullptr
                           ? std::nan("")
                           : cv_convert_double(converter.get(), parts.number);
  if (!std::isfinite(value)) {
    throw InvalidInput(
        fmt::format("'{}' is too large for the units {}", text, system.name));
  }
  const std::string rounded = fmt::format("{:.15g}", value);
  double result = 0.0;
  std::from_chars(rounded.data(), rounded.data() + rounded.size(), result);
  return result;
}

}  // namespace meniscus
