#include "plot_axis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace firstcontact::app {
namespace {

constexpr double kMostSteps = 6.0;

/// The least round number that divides a length into a few steps.
double round_step(double length) {
  const double magnitude = std::pow(10.0, std::floor(std::log10(length / kMostSteps)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (length <= kMostSteps * factor * magnitude) {
      return factor * magnitude;
    }
  }
  return 10.0 * magnitude;
}

}  // namespace

PlotAxis make_axis(double greatest, Unit unit, AxisEnd end) {
  constexpr double kRounding = 1e-9;  // [-]  Error of the quotients, by a step.
  const double length = greatest > 0.0 ? greatest / unit.size : 1.0;
  const double step = round_step(length);
  const double steps = end == AxisEnd::at_tick ? std::ceil(length / step - kRounding)
                                               : std::floor(length / step + kRounding);
  PlotAxis axis{.unit = unit, .end = end == AxisEnd::at_tick ? steps * step : length, .ticks = {}};
  for (int k = 0; k <= static_cast<int>(steps); ++k) {
    axis.ticks.push_back(k * step);
  }
  return axis;
}

std::string plot_title(std::string_view title, double width) {
  constexpr double kWidest = 10.7;  // [px]  Width of a letter, in the mean of capitals.
  const auto is_begin = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  const auto most = static_cast<std::ptrdiff_t>(width / kWidest);
  if (std::ranges::count_if(title, is_begin) <= most) {
    return std::string(title);
  }
  std::size_t end = 0;
  for (std::ptrdiff_t letters = 0; end < title.size(); ++end) {
    letters += is_begin(title[end]) ? 1 : 0;
    if (letters == most) {  // The ellipsis takes its place.
      break;
    }
  }
  return std::string(title.substr(0, end)) + "\u2026";
}

}  // namespace firstcontact::app
