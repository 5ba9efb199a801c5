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

/// Side of the pictures of Fig. 4, pixels, and of the patch of the texture that they show.
constexpr int kForcesSide_px = 288;
constexpr int kForcesPatch_px = 12;
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

GreyImage shrunk(const GreyImage& picture) {
  const int longer = std::max(picture.height(), picture.width());
  if (longer <= kShownSide_px) return picture;
  const auto side = [&](int length) { return std::max(1, length * kShownSide_px / longer); };
  return engine::resized(picture, side(picture.height()), side(picture.width()));
}

GreyImage drawn_texture(const GreyImage& image, engine::Method method, double order = 0.0) {
  engine::ExtractionOptions options;
  options.method = method;
  if (method == engine::Method::fixed) options.order = order;
  return engine::texture_picture(engine::extract_texture<double>(image, options).texture);
}

std::string alt_of(const Tiles& tiles) {
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
          engine::png_bytes(middle_of(drawn_texture(one.image, engine::Method::fixed, order))));
    }
    row.push_back(engine::png_bytes(middle_of(drawn_texture(one.image, engine::Method::adaptive))));
  }
  return picture_of_tiles(
      "paper-orders",
      fmt::format("The middle of each picture, {0} x {0} pixels, its textures of the fixed orders "
                  "of the paper's Fig. 1, and its adaptive texture, as in the paper's Table 2.",
                  kShownSide_px),
      alt_of(tiles), tiles);
}

Picture forces_picture(const PaperPicture& picture) {
  engine::ExtractionOptions options;
  options.method = engine::Method::fixed;
  options.order = kOrderOfFigure4;
  engine::WantedPlanes wanted;
  wanted.picture = true;
  wanted.force = true;
  const auto extraction = engine::extract_texture<double>(picture.image, options, wanted);
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
        {engine::png_bytes(shrunk(one.image)),
         engine::png_bytes(middle_of(drawn_texture(one.image, engine::Method::adaptive))),
         engine::png_bytes(middle_of(drawn_texture(one.image, engine::Method::tv_gabor)))});
  }
  return picture_of_tiles(
      "paper-methods",
      fmt::format("Pictures, made smaller, and the middle of their textures by both methods, "
                  "{0} x {0} pixels, as in the paper's Table 3.",
                  kShownSide_px),
      alt_of(tiles), tiles);
}

std::vector<LegendEntry> legend_of_orders(std::span<const MeasuredPicture> pictures) {
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    legend.push_back(
        mark_entry(series_mark(i), series_colour(i), fitted(pictures[i].name, kCellWidth)));
  }
  legend.push_back({LegendEntry::Kind::dashes, std::string(kFaint), 0, "adaptive texture"});
  legend.push_back(
      {LegendEntry::Kind::field, std::string(kFaint), 0,
       fmt::format("orders {:g} to {:g}", kPublishedLowestOrder, kPublishedHighestOrder)});
  return legend;
}

std::string data_of_orders(std::span<const MeasuredPicture> pictures) {
  std::string data;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    std::vector<std::vector<double>> rows;
    for (const engine::OrderFigures& one : pictures[i].evaluation.orders) {
      rows.push_back(
          {one.order, one.entropy, one.ms_ssim, pictures[i].evaluation.adaptive.entropy});
    }
    data += data_block(fmt::format("orders{}", i), rows);
  }
  return data;
}

std::string curves_of_orders(std::size_t count, int column) {
  std::string plot = "plot ";
  for (std::size_t i = 0; i < count; ++i) {
    plot += fmt::format("{}$orders{} using 1:{} with linespoints lc rgb '{}' pt {} ps 0.5 lw 1.2",
                        i == 0 ? "" : ", ", i, column, series_colour(i), series_mark(i));
    if (column != 2) continue;
    plot += fmt::format(", $orders{} using 1:4 with lines dt (6, 5) lw 1.2 lc rgb '{}'", i,
                        series_colour(i));
  }
  return plot + "\n";
}

}  // namespace

PaperPictures paper_pictures(std::span<const PaperPicture> pictures,
                             std::span<const PaperPicture> compared) {
  return {orders_picture(pictures), forces_picture(pictures.front()), methods_picture(compared)};
}

Figure order_figure(std::span<const MeasuredPicture> pictures) {
  Sheet sheet{16.0, 7.5, false};
  const Legend legend(sheet, 1.5, legend_of_orders(pictures));
  sheet.height_cm = 6.7 + legend.room_cm();
  const Legend placed(sheet, 1.5, legend_of_orders(pictures));
  const Margins left{1.5, 8.4, placed.room_cm() + 0.2, 1.1};
  const Margins right{9.6, 0.4, placed.room_cm() + 0.2, 1.1};
  Figure figure = figure_on(sheet, "paper-sweep");
  figure.caption =
      "Entropy of textures over the fixed order, and MS-SSIM of each with the adaptive texture, "
      "as in the paper's Fig. 3. Dashed: entropy of the adaptive texture.";
  figure.alt = "Entropy and MS-SSIM over the fixed order.";
  for (const MeasuredPicture& one : pictures) {
    const engine::OrderFigures& closest = engine::closest_order(one.evaluation);
    figure.alt += fmt::format(
        " {}: MS-SSIM is largest at order {:.2f}, {:.4f}; entropy of the "
        "adaptive texture {:.3f} nats.",
        one.name, closest.order, closest.ms_ssim, one.evaluation.adaptive.entropy);
  }
  const std::string axis = fmt::format(
      "set xrange [0:1]\nset xtics 0.2\nset xlabel 'fixed order' offset 0, 0.6\n"
      "set object 900 rectangle from {}, graph 0 to {}, graph 1 behind fs solid 0.25 noborder fc "
      "rgb '{}'\n",
      kPublishedLowestOrder, kPublishedHighestOrder, kFaint);
  figure.script =
      data_of_orders(pictures) + sheet_head(sheet) + placed.script() + "set multiplot\n" +
      panel_at(sheet, left) + axis + "set ylabel 'entropy, nats' offset 1.5\n" +
      curves_of_orders(pictures.size(), 2) + "unset label\nunset arrow\nunset object\n" +
      panel_at(sheet, right) + axis +
      "set ylabel 'MS-SSIM with the adaptive texture' offset 1.5\nset yrange [:1.01]\n" +
      curves_of_orders(pictures.size(), 3) + "unset multiplot\n";
  return figure;
}

}  // namespace touchtrial::analysis
