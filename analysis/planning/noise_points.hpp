/// \file The fixed quasi-random numbers that an AnswerModel integrates over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// Points of Sobol's sequence, shifted at random (digit by digit), as independent standard normals.
class NoisePoints {
 public:
  /// \param dimensions  of a point, >= 1  \param count  of points
  /// \param index  of the shift; other indices have other points
  NoisePoints(int dimensions, std::size_t count, std::uint64_t seed, std::uint64_t index);

  [[nodiscard]] std::span<const double> point(std::size_t i) const noexcept {
    return {normals_.data() + i * dimensions_, dimensions_};
  }

 private:
  std::size_t dimensions_;
  std::vector<double> normals_;
};

/// The means of so many equally likely groups of a standard normal, scaled to its variance.
[[nodiscard]] std::vector<double> normal_groups(int groups);

}  // namespace touchtrial::planning
