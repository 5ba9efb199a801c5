/// \file A test's settings for the fake libdhd, and what the fake observed.
#pragma once

#include "device/fakes/fake_parts.hpp"

#include <atomic>
#include <chrono>
#include <string>

namespace touchtrial::fakes {

/// A device that is powered, calibrated and alone at the computer, and weighs nothing.
struct FakeDhd {
  // Orders.
  std::atomic<int> devices{1};
  std::atomic<bool> opens{true};
  std::atomic<bool> connected{true};
  std::atomic<bool> calibrated{true};     ///< false: it waits to be put at its rest position
  std::atomic<bool> wants_button{false};  ///< force comes on only by the device's own button
  std::atomic<bool> device_error{false};
  std::atomic<bool> position_fails{false};  ///< although the device is connected
  std::atomic<bool> exchanges{true};        ///< false: every answer is that of the time guard
  std::atomic<bool> saturated{false};
  std::atomic<bool> refuses_mass{false};
  std::atomic<bool> limits_sum{false};  ///< the largest force holds for force and weight together
  std::atomic<bool> auto_init_fails{false};
  std::atomic<bool> weight_is_nonsense{false};  ///< by the library's model
  std::atomic<unsigned> buttons{0};
  std::atomic<int> system_type{33};  ///< omega.3
  std::atomic<double> arm_mass_kg{0.0};
  /// The mass that the device knows, until it is set; the end-effector does have this mass.
  std::atomic<double> own_mass_kg{0.0};
  FakeHand hand;  ///< in DHD's frame, but mm

  // Orders and observations.
  /// Of the last time that force went off; at first, of an earlier program.
  std::atomic<int> force_off_cause{0};
  std::atomic<int> watchdog{0};  ///< times 125 us; 0: off

  // Observations.
  std::atomic<long> polls{0};
  std::atomic<long> zero_forces_last{0};  ///< asked for in a row, until now
  std::atomic<long> misuses{0};           ///< calls with a wrong device, or after the end
  std::atomic<int> gravity_compensation{1};
  std::atomic<double> effector_mass_kg{-1.0};  ///< as set
  std::atomic<int> time_guard_us{-2};
  std::atomic<double> max_force_n{-1.0};
  std::atomic<bool> brakes{true};
  SharedVec force_n;  ///< of the motors at the hand, DHD's frame
};

/// What the fake exports beside libdhd's own names.
struct FakeDhdExports {
  FakeDhd* state;
  void (*reset)();
  bool (*step)(int ticks);
  void (*run_freely)();
  std::string (*calls)();  ///< the names of opening and closing calls, in order
  /// The device switches force off by itself, or its button does.
  void (*force_off)(int cause);
  void (*press_force_button)();
  /// The fake's time: a millisecond for each force.
  std::chrono::nanoseconds (*now)();
};

}  // namespace touchtrial::fakes

extern "C" touchtrial::fakes::FakeDhdExports* fake_dhd_exports();
