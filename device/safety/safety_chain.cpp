#include "device/safety/safety_chain.hpp"

#include <cmath>

namespace touchtrial::device {

SafetyChain::SafetyChain(const SafetyLimits& limits, double tick_s) noexcept
    : may_engage_(are_valid(limits) && tick_s > 0.0 && std::isfinite(tick_s)),
      max_support_n_(limits.max_support_n),
      gate_(limits.engage_force_n),
      velocity_(limits.max_speed_mm_s, tick_s),
      freshness_(limits.stale_s, tick_s),
      frozen_(limits.frozen_s, tick_s),
      thermal_(limits, tick_s),
      ramp_(limits.ramp_up_s, tick_s),
      slew_(limits.max_slew_n_per_s, tick_s) {}

void SafetyChain::rearm() noexcept {
  fault_ = SafetyFault::none;
  gate_.close();
  slew_.drop();
  sent_n_ = {};
}

}  // namespace touchtrial::device
