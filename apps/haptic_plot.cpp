#include "haptic_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/core.h>

#include "plot_axis.h"
#include "quantity_text.h"

namespace firstcontact::app {
namespace {

constexpr std::int64_t kColumns = 1200;  // Most columns.
constexpr double kPlotWidth = 900.0;     // [px]
constexpr double kPanel = 130.0;
constexpr double kBetween = 34.0;
constexpr double kLeftOfPanels = 86.0;
constexpr double kRightOfPanels = 20.0;
constexpr double kAbovePanels = 44.0;
constexpr std::array<const char*, kMostTools> kColours{"#1f5fa8", "#c0392b"};

/// One quantity of each column.
struct HapticPanel {
  std::string label;
  std::string note;  // Text behind the unit.
  Unit unit;
  std::size_t curves;
  std::function<double(std::size_t column, std::size_t curve)> value;
};

std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' || c == '<' || c == '>' || static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

/// Draws a panel.
///
/// @param end  [columns]  at the right end of the panel
std::string draw_panel(const HapticPanel& panel, std::size_t columns, double end, double top) {
  double greatest = 0.0;
  for (std::size_t k = 0; k < columns; ++k) {
    for (std::size_t curve = 0; curve < panel.curves; ++curve) {
      greatest = std::max(greatest, panel.value(k, curve));
    }
  }
  const PlotAxis axis = make_axis(1.04 * greatest, panel.unit, AxisEnd::at_tick);
  const double wide = kPlotWidth - kLeftOfPanels - kRightOfPanels;
  const auto y = [&](double value) {
    return top + kPanel * (1.0 - std::min(1.0, value / (axis.end * axis.unit.size)));
  };
  std::string text;
  for (const double tick : axis.ticks) {
    const double at = y(tick * axis.unit.size);
    text += fmt::format(
        "<path d=\"M{} {:.1f}h{}\" stroke=\"#ccd3d8\" stroke-width=\"0.7\"/>"
        "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>\n",
        kLeftOfPanels, at, wide, kLeftOfPanels - 8, at + 4, tick);
  }
  for (std::size_t curve = 0; curve < panel.curves; ++curve) {
    text += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\" points=\"",
                        kColours.at(curve));
    for (std::size_t k = 0; k < columns; ++k) {
      const double x = kLeftOfPanels + wide * std::min(1.0, (static_cast<double>(k) + 0.5) / end);
      text += fmt::format("{:.2f},{:.2f} ", x, y(panel.value(k, curve)));
    }
    text += "\"/>\n";
  }
  text += fmt::format(
      "<path d=\"M{0} {1}v{2}h{3}\" fill=\"none\" stroke=\"#333\"/>"
      "<text x=\"{0}\" y=\"{4}\">{5}{6}{7}</text>\n",
      kLeftOfPanels, top, kPanel, wide, top - 8, panel.label,
      *axis.unit.name == '\0' ? "" : fmt::format(" [{}]", axis.unit.name), plain(panel.note));
  return text;
}

}  // namespace

void HapticPlot::Column::take(const Column& other) {
  const auto greater = [](double a, double b) { return std::max(a, b); };
  std::ranges::transform(force, other.force, force.begin(), greater);
  std::ranges::transform(torque, other.torque, torque.begin(), greater);
  std::ranges::transform(apart, other.apart, apart.begin(), greater);
  contacts = std::max(contacts, other.contacts);
}

HapticPlot::Column& HapticPlot::column_at(std::int64_t time_ns) {
  while (time_ns / column_ns_ >= kColumns) {
    for (std::size_t k = 0; k < columns_.size(); k += 2) {
      columns_[k / 2] = columns_[k];
      if (k + 1 < columns_.size()) {
        columns_[k / 2].take(columns_[k + 1]);
      }
    }
    columns_.resize((columns_.size() + 1) / 2);
    column_ns_ *= 2;
  }
  const auto place = static_cast<std::size_t>(time_ns / column_ns_);
  if (place >= columns_.size()) {
    // Between two ticks the values stay.
    columns_.resize(place, columns_.empty() ? Column{} : columns_.back());
    columns_.emplace_back();
  }
  return columns_[place];
}

void HapticPlot::add(const ForceTick& tick, std::int64_t begin_ns,
                     const std::array<Pose, kMostTools>& god_objects) {
  const std::int64_t time_ns = std::max(tick.time_ns - begin_ns, end_ns_);
  end_ns_ = time_ns;
  Column values;
  for (std::size_t k = 0; k < tools_; ++k) {
    const ToolTick& tool = tick.tools[k];
    values.force[k] = tool.asked.force_D.norm();
    values.torque[k] = tool.asked.torque_D.norm();
    const Eigen::Vector3d p_BC =
        tool.target.rotation.conjugate() * (tool.centre - tool.target.position);
    const Pose& X_WB = god_objects[k];
    values.apart[k] = (tool.centre - X_WB.position - X_WB.rotation * p_BC).norm();
  }
  values.contacts = static_cast<double>(tick.contacts);
  column_at(time_ns).take(values);
}

std::string HapticPlot::draw(std::string_view title, const std::string& undriven) const {
  double farthest = 0.0;
  for (const Column& column : columns_) {
    farthest = std::max({farthest, column.apart[0], column.apart[1]});
  }
  const std::string note = undriven.empty() ? "" : "; " + undriven;
  const std::vector<HapticPanel> panels{
      {"force", note, {"N", 1.0}, tools_, [&](auto k, auto c) { return columns_[k].force[c]; }},
      {"torque", note, {"N m", 1.0}, tools_, [&](auto k, auto c) { return columns_[k].torque[c]; }},
      {"from the device to its god-object", "", length_unit(farthest), tools_,
       [&](auto k, auto c) { return columns_[k].apart[c]; }},
      {"contacts listed", "", {"", 1.0}, 1, [&](auto k, auto) { return columns_[k].contacts; }}};
  const double height =
      kAbovePanels + static_cast<double>(panels.size()) * (kPanel + kBetween) + 40.0;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" "
      "fill=\"#333\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
      "<title>{4}</title>\n"
      "<text x=\"{2}\" y=\"24\" font-size=\"16\" font-weight=\"bold\">{3}</text>\n",
      kPlotWidth, height, kLeftOfPanels,
      plain(plot_title(title, kPlotWidth - kLeftOfPanels - kRightOfPanels)), plain(title));
  const double end = std::max(1.0, static_cast<double>(end_ns_) / static_cast<double>(column_ns_));
  double top = kAbovePanels + 20.0;
  for (const HapticPanel& panel : panels) {
    text += draw_panel(panel, columns_.size(), end, top);
    top += kPanel + kBetween;
  }
  const double duration = end * 1e-9 * static_cast<double>(column_ns_);
  const PlotAxis time = make_axis(duration, time_unit(duration), AxisEnd::at_greatest);
  const double bottom = top - kBetween;
  for (const double tick : time.ticks) {
    const double x =
        kLeftOfPanels + (kPlotWidth - kLeftOfPanels - kRightOfPanels) * tick / time.end;
    text += fmt::format(
        "<path d=\"M{0:.1f} {1}v5\" stroke=\"#333\"/>"
        "<text x=\"{0:.1f}\" y=\"{2}\" text-anchor=\"middle\">{3:.4g}</text>\n",
        x, bottom, bottom + 19.0, tick);
  }
  text += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">time [{}]</text>\n</svg>\n",
                      (kLeftOfPanels + kPlotWidth - kRightOfPanels) / 2.0, bottom + 36.0,
                      time.unit.name);
  return text;
}

}  // namespace firstcontact::app
