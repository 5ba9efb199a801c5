#include "engine/gl_weights.hpp"

#include <cstddef>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

void check(double order, int radius) {
  if (!(order >= 0.0 && order < 1.0)) {
    throw std::invalid_argument("order: must be in [0, 1)");
  }
  if (radius < 1) throw std::invalid_argument("radius: must be at least 1");
}

}  // namespace

std::vector<double> gl_weights(double order, int radius) {
  check(order, radius);
  std::vector<double> weights(static_cast<std::size_t>(radius) + 1);
  weights[0] = 1.0;
  for (int k = 1; k <= radius; ++k) {
    weights[static_cast<std::size_t>(k)] =
        weights[static_cast<std::size_t>(k - 1)] * (k - 1 - order) / k;
  }
  return weights;
}

double gl_weight_sum(double order, int radius) {
  check(order, radius);
  double product = 1.0;
  for (int k = 1; k <= radius; ++k) product *= 1.0 - order / k;
  return product;
}

}  // namespace touchtrial::engine
