#include "engine/perception/texture_sense.hpp"

#include "engine/fourier/real_fft.hpp"
#include "engine/perception/threshold_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

constexpr int kWindow = kSenseWindow;
constexpr int kHop = kWindow / 2;
constexpr int kBins = kSenseBins;  // above the mean; the last is half the sample rate
constexpr double kSettleS = 0.5;
constexpr double kMinSpeedMmS = 20.0;
constexpr int kMinContacts = kWindow * 3 / 4;

using Samples = std::array<float, kWindow>;
using Spectrum = std::array<std::complex<float>, kBins + 1>;

Samples hann_window() {
  Samples window{};
  for (int i = 0; i < kWindow; ++i) {
    window[i] = static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / kWindow));
  }
  return window;
}

/// Powers summed over bins, so that the power of a band is the difference of two sums. Entry k sums
/// bins 1 .. k.
class SummedPower {
 public:
  /// \param k  1, 2, .. kBins, in this order
  void add(int k, double power) noexcept { sums_[k] = sums_[k - 1] + power; }
  /// Power up to a frequency in bins; bin k reaches from k - 1/2 to k + 1/2.
  [[nodiscard]] double up_to(double bins) const noexcept {
    const double place = std::clamp(bins - 0.5, 0.0, static_cast<double>(kBins));
    const int whole = std::min(static_cast<int>(place), kBins - 1);
    return sums_[whole] + (place - whole) * (sums_[whole + 1] - sums_[whole]);
  }
  [[nodiscard]] double between(double low_bins, double high_bins) const noexcept {
    return up_to(high_bins) - up_to(low_bins);
  }

 private:
  std::array<double, kBins + 1> sums_{};
};

/// The power that counts as zero with a threshold curve, in thresholds.
constexpr double kNoPower = 1e-12;

using Weights = std::array<double, kBins + 1>;

/// The weight of each bin's power.
Weights weights_of(const SenseOptions& options) {
  Weights weights;
  weights.fill(1.0);
  if (!options.curve) return weights;
  const std::vector<double>& of_bins = threshold_weights(*options.curve, kWindow, options.rate_hz);
  std::copy(of_bins.begin(), of_bins.end(), weights.begin());
  return weights;
}

/// Sums of what was felt, added in the order of the samples.
struct FeltSums {
  float x = 0.0F, y = 0.0F, z = 0.0F;

  void add(float felt_x, float felt_y, float felt_z) noexcept {
    x += felt_x;
    y += felt_y;
    z += felt_z;
  }
};

/// The contribution of half a window.
struct HalfWindow {
  double path_mm = 0.0;
  int contacts = 0;
  Vec3 end_mm;
};

/// Power on a part of the plane, summed over windows.
struct PartPower {
  double lateral = 0.0;
  int windows = 0;
};

/// Powers, N^2 or squares of thresholds, summed over windows.
struct FeltPower {
  std::array<double, kFeltBands> lateral{};
  std::array<double, kFeltBands> normal{};
  double xx = 0.0, yy = 0.0, xy = 0.0;
  std::array<PartPower, kFeltParts> parts{};
  std::array<double, kBins + 1> bins{};  // of all axes, without weights
  int windows = 0;
};

int part_at(Vec3 at_mm, const PlaneGeometry& plane) noexcept {
  const auto third = [](double place_mm, double side_mm) {
    const double share = place_mm / side_mm * kFeltPartsASide;
    return static_cast<int>(std::clamp(share, 0.0, kFeltPartsASide - 1.0));
  };
  return third(at_mm.y, plane.height_mm()) * kFeltPartsASide + third(at_mm.x, plane.width_mm());
}

}  // namespace

struct TextureSense::State {
  explicit State(const SenseOptions& chosen)
      : options(chosen), weights(weights_of(chosen)), fft(1, kWindow) {}

  void take(const Vec3& at_mm, const Vec3& felt, bool touches) noexcept;
  void end_half() noexcept;
  [[nodiscard]] Spectrum spectrum_of(const Samples& samples, float mean) noexcept;
  void add_window(double speed_mm_s, Vec3 middle_mm) noexcept;

  SenseOptions options;
  Weights weights;
  RealFft<float> fft;
  Samples hann = hann_window();
  Samples x{}, y{}, z{};
  FeltSums sums, later_sums;  // of this window, and of the next one, which overlaps its second half
  int filled = 0;
  HalfWindow earlier, current;
  Vec3 last_mm;
  bool landed = false;
  int samples_to_skip = 0;  // remaining samples to skip after landing
  FeltPower power;
};

inline void TextureSense::State::take(const Vec3& at_mm, const Vec3& felt, bool touches) noexcept {
  x[filled] = static_cast<float>(felt.x);
  y[filled] = static_cast<float>(felt.y);
  z[filled] = static_cast<float>(felt.z);
  sums.add(x[filled], y[filled], z[filled]);
  later_sums.add(x[filled], y[filled], z[filled]);
  const Vec2 step_mm{at_mm.x - last_mm.x, at_mm.y - last_mm.y};
  current.path_mm += std::sqrt(step_mm.x * step_mm.x + step_mm.y * step_mm.y);
  current.contacts += touches ? 1 : 0;
  current.end_mm = by_number(at_mm);
  ++filled;
  if (filled % kHop == 0) end_half();
}

void TextureSense::State::end_half() noexcept {
  if (filled == kWindow) {
    const double speed_mm_s = (earlier.path_mm + current.path_mm) * options.rate_hz / kWindow;
    const int contacts = earlier.contacts + current.contacts;
    if (contacts >= kMinContacts && speed_mm_s >= kMinSpeedMmS) {
      add_window(speed_mm_s, earlier.end_mm);
    }
    for (Samples* samples : {&x, &y, &z}) {
      std::copy(samples->begin() + kHop, samples->end(), samples->begin());
    }
    filled = kHop;
    sums = later_sums;
  }
  later_sums = {};
  earlier = current;
  current = {};
}

Spectrum TextureSense::State::spectrum_of(const Samples& samples, float mean) noexcept {
  const std::span<float> plane = fft.plane();
  for (int i = 0; i < kWindow; ++i) plane[i] = hann[i] * (samples[i] - mean);
  fft.forward();
  Spectrum spectrum;
  std::copy_n(fft.spectrum().begin(), spectrum.size(), spectrum.begin());
  return spectrum;
}

void TextureSense::State::add_window(double speed_mm_s, Vec3 middle_mm) noexcept {
  const Spectrum fx = spectrum_of(x, sums.x / kWindow);
  const Spectrum fy = spectrum_of(y, sums.y / kWindow);
  const Spectrum fz = spectrum_of(z, sums.z / kWindow);
  // One-sided, so that the powers of all bins sum to the variance; Hann's squares sum to 3/8.
  constexpr double kScale = 2.0 / (kWindow * (0.375 * kWindow));
  // Real part of a times the conjugate of b.
  const auto product = [](std::complex<float> a, std::complex<float> b) {
    return a.real() * b.real() + a.imag() * b.imag();
  };
  // In two loops, because only the first one vectorises.
  std::array<float, kBins + 1> px, py, pz, pxy;
  for (int k = 1; k <= kBins; ++k) {
    px[k] = product(fx[k], fx[k]);
    py[k] = product(fy[k], fy[k]);
    pz[k] = product(fz[k], fz[k]);
    pxy[k] = product(fx[k], fy[k]);
    power.bins[k] += kScale * (px[k] + py[k] + pz[k]);
  }
  SummedPower xx, yy, zz, xy;
  for (int k = 1; k <= kBins; ++k) {
    xx.add(k, weights[k] * (kScale * px[k]));
    yy.add(k, weights[k] * (kScale * py[k]));
    zz.add(k, weights[k] * (kScale * pz[k]));
    xy.add(k, weights[k] * (kScale * pxy[k]));
  }
  const double max_wavelength = speed_mm_s * kWindow / options.rate_hz / kMaxFeltMm;  // in bins
  for (int band = 0; band < kFeltBands; ++band) {
    const double low = std::ldexp(max_wavelength, band);
    power.lateral[band] += xx.between(low, 2.0 * low) + yy.between(low, 2.0 * low);
    power.normal[band] += zz.between(low, 2.0 * low);
  }
  const double min_wavelength = std::ldexp(max_wavelength, kFeltBands);
  power.xx += xx.between(max_wavelength, min_wavelength);
  power.yy += yy.between(max_wavelength, min_wavelength);
  power.xy += xy.between(max_wavelength, min_wavelength);
  PartPower& part = power.parts[part_at(middle_mm, options.plane)];
  part.lateral +=
      xx.between(max_wavelength, min_wavelength) + yy.between(max_wavelength, min_wavelength);
  ++part.windows;
  ++power.windows;
}

TextureSense::TextureSense(const SenseOptions& options) {
  const bool has_area = options.plane.width_mm() > 0.0 && options.plane.height_mm() > 0.0;
  if (!(options.rate_hz > 0.0) || !(options.threshold_n >= 0.0) || !has_area) {
    throw std::invalid_argument("TextureSense: rate, threshold or plane is out of range");
  }
  state_ = std::make_unique<State>(options);
}

TextureSense::~TextureSense() = default;
TextureSense::TextureSense(TextureSense&&) noexcept = default;
TextureSense& TextureSense::operator=(TextureSense&&) noexcept = default;

void TextureSense::reset(const PlaneGeometry& plane) noexcept {
  state_->options.plane = plane;
  state_->filled = 0;
  state_->sums = {};
  state_->later_sums = {};
  state_->earlier = {};
  state_->current = {};
  state_->landed = false;
  state_->power = {};
}

void TextureSense::feel(const Vec3& position_mm, const Vec3& force_n, const Vec3& felt) noexcept {
  State& s = *state_;
  if (!s.landed) {
    s.landed = force_n.z > 0.0;
    s.samples_to_skip = static_cast<int>(kSettleS * s.options.rate_hz);
  } else if (s.samples_to_skip > 0) {
    --s.samples_to_skip;
  } else {
    s.take(position_mm, felt, force_n.z > 0.0);
  }
  s.last_mm = by_number(position_mm);
}

FeltFeatures TextureSense::features() const noexcept {
  const FeltPower& p = state_->power;
  const double share = p.windows > 0 ? 1.0 / p.windows : 0.0;
  const SenseOptions& options = state_->options;
  const double min_power = options.curve ? kNoPower : options.threshold_n * options.threshold_n;
  const auto intensity = [min_power](double mean_power) {
    return 0.5 * std::log(std::max(0.0, mean_power) + min_power);
  };
  FeltFeatures features{};
  for (int band = 0; band < kFeltBands; ++band) {
    features[kLateralBandsAt + band] = intensity(share * p.lateral[band]);
    features[kNormalBandsAt + band] = intensity(share * p.normal[band]);
  }
  const double diagonal = 0.5 * (p.xx + p.yy);
  const std::array<double, kFeltDirections> along{p.xx, diagonal + p.xy, p.yy, diagonal - p.xy};
  for (int i = 0; i < kFeltDirections; ++i)
    features[kDirectionsAt + i] = intensity(share * along[i]);
  for (int i = 0; i < kFeltParts; ++i) {
    const PartPower& part = p.parts[i];
    features[kPartsAt + i] =
        intensity(part.windows > 0 ? part.lateral / part.windows : share * (p.xx + p.yy));
  }
  return features;
}

std::array<double, kSenseBins + 1> TextureSense::mean_powers() const noexcept {
  std::array<double, kSenseBins + 1> mean = state_->power.bins;
  for (double& power : mean) power /= std::max(1, state_->power.windows);
  return mean;
}

int TextureSense::windows() const noexcept {
  return state_->power.windows;
}

}  // namespace touchtrial::engine
