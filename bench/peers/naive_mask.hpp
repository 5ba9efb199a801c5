/// \file The adaptive texture as its definition reads: at each pixel a mask of its own, made and
/// applied on the spot.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::bench {

/// T = sum over k of |c_k(v)| (I - R_k), every sum in Real.
/// \tparam Real  float, double or long double
/// \param orders  v in [0, 1) for each pixel; the image's shape
/// \param texture  is written over; the image's shape
template <typename Real>
void naive_mask_texture(const GreyImage& image, const Plane<double>& orders, int radius,
                        Plane<Real>& texture);

}  // namespace touchtrial::bench
