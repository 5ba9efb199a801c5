#include "bench/peers/opencv_daub4.hpp"

#include <cmath>
#include <cstddef>

#include <opencv2/imgproc.hpp>

namespace touchtrial::bench {
namespace {

using Taps = cv::Matx14f;

/// {low, high}
std::array<Taps, 2> taps() {
  const double s = std::sqrt(3.0);
  const double scale = 4.0 * std::sqrt(2.0);
  const auto h = [&](double tap) { return static_cast<float>(tap / scale); };
  return {Taps(h(1 + s), h(3 + s), h(3 - s), h(1 - s)),
          Taps(h(1 - s), -h(3 - s), h(3 + s), -h(1 + s))};
}

const cv::Point kFirstTap(0, 0);

/// Rows 0, 2, 4 .. without a copy.
cv::Mat even_rows(const cv::Mat& mat) {
  return cv::Mat(mat.rows / 2, mat.cols, mat.type(), mat.data, 2 * mat.step[0]);
}

/// Columns 0, 2, 4 ..: the first of every two samples, as if they were channels.
void take_even_columns(const cv::Mat& mat, cv::Mat& to) {
  const cv::Mat pairs(mat.rows, mat.cols / 2, CV_32FC2, mat.data, mat.step[0]);
  cv::extractChannel(pairs, to, 0);
}

}  // namespace

void OpenCvDaub4::run(const cv::Mat& image) {
  if (way_ == Daub4Way::full_size) {
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
    take_even_columns(even_rows(filtered_), bands_[band]);
  }
}

void OpenCvDaub4::run_by_rows(const cv::Mat& image) {
  const auto filters = taps();
  const cv::Matx<float, 1, 1> as_it_is(1.0F);
  for (std::size_t along_y = 0; along_y < 2; ++along_y) {
    cv::sepFilter2D(image, along_y_, CV_32F, as_it_is, filters[along_y], kFirstTap, 0,
                    cv::BORDER_REFLECT);
    const cv::Mat kept = even_rows(along_y_);
    for (std::size_t along_x = 0; along_x < 2; ++along_x) {
      cv::sepFilter2D(kept, filtered_, CV_32F, filters[along_x], as_it_is, kFirstTap, 0,
                      cv::BORDER_REFLECT);
      take_even_columns(filtered_, bands_[2 * along_x + along_y]);
    }
  }
}

}  // namespace touchtrial::bench
