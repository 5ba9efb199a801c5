#include "analysis/report/page/picture_tiles.hpp"

#include "analysis/report/escaping.hpp"
#include "analysis/report/figures/style.hpp"
#include "analysis/report/text_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Lengths in CSS pixels.
constexpr int kGap_px = 4;
constexpr int kLabels_px = 76;
constexpr int kHead_px = 22;
constexpr double kCmPerPixel = 2.54 / 96.0;
constexpr std::size_t kLabelColumns = 12;
constexpr double kTileText_px = 32.0 / 3.0;  ///< 8 points, as in the other figures

std::string svg_text(int x, int y, const std::string& text) {
  return fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x, y, xml_escaped(text));
}

std::string svg_tile(int x, int y, int side, const Bytes& png) {
  return fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
      x, y, side, side, to_base64(png));
}

std::string svg_of_tiles(const Tiles& tiles, const std::string& alt) {
  const int left = tiles.labels.empty() ? 0 : kLabels_px;
  const int step = tiles.side_px + kGap_px;
  const int width = left + step * static_cast<int>(tiles.titles.size());
  const int height = kHead_px + step * static_cast<int>(tiles.cells.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.2f}cm\" height=\"{:.2f}cm\" "
      "viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" "
      "font-family=\"Arial,Helvetica,sans-serif\" font-size=\"{:.2f}\" fill=\"{}\">\n<rect "
      "width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n",
      width * kCmPerPixel, height * kCmPerPixel, width, height, xml_escaped(alt), kTileText_px,
      kInk, width, height);
  for (std::size_t i = 0; i < tiles.titles.size(); ++i) {
    svg += svg_text(left + step * static_cast<int>(i), kHead_px - 8, tiles.titles[i]);
  }
  for (std::size_t row = 0; row < tiles.cells.size(); ++row) {
    const int y = kHead_px + step * static_cast<int>(row);
    if (!tiles.labels.empty()) {
      svg += svg_text(0, y + tiles.side_px / 2, fitted(tiles.labels[row], kLabelColumns));
    }
    for (std::size_t i = 0; i < tiles.cells[row].size(); ++i) {
      svg += svg_tile(left + step * static_cast<int>(i), y, tiles.side_px, tiles.cells[row][i]);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace

Picture picture_of_tiles(std::string id, std::string caption, std::string alt, const Tiles& tiles) {
  std::string svg = svg_of_tiles(tiles, alt);
  return {std::move(id), std::move(caption), std::move(alt), std::move(svg)};
}

engine::ArrowPatch middle_of_patch(engine::ArrowPatch patch, int side_px) {
  patch.y += std::max(0, patch.height - side_px) / 2;
  patch.x += std::max(0, patch.width - side_px) / 2;
  patch.height = std::min(patch.height, side_px);
  patch.width = std::min(patch.width, side_px);
  return patch;
}

}  // namespace touchtrial::analysis
