#include "engine/order_map.hpp"

#include <algorithm>

namespace touchtrial::engine {
namespace {

double order_at(double csgv, double largest) {
  if (csgv < kFlatBelowCsgv) return 0.0;
  if (csgv <= kSteepAboveCsgv) return csgv / (3.0 * largest) + 0.666;
  return csgv / (2.0 * largest) + 0.499;
}

}  // namespace

Plane<double> order_map(const Plane<double>& csgv) {
  const double largest = *std::max_element(csgv.samples().begin(), csgv.samples().end());
  Plane<double> orders(csgv.height(), csgv.width());
  std::transform(csgv.samples().begin(), csgv.samples().end(), orders.samples().begin(),
                 [largest](double value) { return order_at(value, largest); });
  return orders;
}

}  // namespace touchtrial::engine
