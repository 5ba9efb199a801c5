#include "device/openhaptics/hd_api.hpp"

#include <type_traits>

namespace touchtrial::device::hd {
namespace {

/// More errors than any stack holds: a library that never runs out of them must not hang us.
constexpr int kMostErrors = 256;

template <typename Pointer>
void find(const DynamicLibrary& library, const char* name, Pointer& function) {
  function = library.function<std::remove_pointer_t<Pointer>>(name);
}

}  // namespace

Api load_api(const DynamicLibrary& library) {
  Api api{};
  find(library, "hdInitDevice", api.init_device);
  find(library, "hdDisableDevice", api.disable_device);
  find(library, "hdMakeCurrentDevice", api.make_current_device);
  find(library, "hdBeginFrame", api.begin_frame);
  find(library, "hdEndFrame", api.end_frame);
  find(library, "hdEnable", api.enable);
  find(library, "hdDisable", api.disable);
  find(library, "hdGetDoublev", api.get_doublev);
  find(library, "hdGetIntegerv", api.get_integerv);
  find(library, "hdSetDoublev", api.set_doublev);
  find(library, "hdGetString", api.get_string);
  find(library, "hdGetErrorString", api.get_error_string);
  find(library, "hdGetError", api.get_error);
  find(library, "hdCheckCalibration", api.check_calibration);
  find(library, "hdUpdateCalibration", api.update_calibration);
  find(library, "hdStartScheduler", api.start_scheduler);
  find(library, "hdStopScheduler", api.stop_scheduler);
  find(library, "hdSetSchedulerRate", api.set_scheduler_rate);
  find(library, "hdScheduleAsynchronous", api.schedule_asynchronous);
  find(library, "hdUnschedule", api.unschedule);
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
