/// \file What the adaptive method makes of one image, in figures: the
/// co-occurrence statistics of image and texture, and how the texture compares
/// with those of fixed orders. Source: docs/method.md, "Metrics" (paper Table 1
/// and Fig. 3).
#pragma once

#include "core/plane.hpp"
#include "engine/metrics/glcm.hpp"

#include <functional>
#include <vector>

namespace touchtrial::engine {

/// Fixed orders k / 20 for k = 1 .. kSweptOrders: 0.05 to 0.95.
inline constexpr int kSweptOrders = 19;

/// One 8-bit picture in figures.
struct PictureFigures {
  double entropy = 0.0;  ///< of the grey levels, nats
  GlcmTable glcm{};      ///< an entry for each of kGlcmOffsets
};

/// The texture of one fixed order, and how like the adaptive one it is.
struct OrderFigures {
  double order = 0.0;         ///< v
  double entropy = 0.0;       ///< of its picture, nats
  double ms_ssim = 0.0;       ///< with the adaptive picture, exponents 1; 1 is identity
  double ms_ssim_wang = 0.0;  ///< the same with Wang's exponents
};

struct Evaluation {
  int height = 0;  ///< of the image, pixels
  int width = 0;
  PictureFigures original;
  PictureFigures adaptive;  ///< of the adaptive method's texture picture, with its defaults
  std::vector<OrderFigures> orders;  ///< kSweptOrders entries by rising order, or none
};

/// Everything is computed in double. Without `sweep` no fixed order is
/// extracted and no MS-SSIM is taken. \param image  at least 2 x 2; for a sweep
/// at least kMsSsimSmallestSide on each side \param order_done  called after
/// each order of a sweep \throws std::invalid_argument if the image is smaller,
/// with its size and the one that is needed Thread-safe.
[[nodiscard]] Evaluation evaluate_image(const GreyImage& image, bool sweep,
                                        const std::function<void()>& order_done = {});

/// The order whose texture is most like the adaptive one by MS-SSIM with
/// exponents 1; the lowest of several. \pre there are orders
[[nodiscard]] const OrderFigures& closest_order(const Evaluation& evaluation);

}  // namespace touchtrial::engine
