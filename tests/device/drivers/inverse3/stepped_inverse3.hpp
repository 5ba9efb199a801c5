/// \file The real driver on the emulated service, one exchange a tick of the servo, so that nothing
/// depends on the speed of the machine.
#pragma once

#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/drivers/inverse3/inverse3_device.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

namespace touchtrial::testing {

/// The time by which the driver judges a force's age. It passes when a test says so.
using TestTime = std::atomic<device::LinkPace::Time>;

/// Options for a machine of any speed: only what hangs is given up, and exchanges follow each other
/// as they can.
/// \param time  null: it stands still
[[nodiscard]] device::inverse3::Inverse3Options patient_options(
    std::shared_ptr<TestTime> time = nullptr);

/// The driver, and what lets its thread go on.
struct PacedInverse3 {
  explicit PacedInverse3(const device::Inverse3Settings& settings);

  device::falcon::Lockstep lockstep;
  device::inverse3::Inverse3Device driver;
};

/// Every `read` runs one exchange, which sends the force of the last `write`.
class SteppedInverse3 final : private PacedInverse3, public device::falcon::LockstepDevice {
 public:
  /// \param before_read  as LockstepDevice
  explicit SteppedInverse3(const device::Inverse3Settings& settings,
                           std::function<void()> before_read = {})
      : PacedInverse3(settings), LockstepDevice(driver, lockstep, std::move(before_read)) {}
};

}  // namespace touchtrial::testing
