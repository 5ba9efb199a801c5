#include "protocols/rating/analysis/figures.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/study_figures.hpp"
#include "analysis/report/figures/style.hpp"
#include "protocols/rating/analysis/page.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

using Rows = std::vector<std::vector<double>>;

/// Dots and means of one method.
struct MethodRows {
  Rows dots;
  Rows means;  ///< place, mean, low, high
};

/// The room of a texture's methods along the axis.
constexpr double kTextureRoom = 0.8;

MethodRows rows_of(const RatingReport& report, const ScaleReport& scale, int method) {
  MethodRows rows;
  const double room = kTextureRoom / static_cast<double>(report.methods.size());
  for (std::size_t i = 0; i < scale.means.items.size(); ++i) {
    const ItemMean& one = scale.means.items[i];
    if (one.item.method != method || !one.mean.mean) continue;
    const double x = one.item.texture_class + 1.0 - 0.5 * kTextureRoom + room * (method + 0.5);
    std::vector<double> sorted = scale.own_means[i];
    std::ranges::sort(sorted);
    add_dots(rows.dots, x, 0.5 * room, sorted);
    const double mean = *one.mean.mean;
    const Interval bar = one.mean.known_interval().value_or(Interval{mean, mean});
    rows.means.push_back({x, mean, bar.low, bar.high});
  }
  return rows;
}

std::string mean_with_interval(const MeanEstimate& mean) {
  const auto interval = mean.known_interval();
  if (!interval) return fmt::format("{:.2f}", *mean.mean);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", *mean.mean, interval->low, interval->high);
}

std::string alt_of(const RatingReport& report, const ScaleReport& scale) {
  std::string alt = "Mean rating by texture and method with 95 % intervals, and participants.";
  for (const ItemMean& one : scale.means.items) {
    if (!one.mean.mean) continue;
    alt += fmt::format(
        " {}, {}: {}.", report.classes[static_cast<std::size_t>(one.item.texture_class)],
        report.methods[static_cast<std::size_t>(one.item.method)], mean_with_interval(one.mean));
  }
  return alt;
}

std::vector<LegendEntry> legend_of(const RatingReport& report) {
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    legend.push_back(mark_entry(series_mark(i), series_colour(i), report.methods[i]));
  }
  return legend;
}

/// The whole scale, with room for marks at its ends.
std::string rating_axis(const study::Scale& scale) {
  const double room = 0.04 * (scale.max() - scale.min());
  return fmt::format("set yrange [{:.6g}:{:.6g}]\nset ytics {:.6g}, {} format '%g'\n",
                     scale.min() - room, scale.max() + room, scale.min(),
                     scale.points == 0 ? 0.2 : 1.0) +
         fmt::format("set ylabel {} noenhanced\n", gnuplot_string("rating, " + scale.id));
}

}  // namespace

std::optional<Figure> ratings_figure(const RatingReport& report, const ScaleReport& scale) {
  std::string data;
  std::string dots;
  std::string means;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodRows rows = rows_of(report, scale, static_cast<int>(i));
    if (rows.means.empty()) continue;
    data += data_block(fmt::format("dots{}", i), rows.dots) +
            data_block(fmt::format("means{}", i), rows.means);
    dots += fmt::format("{}$dots{} using 1:2 with points pt 7 ps 0.25 lc rgb '{}' notitle",
                        dots.empty() ? "plot " : ", ", i, kFaint);
    means += fmt::format(
        ", $means{} using 1:2:3:4 with yerrorbars pt {} ps 0.8 lw 1.6 lc rgb '{}' notitle", i,
        series_mark(i), series_colour(i));
  }
  if (data.empty()) return {};
  Sheet sheet{16.0, 8.0, report.simulated};
  Margins margins;
  const NamesBelow below(report.classes, sheet.width_cm - margins.left_cm - margins.right_cm);
  margins.bottom_cm = below.room_cm() + 0.3;
  sheet.height_cm = 6.5 + margins.bottom_cm;
  const Legend legend(sheet, margins.left_cm, legend_of(report));
  margins.top_cm = legend.room_cm() + 0.2;
  Figure figure = figure_on(sheet, id_of(report, scale, "ratings"), alt_of(report, scale));
  figure.section = "ratings";
  figure.caption = stamped(
      report.simulated,
      caption_of(report, scale,
                 "ratings by texture and method: participants' means as dots, the mean over "
                 "participants and its 95 % t interval") +
          ".");
  figure.script = data + sheet_head(sheet) + panel_at(sheet, margins) + below.script() +
                  rating_axis(scale.scale) + legend.script() + dots + means + "\n";
  return figure;
}

std::vector<Figure> report_figures(const RatingReport& report, const std::string& stamp) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  add(flow_figure(report));
  for (const ScaleReport& scale : report.scales) add(ratings_figure(report, scale));
  add(servo_figure(report, "analysis"));
  stamp_figures(stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::rating
