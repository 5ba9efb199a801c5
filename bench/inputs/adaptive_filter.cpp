#include "bench/inputs/adaptive_filter.hpp"

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/extended_rows.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/kernels/texture_sink.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace touchtrial::bench {

void filter_adaptive(const GreyImage& image, int radius, const Plane<float>& orders,
                     Plane<float>& texture) {
  constexpr std::size_t kReadPast = 2 * engine::kVectorBytes / sizeof(float);
  const auto width = static_cast<std::size_t>(image.width());
  engine::AlignedRows<float> last(1, width, kReadPast);
  engine::Extraction<float> result;
  result.texture = std::move(texture);
  engine::TextureSink sink(image.height(), image.width(), {}, result);
  engine::ExtendedRows rows(image, radius);
  for (int y = 0; y < image.height(); ++y) {
    const float* order = orders.row(y).data();
    const std::size_t end = (static_cast<std::size_t>(y) + 1) * width;
    if (end + kReadPast > orders.size()) {
      std::copy_n(order, width, last.row(0));
      order = last.row(0);
    }
    rows.next_row();
    engine::gl_row(rows, radius, order, sink.row(y), sink.waiting());
    sink.finish_row(y);
  }
  sink.finish();
  texture = std::move(result.texture);
}

}  // namespace touchtrial::bench
