#include "bench/peers/opencv.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace touchtrial::bench {
namespace {

constexpr int kScales = 5;
constexpr int kHalfWindow = 5;  // of the 11 x 11 window
constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
constexpr double kC2 = 0.03 * 255 * 0.03 * 255;

cv::Mat counts_of(const cv::Mat& image, int dy, int dx) {
  cv::Mat counts = cv::Mat::zeros(256, 256, CV_32S);
  for (int y = std::max(0, -dy); y < image.rows - std::max(0, dy); ++y) {
    const auto* const row = image.ptr<std::uint8_t>(y);
    const auto* const neighbour_row = image.ptr<std::uint8_t>(y + dy);
    for (int x = std::max(0, -dx); x < image.cols - std::max(0, dx); ++x) {
      ++counts.at<int>(row[x], neighbour_row[x + dx]);
      ++counts.at<int>(neighbour_row[x + dx], row[x]);
    }
  }
  return counts;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// \param p  symmetric matrix of probabilities
/// \return mean and variance of the marginal distribution
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

double OpenCvMsSsim::run(const cv::Mat& a, const cv::Mat& b) {
  a.convertTo(a_, CV_32F);
  b.convertTo(b_, CV_32F);
  double similarity = 1.0;
  for (int scale = 0; scale < kScales; ++scale) {
    if (scale > 0) halve(a_);
    if (scale > 0) halve(b_);
    const Means means = means_of_scale(scale == kScales - 1);
    similarity *= means.structure * means.luminance;
  }
  return similarity;
}

void OpenCvMsSsim::halve(cv::Mat& image) {
  const int odd_row = image.rows % 2;
  const int odd_column = image.cols % 2;
  if (odd_row + odd_column > 0) {
    cv::copyMakeBorder(image, half_, 0, odd_row, 0, odd_column, cv::BORDER_REPLICATE);
    cv::swap(image, half_);
  }
  cv::resize(image, half_, {image.cols / 2, image.rows / 2}, 0, 0, cv::INTER_AREA);
  cv::swap(image, half_);
}

/// Uses only windows inside the image.
void OpenCvMsSsim::blur(const cv::Mat& source, cv::Mat& target) {
  cv::GaussianBlur(source, blurred_, {2 * kHalfWindow + 1, 2 * kHalfWindow + 1}, 1.5);
  blurred_(cv::Rect(kHalfWindow, kHalfWindow, source.cols - 2 * kHalfWindow,
                    source.rows - 2 * kHalfWindow))
      .copyTo(target);
}

OpenCvMsSsim::Means OpenCvMsSsim::means_of_scale(bool with_luminance) {
  blur(a_, mean_a_);
  blur(b_, mean_b_);
  cv::multiply(a_, a_, product_);
  blur(product_, variance_a_);
  cv::multiply(b_, b_, product_);
  blur(product_, variance_b_);
  cv::multiply(a_, b_, product_);
  blur(product_, covariance_);
  cv::multiply(mean_a_, mean_a_, square_a_);
  cv::multiply(mean_b_, mean_b_, square_b_);
  cv::multiply(mean_a_, mean_b_, mean_product_);
  cv::subtract(covariance_, mean_product_, covariance_);
  cv::add(variance_a_, variance_b_, denominator_);
  cv::add(square_a_, square_b_, square_a_);
  cv::subtract(denominator_, square_a_, denominator_);
  covariance_.convertTo(numerator_, CV_32F, 2.0, kC2);
  cv::add(denominator_, kC2, denominator_);
  cv::divide(numerator_, denominator_, numerator_);
  Means means{cv::mean(numerator_)[0], 1.0};
  if (with_luminance) {
    mean_product_.convertTo(numerator_, CV_32F, 2.0, kC1);
    cv::add(square_a_, kC1, denominator_);
    cv::divide(numerator_, denominator_, numerator_);
    means.luminance = cv::mean(numerator_)[0];
  }
  return means;
}

engine::GlcmTable pair_loop_glcm(const cv::Mat& image) {
  engine::GlcmTable table{};
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    table[i] =
        statistics_of(counts_of(image, engine::kGlcmOffsets[i].dy, engine::kGlcmOffsets[i].dx));
  }
  return table;
}

}  // namespace touchtrial::bench
