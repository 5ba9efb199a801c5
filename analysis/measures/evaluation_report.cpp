#include "analysis/measures/evaluation_report.hpp"

#include "analysis/figures/gnuplot.hpp"
#include "analysis/json_figures.hpp"
#include "analysis/text_table.hpp"

#include <array>
#include <cstddef>
#include <filesystem>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// A row of the co-occurrence table.
struct Statistic {
  const char* name;
  double engine::GlcmStatistics::*member;
  int decimals;
};

constexpr std::array<Statistic, 5> kStatistics = {
    {{"ASM", &engine::GlcmStatistics::angular_second_moment, 6},
     {"energy", &engine::GlcmStatistics::energy, 4},
     {"entropy", &engine::GlcmStatistics::entropy, 3},
     {"contrast", &engine::GlcmStatistics::contrast, 2},
     {"correlation", &engine::GlcmStatistics::correlation, 3}}};

constexpr const char* kWhatEntropyIs =
    "The paper's Table 1 prints, as \"Entropy\", what is called energy here: the square root of "
    "the angular second moment (ASM). The entropy of the co-occurrence matrix, in nats, is in the "
    "rows below it.";

void add_statistic(TextTable& table, const Statistic& statistic, const char* picture,
                   const engine::GlcmTable& glcm) {
  std::vector<std::string> row = {fmt::format("{}, {}", statistic.name, picture)};
  for (const engine::GlcmStatistics& direction : glcm) {
    row.push_back(fmt::format("{:.{}f}", direction.*statistic.member, statistic.decimals));
  }
  table.add(row);
}

std::string glcm_text(const engine::Evaluation& evaluation) {
  std::vector<std::string> header = {"co-occurrence"};
  for (const engine::GlcmOffset& offset : engine::kGlcmOffsets) {
    header.push_back(fmt::format("{} deg", offset.degrees));
  }
  TextTable table(header);
  for (const Statistic& statistic : kStatistics) {
    add_statistic(table, statistic, "original", evaluation.original.glcm);
    add_statistic(table, statistic, "adaptive", evaluation.adaptive.glcm);
  }
  return table.text();
}

std::string orders_text(const engine::Evaluation& evaluation) {
  TextTable table({"fixed order", "entropy, nats", "MS-SSIM", "MS-SSIM (Wang)"});
  for (const engine::OrderFigures& one : evaluation.orders) {
    table.add({fmt::format("{:.2f}", one.order), fmt::format("{:.4f}", one.entropy),
               fmt::format("{:.5f}", one.ms_ssim), fmt::format("{:.5f}", one.ms_ssim_wang)});
  }
  const engine::OrderFigures& closest = engine::closest_order(evaluation);
  return "\n" + table.text() + "\n" +
         wrapped("  ", fmt::format("Closest to the adaptive texture is the fixed order {:.2f}: "
                                   "MS-SSIM {:.5f} (Wang {:.5f}) where 1 is identity, entropy "
                                   "{:.4f} against {:.4f} nats.",
                                   closest.order, closest.ms_ssim, closest.ms_ssim_wang,
                                   closest.entropy, evaluation.adaptive.entropy));
}

std::string image_text(const EvaluatedImage& image) {
  const engine::Evaluation& evaluation = image.evaluation;
  std::string text = fmt::format(
      "{}: {} x {} px, entropy of the grey levels {:.4f} nats, of the "
      "adaptive texture {:.4f}\n\n",
      image.image, evaluation.width, evaluation.height, evaluation.original.entropy,
      evaluation.adaptive.entropy);
  text += glcm_text(evaluation);
  if (!evaluation.orders.empty()) text += orders_text(evaluation);
  return text + "\n";
}

using Json = nlohmann::ordered_json;

Json picture_json(const engine::PictureFigures& picture) {
  return {{"entropy", picture.entropy}, {"glcm", glcm_json(picture.glcm)}};
}

Json orders_json(const std::vector<engine::OrderFigures>& orders) {
  Json list = Json::array();
  for (const engine::OrderFigures& one : orders) {
    list.push_back({{"order", one.order},
                    {"entropy", one.entropy},
                    {"ms_ssim", one.ms_ssim},
                    {"ms_ssim_wang", one.ms_ssim_wang}});
  }
  return list;
}

Json image_json(const EvaluatedImage& image) {
  Json object = {{"image", image.image},
                 {"original", picture_json(image.evaluation.original)},
                 {"adaptive", picture_json(image.evaluation.adaptive)}};
  if (!image.evaluation.orders.empty()) object["orders"] = orders_json(image.evaluation.orders);
  return object;
}

/// Distinct for readers with any colour vision (Okabe and Ito).
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000"};
/// gnuplot's filled and open marks; colours and marks repeat at different times.
constexpr std::array<int, 8> kMarks = {7, 5, 9, 11, 13, 6, 4, 8};

constexpr int kLegendColumns = 2;

constexpr const char* kStyle = R"(set encoding utf8
set border 3 lw 1.2
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set xrange [0:1]
set xtics 0.2
set mxtics 2
set xlabel 'fixed order v' noenhanced
unset key
)";

std::string data_of(const engine::Evaluation& evaluation, std::size_t number) {
  std::string data = fmt::format("$sweep{} << EOD\n", number);
  for (const engine::OrderFigures& one : evaluation.orders) {
    data += fmt::format("{} {} {} {}\n", one.order, one.entropy, one.ms_ssim, one.ms_ssim_wang);
  }
  return data + "EOD\n";
}

std::string colour_of(std::size_t number) {
  return kColours[number % kColours.size()];
}

std::string curve(std::size_t number, int column) {
  return fmt::format("$sweep{} using 1:{} with linespoints lc rgb '{}' pt {} ps 0.9 lw 1.6", number,
                     column, colour_of(number), kMarks[number % kMarks.size()]);
}

std::string entropy_panel(std::span<const EvaluatedImage> images) {
  std::string panel = "set ylabel 'entropy, nats' offset 1\nplot ";
  for (std::size_t i = 0; i < images.size(); ++i) {
    panel += fmt::format("{}{}, {} with lines dt (8, 5) lw 1.6 lc rgb '{}'", i == 0 ? "" : ", ",
                         curve(i, 2), images[i].evaluation.adaptive.entropy, colour_of(i));
  }
  return panel + "\n";
}

std::string likeness_panel(std::span<const EvaluatedImage> images) {
  std::string panel = "set ylabel 'MS-SSIM with the adaptive texture'\nset yrange [:1]\nplot ";
  for (std::size_t i = 0; i < images.size(); ++i) {
    panel += fmt::format("{}{}, $sweep{} using 1:4 with lines dt (2, 4) lw 1.6 lc rgb '{}'",
                         i == 0 ? "" : ", ", curve(i, 3), i, colour_of(i));
  }
  return panel + "\n";
}

/// A panel without axes that explains the colours and the kinds of line.
std::string legend_panel(std::span<const EvaluatedImage> images) {
  std::string panel =
      "unset border\nunset tics\nunset grid\nunset xlabel\nunset ylabel\n"
      "set xrange [0:1]\nset yrange [0:1]\n"
      "set lmargin at screen 0.02\nset rmargin at screen 0.98\n"
      "set key at screen 0.5, screen 0.015 center bottom horizontal Left reverse maxcols " +
      std::to_string(kLegendColumns) + " noenhanced width 2 samplen 3\nplot ";
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string name = std::filesystem::path(images[i].image).stem().string();
    panel += fmt::format("NaN with linespoints lc rgb '{}' pt {} ps 0.9 lw 1.6 title {}, ",
                         colour_of(i), kMarks[i % kMarks.size()], gnuplot_string(name));
  }
  return panel +
         "NaN with lines dt (8, 5) lw 1.6 lc rgb '#606060' title 'entropy of the adaptive "
         "texture', NaN with lines dt (2, 4) lw 1.6 lc rgb '#606060' title 'MS-SSIM with Wang''s "
         "weights'\n";
}

}  // namespace

std::string evaluation_text(std::span<const EvaluatedImage> images) {
  std::string text;
  for (const EvaluatedImage& image : images) text += image_text(image);
  return text + wrapped("", kWhatEntropyIs);
}

std::string evaluation_json(std::span<const EvaluatedImage> images) {
  Json list = Json::array();
  for (const EvaluatedImage& image : images) list.push_back(image_json(image));
  return json_text(Json{{"images", list}});
}

std::string order_sweep_script(std::span<const EvaluatedImage> images) {
  const auto rows = (static_cast<int>(images.size()) + 2 + kLegendColumns - 1) / kLegendColumns;
  const int legend_px = 40 + 30 * rows;
  const int height_px = 620 + legend_px;
  const double floor = static_cast<double>(legend_px + 70) / height_px;
  std::string script = fmt::format(
      "set terminal pngcairo size 1500, {} font 'DejaVu Sans,15' linewidth 1.4\n", height_px);
  script += kStyle;
  for (std::size_t i = 0; i < images.size(); ++i) script += data_of(images[i].evaluation, i);
  script += fmt::format("set multiplot\nset tmargin at screen 0.97\nset bmargin at screen {:.4f}\n",
                        floor);
  script += "set lmargin at screen 0.07\nset rmargin at screen 0.485\n" + entropy_panel(images);
  script += "set lmargin at screen 0.565\nset rmargin at screen 0.985\n" + likeness_panel(images);
  return script + legend_panel(images) + "unset multiplot\n";
}

}  // namespace touchtrial::analysis
