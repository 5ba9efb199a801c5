#include "engine/kernels/float_extraction.hpp"

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/kernels/half_gradient.hpp"
#include "engine/kernels/rows_ahead.hpp"
#include "engine/kernels/strips.hpp"
#include "engine/kernels/texture_rows.hpp"
#include "engine/kernels/wavelet_rows.hpp"
#include "engine/order_map.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {
namespace {

static_assert(ExtractionOptions::kMaxRadius <= kMaxGlRadius);

/// Gives the plane the shape of an image. Keeps the samples if the shape fits, else zeroes them.
template <typename Sample>
void reshape(Plane<Sample>& plane, const GreyImage& image) {
  const int height = image.height();
  if (plane.height() != height || plane.width() != image.width()) plane = {height, image.width()};
}

/// Reshapes a requested plane, and empties any other.
template <typename Sample>
void reshape_if(bool requested, Plane<Sample>& plane, const GreyImage& image) {
  if (requested) {
    reshape(plane, image);
  } else {
    plane = {};
  }
}

void shape_planes(const GreyImage& image, const RequestedPlanes& requested,
                  Extraction<float>& result) {
  reshape(result.texture, image);
  reshape_if(requested.picture, result.picture, image);
}

void fill_flat(Extraction<float>& result) {
  std::ranges::fill(result.texture.samples(), 0.0F);
  std::ranges::fill(result.picture.samples(), std::uint8_t{128});
}

/// Clears results of a previous extraction by another method.
void clear_other_methods(Extraction<float>& result) {
  result.cartoon = {};
  result.components.clear();
  result.gap = 0.0;
  result.steps = 0;
  result.converged = true;
}

std::array<Plane<float>*, 4> sub_bands_of(Extraction<float>& result) {
  return {&result.sub_band_ll, &result.sub_band_lh, &result.sub_band_hl, &result.sub_band_hh};
}

void store_csgv(const HalfGradient& gradient, Plane<float>& csgv) {
  if (csgv.empty()) return;
  for_each_tile(csgv.height(), csgv.width(), [&](Columns tile) {
    for (int y = 0; y < csgv.height(); ++y) {
      const float* const half_row = gradient.row(y / 2, tile);
      float* const out = csgv.row(y).data() + tile.first;
      for (int x = 0; x < tile.count(); ++x) out[x] = half_row[x / 2];
    }
  });
}

/// Computes the orders of a tile row by row. Pairs of rows share their orders, and so do pairs of
/// pixels within a row.
class OrderRows {
 public:
  OrderRows(const HalfGradient& gradient, Columns tile)
      : gradient_(gradient),
        tile_(tile),
        row_(1, static_cast<std::size_t>(tile.count()) + 1, kVectorBytes / sizeof(float)) {}

  const float* row(int y) {
    if (y / 2 != y_) {
      y_ = y / 2;
      order_row(gradient_.row(y_, tile_), (tile_.count() + 1) / 2, gradient_.max_csgv(),
                row_.row(0));
    }
    return row_.row(0);
  }

 private:
  const HalfGradient& gradient_;
  Columns tile_;
  AlignedRows<float> row_;
  int y_ = -1;
};

/// Filters the rows of one tile of a strip of the image.
/// \param order_of  called with y for each row in order; returns the order argument of gl_row()
template <typename OrderOf>
void filter_rows(const GreyImage& image, int radius, Rows strip, Columns tile,
                 Extraction<float>& result, OrderOf order_of) {
  ExtendedRows rows(image, radius, strip.first, tile);
  for (int y = strip.first; y < strip.last; ++y) {
    const auto order = order_of(y);
    rows.next_row();
    float* const texture = result.texture.row(y).data() + tile.first;
    prefetch_row(result.texture, y + 1, tile);
    gl_row(rows, radius, order, texture);
    if (!result.picture.empty()) {  // while the row is in the cache
      picture_row(texture, tile.count(), result.picture.row(y).data() + tile.first);
    }
  }
}

void run_second_pass(const GreyImage& image, int radius, const HalfGradient& gradient,
                     Extraction<float>& result) {
  for_each_strip(image.height(), image.width(), [&](Rows strip) {
    for_each_tile(image.height(), image.width(), [&](Columns tile) {
      OrderRows orders(gradient, tile);
      filter_rows(image, radius, strip, tile, result, [&](int y) {
        const float* const order = orders.row(y);
        if (!result.order.empty()) {
          std::copy_n(order, tile.count(), result.order.row(y).data() + tile.first);
        }
        return order;
      });
    });
  });
}

}  // namespace

void extract_adaptive(const GreyImage& image, int radius, const RequestedPlanes& requested,
                      Extraction<float>& result) {
  clear_other_methods(result);
  for (Plane<float>* const plane : sub_bands_of(result)) {
    if (!requested.sub_bands) *plane = {};
  }
  if (requested.sub_bands) extract_sub_bands(image, result);
  shape_planes(image, requested, result);
  const HalfGradient gradient(image, result.texture);
  reshape_if(requested.csgv, result.csgv, image);
  store_csgv(gradient, result.csgv);
  reshape_if(requested.order, result.order, image);
  if (gradient.max_csgv() < static_cast<float>(kFlatBelowCsgv)) {
    std::ranges::fill(result.order.samples(), 0.0F);
    fill_flat(result);
  } else {
    run_second_pass(image, radius, gradient, result);
  }
}

void extract_fixed(const GreyImage& image, int radius, double order,
                   const RequestedPlanes& requested, Extraction<float>& result) {
  clear_other_methods(result);
  for (Plane<float>* const plane : sub_bands_of(result)) *plane = {};
  result.csgv = {};
  reshape_if(requested.order, result.order, image);
  std::fill(result.order.samples().begin(), result.order.samples().end(),
            static_cast<float>(order));
  shape_planes(image, requested, result);
  for_each_strip(image.height(), image.width(), [&](Rows strip) {
    for_each_tile(image.height(), image.width(), [&](Columns tile) {
      filter_rows(image, radius, strip, tile, result, [=](int) { return order; });
    });
  });
}

void extract_sub_bands(const GreyImage& image, Extraction<float>& result) {
  const int height = (image.height() + 1) / 2;
  const int width = (image.width() + 1) / 2;
  const auto planes = sub_bands_of(result);
  for (Plane<float>* const plane : planes) {
    if (plane->height() != height || plane->width() != width) *plane = {height, width};
  }
  ColumnFilter filter(image, {0, width});
  for (int y = 0; y < height; ++y) {
    BandRows<float> out;
    for (std::size_t band = 0; band < out.size(); ++band) out[band] = planes[band]->row(y).data();
    filter_along_x(filter.row(y), width, out);
  }
}

}  // namespace touchtrial::engine
