/// \file The fractional filters that are compared: the engine's alone, its definition taken
/// literally, and a linear mask for OpenCV.
#pragma once

#include "core/plane.hpp"

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// The engine's adaptive filter alone, with additive normalisation and one order for each pixel.
/// \param orders  v in [0, 1), of the image's shape
/// \param texture  receives the texture; its memory is used again if it has the image's shape
void filter_adaptive(const GreyImage& image, int radius, const Plane<float>& orders,
                     Plane<float>& texture);

/// The adaptive texture by its definition: at each pixel a mask of its own is made and applied.
/// T = sum over k of |c_k(v)| (I - R_k), every sum in Real.
/// \tparam Real  float, double or long double
/// \param orders  v in [0, 1) for each pixel, of the image's shape
/// \param texture  receives the texture; of the image's shape
template <typename Real>
void naive_mask_texture(const GreyImage& image, const Plane<double>& orders, int radius,
                        Plane<Real>& texture);

/// The result of a mask.
enum class MaskGives {
  texture,  ///< T
  enhanced  ///< E = I + T; subtracting I gives T
};

/// The fixed-order texture as one linear (2 K + 1) x (2 K + 1) mask for filter2D, in single
/// precision. Source: docs/method.md, "Extraction".
/// \param order  v in [0, 1)
/// \param radius  K, >= 1
[[nodiscard]] cv::Mat fixed_order_mask(double order, int radius, MaskGives gives);

}  // namespace touchtrial::bench
