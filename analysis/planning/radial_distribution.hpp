/// \file How far along a direction isotropic normal noise reaches.
#pragma once

#include <vector>

namespace touchtrial::planning {

/// Of a noise vector of independent standard normals in d dimensions, length and direction are
/// independent. This is the distribution of the signed length along a line through the middle:
/// symmetric, its absolute value with d degrees of freedom chi-distributed. Tabulated once (cubic
/// between 2,048 points a side, error below 1e-9); thread-safe once made.
class RadialDistribution {
 public:
  /// \param dimensions  >= 1
  explicit RadialDistribution(int dimensions);

  struct Value {
    double below = 0.0;    ///< probability of less than t
    double density = 0.0;  ///< at t
  };
  [[nodiscard]] Value at(double t) const noexcept;

 private:
  double reach_;  ///< beyond which there is nothing to speak of
  double step_;
  std::vector<double> beyond_;   ///< probability of more than i steps, of the absolute value
  std::vector<double> density_;  ///< its density, a step
};

}  // namespace touchtrial::planning
