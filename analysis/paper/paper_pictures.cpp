#include "analysis/paper/paper_pictures.hpp"

#include "analysis/paper/published.hpp"
#include "analysis/report/figures/style.hpp"
#include "analysis/report/page/picture_tiles.hpp"
#include "analysis/report/text_table.hpp"
#include "core/text.hpp"
#include "engine/extraction.hpp"
#include "engine/pictures/colour_image.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr int kForcesSide_px = 288;  ///< side of the pictures of Fig. 4
constexpr int kForcesPatch_px = 12;  ///< side of the part of the texture that they show
constexpr double kOrderOfFigure4 = 0.55;

GreyImage middle_of(const GreyImage& picture) {
  const int height = std::min(kShownSide_px, picture.height());
  const int width = std::min(kShownSide_px, picture.width());
  const int top = (picture.height() - height) / 2;
  const int left = (picture.width() - width) / 2;
  GreyImage middle(height, width);
  for (int y = 0; y < height; ++y) {
    const auto row = picture.row(top + y).subspan(static_cast<std::size_t>(left),
                                                  static_cast<std::size_t>(width));
    std::copy(row.begin(), row.end(), middle.row(y).begin());
  }
  return middle;
}

GreyImage shrink_to_shown_side(const GreyImage& picture) {
  const int longer_side = std::max(picture.height(), picture.width());
  if (longer_side <= kShownSide_px) return picture;
  const auto side = [&](int length) { return std::max(1, length * kShownSide_px / longer_side); };
  return engine::resized(picture, side(picture.height()), side(picture.width()));
}

GreyImage texture_image(const GreyImage& image, engine::Method method, double order = 0.0) {
  engine::ExtractionOptions options;
  options.method = method;
  if (method == engine::Method::fixed) options.order = order;
  return engine::texture_picture(engine::extract_texture<double>(image, options).texture);
}

std::string tiles_alt(const Tiles& tiles) {
  return "Rows: " + listed(tiles.labels) + ". Columns: " + listed(tiles.titles) + ".";
}

Picture orders_picture(std::span<const PaperPicture> pictures) {
  Tiles tiles{{"original"}, {}, {}};
  for (const double order : kPaperOrders) tiles.titles.push_back(fmt::format("order {:g}", order));
  tiles.titles.emplace_back("adaptive");
  for (const PaperPicture& one : pictures) {
    tiles.labels.push_back(one.name);
    std::vector<Bytes>& row = tiles.cells.emplace_back();
    row.push_back(engine::png_bytes(middle_of(one.image)));
    for (const double order : kPaperOrders) {
      row.push_back(
          engine::png_bytes(middle_of(texture_image(one.image, engine::Method::fixed, order))));
    }
    row.push_back(engine::png_bytes(middle_of(texture_image(one.image, engine::Method::adaptive))));
  }
  return picture_of_tiles(
      "paper-orders",
      fmt::format("The middle of each picture, {0} x {0} pixels, its textures of the fixed orders "
                  "of the paper's Fig. 1, and its adaptive texture, as in the paper's Table 2.",
                  kShownSide_px),
      tiles_alt(tiles), tiles);
}

Picture forces_picture(const PaperPicture& picture) {
  engine::ExtractionOptions options;
  options.method = engine::Method::fixed;
  options.order = kOrderOfFigure4;
  engine::RequestedPlanes planes;
  planes.picture = true;
  planes.force = true;
  const auto extraction = engine::extract_texture<double>(picture.image, options, planes);
  const engine::ArrowPatch patch =
      middle_of_patch(engine::strongest_patch(extraction.force), kForcesPatch_px);
  Tiles tiles{{"texture", "forces"}, {}, {}, kForcesSide_px};
  tiles.cells = {{engine::png_bytes(middle_of(extraction.picture)),
                  engine::png_bytes(engine::force_arrows(extraction.picture, extraction.force,
                                                         patch, kForcesSide_px))}};
  return picture_of_tiles(
      "paper-forces",
      fmt::format("The texture of {} at order {:g} (its middle), and the tangential forces in the "
                  "{} x {} pixels in the middle of the strongest part, as in the paper's Fig. 4.",
                  picture.name, kOrderOfFigure4, patch.width, patch.height),
      "A texture, and a part of it with arrows from bright to dark.", tiles);
}

Picture methods_picture(std::span<const PaperPicture> pictures) {
  Tiles tiles{{"original", "adaptive", "TV-Gabor"}, {}, {}};
  for (const PaperPicture& one : pictures) {
    tiles.labels.push_back(one.name);
    tiles.cells.push_back(
        {engine::png_bytes(shrink_to_shown_side(one.image)),
         engine::png_bytes(middle_of(texture_image(one.image, engine::Method::adaptive))),
         engine::png_bytes(middle_of(texture_image(one.image, engine::Method::tv_gabor)))});
  }
  return picture_of_tiles(
      "paper-methods",
      fmt::format("Pictures, made smaller, and the middle of their textures by both methods, "
                  "{0} x {0} pixels, as in the paper's Table 3.",
                  kShownSide_px),
      tiles_alt(tiles), tiles);
}

/// Plots one number of each picture's textures over the fixed order.
Panel orders_panel(std::span<const MeasuredPicture> pictures, std::string label,
                   double engine::OrderEvaluation::*number) {
  Panel panel;
  panel.x = {.label = "fixed order", .low = 0.0, .high = 1.0, .step = 0.2};
  panel.y = {.label = std::move(label)};
  panel.layers = {
      {.kind = LayerKind::rule,
       .name = fmt::format("orders {:g} to {:g}", kPublishedLowestOrder, kPublishedHighestOrder),
       .rows = {{.low = kPublishedLowestOrder, .high = kPublishedHighestOrder}},
       .colour = std::string(kFaint)}};
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    Layer line{.kind = LayerKind::line,
               .name = fitted(pictures[i].name, kCellWidth),
               .colour = series_colour(i),
               .in_key = true};
    for (const engine::OrderEvaluation& one : pictures[i].evaluation.orders) {
      line.rows.push_back({.x = one.order, .y = one.*number});
    }
    Layer marks = line;
    marks.kind = LayerKind::points;
    marks.glyph = series_glyph(i);
    marks.in_key = false;
    panel.layers.push_back(std::move(line));
    panel.layers.push_back(std::move(marks));
  }
  return panel;
}

}  // namespace

PaperPictures paper_pictures(std::span<const PaperPicture> pictures,
                             std::span<const PaperPicture> compared) {
  return {orders_picture(pictures), forces_picture(pictures.front()), methods_picture(compared)};
}

Figure order_figure(std::span<const MeasuredPicture> pictures) {
  Figure figure = empty_figure("paper-sweep", "", false, kPage_cm);
  figure.panels_per_row = 2;
  figure.panels = {orders_panel(pictures, "entropy, nats", &engine::OrderEvaluation::entropy),
                   orders_panel(pictures, "MS-SSIM with the adaptive texture",
                                &engine::OrderEvaluation::ms_ssim)};
  figure.panels[1].y.high = 1.01;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    Layer adaptive = dashed_rule(pictures[i].evaluation.adaptive.entropy, "");
    adaptive.colour = series_colour(i);
    figure.panels[0].layers.push_back(std::move(adaptive));
  }
  figure.caption =
      "Entropy of textures over the fixed order, and MS-SSIM of each with the adaptive texture, "
      "as in the paper's Fig. 3. Dashed: entropy of the adaptive texture; grey: the "
      "orders that the paper names.";
  figure.alt = "Entropy and MS-SSIM over the fixed order.";
  for (const MeasuredPicture& one : pictures) {
    const engine::OrderEvaluation& closest = engine::closest_order(one.evaluation);
    figure.alt += fmt::format(
        " {}: MS-SSIM is largest at order {:.2f}, {:.4f}; entropy of the "
        "adaptive texture {:.3f} nats.",
        one.name, closest.order, closest.ms_ssim, one.evaluation.adaptive.entropy);
  }
  return figure;
}

}  // namespace touchtrial::analysis
