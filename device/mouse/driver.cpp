#include "device/mouse/driver.hpp"

#include "core/errors.hpp"

#include <cstdlib>

namespace touchtrial::device {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::vector<DeviceListing> list_mouse(const DeviceSettings&) {
  DeviceListing listing;
  listing.driver = kMouseDriver;
  const std::string wayland = variable("WAYLAND_DISPLAY");
  listing.where = wayland.empty() ? variable("DISPLAY") : wayland;
  listing.present = !listing.where.empty();
  if (listing.present) {
    listing.model = "pointer on a screen";
  } else {
    listing.missing = {
        "no display: neither DISPLAY nor WAYLAND_DISPLAY is set; run in a graphical session"};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> refuse_without_window(const DeviceSettings&) {
  throw DeviceError(
      "mouse: it needs a window, which is not to be had here; use touchtrial device monitor mouse");
}

}  // namespace

DeviceDriver mouse_driver() {
  return {kMouseDriver,
          "pointer on a screen, for demonstration and pilot sessions: visual, not blind",
          list_mouse, refuse_without_window};
}

}  // namespace touchtrial::device
