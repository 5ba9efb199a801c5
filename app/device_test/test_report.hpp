/// \file The summary of `device test`, for people and for programs.
#pragma once

#include "device/haptic_device.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/force_sequence.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

struct TestPhase {
  std::string name;  ///< "wall" or "texture"
  device::ForceSequence::Part felt;
};

struct DeviceTest {
  device::DeviceInfo device;
  device::SchedulingObtained scheduling;
  std::optional<device::ServoReport> run;  ///< nothing: it was stopped before it began
  bool quit = false;                       ///< by the person, with q
  std::vector<TestPhase> phases;           ///< those that began
  std::filesystem::path fault_record;      ///< empty unless a fault was recorded
};

[[nodiscard]] std::string test_text(const DeviceTest& test);
/// Documented in docs/devices/README.md.
[[nodiscard]] std::string test_json(const DeviceTest& test);

}  // namespace touchtrial::app
