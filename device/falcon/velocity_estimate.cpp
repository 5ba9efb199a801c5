#include "device/falcon/velocity_estimate.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {

Vec3 VelocityEstimate::add(Vec3 position_mm, Time at) noexcept {
  drop_old(at);
  if (count_ == kReadings) {
    std::move(readings_.begin() + 1, readings_.end(), readings_.begin());
    --count_;
  }
  readings_[count_++] = {position_mm, at};
  return slope_mm_s();
}

void VelocityEstimate::drop_old(Time now) noexcept {
  const auto end = readings_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto kept = std::find_if(
      readings_.begin(), end, [&](const Reading& reading) { return now - reading.at <= kMemory; });
  std::move(kept, end, readings_.begin());
  count_ = static_cast<std::size_t>(end - kept);
}

Vec3 VelocityEstimate::slope_mm_s() const noexcept {
  // Times from the newest reading, so that they stay small and exact.
  const Reading& newest = readings_[count_ - 1];
  double mean_s = 0.0;
  Vec3 mean_mm;
  for (std::size_t i = 0; i < count_; ++i) {
    const double share = 1.0 / static_cast<double>(count_);
    mean_s += share * std::chrono::duration<double>(readings_[i].at - newest.at).count();
    mean_mm = mean_mm + share * (readings_[i].position_mm - newest.position_mm);
  }
  double spread_s2 = 0.0;
  Vec3 product_mm_s;
  for (std::size_t i = 0; i < count_; ++i) {
    const double s = std::chrono::duration<double>(readings_[i].at - newest.at).count() - mean_s;
    spread_s2 += s * s;
    product_mm_s = product_mm_s + s * (readings_[i].position_mm - newest.position_mm - mean_mm);
  }
  return spread_s2 > 0.0 ? (1.0 / spread_s2) * product_mm_s : Vec3{};
}

}  // namespace touchtrial::device::falcon
