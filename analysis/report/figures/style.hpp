/// \file The common style of all figures: Okabe-Ito colours, which also differ in lightness, with a
/// mark for each colour; and layers made from numbers.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/statistics/proportion.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

inline constexpr std::string_view kInk = "#1a1a1a";
inline constexpr std::string_view kFaint = "#8c8c8c";  ///< for single participants
inline constexpr std::string_view kPale = "#b4b4b4";   ///< for lines of many participants

/// The colour of the n-th method or other series; colours repeat after six.
[[nodiscard]] std::string series_colour(std::size_t n);
[[nodiscard]] Glyph series_glyph(std::size_t n) noexcept;

struct Rgb {
  int red = 0;  ///< channels: 0 to 255
  int green = 0;
  int blue = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// A colour from white to dark blue, darker for larger shares, also in grey.
/// \param share  0 .. 1
[[nodiscard]] Rgb shade_of(double share) noexcept;
/// Black or white, whichever has more contrast.
[[nodiscard]] Rgb ink_on(Rgb ground) noexcept;
/// The contrast of two colours, from 1 to 21. Source: WCAG 2.1, relative luminance.
[[nodiscard]] double contrast(Rgb a, Rgb b) noexcept;
/// "#003e6e"
[[nodiscard]] std::string hex_code(Rgb colour);

/// The layer's colour; ink if it has none.
[[nodiscard]] std::string colour_of(const Layer& layer);
/// A figure without caption and panels.
[[nodiscard]] Figure empty_figure(std::string id, std::string section, bool simulated,
                                  double width_cm = kColumn_cm);

/// An axis from 0 to 100 per cent, with room for marks at both ends.
[[nodiscard]] Axis percent_axis(std::string label);
[[nodiscard]] Axis names_axis(std::vector<std::string> names, std::string label = {});
/// A dashed line across the panel, named at its end.
[[nodiscard]] Layer dashed_rule(double height, std::string name);
/// A dashed rule at 100 / classes, named "chance".
[[nodiscard]] Layer chance_rule(int classes);
/// Moves the text of the panel's first layer, a rule, beyond the axis, where no mark covers it.
void put_label_outside(Panel& panel);
/// Makes participants' dots darker and larger if they are few.
void emphasise_few(Layer& dots);
/// A label beside its data.
[[nodiscard]] Layer direct_label(double x, double y, std::string text, std::string colour,
                                 Anchor anchor = Anchor::start);

/// A row for a mark with a bar; the bar has no length without an interval.
[[nodiscard]] Datum bar(double place, double mean, const std::optional<Interval>& interval,
                        double unit = 1.0);

/// A participant's number.
struct ParticipantValue {
  double value = 0.0;
  std::string participant{};
};

/// The maximum number of dots of `swarm`.
inline constexpr std::size_t kMaxDots = 120;
/// Adds a row for each value, or for kMaxDots of them, evenly chosen by rank. Dots that would
/// overlap are placed side by side around x.
/// \param width  the maximum width of a row of dots
/// \param overlap  values that differ by no more than this overlap
void swarm(std::vector<Datum>& rows, double x, double width, double overlap,
           std::vector<ParticipantValue> values);

/// The sentence, with "SIMULATED participants: " before it if they are simulated.
[[nodiscard]] std::string stamped(bool simulated, const std::string& sentence);
/// "87.0% (60.9 to 91.1%)", or "87.0%" without an interval
[[nodiscard]] std::string share_with_interval(double share,
                                              const std::optional<Interval>& interval);

}  // namespace touchtrial::analysis
