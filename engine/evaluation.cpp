#include "engine/evaluation.hpp"

#include "core/parallel.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/metrics/ssim.hpp"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <stdexcept>
#include <string>

namespace touchtrial::engine {
namespace {

constexpr int kGlcmSmallestSide = 2;
/// Larger images are evaluated one order at a time, on all cores, to limit memory.
constexpr std::size_t kMinPixelsOneOrder = std::size_t{4} << 20;

void refuse_smaller(const GreyImage& image, int side, const std::string& purpose) {
  if (std::min(image.height(), image.width()) >= side) return;
  throw std::invalid_argument("has " + std::to_string(image.width()) + " x " +
                              std::to_string(image.height()) + " px; " + purpose + " at least " +
                              std::to_string(side) + " px on each side");
}

void refuse_small(const GreyImage& image, bool sweep) {
  if (sweep) refuse_smaller(image, kMsSsimSmallestSide, "MS-SSIM needs");
  refuse_smaller(image, kGlcmSmallestSide, "co-occurrence statistics need");
}

PictureEvaluation measures_of(const GreyImage& picture) {
  return {entropy(picture), glcm_statistics(picture)};
}

GreyImage picture_of(const GreyImage& image, const ExtractionOptions& options) {
  return texture_picture(extract_texture<double>(image, options).texture);
}

OrderEvaluation measures_of_order(const GreyImage& image, double order, const GreyImage& adaptive) {
  ExtractionOptions options;
  options.method = Method::fixed;
  options.order = order;
  const GreyImage picture = picture_of(image, options);
  const MsSsim similarity = ms_ssim<double>(picture, adaptive);
  return {order, entropy(picture), similarity.unit, similarity.wang};
}

}  // namespace

Evaluation evaluate_image(const GreyImage& image, bool sweep,
                          const std::function<void()>& on_order_done) {
  refuse_small(image, sweep);
  const GreyImage adaptive = picture_of(image, {});
  Evaluation evaluation{image.height(), image.width(), {}, {}, {}};
  in_parallel(0, 2, [&](std::size_t i) {
    (i == 0 ? evaluation.original : evaluation.adaptive) = measures_of(i == 0 ? image : adaptive);
  });
  if (!sweep) return evaluation;
  evaluation.orders.resize(kSweptOrders);
  std::mutex mutex;
  const int orders_at_once = image.size() < kMinPixelsOneOrder ? 0 : 1;
  in_parallel(orders_at_once, evaluation.orders.size(), [&](std::size_t i) {
    evaluation.orders[i] = measures_of_order(image, static_cast<double>(i + 1) / 20.0, adaptive);
    const std::lock_guard lock(mutex);
    if (on_order_done) on_order_done();
  });
  return evaluation;
}

const OrderEvaluation& closest_order(const Evaluation& evaluation) {
  return *std::max_element(
      evaluation.orders.begin(), evaluation.orders.end(),
      [](const OrderEvaluation& a, const OrderEvaluation& b) { return a.ms_ssim < b.ms_ssim; });
}

}  // namespace touchtrial::engine
