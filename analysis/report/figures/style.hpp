/// \file The common look of all figures: colours after Okabe and Ito that also differ in lightness,
/// a mark for every colour; and how numbers become layers.
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
inline constexpr std::string_view kFaint = "#8c8c8c";  ///< of single participants
inline constexpr std::string_view kPale = "#b4b4b4";   ///< of their lines, where they are many

/// The colour of the n-th method or other series; colours repeat after six.
[[nodiscard]] std::string series_colour(std::size_t n);
/// The n-th series' filled mark.
[[nodiscard]] Glyph series_glyph(std::size_t n) noexcept;

struct Rgb {
  int red = 0;  ///< 0 to 255, like the others
  int green = 0;
  int blue = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// A colour from white to dark blue: the larger the share, the darker, in colour and in grey.
/// \param share  0 .. 1
[[nodiscard]] Rgb shade_of(double share) noexcept;
/// Black or white, whichever has more contrast.
[[nodiscard]] Rgb ink_on(Rgb ground) noexcept;
/// The contrast of two colours, from 1 to 21. Source: WCAG 2.1, relative luminance.
[[nodiscard]] double contrast(Rgb a, Rgb b) noexcept;
/// "#003e6e"
[[nodiscard]] std::string hexadecimal(Rgb colour);

/// The layer's own colour, or ink.
[[nodiscard]] std::string colour_of(const Layer& layer);
/// A new figure without caption and panels.
[[nodiscard]] Figure figure_named(std::string id, std::string section, bool simulated,
                                  double width_cm = kColumn_cm);

/// An axis in per cent from 0 to 100, with room for whole marks at both ends.
[[nodiscard]] Axis percent_axis(std::string label);
/// An axis of names.
[[nodiscard]] Axis names_axis(std::vector<std::string> names, std::string label = {});
/// A dashed line across the panel, named at its end.
[[nodiscard]] Layer dashed_rule(double height, std::string name);
/// The same at 1 / classes.
[[nodiscard]] Layer chance_rule(int classes);
/// A text beside what it names.
[[nodiscard]] Layer direct_label(double x, double y, std::string text, std::string colour,
                                 Anchor anchor = Anchor::start);

/// A row for a mark with a bar, which has no length without an interval.
[[nodiscard]] Datum bar(double place, double mean, const std::optional<Interval>& interval,
                        double unit = 1.0);

/// A number of a participant.
struct OwnValue {
  double value = 0.0;
  std::string participant{};
};

/// The most dots that `swarm` adds.
inline constexpr std::size_t kMaxDots = 120;
/// Adds a row for each of at most kMaxDots values, evenly chosen by rank, those that would cover
/// each other side by side around x.
/// \param width  that they may take
/// \param near   values so near would cover each other
void swarm(std::vector<Datum>& rows, double x, double width, double near,
           std::vector<OwnValue> values);

/// The sentence, after "SIMULATED participants: " if they are.
[[nodiscard]] std::string stamped(bool simulated, const std::string& sentence);
/// "87.0 % (60.9 to 91.1 %)", or "87.0 %" without an interval
[[nodiscard]] std::string with_interval(double share, const std::optional<Interval>& interval);

}  // namespace touchtrial::analysis
