/// \file The adaptive extraction by OpenCV, as an experienced user would write it. Every matrix is
/// kept from image to image.
#pragma once

#include "core/plane.hpp"

#include <array>

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// How the separable filters are combined.
enum class Daub4Way {
  full_size,  ///< one sepFilter2D for each band, of which a quarter of the samples is kept
  by_rows     ///< along y first, then along x on the rows that are kept: half the work
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

/// How far the extraction is optimised.
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
  /// clamp(round(128 + T)).
  /// \pre extract was called
  void make_picture();
  /// The largest T.
  /// \pre extract was called
  void find_highest();
  /// Minus half the Sobel gradient of T. It differs from docs/method.md at the outermost pixels,
  /// where the method counts only neighbours that exist.
  /// \pre extract was called
  void make_force();

  [[nodiscard]] const cv::Mat& texture() const noexcept { return texture_; }
  [[nodiscard]] const cv::Mat& force_x() const noexcept { return force_x_; }
  [[nodiscard]] const cv::Mat& force_y() const noexcept { return force_y_; }

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
  cv::Mat texture_, picture_, force_x_, force_y_;
  double highest_ = 0.0;
};

}  // namespace touchtrial::bench
