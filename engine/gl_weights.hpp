/// \file Weights of the Gruenwald-Letnikov fractional difference.
/// Source: docs/method.md, "Extraction".
#pragma once

#include <vector>

namespace touchtrial::engine {

/// c_0 = 1, c_k = c_{k-1} (k - 1 - v) / k. Negative from c_1 on if v > 0, and zero if v = 0.
/// \param order  v, dimensionless, in [0, 1)
/// \param radius  K, >= 1
/// \return c_0 .. c_K
/// \throws std::invalid_argument if the order is NaN or outside [0, 1), or the radius is below 1
[[nodiscard]] std::vector<double> gl_weights(double order, int radius);

/// S_K = c_0 + .. + c_K = (1 - v) (1 - v/2) .. (1 - v/K), in (0, 1]: what the weights leave of a
/// constant. A texture lies within 255 (1 - S_K) of zero.
/// \throws std::invalid_argument as gl_weights
[[nodiscard]] double gl_weight_sum(double order, int radius);

}  // namespace touchtrial::engine
