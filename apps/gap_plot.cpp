#include "gap_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/sample_gap.h>

#include "plot_axis.h"
#include "print_result.h"
#include "quantity_text.h"

namespace firstcontact::app {
namespace {

constexpr double kWidth = 800.0;  // [px]
constexpr double kHeight = 400.0;
constexpr double kLeft = 76.0;
constexpr double kRight = 24.0;
constexpr double kTop = 58.0;
constexpr double kBottom = 56.0;

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

double greatest_distance(const std::vector<GapSample>& curve) {
  double greatest = 0.0;
  for (const GapSample& sample : curve) {
    greatest = std::isfinite(sample.distance) ? std::max(greatest, sample.distance) : greatest;
  }
  return greatest;
}

/// [m]  The least proven distance over the whole step; 0 where the closest approach was not asked
/// for.
double least_proven(const SceneResult& result) {
  return result.closest ? result.pairs[*result.closest].closest->lower_bound : 0.0;
}

class Plot {
 public:
  explicit Plot(const SceneAnswer& answer)
      : answer_(answer),
        duration_(answer.loaded.scene.duration),
        time_(make_axis(duration_, time_unit(duration_), AxisEnd::at_greatest)),
        gap_(make_axis(1.04 * greatest_distance(answer.curve),
                       length_unit(greatest_distance(answer.curve)), AxisEnd::at_tick)) {}

  std::string draw(std::string_view title) {
    print(
        R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" )"
        R"(font-family="Helvetica, Arial, sans-serif" font-size="13" fill="#333">)",
        kWidth, kHeight);
    print(R"(<rect width="{}" height="{}" fill="#fff"/>)", kWidth, kHeight);
    print("<title>{}</title>", escaped(title));
    text(kLeft, 24, "start", plot_title(title, kWidth - kLeft - kRight),
         R"( font-size="16" font-weight="bold")");
    text(kLeft, 44, "start", describe_verdict(answer_), R"( fill="#555")");
    regions();
    lower_bound();
    axes();
    curve();
    samples();
    lines();
    text_ += "</svg>\n";
    return text_;
  }

 private:
  template <typename... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    text_ += fmt::format(format, std::forward<T>(values)...);
    text_ += '\n';
  }

  void text(double x, double y, const char* anchor, std::string_view what,
            std::string_view more = "") {
    print(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}"{}>{}</text>)", x, y, anchor, more,
          escaped(what));
  }

  [[nodiscard]] static double x(double t) { return kLeft + t * (kWidth - kLeft - kRight); }

  [[nodiscard]] double y(double distance) const {
    const double share = std::min(distance / (gap_.end * gap_.unit.size), 1.0);
    return kHeight - kBottom - share * (kHeight - kTop - kBottom);
  }

  void region(double from, double to, const char* colour) {
    if (to > from) {
      print(R"(<rect x="{:.2f}" y="{:.1f}" width="{:.2f}" height="{:.1f}" fill="{}"/>)", x(from),
            kTop, x(to) - x(from), kHeight - kTop - kBottom, colour);
    }
  }

  /// Draws the region that is proven free, and the one after it.
  void regions() {
    region(0.0, answer_.result.t, "#eaf5ec");
    region(answer_.result.t, 1.0, "#f6efec");
  }

  /// Draws the proven lower bound of the gap.
  void lower_bound() {
    const std::vector<GapPoint> bound =
        gap_lower_bound(answer_.loaded, answer_.result, answer_.curve);
    if (bound.empty()) {
      return;
    }
    text_ += R"(<polygon fill="#cfe6d4" points=")";
    text_ += fmt::format("{:.2f},{:.2f} ", x(bound.front().t), y(0.0));
    for (const GapPoint& point : bound) {
      text_ += fmt::format("{:.2f},{:.2f} ", x(point.t), y(point.distance));
    }
    text_ += fmt::format("{:.2f},{:.2f}", x(bound.back().t), y(0.0));
    text_ += "\"/>\n";
  }

  void axes() {
    for (const double tick : gap_.ticks) {
      const double at = y(tick * gap_.unit.size);
      print(R"(<path d="M{} {:.1f}H{}" stroke="#ccd3d8" stroke-width="0.7"/>)", kLeft, at,
            kWidth - kRight);
      text(kLeft - 8, at + 4, "end", fmt::format("{:.4g}", tick));
    }
    for (const double tick : time_.ticks) {
      const double at = x(tick / time_.end);
      print(R"(<path d="M{:.1f} {}v5" stroke="#333"/>)", at, kHeight - kBottom);
      text(at, kHeight - kBottom + 20, "middle", fmt::format("{:.4g}", tick));
    }
    print(R"(<path d="M{} {}V{}H{}" fill="none" stroke="#333"/>)", kLeft, kTop, kHeight - kBottom,
          kWidth - kRight);
    text((kLeft + kWidth - kRight) / 2, kHeight - 14, "middle",
         fmt::format("time [{}]", time_.unit.name));
    const double middle = (kTop + kHeight - kBottom) / 2;
    text(20, middle, "middle", fmt::format("gap [{}]", gap_.unit.name),
         fmt::format(R"_( transform="rotate(-90 20 {:.1f})")_", middle));
  }

  void curve() {
    text_ +=
        R"(<polyline fill="none" stroke="#1f5fa8" stroke-width="2" stroke-linejoin="round" points=")";
    for (const GapSample& sample : answer_.curve) {
      if (std::isfinite(sample.distance)) {
        text_ += fmt::format("{:.2f},{:.2f} ", x(sample.t), y(sample.distance));
      }
    }
    text_ += "\"/>\n";
  }

  void samples() {
    for (const GapSample& sample : answer_.samples) {
      if (std::isfinite(sample.distance)) {
        print(R"(<circle cx="{:.2f}" cy="{:.2f}" r="3.5" fill="#fff" stroke="#1f5fa8"/>)",
              x(sample.t), y(sample.distance));
      }
    }
    if (answer_.sampling) {
      text(kWidth - kRight, 44, "end",
           fmt::format("\u25cb {:g} samples a second", answer_.sampling->rate), R"( fill="#555")");
    }
  }

  void horizontal(double distance, const std::string& label) {
    const double at = y(distance);
    const bool low = at + 20 > kHeight - kBottom;
    print(R"(<path d="M{} {:.1f}H{}" stroke="#2e7d32" stroke-dasharray="6 4"/>)", kLeft, at,
          kWidth - kRight);
    text(kWidth - kRight - 6, low ? at - 8 : at + 16, "end", label, R"( fill="#2e7d32")");
  }

  void lines() {
    const SceneResult& result = answer_.result;
    const double margin = answer_.loaded.scene.options.margin;
    if (margin > 0.0) {
      horizontal(margin, "margin " + length_text(margin));
    } else if (const double bound = least_proven(result); bound > 0.0) {
      horizontal(bound, "proven: never below " + length_text(bound));
    }
    if (result.verdict != Verdict::free) {
      const bool left = result.t > 0.6;
      print(R"(<path d="M{0:.2f} {1}V{2}" stroke="#c0392b" stroke-width="1.5"/>)", x(result.t),
            kTop, kHeight - kBottom);
      text(x(result.t) + (left ? -6 : 6), kTop + 16, left ? "end" : "start",
           (result.verdict == Verdict::undecided ? "undecided from " : "first contact at ") +
               time_text(result.t * duration_),
           R"( fill="#c0392b")");
    }
  }

  const SceneAnswer& answer_;
  double duration_;
  PlotAxis time_;
  PlotAxis gap_;
  std::string text_;
};

}  // namespace

std::string gap_plot(std::string_view title, const SceneAnswer& answer) {
  return Plot(answer).draw(title);
}

}  // namespace firstcontact::app
