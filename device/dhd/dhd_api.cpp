#include "device/dhd/dhd_api.hpp"

#include <type_traits>

namespace touchtrial::device::dhd {
namespace {

template <typename Pointer>
void find(const DynamicLibrary& library, const char* name, Pointer& function) {
  function = library.function<std::remove_pointer_t<Pointer>>(name);
}

template <typename Pointer>
void find_if_any(const DynamicLibrary& library, const char* name, Pointer& function) {
  function = library.function_if_any<std::remove_pointer_t<Pointer>>(name);
}

}  // namespace

Api load_api(const DynamicLibrary& library) {
  Api api{};
  find(library, "dhdGetDeviceCount", api.get_device_count);
  find(library, "dhdOpenID", api.open_id);
  find(library, "dhdClose", api.close);
  find(library, "dhdGetPosition", api.get_position);
  find(library, "dhdGetLinearVelocity", api.get_linear_velocity);
  find(library, "dhdSetForce", api.set_force);
  find(library, "dhdEnableForce", api.enable_force);
  find(library, "dhdGetButtonMask", api.get_button_mask);
  find(library, "dhdGetStatus", api.get_status);
  find(library, "dhdSetTimeGuard", api.set_time_guard);
  find(library, "dhdSetGravityCompensation", api.set_gravity_compensation);
  find(library, "dhdSetEffectorMass", api.set_effector_mass);
  find(library, "dhdErrorGetLastStr", api.error_get_last_str);
  find_if_any(library, "dhdEnableExpertMode", api.enable_expert_mode);
  find_if_any(library, "dhdDisableExpertMode", api.disable_expert_mode);
  find_if_any(library, "dhdGetSystemName", api.get_system_name);
  find_if_any(library, "dhdGetSerialNumber", api.get_serial_number);
  find_if_any(library, "dhdGetVersion", api.get_version);
  return api;
}

}  // namespace touchtrial::device::dhd
