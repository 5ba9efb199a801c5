#include "device/openhaptics/hd_api.hpp"

namespace touchtrial::device::hd {
namespace {

/// More errors than any stack holds, so that a library that never runs out of them cannot hang us.
constexpr int kMostErrors = 256;

}  // namespace

Api load_api(const DynamicLibrary& library) {
  Api api{};
  library.find("hdInitDevice", api.init_device);
  library.find("hdDisableDevice", api.disable_device);
  library.find("hdMakeCurrentDevice", api.make_current_device);
  library.find("hdBeginFrame", api.begin_frame);
  library.find("hdEndFrame", api.end_frame);
  library.find("hdEnable", api.enable);
  library.find("hdDisable", api.disable);
  library.find("hdGetDoublev", api.get_doublev);
  library.find("hdGetIntegerv", api.get_integerv);
  library.find("hdSetDoublev", api.set_doublev);
  library.find("hdGetString", api.get_string);
  library.find("hdGetErrorString", api.get_error_string);
  library.find("hdGetError", api.get_error);
  library.find("hdCheckCalibration", api.check_calibration);
  library.find("hdUpdateCalibration", api.update_calibration);
  library.find("hdStartScheduler", api.start_scheduler);
  library.find("hdStopScheduler", api.stop_scheduler);
  library.find("hdSetSchedulerRate", api.set_scheduler_rate);
  library.find("hdScheduleAsynchronous", api.schedule_asynchronous);
  library.find("hdUnschedule", api.unschedule);
  return api;
}

DeviceFault fault_of(std::uint32_t code) noexcept {
  switch (code) {
    case 0:
      return DeviceFault::none;
    case kWarmMotors:
      return DeviceFault::warm_motors;
    case kExceededForce:
    case kExceededImpulse:
    case kExceededVelocity:
      return DeviceFault::limit_passed;
    case kCommunicationError:
      return DeviceFault::link_lost;
    default:
      return DeviceFault::driver;
  }
}

Errors drain_errors(const Api& api) noexcept {
  Errors errors;
  for (int i = 0; i < kMostErrors; ++i) {
    const std::uint32_t code = api.get_error().code;
    if (code == 0) break;
    errors.oldest = code;
    const bool telling = errors.fault != DeviceFault::none && errors.fault != DeviceFault::driver;
    if (!telling) errors.fault = fault_of(code);
  }
  return errors;
}

}  // namespace touchtrial::device::hd
