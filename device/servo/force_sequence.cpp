#include "device/servo/force_sequence.hpp"

#include <algorithm>

namespace touchtrial::device {

Vec3 ForceSequence::force_n(const DeviceSample& sample) noexcept {
  const std::int64_t changing = tick_ - change_tick_;
  if (changing < 0) return first_.force_n(sample);
  if (changing >= blend_ticks_) return second_.force_n(sample);
  const double u = static_cast<double>(changing) / static_cast<double>(blend_ticks_);
  const double share = u * u * (3.0 - 2.0 * u);
  return (1.0 - share) * first_.force_n(sample) + share * second_.force_n(sample);
}

void ForceSequence::record(const ServoSample& sample) noexcept {
  tick_ = sample.tick + 1;
  Part& part = parts_[is_second(sample.tick) ? 1 : 0];
  ++part.ticks;
  part.contact_ticks += sample.force_n.z > 0.0 ? 1 : 0;
  part.greatest_force_n = std::max(part.greatest_force_n, norm(sample.force_n));
}

}  // namespace touchtrial::device
