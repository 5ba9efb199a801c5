#include "bench/peers/opencv.hpp"
#include "tests/engine/reference/gl_weights.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace touchtrial::bench {
namespace {

using Taps = cv::Matx14f;

/// \return the low-pass and the high-pass filter
std::array<Taps, 2> taps() {
  const double s = std::sqrt(3.0);
  const double scale = 4.0 * std::sqrt(2.0);
  const auto h = [&](double tap) { return static_cast<float>(tap / scale); };
  return {Taps(h(1 + s), h(3 + s), h(3 - s), h(1 - s)),
          Taps(h(1 - s), -h(3 - s), h(3 + s), -h(1 + s))};
}

const cv::Point kFirstTap(0, 0);

/// \return a view of rows 0, 2, 4, ...
cv::Mat even_rows(const cv::Mat& mat) {
  return cv::Mat(mat.rows / 2, mat.cols, mat.type(), mat.data, 2 * mat.step[0]);
}

/// Copies columns 0, 2, 4, ... by treating pairs of samples as channels.
void copy_even_columns(const cv::Mat& mat, cv::Mat& columns) {
  const cv::Mat pairs(mat.rows, mat.cols / 2, CV_32FC2, mat.data, mat.step[0]);
  cv::extractChannel(pairs, columns, 0);
}

}  // namespace

cv::Mat fixed_order_mask(double order, int radius, bool enhanced) {
  const std::vector<double> weights = reference::gl_weights(order, radius);
  cv::Mat mask = cv::Mat::zeros(2 * radius + 1, 2 * radius + 1, CV_32F);
  double centre = enhanced ? 1.0 : 0.0;
  for (int k = 1; k <= radius; ++k) {
    const double share = std::abs(weights[static_cast<std::size_t>(k)]) / 8.0;
    centre += 8.0 * share;
    for (int dy = -k; dy <= k; dy += k) {
      for (int dx = -k; dx <= k; dx += k) {
        mask.at<float>(radius + dy, radius + dx) = static_cast<float>(-share);
      }
    }
  }
  mask.at<float>(radius, radius) = static_cast<float>(centre);
  return mask;
}

void OpenCvDaub4::run(const cv::Mat& image) {
  if (mode_ == Daub4Mode::full_size) {
    run_at_full_size(image);
  } else {
    run_by_rows(image);
  }
}

void OpenCvDaub4::run_at_full_size(const cv::Mat& image) {
  const auto filters = taps();
  for (std::size_t band = 0; band < bands_.size(); ++band) {
    // ll, lh, hl, hh: the first letter is the filter along x.
    cv::sepFilter2D(image, filtered_, CV_32F, filters[band / 2], filters[band % 2], kFirstTap, 0,
                    cv::BORDER_REFLECT);
    copy_even_columns(even_rows(filtered_), bands_[band]);
  }
}

void OpenCvDaub4::run_by_rows(const cv::Mat& image) {
  const auto filters = taps();
  const cv::Matx<float, 1, 1> identity(1.0F);
  for (std::size_t along_y = 0; along_y < 2; ++along_y) {
    cv::sepFilter2D(image, along_y_, CV_32F, identity, filters[along_y], kFirstTap, 0,
                    cv::BORDER_REFLECT);
    const cv::Mat even = even_rows(along_y_);
    for (std::size_t along_x = 0; along_x < 2; ++along_x) {
      cv::sepFilter2D(even, filtered_, CV_32F, filters[along_x], identity, kFirstTap, 0,
                      cv::BORDER_REFLECT);
      copy_even_columns(filtered_, bands_[2 * along_x + along_y]);
    }
  }
}

void OpenCvRingSums::extract(const cv::Mat& image, int radius) {
  make_orders(image);
  pad(image, radius);
  make_texture(radius);
}

void OpenCvRingSums::sum_gradients() {
  for (std::size_t band = 0; band < daub4_.bands().size(); ++band) {
    cv::Sobel(daub4_.bands()[band], slope_x_, CV_32F, 1, 0, 3, 1, 0, cv::BORDER_REFLECT);
    cv::Sobel(daub4_.bands()[band], slope_y_, CV_32F, 0, 1, 3, 1, 0, cv::BORDER_REFLECT);
    cv::magnitude(slope_x_, slope_y_, band == 0 ? csgv_ : slope_);
    if (band > 0) cv::add(csgv_, slope_, csgv_);
  }
}

void OpenCvRingSums::make_orders(const cv::Mat& image) {
  daub4_.run(image);
  sum_gradients();
  double largest = 0.0;
  cv::minMaxLoc(csgv_, nullptr, &largest);
  csgv_.convertTo(half_orders_, CV_32F, 1.0 / (3.0 * largest), 0.666);
  csgv_.convertTo(steep_, CV_32F, 1.0 / (2.0 * largest), 0.499);
  cv::compare(csgv_, 128.0, branch_, cv::CMP_GT);
  steep_.copyTo(half_orders_, branch_);
  cv::compare(csgv_, 2.0, branch_, cv::CMP_LT);
  half_orders_.setTo(0.0, branch_);
  cv::resize(half_orders_, orders_, image.size(), 0, 0, cv::INTER_NEAREST);
}

void OpenCvRingSums::pad(const cv::Mat& image, int radius) {
  cv::copyMakeBorder(image, padded_u8_, radius, radius, radius, radius, cv::BORDER_REFLECT);
  padded_u8_.convertTo(padded_, sum_type_);
  image.convertTo(image_times_9_, sum_type_, 9.0);
}

/// Computes 8 (I - R_k).
void OpenCvRingSums::make_difference(int k, int radius) {
  const int height = image_times_9_.rows;
  const int width = image_times_9_.cols;
  const auto rows_at = [&](int dy) { return padded_.rowRange(radius + dy, radius + dy + height); };
  cv::add(rows_at(-k), rows_at(k), column_sums_);
  cv::add(column_sums_, rows_at(0), column_sums_);
  const auto columns_at = [&](int dx) {
    return column_sums_.colRange(radius + dx, radius + dx + width);
  };
  cv::add(columns_at(-k), columns_at(k), ring_);
  cv::add(ring_, columns_at(0), ring_);
  if (sum_type_ == CV_32F) {
    cv::subtract(image_times_9_, ring_, difference_);
  } else {
    cv::subtract(image_times_9_, ring_, ring_);
    ring_.convertTo(difference_, CV_32F);
  }
}

/// Computes T = v/8 (8 D_1 + a_2 (8 D_2 + ...)), a_k = (k - 1 - v) / k.
void OpenCvRingSums::make_texture(int radius) {
  make_difference(radius, radius);
  cv::swap(texture_, difference_);
  for (int k = radius - 1; k >= 1; --k) {
    orders_.convertTo(decay_, CV_32F, -1.0 / (k + 1), static_cast<double>(k) / (k + 1));
    cv::multiply(texture_, decay_, texture_);
    make_difference(k, radius);
    cv::add(texture_, difference_, texture_);
  }
  cv::multiply(texture_, orders_, texture_, 1.0 / 8.0);
}

double OpenCvRingSums::max_texture() const {
  double max_value = 0.0;
  cv::minMaxLoc(texture_, nullptr, &max_value);
  return max_value;
}

}  // namespace touchtrial::bench
