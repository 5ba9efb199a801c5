#include "engine/metrics/picture_statistics.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace touchtrial::engine {

double entropy(const GreyImage& image) {
  if (image.empty()) throw std::invalid_argument("entropy: the image is empty");
  std::array<std::int64_t, 256> histogram{};
  for (const std::uint8_t sample : image.samples()) ++histogram[sample];
  const auto total = static_cast<double>(image.size());
  double sum = 0.0;
  for (const std::int64_t count : histogram) {
    if (count == 0) continue;
    const auto occurrences = static_cast<double>(count);
    sum += occurrences / total * std::log(total / occurrences);
  }
  return sum;
}

}  // namespace touchtrial::engine
