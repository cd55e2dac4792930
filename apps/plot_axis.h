/// @file
/// An axis of a plot, with ticks at round numbers.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "quantity_text.h"

namespace firstcontact::app {

/// Runs from 0 to `end`.
struct PlotAxis {
  Unit unit;
  double end;                 ///< In units.
  std::vector<double> ticks;  ///< In units; 1, 2 or 5 times a power of ten apart.
};

enum class AxisEnd { at_greatest, at_tick };

/// @param greatest  in SI units: what must fit; 0 gives an axis to 1
[[nodiscard]] PlotAxis make_axis(double greatest, Unit unit, AxisEnd end);

/// A title that fits into a plot; what is too long ends with an ellipsis.
///
/// @param width  [px]  of a bold text of 16 px
[[nodiscard]] std::string plot_title(std::string_view title, double width);

}  // namespace firstcontact::app
