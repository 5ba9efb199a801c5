#include "bench/peers/fixed_mask.hpp"

#include "tests/engine/reference/gl_weights.hpp"

#include <cmath>
#include <vector>

namespace touchtrial::bench {

cv::Mat fixed_order_mask(double order, int radius, MaskGives gives) {
  const std::vector<double> weights = reference::gl_weights(order, radius);
  cv::Mat mask = cv::Mat::zeros(2 * radius + 1, 2 * radius + 1, CV_32F);
  double centre = gives == MaskGives::enhanced ? 1.0 : 0.0;
  for (int k = 1; k <= radius; ++k) {
    const double share = std::abs(weights[static_cast<std::size_t>(k)]) / 8.0;
    centre += 8.0 * share;
    for (int dy = -k; dy <= k; dy += k) {
      for (int dx = -k; dx <= k; dx += k) {
        if (dy == 0 && dx == 0) continue;
        mask.at<float>(radius + dy, radius + dx) = static_cast<float>(-share);
      }
    }
  }
  mask.at<float>(radius, radius) = static_cast<float>(centre);
  return mask;
}

}  // namespace touchtrial::bench
