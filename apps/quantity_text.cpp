#include "quantity_text.h"

#include <array>
#include <cmath>
#include <span>
#include <string>

#include <fmt/core.h>

namespace firstcontact::app {
namespace {

constexpr std::array<Unit, 5> kLengths{
    {{"km", 1e3}, {"m", 1.0}, {"mm", 1e-3}, {"µm", 1e-6}, {"nm", 1e-9}}};
constexpr std::array<Unit, 4> kTimes{{{"s", 1.0}, {"ms", 1e-3}, {"µs", 1e-6}, {"ns", 1e-9}}};
constexpr std::array<Unit, 4> kImpulses{
    {{"kN s", 1e3}, {"N s", 1.0}, {"mN s", 1e-3}, {"µN s", 1e-6}}};

/// The largest unit of which there is at least one; the base unit for 0, the smallest for less.
Unit fitting(std::span<const Unit> units, double quantity, Unit base) {
  const double size = std::abs(quantity);
  if (!(size > 0.0)) {
    return base;
  }
  for (const Unit& unit : units) {
    if (size >= unit.size) {
      return unit;
    }
  }
  return units.back();
}

/// A quantity rounded to the four digits of in_unit(), so that 999.99 µm are 1 mm.
double rounded(double quantity) {
  return std::isfinite(quantity) ? std::stod(fmt::format("{:.3e}", quantity)) : quantity;
}

std::string in_unit(double quantity, Unit unit) {
  constexpr double kShown = 1e-3;  // Less than this, in the smallest unit, is rounding.
  if (quantity > 0.0 && quantity < kShown * unit.size) {
    return fmt::format("below {:g} {}", kShown, unit.name);
  }
  return fmt::format("{:.4g} {}", quantity / unit.size, unit.name);
}

}  // namespace

Unit length_unit(double metres) { return fitting(kLengths, metres, kLengths[1]); }

Unit time_unit(double seconds) { return fitting(kTimes, seconds, kTimes[0]); }

std::string length_text(double metres) { return in_unit(metres, length_unit(rounded(metres))); }

std::string lower_bound_text(double metres) {
  if (!(metres > 0.0) || !std::isfinite(metres)) {
    return length_text(metres);
  }
  const Unit unit = length_unit(metres);
  const double quantity = metres / unit.size;
  const std::string nearest = in_unit(metres, unit);
  const double shown = std::stod(fmt::format("{:.4g}", quantity));
  if (!(shown > quantity)) {
    return nearest;
  }
  // The nearest text is above by half of the last of its four digits, or less.
  const double digit = std::pow(10.0, std::floor(std::log10(shown)) - 3.0);
  return in_unit((shown - digit) * unit.size, unit);
}

std::string apart_text(double metres) {
  return std::isfinite(metres) ? lower_bound_text(metres) + " or more, proven"
                               : "no pair to keep apart";
}

std::string time_text(double seconds) { return in_unit(seconds, time_unit(rounded(seconds))); }

std::string impulse_text(double newton_seconds) {
  return in_unit(newton_seconds, fitting(kImpulses, rounded(newton_seconds), kImpulses[1]));
}

std::string speed_text(double metres_per_second) { return length_text(metres_per_second) + "/s"; }

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string plain_number(double number) {
  return std::abs(number) >= 100.0 ? fmt::format("{:.0f}", number) : fmt::format("{:.3g}", number);
}

std::string direction_text(const Eigen::Vector3d& direction) {
  // Without a sign on numbers that round to zero.
  const Eigen::Vector3d rounded = (direction * 1e3).array().round() / 1e3 + 0.0;
  return fmt::format("({:6.3f}, {:6.3f}, {:6.3f})", rounded.x(), rounded.y(), rounded.z());
}

}  // namespace firstcontact::app
