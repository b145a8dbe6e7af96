#include "core/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <locale.h>
#include <memory>
#include <mutex>

#include <fmt/format.h>
#include <udunits2.h>

#include "core/error.h"

namespace meniscus {

namespace {

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;
using Converter = std::unique_ptr<cv_converter, decltype(&cv_free)>;

constexpr std::size_t kLongestUnit = 64;
constexpr std::array<Dimension, 12> kDimensions = {
    Dimension::None,    Dimension::Length,   Dimension::Angle,
    Dimension::Force,   Dimension::Pressure, Dimension::Volume,
    Dimension::Area,    Dimension::Mass,     Dimension::Density,
    Dimension::Tension, Dimension::Energy,   Dimension::Time};

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

/// The unit that UDUNITS understands for a quantity of the system.
std::string definition(const UnitSystem& system, Dimension dimension) {
  const std::string& l = system.length;
  const std::string& f = system.force;
  switch (dimension) {
    case Dimension::None:
      return "1";
    case Dimension::Length:
      return l;
    case Dimension::Angle:
      return "radian";
    case Dimension::Force:
      return f;
    case Dimension::Pressure:
      return f + "/" + l + "^2";
    case Dimension::Volume:
      return l + "^3";
    case Dimension::Area:
      return l + "^2";
    case Dimension::Mass:
      return f + " s^2/" + l;
    case Dimension::Density:
      return f + " s^2/" + l + "^4";
    case Dimension::Tension:
      return f + "/" + l;
    case Dimension::Energy:
      return f + " " + l;
    case Dimension::Time:
      return "s";
  }
  return "1";
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
    for (const Dimension each : kDimensions) {
      Unit to = parse(definition(system, each));
      if ((dimension ? each == *dimension : each != Dimension::None) && to &&
          ut_are_convertible(from.get(), to.get()) != 0) {
        return to;
      }
    }
    return {nullptr, &ut_free};
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

std::string no_such_dimension(std::string_view text,
                              std::optional<Dimension> dimension,
                              const UnitSystem& system) {
  if (!dimension) {
    return fmt::format(
        "'{}' is no quantity of a case; there are lengths, angles, forces, "
        "pressures, volumes, areas, masses, densities, tensions, energies and "
        "times",
        text);
  }
  return fmt::format("'{}' is no {}; try {}", text, name_of(*dimension),
                     advised_unit(dimension, system));
}

}  // namespace

const char* name_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::None:
      return "number";
    case Dimension::Length:
      return "length";
    case Dimension::Angle:
      return "angle";
    case Dimension::Force:
      return "force";
    case Dimension::Pressure:
      return "pressure";
    case Dimension::Volume:
      return "volume";
    case Dimension::Area:
      return "area";
    case Dimension::Mass:
      return "mass";
    case Dimension::Density:
      return "density";
    case Dimension::Tension:
      return "tension (force per length)";
    case Dimension::Energy:
      return "energy";
    case Dimension::Time:
      return "time";
  }
  return "number";
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
  }
  return "";
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

double parse_quantity(std::string_view text, std::optional<Dimension> dimension,
                      const UnitSystem& system) {
  const std::optional<Parts> parts = split(text);
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
  const PlainLocale plain;
  Database& database = Database::get();
  const std::lock_guard<std::mutex> guard(database.lock());
  const Unit from = database.parse(parts->unit);
  if (!from) {
    throw InvalidInput(fmt::format("unknown unit '{}' in '{}'; try {}",
                                   parts->unit, text,
                                   advised_unit(dimension, system)));
  }
  const Unit to = database.target(from, dimension, system);
  if (!to) {
    throw InvalidInput(no_such_dimension(text, dimension, system));
  }
  const Converter converter(ut_get_converter(from.get(), to.get()), &cv_free);
  const double value = converter == nullptr
                           ? std::nan("")
                           : cv_convert_double(converter.get(), parts->number);
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
