#include "protocols/session/trial_servo_options.hpp"

#include <chrono>
#include <cmath>

namespace touchtrial::session {
namespace {

constexpr std::chrono::milliseconds kFade{100};

}  // namespace

device::ServoOptions trial_servo_options(const design::Study& study, double rate_hz,
                                         const device::LabLimits& lab) {
  device::ServoOptions options;
  options.rate_hz = rate_hz;
  options.limit_ticks = std::llround(study.trials.explore_limit_s * rate_hz);
  options.fade_ticks = std::llround(std::chrono::duration<double>(kFade).count() * rate_hz);
  options.limits.max_force_n = study.rendering.max_force_n;
  options.limits = device::stricter_of(options.limits, lab);
  return options;
}

}  // namespace touchtrial::session
