#include "protocols/rating/analysis/figures.hpp"

#include "analysis/report/figures/layout.hpp"
#include "analysis/report/figures/study_figures.hpp"
#include "analysis/report/figures/style.hpp"
#include "protocols/rating/analysis/page.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

/// The width of a texture's methods along the axis.
constexpr double kTextureWidth = 0.8;
/// More means need the page's whole width.
constexpr std::size_t kMaxMeansInColumn = 8;
constexpr double kMaxPicture_cm = 1.5;
constexpr double kPictureShare = 0.86;  ///< of an item's slot

void add_rows(const RatingReport& report, const ScaleReport& scale, std::size_t method, Layer& dots,
              Layer& means) {
  constexpr double kOverlap = 0.012;  ///< share of the scale
  const double width = kTextureWidth / static_cast<double>(report.methods.size());
  const double overlap = kOverlap * (scale.scale.max() - scale.scale.min());
  for (std::size_t i = 0; i < scale.means.items.size(); ++i) {
    const ItemMean& item_mean = scale.means.items[i];
    if (static_cast<std::size_t>(item_mean.item.method) != method || !item_mean.mean.mean) continue;
    const double x = item_mean.item.texture_class + 1.0 - 0.5 * kTextureWidth +
                     width * (static_cast<double>(method) + 0.5);
    std::vector<ParticipantValue> values;
    for (const double value : scale.participant_means[i]) values.push_back({value});
    swarm(dots.rows, x - 0.1 * width, 0.6 * width, overlap, std::move(values));
    means.rows.push_back(
        bar(x + 0.3 * width, *item_mean.mean.mean, item_mean.mean.known_interval()));
    means.rows.back().text = report.classes[static_cast<std::size_t>(item_mean.item.texture_class)];
  }
}

std::string mean_with_interval(const MeanEstimate& mean) {
  const auto interval = mean.known_interval();
  if (!interval) return fmt::format("{:.2f}", *mean.mean);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", *mean.mean, interval->low, interval->high);
}

std::string alt_of(const RatingReport& report, const ScaleReport& scale) {
  std::string alt =
      "Mean rating by texture and method with 95% intervals, and participants' means.";
  for (const ItemMean& item : scale.means.items) {
    if (!item.mean.mean) continue;
    alt += fmt::format(
        " {}, {}: {}.", report.classes[static_cast<std::size_t>(item.item.texture_class)],
        report.methods[static_cast<std::size_t>(item.item.method)], mean_with_interval(item.mean));
  }
  return alt;
}

/// The whole scale, with room for marks at its ends.
Axis rating_axis(const study::Scale& scale) {
  const double room = 0.04 * (scale.max() - scale.min());
  return {.label = "rating, " + scale.id,
          .low = scale.min() - room,
          .high = scale.max() + room,
          .step = scale.points == 0 ? 0.2 : 1.0,
          .first = scale.min()};
}

/// Pictures below the names of items.
/// \param slot_cm  the width of an item along the axis
Panel pictures_panel(const ItemPictures& pictures, double slot_cm) {
  const double side_cm = std::min(kMaxPicture_cm, kPictureShare * slot_cm);
  Panel panel;
  panel.height_cm = side_cm;
  panel.x = {.low = 0.5, .high = static_cast<double>(pictures.size()) + 0.5, .hidden = true};
  panel.y = {.low = 0.0, .high = 1.0, .hidden = true};
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const GreyImage& grey = pictures[i];
    if (grey.empty()) continue;
    const double longer = std::max(grey.width(), grey.height());
    const double half = 0.5 * side_cm / slot_cm * grey.width() / longer;
    const auto x = static_cast<double>(i + 1);
    panel.layers.push_back(
        {.kind = LayerKind::picture,
         .name = "the item's picture",
         .rows = {{.x = x - half, .y = 1.0, .low = x + half, .high = 1.0 - grey.height() / longer}},
         .grey = grey});
  }
  return panel;
}

}  // namespace

std::optional<Figure> ratings_figure(const RatingReport& report, const ScaleReport& scale,
                                     const ItemPictures& pictures) {
  const std::size_t count = report.classes.size() * report.methods.size();
  Figure figure = empty_figure(id_of(report, scale, "ratings-by-item"), "result", report.simulated,
                               count > kMaxMeansInColumn ? kPage_cm : kColumn_cm);
  Panel panel;
  panel.x = names_axis(report.classes);
  panel.y = rating_axis(scale.scale);
  std::vector<Layer> means;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    Layer dots{
        .name = report.methods[i] + ", participants", .colour = std::string(kPale), .size = 0.7};
    Layer mean{.kind = LayerKind::interval,
               .name = report.methods[i],
               .colour = series_colour(i),
               .size = 1.1,
               .glyph = series_glyph(i),
               .in_key = report.methods.size() > 1};
    add_rows(report, scale, i, dots, mean);
    if (mean.rows.empty()) continue;
    emphasise_few(dots);
    panel.layers.push_back(std::move(dots));
    means.push_back(std::move(mean));
  }
  if (means.empty()) return {};
  std::ranges::move(means, std::back_inserter(panel.layers));
  figure.panels = {std::move(panel)};
  const bool has_pictures =
      std::ranges::any_of(pictures, [](const GreyImage& grey) { return !grey.empty(); });
  if (has_pictures) {
    const PlacedPanel placed_panel = layout_of(figure).panels.front();
    figure.panels.push_back(pictures_panel(
        pictures, (placed_panel.right_cm - placed_panel.left_cm) /
                      static_cast<double>(std::max<std::size_t>(pictures.size(), 1))));
  }
  figure.alt = alt_of(report, scale);
  figure.caption = stamped(
      report.simulated,
      caption_of(report, scale,
                 "ratings by texture and method: participants' means as dots, the mean over "
                 "participants and its 95% t interval") +
          (has_pictures ? "; below, the items' pictures." : "."));
  return figure;
}

std::vector<Figure> report_figures(const RatingReport& report, const ItemPictures& pictures,
                                   const std::string& stamp) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  for (const ScaleReport& scale : report.scales) add(ratings_figure(report, scale, pictures));
  add(flow_figure(report));
  add(servo_figure(report, "analysis"));
  stamp_figures(stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::rating
