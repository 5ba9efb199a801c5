#include "engine/ring_differences.hpp"

#include "engine/symmetric_extension.hpp"

#include <algorithm>

namespace touchtrial {

RingDifferences::RingDifferences(const GreyImage& image, int radius)
    : image_(image),
      radius_(radius),
      rows_(2 * static_cast<std::size_t>(radius) + 1,
            std::vector<std::uint8_t>(static_cast<std::size_t>(image.width()) +
                                      2 * static_cast<std::size_t>(radius))) {
  for (int y = -radius; y < radius; ++y) load(y);
}

void RingDifferences::next_row() {
  ++y_;
  load(y_ + radius_);
}

RingDifferences::Ring RingDifferences::ring(int k) const noexcept {
  Ring ring;
  ring.above_ = first_sample(y_ - k);
  ring.centre_ = first_sample(y_);
  ring.below_ = first_sample(y_ + k);
  ring.k_ = k;
  return ring;
}

void RingDifferences::load(int y) {
  const auto from = image_.row(symmetric_index(y, image_.height()));
  std::vector<std::uint8_t>& to = rows_[slot(y)];
  std::copy(from.begin(), from.end(), to.begin() + radius_);
  for (int i = 1; i <= radius_; ++i) {
    to[static_cast<std::size_t>(radius_ - i)] = from[symmetric_index(-i, image_.width())];
    to[to.size() - static_cast<std::size_t>(radius_ - i + 1)] =
        from[symmetric_index(image_.width() - 1 + i, image_.width())];
  }
}

/// Rows y - radius .. y + radius have slots of their own, whatever y.
std::size_t RingDifferences::slot(int y) const noexcept {
  return static_cast<std::size_t>(y + radius_) % rows_.size();
}

const std::uint8_t* RingDifferences::first_sample(int y) const noexcept {
  return rows_[slot(y)].data() + radius_;
}

}  // namespace touchtrial
