/// \file One row of the composite sub-band gradient (CSGV) and of the orders that follow from it,
/// in single precision, vectorised for every target. Source: docs/method.md, "CSGV and the order
/// map".
#pragma once

#include "engine/kernels/wavelet_rows.hpp"

namespace touchtrial::engine {

/// Everything up to the gradient is exact in whole numbers: CSGV is exact where the gradient is a
/// whole number along one axis, as for ramps, and 0 where there is none.
/// \param rows  with the ends of `smoothed` and `difference` mirrored, or with more of the image
/// \param first  column of the rows that the result begins with
/// \param csgv  receives `count` samples; a vector behind them may be overwritten
/// \return the largest of the samples
float csgv_row(const SobelRows& rows, int first, int count, float* csgv);

/// Orders of one row of squares, each twice: out[2 i] = out[2 i + 1] = the order of csgv[i].
/// \param largest  of the whole image, >= kFlatBelowCsgv
/// \param out  receives 2 * count samples; two vectors behind them may be overwritten
void order_row(const float* csgv, int count, float largest, float* out);

}  // namespace touchtrial::engine
