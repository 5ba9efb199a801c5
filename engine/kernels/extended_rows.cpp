#include "engine/kernels/extended_rows.hpp"

#include "engine/symmetric_extension.hpp"

#include <algorithm>

namespace touchtrial {

void extend_row(const std::uint8_t* from, int width, int before, int after, std::uint8_t* to) {
  std::copy_n(from, width, to);
  for (int i = 1; i <= before; ++i) to[-i] = from[symmetric_index(-i, width)];
  for (int i = 0; i < after; ++i) to[width + i] = from[symmetric_index(width + i, width)];
}

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
  const auto from = image_.row(symmetric_index(y, image_.height()));
  extend_row(from.data(), image_.width(), reach_, reach_, rows_.row(slot(y)));
}

}  // namespace touchtrial
