/// \file The summary of `device test`, for people and for programs.
#pragma once

#include "device/haptic_device.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/servo.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {

struct TestPhase {
  std::string name;  ///< "wall" or "texture"
  ServoReport report;
};

struct DeviceTest {
  DeviceInfo device;
  SchedulingObtained scheduling;
  std::vector<TestPhase> phases;       ///< those that began
  std::filesystem::path fault_record;  ///< empty unless a fault was recorded
};

[[nodiscard]] std::string test_text(const DeviceTest& test);
/// Documented in docs/devices/README.md.
[[nodiscard]] std::string test_json(const DeviceTest& test);

}  // namespace touchtrial
