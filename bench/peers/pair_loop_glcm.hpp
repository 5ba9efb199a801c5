/// \file Co-occurrence statistics by a plain loop over pairs, as OpenCV's users write it.
#pragma once

#include "engine/metrics/glcm.hpp"

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// \param image  8 bit
[[nodiscard]] engine::GlcmTable pair_loop_glcm(const cv::Mat& image);

}  // namespace touchtrial::bench
