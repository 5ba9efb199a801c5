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
constexpr int kBins = kSenseBins;  // without the mean; the last is half the sample rate
constexpr double kLandingS = 0.5;
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

/// Cumulative powers, so that the power of a band is a difference. Entry k sums bins 1 .. k.
class CumulativePower {
 public:
  /// \param k  1, 2, .. kBins, in this order
  void add(int k, double power) noexcept { sums_[k] = sums_[k - 1] + power; }
  /// Power up to a frequency in bins; bin k spans k - 1/2 to k + 1/2.
  [[nodiscard]] double power_up_to(double bins) const noexcept {
    const double index = std::clamp(bins - 0.5, 0.0, static_cast<double>(kBins));
    const int lower = std::min(static_cast<int>(index), kBins - 1);
    return sums_[lower] + (index - lower) * (sums_[lower + 1] - sums_[lower]);
  }
  [[nodiscard]] double band_power(double low_bins, double high_bins) const noexcept {
    return power_up_to(high_bins) - power_up_to(low_bins);
  }

 private:
  std::array<double, kBins + 1> sums_{};
};

/// The smallest power with a threshold curve, in squared thresholds.
constexpr double kMinPower = 1e-12;

using Weights = std::array<double, kBins + 1>;

/// The weight of each bin's power.
Weights weights_of(const SenseOptions& options) {
  Weights weights;
  weights.fill(1.0);
  if (!options.curve) return weights;
  const std::vector<double>& bin_weights =
      threshold_weights(*options.curve, kWindow, options.rate_hz);
  std::copy(bin_weights.begin(), bin_weights.end(), weights.begin());
  return weights;
}

/// Sums of the felt vector, added in the order of the samples.
struct FeltSums {
  float x = 0.0F, y = 0.0F, z = 0.0F;

  void add(float felt_x, float felt_y, float felt_z) noexcept {
    x += felt_x;
    y += felt_y;
    z += felt_z;
  }
};

/// Sums over half a window.
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

/// Powers, N^2 or squared thresholds, summed over windows.
struct FeltPower {
  std::array<double, kFeltBands> lateral{};
  std::array<double, kFeltBands> normal{};
  double xx = 0.0, yy = 0.0, xy = 0.0;
  std::array<PartPower, kFeltParts> parts{};
  std::array<double, kBins + 1> bins{};  // of all axes, without weights
  int windows = 0;
};

int part_at(Vec3 position_mm, const PlaneGeometry& plane) noexcept {
  const auto grid_index = [](double coordinate_mm, double side_mm) {
    const double share = coordinate_mm / side_mm * kFeltPartsPerSide;
    return static_cast<int>(std::clamp(share, 0.0, kFeltPartsPerSide - 1.0));
  };
  return grid_index(position_mm.y, plane.height_mm()) * kFeltPartsPerSide +
         grid_index(position_mm.x, plane.width_mm());
}

}  // namespace

struct TextureSense::State {
  explicit State(const SenseOptions& sense_options)
      : options(sense_options), weights(weights_of(sense_options)), fft(1, kWindow) {}

  void add_sample(const Vec3& position_mm, const Vec3& felt, bool in_contact) noexcept;
  void finish_half() noexcept;
  [[nodiscard]] Spectrum spectrum_of(const Samples& samples, float mean) noexcept;
  void add_window(double speed_mm_s, Vec3 middle_mm) noexcept;

  SenseOptions options;
  Weights weights;
  RealFft<float> fft;
  Samples hann = hann_window();
  Samples x{}, y{}, z{};
  FeltSums sums, next_sums;  // of this window, and of the next, which overlaps its second half
  int sample_count = 0;
  HalfWindow previous_half, current_half;
  Vec3 last_position_mm;
  bool has_landed = false;
  int samples_to_skip = 0;  // remaining samples to skip after landing
  FeltPower power;
};

inline void TextureSense::State::add_sample(const Vec3& position_mm, const Vec3& felt,
                                            bool in_contact) noexcept {
  x[sample_count] = static_cast<float>(felt.x);
  y[sample_count] = static_cast<float>(felt.y);
  z[sample_count] = static_cast<float>(felt.z);
  sums.add(x[sample_count], y[sample_count], z[sample_count]);
  next_sums.add(x[sample_count], y[sample_count], z[sample_count]);
  const Vec2 step_mm{position_mm.x - last_position_mm.x, position_mm.y - last_position_mm.y};
  current_half.path_mm += std::sqrt(step_mm.x * step_mm.x + step_mm.y * step_mm.y);
  current_half.contacts += in_contact ? 1 : 0;
  current_half.end_mm = copy_by_component(position_mm);
  ++sample_count;
  if (sample_count % kHop == 0) finish_half();
}

void TextureSense::State::finish_half() noexcept {
  if (sample_count == kWindow) {
    const double speed_mm_s =
        (previous_half.path_mm + current_half.path_mm) * options.rate_hz / kWindow;
    const int contacts = previous_half.contacts + current_half.contacts;
    if (contacts >= kMinContacts && speed_mm_s >= kMinSpeedMmS) {
      add_window(speed_mm_s, previous_half.end_mm);
    }
    for (Samples* samples : {&x, &y, &z}) {
      std::copy(samples->begin() + kHop, samples->end(), samples->begin());
    }
    sample_count = kHop;
    sums = next_sums;
  }
  next_sums = {};
  previous_half = current_half;
  current_half = {};
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
  // The scale is one-sided, so that the powers of all bins sum to the variance; Hann's squares sum
  // to 3/8.
  constexpr double kScale = 2.0 / (kWindow * (0.375 * kWindow));
  // Returns the real part of a times the conjugate of b.
  const auto product = [](std::complex<float> a, std::complex<float> b) {
    return a.real() * b.real() + a.imag() * b.imag();
  };
  // Two loops, because only the first one vectorises.
  std::array<float, kBins + 1> px, py, pz, pxy;
  for (int k = 1; k <= kBins; ++k) {
    px[k] = product(fx[k], fx[k]);
    py[k] = product(fy[k], fy[k]);
    pz[k] = product(fz[k], fz[k]);
    pxy[k] = product(fx[k], fy[k]);
    power.bins[k] += kScale * (px[k] + py[k] + pz[k]);
  }
  CumulativePower xx, yy, zz, xy;
  for (int k = 1; k <= kBins; ++k) {
    xx.add(k, weights[k] * (kScale * px[k]));
    yy.add(k, weights[k] * (kScale * py[k]));
    zz.add(k, weights[k] * (kScale * pz[k]));
    xy.add(k, weights[k] * (kScale * pxy[k]));
  }
  const double min_bin = speed_mm_s * kWindow / options.rate_hz / kMaxFeltMm;
  for (int band = 0; band < kFeltBands; ++band) {
    const double low = std::ldexp(min_bin, band);
    power.lateral[band] += xx.band_power(low, 2.0 * low) + yy.band_power(low, 2.0 * low);
    power.normal[band] += zz.band_power(low, 2.0 * low);
  }
  const double max_bin = std::ldexp(min_bin, kFeltBands);
  power.xx += xx.band_power(min_bin, max_bin);
  power.yy += yy.band_power(min_bin, max_bin);
  power.xy += xy.band_power(min_bin, max_bin);
  PartPower& part = power.parts[part_at(middle_mm, options.plane)];
  part.lateral += xx.band_power(min_bin, max_bin) + yy.band_power(min_bin, max_bin);
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
  state_->sample_count = 0;
  state_->sums = {};
  state_->next_sums = {};
  state_->previous_half = {};
  state_->current_half = {};
  state_->has_landed = false;
  state_->power = {};
}

void TextureSense::feel(const Vec3& position_mm, const Vec3& force_n, const Vec3& felt) noexcept {
  State& s = *state_;
  if (!s.has_landed) {
    s.has_landed = force_n.z > 0.0;
    s.samples_to_skip = static_cast<int>(kLandingS * s.options.rate_hz);
  } else if (s.samples_to_skip > 0) {
    --s.samples_to_skip;
  } else {
    s.add_sample(position_mm, felt, force_n.z > 0.0);
  }
  s.last_position_mm = copy_by_component(position_mm);
}

FeltFeatures TextureSense::features() const noexcept {
  const FeltPower& p = state_->power;
  const double share = p.windows > 0 ? 1.0 / p.windows : 0.0;
  const SenseOptions& options = state_->options;
  const double min_power = options.curve ? kMinPower : options.threshold_n * options.threshold_n;
  const auto intensity = [min_power](double mean_power) {
    return 0.5 * std::log(std::max(0.0, mean_power) + min_power);
  };
  FeltFeatures features{};
  for (int band = 0; band < kFeltBands; ++band) {
    features[kLateralBandsAt + band] = intensity(share * p.lateral[band]);
    features[kNormalBandsAt + band] = intensity(share * p.normal[band]);
  }
  const double diagonal = 0.5 * (p.xx + p.yy);
  const std::array<double, kFeltDirections> direction_powers{p.xx, diagonal + p.xy, p.yy,
                                                             diagonal - p.xy};
  for (int i = 0; i < kFeltDirections; ++i)
    features[kDirectionsAt + i] = intensity(share * direction_powers[i]);
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
