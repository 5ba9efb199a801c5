#include "analysis/report/figures/style.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::array<std::string_view, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                      "#cc79a7", "#56b4e9", "#1a1a1a"};
constexpr std::array<int, 5> kMarks = {7, 5, 9, 13, 11};

/// The width of an average letter of 8 points, in the widest of the usual fonts.
constexpr double kLetter_cm = 0.17;
constexpr double kSlant = 0.707;  ///< sine of 45 degrees

constexpr const char* kStyle = R"(set encoding utf8
set border 3 lw 1 lc rgb '#1a1a1a'
set tics nomirror out scale 0.5
set grid ytics lc rgb '#e0e0e0' lw 0.7 dt solid
set bars 0.6
unset key
)";

constexpr double kLegendRow_cm = 0.42;
constexpr double kSample_cm = 0.6;
/// With room for narrow windows, which show larger letters.
constexpr double kLegendLetter_cm = 0.17;
constexpr double kStamp_cm = 2.2;  ///< the stamp's width, in the upper right corner
constexpr std::size_t kLegendColumns = 48;

std::string line_entry(const Sheet& sheet, const LegendEntry& entry, double x_cm, double y_cm) {
  const bool dashed = entry.kind == LegendEntry::Kind::dashes;
  return fmt::format(
      "set arrow from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} nohead {} lc "
      "rgb '{}'\n",
      x_cm / sheet.width_cm, 1.0 - y_cm / sheet.height_cm, (x_cm + kSample_cm) / sheet.width_cm,
      1.0 - y_cm / sheet.height_cm, dashed ? "dt (6, 5) lw 1.2" : "lw 3", entry.colour);
}

std::string field_entry(const Sheet& sheet, const LegendEntry& entry, double x_cm, double y_cm) {
  return fmt::format(
      "set object rectangle from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} fs "
      "solid 0.25 noborder fc rgb '{}'\n",
      x_cm / sheet.width_cm, 1.0 - (y_cm + 0.12) / sheet.height_cm,
      (x_cm + kSample_cm) / sheet.width_cm, 1.0 - (y_cm - 0.12) / sheet.height_cm, entry.colour);
}

std::string sample_at(const Sheet& sheet, const LegendEntry& entry, double x_cm, double y_cm) {
  switch (entry.kind) {
    case LegendEntry::Kind::mark:
      return text_on_sheet(
          sheet, "", x_cm + 0.5 * kSample_cm, y_cm,
          fmt::format("left point pt {} ps 0.7 lw 1.3 lc rgb '{}'", entry.mark, entry.colour));
    case LegendEntry::Kind::field:
      return field_entry(sheet, entry, x_cm, y_cm);
    case LegendEntry::Kind::line:
    case LegendEntry::Kind::dashes:
      break;
  }
  return line_entry(sheet, entry, x_cm, y_cm);
}

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

std::string_view series_colour(std::size_t n) noexcept {
  return kColours[n % kColours.size()];
}

int series_mark(std::size_t n) noexcept {
  return kMarks[n % kMarks.size()];
}

Rgb shade_of(double share) noexcept {
  const auto between = [share](double from, double to) {
    return static_cast<int>(std::lround(from + (to - from) * share));
  };
  return {between(255.0, 0.0), between(255.0, 62.0), between(255.0, 110.0)};
}

double contrast(Rgb a, Rgb b) noexcept {
  const double one = luminance(a) + 0.05;
  const double other = luminance(b) + 0.05;
  return std::max(one, other) / std::min(one, other);
}

Rgb ink_on(Rgb ground) noexcept {
  return contrast(kWhite, ground) > contrast(kBlack, ground) ? kWhite : kBlack;
}

std::string hexadecimal(Rgb colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

Figure figure_on(const Sheet& sheet, std::string id, std::string alt, std::string section) {
  return {.id = std::move(id),
          .caption = {},
          .alt = std::move(alt),
          .script = {},
          .width_cm = sheet.width_cm,
          .height_cm = sheet.height_cm,
          .section = std::move(section)};
}

std::string sheet_head(const Sheet& sheet) {
  std::string head = kStyle;
  if (sheet.simulated) {
    head += text_on_sheet(sheet, "SIMULATED", sheet.width_cm - 0.15, 0.3,
                          "right textcolor rgb '#b3261e'");
  }
  return head;
}

std::string panel_at(const Sheet& sheet, const Margins& margins) {
  return fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
      "set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n",
      margins.left_cm / sheet.width_cm, 1.0 - margins.right_cm / sheet.width_cm,
      1.0 - margins.top_cm / sheet.height_cm, margins.bottom_cm / sheet.height_cm);
}

std::string text_at(const std::string& text, const std::string& at) {
  return fmt::format("set label {} at {} noenhanced\n", gnuplot_string(text), at);
}

std::string text_on_sheet(const Sheet& sheet, const std::string& text, double left_cm,
                          double top_cm, const std::string& more) {
  return text_at(text, fmt::format("screen {:.4f}, screen {:.4f} {}", left_cm / sheet.width_cm,
                                   1.0 - top_cm / sheet.height_cm, more));
}

std::string data_block(const std::string& name, std::span<const std::vector<double>> rows) {
  std::string block = fmt::format("${} << EOD\n", name);
  for (const std::vector<double>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) block += ' ';
      block += std::isfinite(row[i]) ? fmt::format("{:.6g}", row[i]) : "NaN";
    }
    block += '\n';
  }
  return block + "EOD\n";
}

std::string accuracy_axis(const std::string& label) {
  return fmt::format(
      "set yrange [0:104]\nset ytics 0, 20, 100 format '%g'\nset ylabel {} "
      "noenhanced\n",
      gnuplot_string(label));
}

void add_bar(Rows& rows, double place, double mean, const std::optional<Interval>& interval,
             double unit) {
  const Interval bar = interval.value_or(Interval{mean, mean});
  rows.push_back({place, unit * mean, unit * bar.low, unit * bar.high});
}

std::vector<double> evenly_chosen(const std::vector<double>& sorted, std::size_t most) {
  if (sorted.size() <= most) return sorted;
  std::vector<double> chosen;
  for (std::size_t i = 0; i < most; ++i) {
    chosen.push_back(sorted[i * (sorted.size() - 1) / (most - 1)]);
  }
  return chosen;
}

void add_dots(Rows& rows, double x, double width, const std::vector<double>& sorted) {
  constexpr double kGoldenSection = 0.618033988749895;
  const std::vector<double> chosen = evenly_chosen(sorted, kMaxDots);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const double aside = std::fmod(kGoldenSection * static_cast<double>(i), 1.0) - 0.5;
    rows.push_back({x + width * aside, chosen[i]});
  }
}

std::string dashed_line(double height) {
  return fmt::format(
      "set arrow from graph 0, first {0:.6g} to graph 1, first {0:.6g} nohead dt (6, 5) lw 1.2 "
      "lc rgb '{1}' back\n",
      height, kInk);
}

std::string chance_line(int classes) {
  return dashed_line(100.0 / std::max(classes, 1));
}

NamesBelow::NamesBelow(std::span<const std::string> names, double axis_cm,
                       std::size_t slanted_columns) {
  const double slot_cm = axis_cm / static_cast<double>(std::max<std::size_t>(names.size(), 1));
  const auto columns = static_cast<std::size_t>(slot_cm / kLetter_cm);
  std::size_t widest = 0;
  for (const std::string& name : names) widest = std::max(widest, display_width(name));
  slanted_ = widest > std::max<std::size_t>(columns, 1);
  for (const std::string& name : names) {
    names_.push_back(fitted(name, slanted_ ? slanted_columns : widest));
  }
  if (slanted_) {
    const auto longest = static_cast<double>(std::min(widest, slanted_columns));
    room_cm_ = 0.5 + longest * kLetter_cm * kSlant;
  }
}

std::string NamesBelow::script() const {
  std::string script = fmt::format("set xrange [0.5:{0}.5]\nset xtics 1, 1, {0} format ''\n",
                                   std::max<std::size_t>(names_.size(), 1));
  const char* how = slanted_ ? "right rotate by 45 offset 0.4, -0.5" : "center offset 0, -0.9";
  for (std::size_t i = 0; i < names_.size(); ++i) {
    script += text_at(names_[i], fmt::format("first {}, graph 0 {}", i + 1, how));
  }
  return script;
}

LegendEntry mark_entry(int mark, std::string_view colour, std::string text) {
  return {LegendEntry::Kind::mark, std::string(colour), mark, std::move(text)};
}

LegendEntry chance_entry(int classes) {
  return {LegendEntry::Kind::dashes, std::string(kInk), 7,
          fmt::format("chance (1 of {})", classes)};
}

Legend::Legend(const Sheet& sheet, double left_cm, std::span<const LegendEntry> entries) {
  double x_cm = left_cm;
  double y_cm = kLegendRow_cm - 0.1;
  for (const LegendEntry& entry : entries) {
    const std::string text = fitted(entry.text, kLegendColumns);
    const double width_cm =
        kSample_cm + 0.5 + kLegendLetter_cm * static_cast<double>(display_width(text));
    if (x_cm + width_cm > sheet.width_cm - kStamp_cm && x_cm > left_cm) {
      x_cm = left_cm;
      y_cm += kLegendRow_cm;
    }
    script_ += sample_at(sheet, entry, x_cm, y_cm) +
               text_on_sheet(sheet, text, x_cm + kSample_cm + 0.15, y_cm);
    x_cm += width_cm;
  }
  room_cm_ = y_cm + 0.3;
}

Panels::Panels(std::size_t count, std::size_t across, double height_cm, const Margins& around,
               bool simulated)
    : count_(count),
      across_(std::min(count, across)),
      height_cm_(height_cm),
      around_(around),
      sheet_{16.0, kLegend_cm, simulated} {
  const std::size_t rows = (count_ + across_ - 1) / across_;
  sheet_.height_cm += height_cm_ * static_cast<double>(rows);
}

double Panels::axis_cm() const noexcept {
  return sheet_.width_cm / static_cast<double>(across_) - around_.left_cm - around_.right_cm;
}

std::string Panels::begin(std::size_t panel, const std::string& title) const {
  const double share_cm = sheet_.width_cm / static_cast<double>(across_);
  const double left_cm = share_cm * static_cast<double>(panel % across_);
  const double top_cm = kLegend_cm + height_cm_ * static_cast<double>(panel / across_);
  const Margins margins{
      left_cm + around_.left_cm, sheet_.width_cm - left_cm - share_cm + around_.right_cm,
      top_cm + around_.top_cm, sheet_.height_cm - top_cm - height_cm_ + around_.bottom_cm};
  std::string script = panel_at(sheet_, margins);
  if (count_ > 1) {
    const auto columns = static_cast<std::size_t>(std::max(axis_cm() / kLetter_cm, 8.0));
    script += text_at(fitted(title, columns), "graph 0, graph 1 left offset 0.2, 0.6");
  }
  return script;
}

std::string stamped(bool simulated, const std::string& sentence) {
  return (simulated ? "SIMULATED participants: " : "") + sentence;
}

std::string with_interval(double share, const std::optional<Interval>& interval) {
  if (!interval) return fmt::format("{:.1f} %", 100.0 * share);
  return fmt::format("{:.1f} % ({:.1f} to {:.1f} %)", 100.0 * share, 100.0 * interval->low,
                     100.0 * interval->high);
}

}  // namespace touchtrial::analysis
