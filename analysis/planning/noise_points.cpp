#include "analysis/planning/noise_points.hpp"

#include "core/random.hpp"

#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>

namespace touchtrial::planning {
namespace {

/// The middle of the cell of 2^-53 that the bits name: never 0 or 1.
double normal_of(std::uint64_t bits) {
  constexpr int kUnused = 11;
  const double uniform = (static_cast<double>(bits >> kUnused) + 0.5) * 0x1.0p-53;
  // The upper tail by symmetry: close to 1 there are fewer numbers than close to 0.
  const boost::math::normal standard;
  return uniform < 0.5 ? boost::math::quantile(standard, uniform)
                       : boost::math::quantile(boost::math::complement(standard, 1.0 - uniform));
}

}  // namespace

NoisePoints::NoisePoints(int dimensions, std::size_t count, std::uint64_t seed, std::uint64_t index)
    : dimensions_(static_cast<std::size_t>(dimensions)) {
  RandomStream random(seed, "answer model: shift of the noise points", index);
  std::vector<std::uint64_t> shift(dimensions_);
  for (std::uint64_t& bits : shift) bits = random.bits();
  boost::random::sobol sequence(dimensions_);
  normals_.reserve(dimensions_ * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::uint64_t bits : shift) normals_.push_back(normal_of(sequence() ^ bits));
  }
}

std::vector<double> normal_groups(int groups) {
  const boost::math::normal standard;
  std::vector<double> means;
  double from = 0.0;  // density at the group's lower end
  double squares = 0.0;
  for (int i = 1; i <= groups; ++i) {
    const double to =
        i < groups ? boost::math::pdf(
                         standard, boost::math::quantile(standard, static_cast<double>(i) / groups))
                   : 0.0;
    means.push_back(groups * (from - to));
    squares += means.back() * means.back();
    from = to;
  }
  const double scale = squares > 0.0 ? std::sqrt(groups / squares) : 0.0;
  for (double& mean : means) mean *= scale;
  return means;
}

}  // namespace touchtrial::planning
