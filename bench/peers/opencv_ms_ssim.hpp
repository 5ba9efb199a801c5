/// \file MS-SSIM as it is usually written with OpenCV: Gaussian blurs of both images, their squares
/// and their product, in single precision. Matrices are kept from pair to pair.
#pragma once

#include <opencv2/core.hpp>

namespace touchtrial::bench {

class OpenCvMsSsim {
 public:
  /// \param a,b  8 bit, of one size, every side >= 161
  /// \return the plain product over five scales
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

}  // namespace touchtrial::bench
