/// \file DAUB4 sub-bands by OpenCV: separable filters at full size, then every other sample.
#pragma once

#include "core/plane.hpp"

#include <array>

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// How the separable filters are put together.
enum class Daub4Way {
  full_size,  ///< one sepFilter2D a band, and a quarter of its samples kept
  by_rows     ///< along y first, then only the rows that stay: half the work, and less obvious
};

/// In single precision. Keeps its matrices from image to image.
class OpenCvDaub4 {
 public:
  explicit OpenCvDaub4(Daub4Way way) : way_(way) {}

  /// \param image  8 bit or float, both sides even
  void run(const cv::Mat& image);

  /// ll, lh, hl, hh, as of docs/method.md.
  [[nodiscard]] const std::array<cv::Mat, 4>& bands() const noexcept { return bands_; }

 private:
  void run_at_full_size(const cv::Mat& image);
  void run_by_rows(const cv::Mat& image);

  Daub4Way way_;
  cv::Mat along_y_, filtered_;
  std::array<cv::Mat, 4> bands_;
};

}  // namespace touchtrial::bench
