#include "bench/peers/extended_rows.hpp"

#include "engine/symmetric_extension.hpp"

#include <algorithm>

namespace touchtrial::bench {

ExtendedRows::ExtendedRows(const GreyImage& image, int reach)
    : image_(image),
      reach_(reach),
      rows_(2 * static_cast<std::size_t>(reach) + 1, static_cast<std::size_t>(image.width()),
            static_cast<std::size_t>(reach)) {
  for (int y = -reach; y < reach; ++y) load(y);
}

void ExtendedRows::next_row() {
  ++y_;
  load(y_ + reach_);
}

void ExtendedRows::load(int y) {
  const int width = image_.width();
  std::int16_t* const to = rows_.row(slot(y));
  std::ranges::copy(image_.row(engine::symmetric_index(y, image_.height())), to);
  for (int i = 1; i <= reach_; ++i) {
    to[-i] = to[engine::symmetric_index(-i, width)];
    to[width - 1 + i] = to[engine::symmetric_index(width - 1 + i, width)];
  }
}

}  // namespace touchtrial::bench
