/// \file The whole adaptive extraction by OpenCV, as good users would write it: sub-bands by
/// separable filters, the rings' sums from shifted views of one padded image, Horner's rule on
/// planes. Every matrix is kept from image to image.
#pragma once

#include "bench/peers/opencv_daub4.hpp"
#include "core/plane.hpp"

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// How far its author went.
enum class RingSums {
  plain,  ///< single precision throughout, one sepFilter2D a sub-band
  tuned   ///< rings in 16 bits, where they are exact, and half the work for the sub-bands
};

class OpenCvRingSums {
 public:
  explicit OpenCvRingSums(RingSums how)
      : daub4_(how == RingSums::tuned ? Daub4Way::by_rows : Daub4Way::full_size),
        sum_type_(how == RingSums::tuned ? CV_16S : CV_32F) {}

  /// \param image  8 bit, both sides even  \param radius  K, 1 .. 63
  void extract(const cv::Mat& image, int radius);
  /// After extract: clamp(round(128 + T)).
  void make_picture();
  /// After extract: minus half the Sobel gradient of T. Differs from docs/method.md at the
  /// outermost pixels, where that counts only neighbours that exist.
  void make_force();

  [[nodiscard]] const cv::Mat& texture() const noexcept { return texture_; }
  [[nodiscard]] const cv::Mat& picture() const noexcept { return picture_; }
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
};

}  // namespace touchtrial::bench
