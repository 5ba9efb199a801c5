/// \file The middle of a handful of times.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace touchtrial::bench {

/// The middle value, or the mean of the two in the middle. \pre not empty
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

}  // namespace touchtrial::bench
