#include "analysis/evaluation/evaluation_report.hpp"
#include "analysis/json_figures.hpp"

#include <cstddef>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json picture_json(const engine::PictureFigures& picture) {
  Json glcm = Json::object();
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    glcm[std::to_string(engine::kGlcmOffsets[i].degrees)] = statistics_json(picture.glcm[i]);
  }
  return {{"entropy", picture.entropy}, {"glcm", glcm}};
}

Json orders_json(const std::vector<engine::OrderFigures>& orders) {
  Json list = Json::array();
  for (const engine::OrderFigures& figures : orders) {
    list.push_back({{"order", figures.order},
                    {"entropy", figures.entropy},
                    {"ms_ssim", figures.ms_ssim},
                    {"ms_ssim_wang", figures.ms_ssim_wang}});
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

std::string evaluation_json(std::span<const EvaluatedImage> images) {
  Json list = Json::array();
  for (const EvaluatedImage& image : images) list.push_back(image_json(image));
  return json_text({{"images", list}});
}

}  // namespace touchtrial::analysis
