#include "analysis/measures/evaluation_report.hpp"

#include "analysis/report/json_figures.hpp"
#include "analysis/report/text_table.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

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

constexpr const char* kEntropyNote =
    "The row \"Entropy\" of the paper's Table 1 shows what is called energy here: the square root "
    "of "
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
  for (const engine::OrderEvaluation& one : evaluation.orders) {
    table.add({fmt::format("{:.2f}", one.order), fmt::format("{:.4f}", one.entropy),
               fmt::format("{:.5f}", one.ms_ssim), fmt::format("{:.5f}", one.ms_ssim_wang)});
  }
  const engine::OrderEvaluation& closest = engine::closest_order(evaluation);
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

Json picture_json(const engine::PictureEvaluation& picture) {
  return {{"entropy", picture.entropy}, {"glcm", glcm_json(picture.glcm)}};
}

Json orders_json(const std::vector<engine::OrderEvaluation>& orders) {
  Json list = Json::array();
  for (const engine::OrderEvaluation& one : orders) {
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

}  // namespace

std::string evaluation_text(std::span<const EvaluatedImage> images) {
  std::string text;
  for (const EvaluatedImage& image : images) text += image_text(image);
  return text + wrapped("", kEntropyNote);
}

std::string evaluation_json(std::span<const EvaluatedImage> images) {
  Json list = Json::array();
  for (const EvaluatedImage& image : images) list.push_back(image_json(image));
  return json_text(Json{{"images", list}});
}

}  // namespace touchtrial::analysis
