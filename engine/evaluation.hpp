/// \file Measures of the adaptive method on one image: the co-occurrence statistics of image and
/// texture, and the similarity of the texture to those of fixed orders. Source: docs/method.md,
/// "Metrics" (paper Table 1 and Fig. 3).
#pragma once

#include "core/plane.hpp"
#include "engine/metrics/glcm.hpp"

#include <functional>
#include <vector>

namespace touchtrial::engine {

/// Fixed orders k / 20 for k = 1 .. kSweptOrders: 0.05 to 0.95.
inline constexpr int kSweptOrders = 19;

/// The measures of one 8-bit picture.
struct PictureFigures {
  double entropy = 0.0;  ///< of the grey levels, nats
  GlcmTable glcm{};      ///< an entry for each of kGlcmOffsets
};

/// The texture of one fixed order, and its similarity to the adaptive texture.
struct OrderFigures {
  double order = 0.0;         ///< v
  double entropy = 0.0;       ///< of its picture, nats
  double ms_ssim = 0.0;       ///< with the adaptive picture, exponents 1; 1 for equal pictures
  double ms_ssim_wang = 0.0;  ///< the same with Wang's exponents
};

struct Evaluation {
  int height = 0;  ///< of the image, pixels
  int width = 0;
  PictureFigures original;
  PictureFigures adaptive;  ///< of the adaptive method's texture picture, with its defaults
  std::vector<OrderFigures> orders;  ///< kSweptOrders entries by rising order, or none
};

/// Evaluates an image, in double.
/// \param image  at least 2 x 2; for a sweep at least kMsSsimSmallestSide on each side
/// \param sweep  whether to extract the fixed orders and compare them by MS-SSIM
/// \param order_done  called after each order of a sweep, from any thread, never from two at a time
/// \throws std::invalid_argument if the image is smaller; the message has its size and the least
///   one
/// Thread-safe. Uses all cores: the results do not depend on their number.
[[nodiscard]] Evaluation evaluate_image(const GreyImage& image, bool sweep,
                                        const std::function<void()>& order_done = {});

/// The order whose texture is most similar to the adaptive one, by MS-SSIM with exponents 1; the
/// lowest if several are equally similar.
/// \param evaluation  of a sweep
[[nodiscard]] const OrderFigures& closest_order(const Evaluation& evaluation);

}  // namespace touchtrial::engine
