/// \file Weights of the Gruenwald-Letnikov fractional difference, one by one.
/// Source: docs/method.md, "Extraction".
#pragma once

#include <vector>

namespace touchtrial::reference {

/// c_0 = 1, c_k = c_{k-1} (k - 1 - v) / k. Negative from c_1 on if v > 0, and zero if v = 0.
/// \param order  v, dimensionless, in [0, 1)
/// \param radius  K, >= 1
/// \return c_0 .. c_K
[[nodiscard]] inline std::vector<double> gl_weights(double order, int radius) {
  std::vector<double> weights = {1.0};
  for (int k = 1; k <= radius; ++k) weights.push_back(weights.back() * (k - 1 - order) / k);
  return weights;
}

}  // namespace touchtrial::reference
