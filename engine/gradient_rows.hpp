/// \file How steep a plane is. Source: docs/method.md, "Gradient and order map" and "Options".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_choices.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// Gives the norm of a plane's gradient row by row, with symmetric extension. Differences come
/// before sums, so that equal neighbours give exactly zero. Sample is double or std::uint8_t. Keeps
/// a reference to the plane; not thread-safe.
template <typename Sample>
class GradientRows {
 public:
  /// \param plane  not empty
  GradientRows(const Plane<Sample>& plane, Gradient gradient);

  /// The norms of row y, >= 0; valid until the next call.
  [[nodiscard]] std::span<const double> row(int y);

 private:
  [[nodiscard]] double& smooth(int x) { return smooth_[static_cast<std::size_t>(x + 1)]; }
  [[nodiscard]] double& slope(int x) { return slope_[static_cast<std::size_t>(x + 1)]; }
  void filter_columns(int y);

  const Plane<Sample>& plane_;
  Gradient gradient_;
  std::vector<double> smooth_;  ///< along y, with a mirrored sample before and behind
  std::vector<double> slope_;
  std::vector<double> norms_;
};

}  // namespace touchtrial::engine
