#include "app/readings/plot.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

Extent extent_of(const std::vector<PlotLine>& lines, Extent at_least) {
  for (const PlotLine& line : lines) {
    for (const Extent& value : line.values) {
      if (value.is_empty()) continue;
      at_least.add(value.least);
      at_least.add(value.greatest);
    }
  }
  return at_least;
}

/// The smallest number of the form 1, 2 or 5 times a power of ten that is not below `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= step * (1.0 - 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

/// The area of a plot's lines, and the map from values to it.
struct Frame {
  ImVec2 least;     ///< top left
  ImVec2 greatest;  ///< bottom right
  PlotScale scale;
  float density = 1.0F;

  [[nodiscard]] float y_of(double value) const {
    const PlotScale& s = scale;
    const double share = s.logarithmic ? std::log(std::max(value, s.least) / s.least) /
                                             std::log(s.greatest / s.least)
                                       : (value - s.least) / (s.greatest - s.least);
    return greatest.y - static_cast<float>(std::clamp(share, 0.0, 1.0)) * (greatest.y - least.y);
  }
  [[nodiscard]] float x_of(std::size_t index, std::size_t count) const {
    const float share = (static_cast<float>(index) + 0.5F) / static_cast<float>(count);
    return least.x + share * (greatest.x - least.x);
  }
};

std::vector<double> ticks_of(const PlotScale& scale) {
  std::vector<double> ticks;
  if (scale.logarithmic) {
    for (double tick = scale.least; tick <= scale.greatest * 1.01; tick *= scale.step) {
      ticks.push_back(tick);
    }
    return ticks;
  }
  const auto count = static_cast<int>(std::lround((scale.greatest - scale.least) / scale.step));
  for (int i = 0; i <= count; ++i) ticks.push_back(scale.least + i * scale.step);
  return ticks;
}

std::string label_of(double value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-9 ? 0.0 : value);
}

void draw_value_axis(ImDrawList& list, const Frame& frame) {
  for (const double tick : ticks_of(frame.scale)) {
    const float y = frame.y_of(tick);
    list.AddLine({frame.least.x, y}, {frame.greatest.x, y}, kPale);
    const std::string label = label_of(tick);
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    list.AddText({frame.least.x - size.x - 6.0F * frame.density, y - size.y / 2.0F}, kGrey,
                 label.c_str());
  }
}

void draw_time_axis(ImDrawList& list, const Frame& frame, double span_s, bool labels) {
  const int seconds = static_cast<int>(span_s);
  for (int back = 0; back <= seconds; ++back) {
    const float share = static_cast<float>(back / span_s);
    const float x = frame.greatest.x - share * (frame.greatest.x - frame.least.x);
    list.AddLine({x, frame.least.y}, {x, frame.greatest.y}, kPale);
    if (!labels) continue;
    const std::string label = back == 0 ? "now" : fmt::format("-{} s", back);
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    list.AddText({x - size.x / 2.0F, frame.greatest.y + 3.0F * frame.density}, kGrey,
                 label.c_str());
  }
}

/// The middle of each extent as a line, and the extents as a band.
void draw_line(ImDrawList& list, const Frame& frame, const PlotLine& line) {
  const ImU32 band = (line.colour & 0x00FFFFFFU) | 0x50000000U;
  const auto middle = [&](std::size_t i) {
    const Extent& value = line.values[i];
    const float y = (frame.y_of(value.least) + frame.y_of(value.greatest)) / 2.0F;
    return ImVec2(frame.x_of(i, line.values.size()), y);
  };
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    const Extent& value = line.values[i];
    if (value.is_empty()) continue;
    const float x = frame.x_of(i, line.values.size());
    list.AddLine({x, frame.y_of(value.least)}, {x, frame.y_of(value.greatest)}, band,
                 2.0F * frame.density);
    if (i == 0 || line.values[i - 1].is_empty()) continue;
    list.AddLine(middle(i - 1), middle(i), line.colour, 2.0F * frame.density);
  }
}

/// The names of the lines with samples of their colours, right-aligned above the plot.
void draw_legend(ImDrawList& list, const Plot& plot, const Frame& frame, float top) {
  const float gap = 8.0F * frame.density;
  const float height = ImGui::GetTextLineHeight();
  float right = frame.greatest.x;
  for (auto line = plot.lines.rbegin(); line != plot.lines.rend(); ++line) {
    const float wide = ImGui::CalcTextSize(line->name.c_str()).x;
    list.AddText({right - wide, top}, kBlack, line->name.c_str());
    const float end = right - wide - gap;
    list.AddLine({end - 2.0F * gap, top + height / 2.0F}, {end, top + height / 2.0F}, line->colour,
                 3.0F * frame.density);
    right = end - 4.0F * gap;
  }
}

}  // namespace

PlotScale scale_for(const std::vector<PlotLine>& lines, Extent at_least, int ticks) {
  const Extent all = extent_of(lines, at_least);
  const double step = round_step(std::max(all.greatest - all.least, 1e-6) / ticks);
  return {step * std::floor(all.least / step + 1e-9), step * std::ceil(all.greatest / step - 1e-9),
          step, false};
}

PlotScale decades_for(const std::vector<PlotLine>& lines, Extent at_least) {
  const Extent all = extent_of(lines, at_least);
  const double least = std::max(all.least, at_least.least);
  return {std::pow(10.0, std::floor(std::log10(least) + 1e-9)),
          std::pow(10.0, std::ceil(std::log10(all.greatest) - 1e-9)), 10.0, true};
}

void draw_plot(const Plot& plot, float width, float height, float density) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line_height = ImGui::GetTextLineHeight();
  const float below = plot.time_labels ? line_height + 8.0F * density : 8.0F * density;
  const Frame frame{{at.x + 64.0F * density, at.y + line_height + 8.0F * density},
                    {at.x + width - 20.0F * density, at.y + height - below},
                    plot.scale,
                    density};
  list.AddText(at, kBlack, plot.title.c_str());
  draw_time_axis(list, frame, plot.span_s, plot.time_labels);
  draw_value_axis(list, frame);
  list.PushClipRect(frame.least, frame.greatest, true);
  for (const PlotLine& line : plot.lines) draw_line(list, frame, line);
  list.PopClipRect();
  list.AddRect(frame.least, frame.greatest, kGrey);
  draw_legend(list, plot, frame, at.y);
  ImGui::Dummy({width, height});
}

}  // namespace touchtrial::app
