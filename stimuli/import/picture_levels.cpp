#include "stimuli/import/picture_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace touchtrial::stimuli {
namespace {

using Histogram = std::array<std::int64_t, 256>;

Histogram histogram_of(const GreyImage& picture) {
  Histogram histogram{};
  for (const std::uint8_t grey : picture.samples()) ++histogram[grey];
  return histogram;
}

/// The first grey level, counted from black or from white, up to which lie more than `share` of the
/// pixels.
int tail(const Histogram& histogram, double share, bool from_bright) {
  std::int64_t total = 0;
  for (const std::int64_t count : histogram) total += count;
  std::int64_t beyond = 0;
  for (std::size_t step = 0; step < histogram.size(); ++step) {
    const std::size_t level = from_bright ? histogram.size() - 1 - step : step;
    beyond += histogram[level];
    if (static_cast<double>(beyond) > share * static_cast<double>(total)) {
      return static_cast<int>(level);
    }
  }
  return 0;
}

/// Mean of the squared gradient, by forward differences within the picture.
double mean_squared_gradient(const GreyImage& picture) {
  double across = 0.0;
  double down = 0.0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const double here = picture.at(y, x);
      if (x + 1 < picture.width()) across += std::pow(picture.at(y, x + 1) - here, 2);
      if (y + 1 < picture.height()) down += std::pow(picture.at(y + 1, x) - here, 2);
    }
  }
  const auto steps = [](int length, int other) {
    return std::max(1.0, static_cast<double>(length - 1) * other);
  };
  return across / steps(picture.width(), picture.height()) +
         down / steps(picture.height(), picture.width());
}

/// The largest rms that a picture can have about a mean without clipping beyond its tails.
double reachable_rms(const PictureLevels& levels, double mean_grey) {
  const double up = std::max(levels.high_grey - levels.mean_grey, 0.5);
  const double down = std::max(levels.mean_grey - levels.low_grey, 0.5);
  return levels.rms_grey * std::min((255.0 - mean_grey) / up, mean_grey / down);
}

double median_rms(std::span<const PictureLevels> set) {
  std::vector<double> rms;
  for (const PictureLevels& levels : set) rms.push_back(levels.rms_grey);
  return median(std::move(rms));
}

}  // namespace

double median(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const std::size_t middle = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[middle] : (numbers[middle - 1] + numbers[middle]) / 2;
}

PictureLevels levels_of(const GreyImage& picture) {
  const Histogram histogram = histogram_of(picture);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t level = 0; level < histogram.size(); ++level) {
    const auto weighted = static_cast<double>(histogram[level]) * static_cast<double>(level);
    sum += weighted;
    squares += weighted * static_cast<double>(level);
  }
  const auto pixels = static_cast<double>(picture.size());
  PictureLevels levels;
  levels.mean_grey = sum / pixels;
  levels.rms_grey = std::sqrt(std::max(0.0, (squares - sum * sum / pixels) / pixels));
  levels.low_grey = tail(histogram, kTailShare, false);
  levels.high_grey = tail(histogram, kTailShare, true);
  const double gradient = std::sqrt(mean_squared_gradient(picture));
  if (gradient > 0.0) levels.feature_px = 2 * std::numbers::pi * levels.rms_grey / gradient;
  return levels;
}

EqualLevels equal_levels(std::span<const PictureLevels> set, LevelEqualising which) {
  EqualLevels wanted;
  if (which == LevelEqualising::mean || which == LevelEqualising::both) {
    wanted.mean_grey = kEqualMeanGrey;
  }
  if (which == LevelEqualising::rms || which == LevelEqualising::both) {
    double rms = median_rms(set);
    for (const PictureLevels& levels : set) {
      rms = std::min(rms, reachable_rms(levels, wanted.mean_grey.value_or(levels.mean_grey)));
    }
    wanted.rms_grey = rms;
  }
  return wanted;
}

EqualisedPicture equalised(const GreyImage& picture, const PictureLevels& levels,
                           const EqualLevels& wanted) {
  const double gain = wanted.rms_grey ? *wanted.rms_grey / levels.rms_grey : 1.0;
  const double mean = wanted.mean_grey.value_or(levels.mean_grey);
  EqualisedPicture result{GreyImage(picture.height(), picture.width()), 0.0};
  std::int64_t clipped = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double grey = std::floor(mean + gain * (picture.samples()[i] - levels.mean_grey) + 0.5);
    if (grey < 0.0 || grey > 255.0) ++clipped;
    result.picture.samples()[i] = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
  }
  result.clipped_share = static_cast<double>(clipped) / static_cast<double>(picture.size());
  return result;
}

}  // namespace touchtrial::stimuli
