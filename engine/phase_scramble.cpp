#include "engine/phase_scramble.hpp"

#include "core/random.hpp"
#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {
namespace {

using Coefficient = std::complex<double>;

/// The amplitudes of the texture's variation, in the order of the half spectrum.
template <typename Real>
std::vector<double> amplitudes_of(const Plane<Real>& texture, double mean, RealFft<double>& fft) {
  std::ranges::transform(texture.samples(), fft.plane().begin(),
                         [mean](Real sample) { return static_cast<double>(sample) - mean; });
  fft.forward();
  std::vector<double> amplitudes(fft.spectrum().size());
  std::ranges::transform(fft.spectrum(), amplitudes.begin(),
                         [](const Coefficient& value) { return std::abs(value); });
  amplitudes.front() = 0.0;  // the mean is added at the end, without rounding
  return amplitudes;
}

/// Sets the amplitudes of a noise spectrum and keeps its phases. The noise is real, so the spectrum
/// keeps its conjugate symmetry.
void set_amplitudes(std::span<Coefficient> noise, const std::vector<double>& amplitudes) {
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double magnitude = std::abs(noise[i]);
    noise[i] =
        magnitude > 0.0 ? noise[i] * (amplitudes[i] / magnitude) : Coefficient(amplitudes[i]);
  }
}

}  // namespace

template <typename Real>
Plane<Real> phase_scrambled(const Plane<Real>& texture, std::uint64_t seed) {
  if (is_flat(texture)) return texture;
  const double mean = mean_of(texture);
  RealFft<double> fft(texture.height(), texture.width());
  const std::vector<double> amplitudes = amplitudes_of(texture, mean, fft);
  RandomStream random(seed, "phase-scrambled");
  std::ranges::generate(fft.plane(), [&random] { return random.normal(); });
  fft.forward();
  set_amplitudes(fft.spectrum(), amplitudes);
  fft.inverse();
  Plane<Real> scrambled(texture.height(), texture.width());
  const auto scale = 1.0 / static_cast<double>(texture.size());
  std::ranges::transform(fft.plane(), scrambled.samples().begin(),
                         [=](double sample) { return static_cast<Real>(mean + scale * sample); });
  return scrambled;
}

template Plane<float> phase_scrambled<float>(const Plane<float>&, std::uint64_t);
template Plane<double> phase_scrambled<double>(const Plane<double>&, std::uint64_t);

}  // namespace touchtrial::engine
