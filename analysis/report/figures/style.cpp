#include "analysis/report/figures/style.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::array<std::string_view, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                      "#cc79a7", "#56b4e9", "#1a1a1a"};
constexpr std::array kGlyphs = {Glyph::disc, Glyph::square, Glyph::triangle, Glyph::diamond,
                                Glyph::down};

double linear(int channel) noexcept {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double luminance(Rgb colour) noexcept {
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

constexpr Rgb kBlack{0, 0, 0};
constexpr Rgb kWhite{255, 255, 255};

}  // namespace

std::string series_colour(std::size_t n) {
  return std::string(kColours[n % kColours.size()]);
}

Glyph series_glyph(std::size_t n) noexcept {
  return kGlyphs[n % kGlyphs.size()];
}

Rgb shade_of(double share) noexcept {
  const auto mixed = [share](double from, double to) {
    return static_cast<int>(std::lround(from + (to - from) * share));
  };
  return {mixed(255.0, 0.0), mixed(255.0, 62.0), mixed(255.0, 110.0)};
}

double contrast(Rgb a, Rgb b) noexcept {
  const double first = luminance(a) + 0.05;
  const double second = luminance(b) + 0.05;
  return std::max(first, second) / std::min(first, second);
}

Rgb ink_on(Rgb ground) noexcept {
  return contrast(kWhite, ground) > contrast(kBlack, ground) ? kWhite : kBlack;
}

std::string hex_code(Rgb colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::string colour_of(const Layer& layer) {
  return layer.colour.empty() ? std::string(kInk) : layer.colour;
}

Figure empty_figure(std::string id, std::string section, bool simulated, double width_cm) {
  return {.id = std::move(id),
          .caption = {},
          .alt = {},
          .section = std::move(section),
          .width_cm = width_cm,
          .simulated = simulated};
}

Axis percent_axis(std::string label) {
  return {.label = std::move(label), .low = -2.0, .high = 103.0, .step = 20.0};
}

Axis names_axis(std::vector<std::string> names, std::string label) {
  return {.label = std::move(label), .names = std::move(names)};
}

Layer dashed_rule(double height, std::string name) {
  Layer rule{.kind = LayerKind::rule, .name = name, .dashed = true};
  rule.rows = {{.y = height, .text = std::move(name)}};
  return rule;
}

Layer chance_rule(int classes) {
  return dashed_rule(100.0 / std::max(classes, 1), "chance");
}

void put_label_outside(Panel& panel) {
  constexpr double kRoom_cm = 1.2;
  panel.layers.front().anchor = Anchor::start;
  panel.room_right_cm = kRoom_cm;
}

void emphasise_few(Layer& dots) {
  constexpr std::size_t kFew = 60;
  if (dots.rows.size() > kFew) return;
  dots.colour = kFaint;
  dots.size = 1.1;
}

Layer direct_label(double x, double y, std::string text, std::string colour, Anchor anchor) {
  Layer label{.kind = LayerKind::label, .colour = std::move(colour), .anchor = anchor};
  label.rows = {{.x = x, .y = y, .text = std::move(text)}};
  return label;
}

Datum bar(double place, double mean, const std::optional<Interval>& interval, double unit) {
  const Interval ends = interval.value_or(Interval{mean, mean});
  return {.x = place, .y = unit * mean, .low = unit * ends.low, .high = unit * ends.high};
}

void swarm(std::vector<Datum>& rows, double x, double width, double overlap,
           std::vector<ParticipantValue> values) {
  constexpr double kStepOfWidth = 0.12;
  std::ranges::stable_sort(values, {}, &ParticipantValue::value);
  std::vector<const ParticipantValue*> selected;
  const std::size_t count = std::min(values.size(), kMaxDots);
  for (std::size_t i = 0; i < count; ++i) {
    selected.push_back(&values[count < 2 ? i : i * (values.size() - 1) / (count - 1)]);
  }
  for (std::size_t first = 0; first < selected.size();) {
    std::size_t end = first;
    while (end < selected.size() && selected[end]->value - selected[first]->value <= overlap) ++end;
    const auto dots = static_cast<double>(end - first);
    const double step = width * std::min(kStepOfWidth, 1.0 / dots);
    for (std::size_t i = first; i < end; ++i) {
      const double place = static_cast<double>(i - first) - 0.5 * (dots - 1.0);
      rows.push_back(
          {.x = x + step * place, .y = selected[i]->value, .text = selected[i]->participant});
    }
    first = end;
  }
}

std::string stamped(bool simulated, const std::string& sentence) {
  return (simulated ? "SIMULATED participants: " : "") + sentence;
}

std::string share_with_interval(double share, const std::optional<Interval>& interval) {
  if (!interval) return fmt::format("{:.1f}%", 100.0 * share);
  return fmt::format("{:.1f}% ({:.1f} to {:.1f}%)", 100.0 * share, 100.0 * interval->low,
                     100.0 * interval->high);
}

}  // namespace touchtrial::analysis
