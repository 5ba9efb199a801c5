/// \file A test's settings for the fake libdhd, and the calls that the fake observed.
#pragma once

#include "device/fakes/fake_parts.hpp"

#include <atomic>
#include <string>

namespace touchtrial::fakes {

struct FakeDhd {
  // Orders.
  std::atomic<int> devices{1};
  std::atomic<bool> opens{true};
  std::atomic<bool> connected{true};
  std::atomic<bool> calibrated{true};
  std::atomic<bool> device_error{false};
  std::atomic<int> force_off_cause{0};      ///< not 0: force is off for this cause
  std::atomic<bool> position_fails{false};  ///< although the device is connected
  std::atomic<bool> too_soon{false};        ///< the time guard answers every position
  std::atomic<bool> saturated{false};
  std::atomic<bool> refuses_mass{false};
  std::atomic<unsigned> buttons{0};
  FakeHand hand;  ///< in DHD's frame, but mm

  // Observations.
  std::atomic<long> polls{0};
  std::atomic<long> zero_forces_last{0};  ///< in a row, until now
  std::atomic<long> misuses{0};           ///< calls with a wrong device, or after the end
  std::atomic<int> gravity_compensation{-1};
  std::atomic<double> effector_mass_kg{-1.0};
  std::atomic<int> time_guard_us{-2};
  SharedVec force_n;  ///< DHD's frame
};

/// What the fake exports beside libdhd's own names.
struct FakeDhdExports {
  FakeDhd* state;
  void (*reset)();
  bool (*step)(int ticks);
  void (*run_freely)();
  std::string (*calls)();  ///< the names of opening and closing calls, in order
};

}  // namespace touchtrial::fakes

extern "C" touchtrial::fakes::FakeDhdExports* fake_dhd_exports();
