/// \file A statistic of one picture: the entropy of its grey levels.
/// Source: docs/method.md, "Metrics" (paper Eq. 5).
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The entropy of the histogram with 256 bins, in nats: 0 for a constant image, at most ln 256.
/// \throws std::invalid_argument if the image is empty
/// Thread-safe.
[[nodiscard]] double entropy(const GreyImage& image);

}  // namespace touchtrial::engine
