/// \file Extraction, MS-SSIM and co-occurrence statistics with OpenCV, as an experienced user would
/// write them. All matrices are reused between images.
#pragma once

#include "core/plane.hpp"
#include "engine/metrics/glcm.hpp"

#include <array>
#include <cstdint>

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// \return a view of an image, only for reading
[[nodiscard]] inline cv::Mat mat_of(const GreyImage& image) {
  return cv::Mat(image.height(), image.width(), CV_8U,
                 const_cast<std::uint8_t*>(image.samples().data()));
}

/// \return a copy of a float matrix with one channel
[[nodiscard]] inline Plane<float> plane_of(const cv::Mat& mat) {
  Plane<float> plane(mat.rows, mat.cols);
  mat.copyTo(cv::Mat(mat.rows, mat.cols, CV_32F, plane.samples().data()));
  return plane;
}

/// \param order  v in [0, 1)
/// \param radius  K, >= 1
/// \param enhanced  whether the mask computes E = I + T instead of T
/// \return a (2 K + 1) x (2 K + 1) mask that computes the fixed-order texture with filter2D, in
///   single precision. Source: docs/method.md, "Extraction".
[[nodiscard]] cv::Mat fixed_order_mask(double order, int radius, bool enhanced);

/// The combination of the separable filters.
enum class Daub4Mode {
  full_size,  ///< one sepFilter2D per band, then every other sample of every other row
  by_rows     ///< along y first, then along x only on every other row: half the work
};

/// DAUB4 sub-bands in single precision: separable filters at full size, then every other sample.
class OpenCvDaub4 {
 public:
  explicit OpenCvDaub4(Daub4Mode mode) : mode_(mode) {}

  /// \param image  8 bit or float, both sides even
  void run(const cv::Mat& image);

  /// \return ll, lh, hl, hh, as defined in docs/method.md
  [[nodiscard]] const std::array<cv::Mat, 4>& bands() const noexcept { return bands_; }

 private:
  void run_at_full_size(const cv::Mat& image);
  void run_by_rows(const cv::Mat& image);

  Daub4Mode mode_;
  cv::Mat along_y_, filtered_;
  std::array<cv::Mat, 4> bands_;
};

/// The precision of the extraction.
enum class RingSums {
  plain,  ///< single precision throughout, Daub4Mode::full_size
  tuned   ///< rings in 16 bits, where they are exact; Daub4Mode::by_rows
};

/// The complete extraction: sub-bands by separable filters, ring sums from shifted views of a
/// padded image, and Horner's rule on planes.
class OpenCvRingSums {
 public:
  explicit OpenCvRingSums(RingSums mode)
      : daub4_(mode == RingSums::tuned ? Daub4Mode::by_rows : Daub4Mode::full_size),
        sum_type_(mode == RingSums::tuned ? CV_16S : CV_32F) {}

  /// \param image  8 bit, both sides even
  /// \param radius  K, 1 .. 63
  void extract(const cv::Mat& image, int radius);
  /// \pre extract was called
  /// \return the largest T
  [[nodiscard]] double max_texture() const;

  [[nodiscard]] const cv::Mat& texture() const noexcept { return texture_; }

 private:
  void make_orders(const cv::Mat& image);
  void sum_gradients();
  void pad(const cv::Mat& image, int radius);
  void make_difference(int k, int radius);
  void make_texture(int radius);

  OpenCvDaub4 daub4_;
  int sum_type_;
  cv::Mat slope_x_, slope_y_, slope_, csgv_, steep_, branch_, half_orders_, orders_;
  cv::Mat padded_u8_, padded_, image_times_9_, column_sums_, ring_, difference_, decay_;
  cv::Mat texture_;
};

/// MS-SSIM by Gaussian blurs of both images, their squares and their product, in single precision.
class OpenCvMsSsim {
 public:
  /// \param a,b  8 bit, of equal size, every side >= 161
  /// \return the product over five scales
  [[nodiscard]] double run(const cv::Mat& a, const cv::Mat& b);

 private:
  struct Means {
    double structure;
    double luminance;
  };
  [[nodiscard]] Means means_of_scale(bool with_luminance);
  void blur(const cv::Mat& source, cv::Mat& target);
  void halve(cv::Mat& image);

  cv::Mat a_, b_, half_, product_, blurred_;
  cv::Mat mean_a_, mean_b_, square_a_, square_b_, mean_product_;
  cv::Mat variance_a_, variance_b_, covariance_, numerator_, denominator_;
};

/// \param image  8 bit
/// \return statistics of the co-occurrence matrix, computed by a plain loop over pairs
[[nodiscard]] engine::GlcmTable pair_loop_glcm(const cv::Mat& image);

}  // namespace touchtrial::bench
