/// \file MS-SSIM and co-occurrence statistics, as users of OpenCV usually write them.
#pragma once

#include "engine/metrics/glcm.hpp"

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// MS-SSIM by Gaussian blurs of both images, their squares and their product, in single precision.
/// Matrices are kept from pair to pair.
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
