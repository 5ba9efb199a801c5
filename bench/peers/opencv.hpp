/// \file The extraction, MS-SSIM and co-occurrence statistics with OpenCV, as an experienced user
/// would write them. All matrices are reused between images.
#pragma once

#include "core/plane.hpp"
#include "engine/metrics/glcm.hpp"

#include <array>
#include <cstdint>

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// A view of an image, to which OpenCV's functions do not write.
[[nodiscard]] inline cv::Mat mat_of(const GreyImage& image) {
  return cv::Mat(image.height(), image.width(), CV_8U,
                 const_cast<std::uint8_t*>(image.samples().data()));
}

/// A copy of a float matrix of one channel.
[[nodiscard]] inline Plane<float> plane_of(const cv::Mat& mat) {
  Plane<float> plane(mat.rows, mat.cols);
  mat.copyTo(cv::Mat(mat.rows, mat.cols, CV_32F, plane.samples().data()));
  return plane;
}

/// The fixed-order texture as one linear (2 K + 1) x (2 K + 1) mask for filter2D, in single
/// precision. Source: docs/method.md, "Extraction".
/// \param order  v in [0, 1)
/// \param radius  K, >= 1
/// \param enhanced  whether the mask gives E = I + T, not T
[[nodiscard]] cv::Mat fixed_order_mask(double order, int radius, bool enhanced);

/// How the separable filters are combined.
enum class Daub4Way {
  full_size,  ///< one sepFilter2D for each band, keeping a quarter of the samples
  by_rows     ///< along y first, then along x on the kept rows only: half the work
};

/// DAUB4 sub-bands in single precision: separable filters at full size, then every other sample.
class OpenCvDaub4 {
 public:
  explicit OpenCvDaub4(Daub4Way way) : way_(way) {}

  /// \param image  8 bit or float, both sides even
  void run(const cv::Mat& image);

  /// ll, lh, hl, hh, as docs/method.md defines them.
  [[nodiscard]] const std::array<cv::Mat, 4>& bands() const noexcept { return bands_; }

 private:
  void run_at_full_size(const cv::Mat& image);
  void run_by_rows(const cv::Mat& image);

  Daub4Way way_;
  cv::Mat along_y_, filtered_;
  std::array<cv::Mat, 4> bands_;
};

/// The optimisation of the extraction.
enum class RingSums {
  plain,  ///< single precision throughout, Daub4Way::full_size
  tuned   ///< rings in 16 bits, where they are exact; Daub4Way::by_rows
};

/// The whole extraction: sub-bands by separable filters, ring sums from shifted views of one padded
/// image, and Horner's rule on planes.
class OpenCvRingSums {
 public:
  explicit OpenCvRingSums(RingSums how)
      : daub4_(how == RingSums::tuned ? Daub4Way::by_rows : Daub4Way::full_size),
        sum_type_(how == RingSums::tuned ? CV_16S : CV_32F) {}

  /// \param image  8 bit, both sides even
  /// \param radius  K, 1 .. 63
  void extract(const cv::Mat& image, int radius);
  /// The largest T.
  /// \pre extract was called
  [[nodiscard]] double highest() const;

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
  cv::Mat padded_u8_, padded_, nine_, column_sums_, ring_, difference_, decay_;
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
  void blur(const cv::Mat& from, cv::Mat& to);
  void halve(cv::Mat& image);

  cv::Mat a_, b_, half_, product_, blurred_;
  cv::Mat mean_a_, mean_b_, square_a_, square_b_, both_;
  cv::Mat variance_a_, variance_b_, covariance_, above_, below_;
};

/// Statistics of the co-occurrence matrix, which a plain loop over pairs counts.
/// \param image  8 bit
[[nodiscard]] engine::GlcmTable pair_loop_glcm(const cv::Mat& image);

}  // namespace touchtrial::bench
