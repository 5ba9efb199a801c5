/// \file A simulated hand on an emulated Falcon: homes the grip, explores the plane, lets go.
#pragma once

#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/servo/placed_device.hpp"

#include <mutex>
#include <optional>

namespace touchtrial::device::falcon {

/// Gives the emulator its hand: `emulator.set_hand([&](Vec3 force_n) { return hand.tick(force_n);
/// })`. Every tick is a millisecond, like a tick of the simulated hand. Positions and forces of the
/// emulator are in the device frame, those of the simulated hand in the plane's frame.
///
/// Threads: the emulator's thread calls `tick`; any thread may call the other functions. One mutex
/// guards all.
class HandOnFalcon {
 public:
  /// \param rest_mm  where the grip waits between explorations, device frame
  HandOnFalcon(const device::PlanePlacement& placement, Vec3 rest_mm);

  /// Runs one millisecond.
  /// \return the place of the grip after it, device frame, mm
  [[nodiscard]] Vec3 tick(Vec3 force_n);

  /// Moves the grip through 20 mm to either side along the device's axis, which homes all three.
  void home();
  /// Carries the grip to the hand's start at 100 mm/s, lets the hand explore until it stops, and
  /// carries the grip back to rest. Ends an earlier motion.
  void explore(device::SimulatedHand hand);
  /// \return the number of explorations that ended because their hand stopped
  [[nodiscard]] int explorations() const;

 private:
  enum class Doing { resting, homing, approaching, exploring, returning };

  void carry_to(Vec3 target_mm, Doing doing);
  void carry();
  void explore_on(Vec3 force_n);
  [[nodiscard]] Vec3 hand_position_mm();

  mutable std::mutex mutex_;
  device::PlanePlacement placement_;
  Vec3 rest_mm_;
  Vec3 position_mm_;
  Vec3 from_mm_;
  Vec3 to_mm_;
  Doing doing_ = Doing::resting;
  int tick_ = 0;   ///< of the present motion
  int ticks_ = 0;  ///< of the whole motion
  int explorations_ = 0;
  std::optional<device::SimulatedHand> hand_;
};

}  // namespace touchtrial::device::falcon
