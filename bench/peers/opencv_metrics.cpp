#include "bench/peers/opencv.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace touchtrial::bench {
namespace {

cv::Mat counts_of(const cv::Mat& image, int dy, int dx) {
  cv::Mat counts = cv::Mat::zeros(256, 256, CV_32S);
  for (int y = std::max(0, -dy); y < image.rows - std::max(0, dy); ++y) {
    const auto* const row = image.ptr<std::uint8_t>(y);
    const auto* const other = image.ptr<std::uint8_t>(y + dy);
    for (int x = std::max(0, -dx); x < image.cols - std::max(0, dx); ++x) {
      ++counts.at<int>(row[x], other[x + dx]);
      ++counts.at<int>(other[x + dx], row[x]);
    }
  }
  return counts;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// The moments of one level; the matrix is symmetric.
Moments moments_of(const cv::Mat& p) {
  Moments moments;
  double square = 0.0;
  for (int i = 0; i < p.rows; ++i) {
    const double share = cv::sum(p.row(i))[0];
    moments.mean += i * share;
    square += i * i * share;
  }
  moments.variance = square - moments.mean * moments.mean;
  return moments;
}

engine::GlcmStatistics statistics_of(const cv::Mat& counts) {
  cv::Mat p;
  counts.convertTo(p, CV_64F, 1.0 / cv::sum(counts)[0]);
  const Moments moments = moments_of(p);
  engine::GlcmStatistics statistics{0.0, 0.0, 0.0, 0.0, 0.0};
  for (int i = 0; i < p.rows; ++i) {
    const auto* const row = p.ptr<double>(i);
    for (int j = 0; j < p.cols; ++j) {
      if (row[j] == 0.0) continue;
      statistics.angular_second_moment += row[j] * row[j];
      statistics.entropy -= row[j] * std::log(row[j]);
      statistics.contrast += (i - j) * (i - j) * row[j];
      statistics.correlation += (i - moments.mean) * (j - moments.mean) * row[j];
    }
  }
  statistics.energy = std::sqrt(statistics.angular_second_moment);
  statistics.correlation = moments.variance > 0.0 ? statistics.correlation / moments.variance : 1.0;
  return statistics;
}

}  // namespace

engine::GlcmTable pair_loop_glcm(const cv::Mat& image) {
  engine::GlcmTable table{};
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    table[i] =
        statistics_of(counts_of(image, engine::kGlcmOffsets[i].dy, engine::kGlcmOffsets[i].dx));
  }
  return table;
}

}  // namespace touchtrial::bench
