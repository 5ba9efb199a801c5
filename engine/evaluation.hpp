/// \file Evaluates the adaptive method on one image: co-occurrence statistics of image and texture,
/// and similarity to the textures of fixed orders. Source: docs/method.md, "Metrics" (paper Table 1
/// and Fig. 3).
#pragma once

#include "core/plane.hpp"
#include "engine/metrics/glcm.hpp"

#include <functional>
#include <vector>

namespace touchtrial::engine {

/// Fixed orders k / 20 for k = 1 .. kSweptOrders: 0.05 to 0.95.
inline constexpr int kSweptOrders = 19;

/// The measures of one 8-bit picture.
struct PictureEvaluation {
  double entropy = 0.0;  ///< of the grey levels, nats
  GlcmTable glcm{};      ///< one entry per kGlcmOffsets
};

/// Measures of the texture of one fixed order, and its similarity to the adaptive texture.
struct OrderEvaluation {
  double order = 0.0;         ///< v
  double entropy = 0.0;       ///< of the texture picture, nats
  double ms_ssim = 0.0;       ///< with the adaptive picture, exponents 1; 1 for equal pictures
  double ms_ssim_wang = 0.0;  ///< the same with Wang's exponents
};

struct Evaluation {
  int height = 0;  ///< of the image, pixels
  int width = 0;
  PictureEvaluation original;
  PictureEvaluation adaptive;  ///< of the adaptive method's texture picture, with its defaults
  std::vector<OrderEvaluation> orders;  ///< kSweptOrders entries in rising order, or none
};

/// Evaluates an image, in double.
/// \param image  at least 2 x 2; for a sweep at least kMsSsimSmallestSide on each side
/// \param sweep  whether to extract the fixed orders and compare them by MS-SSIM
/// \param on_order_done  called after each order of a sweep, from any thread, one call at a time
/// \throws std::invalid_argument if the image is smaller; the message states the size and the limit
/// Thread-safe. Uses all cores; the results do not depend on their number.
[[nodiscard]] Evaluation evaluate_image(const GreyImage& image, bool sweep,
                                        const std::function<void()>& on_order_done = {});

/// The order whose texture is most similar to the adaptive one, by MS-SSIM with exponents 1; the
/// lowest if several are equally similar.
/// \param evaluation  of a sweep
[[nodiscard]] const OrderEvaluation& closest_order(const Evaluation& evaluation);

}  // namespace touchtrial::engine
