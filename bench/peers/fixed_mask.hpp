/// \file The fixed-order texture as one linear mask, for OpenCV's filter2D.
#pragma once

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// What the mask gives of an image.
enum class MaskGives {
  texture,  ///< T
  enhanced  ///< E = I + T, from which T is what is left after subtracting I
};

/// The (2 K + 1) x (2 K + 1) mask of docs/method.md, "Extraction", in single precision.
/// \param order  v in [0, 1)  \param radius  K, >= 1
[[nodiscard]] cv::Mat fixed_order_mask(double order, int radius, MaskGives gives);

}  // namespace touchtrial::bench
