/// \file How long and how hard a trial's plane may be felt.
#pragma once

#include "device/device_settings.hpp"
#include "device/servo/servo.hpp"
#include "protocols/design/study.hpp"

namespace touchtrial::session {

/// The servo's options of a study's trials: the study's limits, or the lab's where they are
/// stricter. \param rate_hz  of the servo  \param lab  none in virtual time
[[nodiscard]] device::ServoOptions trial_servo_options(const design::Study& study, double rate_hz,
                                                       const device::LabLimits& lab);

}  // namespace touchtrial::session
