#include "engine/kernels/float_extraction.hpp"

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/kernels/half_gradient.hpp"
#include "engine/kernels/strips.hpp"
#include "engine/kernels/texture_sink.hpp"
#include "engine/order_map.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace touchtrial::engine {
namespace {

static_assert(ExtractionOptions::kMaxRadius <= kMaxGlRadius);

/// Clears what an extraction by another method may have left.
void forget_other_methods(Extraction<float>& result) {
  result.cartoon = {};
  result.components.clear();
  result.gap = 0.0;
  result.steps = 0;
  result.converged = true;
}

std::array<Plane<float>*, 4> sub_bands_of(Extraction<float>& result) {
  return {&result.sub_band_ll, &result.sub_band_lh, &result.sub_band_hl, &result.sub_band_hh};
}

void keep_csgv(const HalfGradient& gradient, Plane<float>& csgv) {
  for (int y = 0; y < csgv.height(); ++y) {
    const float* const from = gradient.row(y / 2);
    const auto to = csgv.row(y);
    for (std::size_t x = 0; x < to.size(); ++x) to[x] = from[x / 2];
  }
}

/// The orders of rows of the image, one after the other. Two rows share their orders, and so do two
/// pixels of a row.
class OrderRows {
 public:
  explicit OrderRows(const HalfGradient& gradient)
      : gradient_(gradient),
        row_(1, 2 * static_cast<std::size_t>(gradient.width()), kVectorBytes / sizeof(float)) {}

  const float* row(int y) {
    if (y / 2 != made_) {
      made_ = y / 2;
      order_row(gradient_.row(made_), gradient_.width(), gradient_.largest(), row_.row(0));
    }
    return row_.row(0);
  }

 private:
  const HalfGradient& gradient_;
  AlignedRows<float> row_;
  int made_ = -1;
};

/// Filters the rows of one strip of the image.
/// \param order_of  called with y for the strip's rows, one after the other; returns the order for
///   gl_row()
template <typename OrderOf>
void filter_rows(const GreyImage& image, int radius, Rows strip, Extraction<float>& result,
                 OrderOf order_of) {
  ExtendedRows rows(image, radius, strip.first);
  TextureSink sink(result);
  for (int y = strip.first; y < strip.last; ++y) {
    const auto order = order_of(y);
    rows.next_row();
    gl_row(rows, radius, order, sink.row(y), sink.waiting());
    sink.finish_row(y);
  }
  sink.finish();
}

void second_pass(const GreyImage& image, int radius, const HalfGradient& gradient,
                 Extraction<float>& result) {
  for_each_strip(image.height(), image.width(), [&](Rows strip) {
    OrderRows orders(gradient);
    filter_rows(image, radius, strip, result, [&](int y) {
      const float* const order = orders.row(y);
      if (!result.order.empty()) std::copy_n(order, image.width(), result.order.row(y).data());
      return order;
    });
  });
}

}  // namespace

void extract_adaptive(const GreyImage& image, int radius, const WantedPlanes& wanted,
                      Extraction<float>& result) {
  forget_other_methods(result);
  for (Plane<float>* const plane : sub_bands_of(result)) {
    if (!wanted.sub_bands) *plane = {};
  }
  if (wanted.sub_bands) extract_sub_bands(image, result);
  const HalfGradient gradient(image);
  reshape_if(wanted.csgv, result.csgv, image.height(), image.width());
  keep_csgv(gradient, result.csgv);
  reshape_if(wanted.order, result.order, image.height(), image.width());
  shape_planes(image.height(), image.width(), wanted, result);
  if (gradient.largest() < static_cast<float>(kFlatBelowCsgv)) {
    std::ranges::fill(result.order.samples(), 0.0F);
    fill_flat(result);
  } else {
    second_pass(image, radius, gradient, result);
  }
}

void extract_fixed(const GreyImage& image, int radius, double order, const WantedPlanes& wanted,
                   Extraction<float>& result) {
  forget_other_methods(result);
  for (Plane<float>* const plane : sub_bands_of(result)) *plane = {};
  result.csgv = {};
  reshape_if(wanted.order, result.order, image.height(), image.width());
  std::fill(result.order.samples().begin(), result.order.samples().end(),
            static_cast<float>(order));
  shape_planes(image.height(), image.width(), wanted, result);
  for_each_strip(image.height(), image.width(), [&](Rows strip) {
    filter_rows(image, radius, strip, result, [=](int) { return order; });
  });
}

void extract_sub_bands(const GreyImage& image, Extraction<float>& result) {
  const int height = (image.height() + 1) / 2;
  const int width = (image.width() + 1) / 2;
  const auto planes = sub_bands_of(result);
  for (Plane<float>* const plane : planes) reshape(*plane, height, width);
  ColumnFilter filter(image, {0, width});
  for (int y = 0; y < height; ++y) {
    BandRows<float> to;
    for (std::size_t band = 0; band < to.size(); ++band) to[band] = planes[band]->row(y).data();
    filter_along_x(filter.row(y), width, to);
  }
}

}  // namespace touchtrial::engine
