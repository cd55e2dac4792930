/// @file
/// An axis of a plot, with ticks at round numbers.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "quantity_text.h"

namespace firstcontact::app {

/// An axis from 0 to `end`.
struct PlotAxis {
  Unit unit;
  double end;                 ///< End of the axis, in units.
  std::vector<double> ticks;  ///< In units; 1, 2 or 5 times a power of ten apart.
};

enum class AxisEnd { at_greatest, at_tick };

/// Makes an axis.
///
/// @param greatest  in SI units: the greatest number that must fit; 0 gives an axis to 1
[[nodiscard]] PlotAxis make_axis(double greatest, Unit unit, AxisEnd end);

/// A title that fits into a plot; a title that is too long ends with an ellipsis.
///
/// @param width  [px]  for a bold text of 16 px
[[nodiscard]] std::string plot_title(std::string_view title, double width);

}  // namespace firstcontact::app
