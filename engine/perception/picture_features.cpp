#include "engine/perception/picture_features.hpp"

#include "engine/fourier/faded_picture.hpp"
#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace touchtrial::engine {
namespace {

using Coefficient = std::complex<double>;

/// Mean squares below this are none: a thousandth of a grey level, root mean square.
constexpr double kFaintest = 1e-6;

double log_root(double mean_square) {
  return 0.5 * std::log(mean_square + kFaintest);
}

/// The felt band of a wavelength; outside 0 .. kFeltBands - 1: none.
int band_of(double cycles_per_mm) {
  return static_cast<int>(std::floor(std::log2(cycles_per_mm * kLongestFeltMm)));
}

/// A coefficient of the half spectrum within the felt bands.
struct FeltCoefficient {
  std::size_t at = 0;
  int band = 0;
  double x = 0.0;       ///< radians per mm, towards the picture's right
  double y = 0.0;       ///< towards its lower edge
  double weight = 1.0;  ///< 2 if its conjugate is not stored
};

std::vector<FeltCoefficient> felt_coefficients(const GreyImage& picture, double pitch_mm) {
  const int height = picture.height();
  const int width = picture.width();
  const int columns = width / 2 + 1;
  std::vector<FeltCoefficient> felt;
  for (int row = 0; row < height; ++row) {
    const double fy = static_cast<double>(2 * row > height ? row - height : row) / height;
    for (int column = row == 0 ? 1 : 0; column < columns; ++column) {
      const double fx = static_cast<double>(column) / width;
      const int band = band_of(std::hypot(fx, fy) / pitch_mm);
      if (band < 0 || band >= kFeltBands) continue;
      const double turn = 2.0 * std::numbers::pi / pitch_mm;
      const bool has_twin = column != 0 && 2 * column != width;
      felt.push_back({static_cast<std::size_t>(row) * columns + column, band, turn * fx, turn * fy,
                      has_twin ? 2.0 : 1.0});
    }
  }
  return felt;
}

/// A component of the gradient as a plane, from the felt coefficients alone. Its mean square over
/// each part of the picture.
template <typename Wave>
std::array<double, kFeltParts> part_squares(const GreyImage& picture,
                                            const std::vector<FeltCoefficient>& felt,
                                            const std::vector<Coefficient>& spectrum, Wave wave,
                                            RealFft<double>& fft) {
  std::ranges::fill(fft.spectrum(), Coefficient{});
  for (const FeltCoefficient& one : felt) {
    fft.spectrum()[one.at] = Coefficient(0.0, wave(one)) * spectrum[one.at];
  }
  fft.inverse();
  const auto samples = static_cast<double>(picture.size());
  std::array<double, kFeltParts> squares{};
  std::array<int, kFeltParts> counts{};
  const double* from = fft.plane().data();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const int part = y * kFeltPartsASide / picture.height() * kFeltPartsASide +
                       x * kFeltPartsASide / picture.width();
      const double value = *from++ / samples;
      squares[part] += value * value;
      ++counts[part];
    }
  }
  for (int part = 0; part < kFeltParts; ++part) squares[part] /= std::max(counts[part], 1);
  return squares;
}

}  // namespace

FeltFeatures features_of_picture(const GreyImage& picture, double pitch_mm) {
  if (picture.empty() || !(pitch_mm > 0.0)) {
    throw std::invalid_argument("features_of_picture: the picture is empty or the pitch not > 0");
  }
  RealFft<double> fft(picture.height(), picture.width());
  load_faded(picture, fft);
  fft.forward();
  const std::vector<Coefficient> spectrum(fft.spectrum().begin(), fft.spectrum().end());
  const std::vector<FeltCoefficient> felt = felt_coefficients(picture, pitch_mm);
  const auto samples = static_cast<double>(picture.size());
  std::array<double, kFeltBands> gradient{};
  std::array<double, kFeltBands> grey{};
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (const FeltCoefficient& one : felt) {
    const double power = one.weight * std::norm(spectrum[one.at]) / (samples * samples);
    grey[one.band] += power;
    gradient[one.band] += (one.x * one.x + one.y * one.y) * power;
    xx += one.x * one.x * power;
    yy += one.y * one.y * power;
    xy += one.x * one.y * power;
  }
  FeltFeatures features{};
  for (int band = 0; band < kFeltBands; ++band) {
    features[kLateralBandsAt + band] = log_root(gradient[band]);
    features[kNormalBandsAt + band] = log_root(grey[band]);
  }
  for (int i = 0; i < kFeltDirections; ++i) {
    const double angle = std::numbers::pi * i / kFeltDirections;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    features[kDirectionsAt + i] =
        log_root(std::max(0.0, c * c * xx + s * s * yy + 2.0 * c * s * xy));
  }
  const auto x = part_squares(
      picture, felt, spectrum, [](const auto& one) { return one.x; }, fft);
  const auto y = part_squares(
      picture, felt, spectrum, [](const auto& one) { return one.y; }, fft);
  for (int part = 0; part < kFeltParts; ++part) {
    features[kPartsAt + part] = log_root(x[part] + y[part]);
  }
  return features;
}

}  // namespace touchtrial::engine
