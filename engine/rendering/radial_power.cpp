#include "engine/rendering/radial_power.hpp"

#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

namespace touchtrial::engine {
namespace {

constexpr double kRoundingOfRadii = 1e-9;  // relative

/// Loads a plane less its mean into the transform, and transforms it.
void transform(const Plane<double>& plane, RealFft<double>& fft) {
  const auto samples = plane.samples();
  const double mean =
      std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  std::ranges::transform(samples, fft.plane().begin(),
                         [mean](double sample) { return sample - mean; });
  fft.forward();
}

/// The power of the coefficients in one row of the half spectrum, twice where the conjugate that is
/// not stored belongs to another column.
template <typename Visit>
void for_each_power(RealFft<double>& fft, int height, int width, Visit visit) {
  const int columns = width / 2 + 1;
  for (int row = 0; row < height; ++row) {
    const double fy = static_cast<double>(std::min(row, height - row)) / height;
    for (int column = 0; column < columns; ++column) {
      if (row == 0 && column == 0) continue;
      const double fx = static_cast<double>(column) / width;
      const bool has_twin = column != 0 && 2 * column != width;
      const std::size_t at = static_cast<std::size_t>(row) * columns + column;
      visit(std::sqrt(fx * fx + fy * fy), (has_twin ? 2.0 : 1.0) * std::norm(fft.spectrum()[at]));
    }
  }
}

}  // namespace

std::vector<double> power_shares_above(const Plane<double>& x, const Plane<double>& y,
                                       std::span<const double> limits_cycles_per_px) {
  RealFft<double> fft(x.height(), x.width());
  std::vector<double> shares(limits_cycles_per_px.size(), 0.0);
  double total = 0.0;
  for (const Plane<double>* component : {&x, &y}) {
    transform(*component, fft);
    for_each_power(fft, x.height(), x.width(), [&](double cycles_per_px, double power) {
      total += power;
      for (std::size_t i = 0; i < shares.size(); ++i) {
        if (cycles_per_px > limits_cycles_per_px[i] * (1.0 + kRoundingOfRadii)) shares[i] += power;
      }
    });
  }
  for (double& share : shares) share = total > 0.0 ? share / total : 0.0;
  return shares;
}

}  // namespace touchtrial::engine
