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

/// The first grey level, from black or from white, at which the cumulative share of pixels exceeds
/// `share`.
int tail_level(const Histogram& histogram, double share, bool from_white) {
  std::int64_t total = 0;
  for (const std::int64_t count : histogram) total += count;
  std::int64_t cumulative = 0;
  for (std::size_t step = 0; step < histogram.size(); ++step) {
    const std::size_t level = from_white ? histogram.size() - 1 - step : step;
    cumulative += histogram[level];
    if (static_cast<double>(cumulative) > share * static_cast<double>(total)) {
      return static_cast<int>(level);
    }
  }
  return 0;
}

/// Mean of the squared gradient, by forward differences within the picture.
double mean_squared_gradient(const GreyImage& picture) {
  double sum_x = 0.0;
  double sum_y = 0.0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const double grey = picture.at(y, x);
      if (x + 1 < picture.width()) sum_x += std::pow(picture.at(y, x + 1) - grey, 2);
      if (y + 1 < picture.height()) sum_y += std::pow(picture.at(y + 1, x) - grey, 2);
    }
  }
  const auto steps = [](int length, int lines) {
    return std::max(1.0, static_cast<double>(length - 1) * lines);
  };
  return sum_x / steps(picture.width(), picture.height()) +
         sum_y / steps(picture.height(), picture.width());
}

/// The largest rms around a mean that clips at most the tails of a picture.
double max_rms(const PictureLevels& levels, double mean_grey) {
  const double bright_range = std::max(levels.high_grey - levels.mean_grey, 0.5);
  const double dark_range = std::max(levels.mean_grey - levels.low_grey, 0.5);
  return levels.rms_grey * std::min((255.0 - mean_grey) / bright_range, mean_grey / dark_range);
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
    const auto weighted_level = static_cast<double>(histogram[level]) * static_cast<double>(level);
    sum += weighted_level;
    squares += weighted_level * static_cast<double>(level);
  }
  const auto pixels = static_cast<double>(picture.size());
  PictureLevels levels;
  levels.mean_grey = sum / pixels;
  levels.rms_grey = std::sqrt(std::max(0.0, (squares - sum * sum / pixels) / pixels));
  levels.low_grey = tail_level(histogram, kTailShare, false);
  levels.high_grey = tail_level(histogram, kTailShare, true);
  const double gradient = std::sqrt(mean_squared_gradient(picture));
  if (gradient > 0.0) levels.feature_px = 2 * std::numbers::pi * levels.rms_grey / gradient;
  return levels;
}

EqualLevels equal_levels(std::span<const PictureLevels> set, LevelEqualising equalising) {
  EqualLevels target;
  if (equalising == LevelEqualising::mean || equalising == LevelEqualising::both) {
    target.mean_grey = kEqualMeanGrey;
  }
  if (equalising == LevelEqualising::rms || equalising == LevelEqualising::both) {
    double rms = median_rms(set);
    for (const PictureLevels& levels : set) {
      rms = std::min(rms, max_rms(levels, target.mean_grey.value_or(levels.mean_grey)));
    }
    target.rms_grey = rms;
  }
  return target;
}

EqualisedPicture equalise_picture(const GreyImage& picture, const PictureLevels& levels,
                                  const EqualLevels& target) {
  const double gain = target.rms_grey ? *target.rms_grey / levels.rms_grey : 1.0;
  const double mean = target.mean_grey.value_or(levels.mean_grey);
  EqualisedPicture result{GreyImage(picture.height(), picture.width()), 0.0};
  std::int64_t clipped_count = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double grey = std::floor(mean + gain * (picture.samples()[i] - levels.mean_grey) + 0.5);
    if (grey < 0.0 || grey > 255.0) ++clipped_count;
    result.picture.samples()[i] = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
  }
  result.clipped_share = static_cast<double>(clipped_count) / static_cast<double>(picture.size());
  return result;
}

}  // namespace touchtrial::stimuli
