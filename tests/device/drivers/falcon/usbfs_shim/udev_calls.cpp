// The functions of libudev that libusb calls, over the bus of the shim. libusb sees pointers alone,
// so the types are this file's own.
#include "device/drivers/falcon/usbfs_shim/usbfs_bus.hpp"

#include <memory>

using touchtrial::testing::BusEvent;
using touchtrial::testing::UsbfsBus;
using touchtrial::testing::UsbIdentity;

extern "C" {

struct udev {
  int unused = 0;
};

struct udev_list_entry {
  std::string path;
  udev_list_entry* next = nullptr;
};

struct udev_enumerate {
  std::vector<std::unique_ptr<udev_list_entry>> entries;
};

struct udev_monitor {
  int descriptor = -1;
};

struct udev_device {
  std::string action;
  std::string name;
  std::string node;
};

udev* udev_new() {
  return new udev;
}
udev* udev_unref(udev* context) {
  delete context;
  return nullptr;
}

udev_enumerate* udev_enumerate_new(udev*) {
  return new udev_enumerate;
}
udev_enumerate* udev_enumerate_unref(udev_enumerate* list) {
  delete list;
  return nullptr;
}
int udev_enumerate_add_match_subsystem(udev_enumerate*, const char*) {
  return 0;
}
int udev_enumerate_add_match_property(udev_enumerate*, const char*, const char*) {
  return 0;
}

int udev_enumerate_scan_devices(udev_enumerate* list) {
  for (const UsbIdentity& identity : UsbfsBus::instance().present()) {
    auto entry = std::make_unique<udev_list_entry>();
    entry->path = "/sys/bus/usb/devices/" + identity.port;
    if (!list->entries.empty()) list->entries.back()->next = entry.get();
    list->entries.push_back(std::move(entry));
  }
  return 0;
}

udev_list_entry* udev_enumerate_get_list_entry(udev_enumerate* list) {
  return list->entries.empty() ? nullptr : list->entries.front().get();
}
udev_list_entry* udev_list_entry_get_next(udev_list_entry* entry) {
  return entry->next;
}
const char* udev_list_entry_get_name(udev_list_entry* entry) {
  return entry->path.c_str();
}

udev_device* udev_device_new_from_syspath(udev*, const char* path) {
  const std::string name = std::string(path).substr(std::string(path).rfind('/') + 1);
  for (const UsbIdentity& identity : UsbfsBus::instance().present()) {
    if (identity.port == name) return new udev_device{"", name, identity.node()};
  }
  return nullptr;
}
udev_device* udev_device_unref(udev_device* device) {
  delete device;
  return nullptr;
}
const char* udev_device_get_devnode(udev_device* device) {
  return device->node.c_str();
}
const char* udev_device_get_sysname(udev_device* device) {
  return device->name.c_str();
}
const char* udev_device_get_action(udev_device* device) {
  return device->action.c_str();
}

udev_monitor* udev_monitor_new_from_netlink(udev*, const char*) {
  return new udev_monitor;
}
int udev_monitor_filter_add_match_subsystem_devtype(udev_monitor*, const char*, const char*) {
  return 0;
}
int udev_monitor_enable_receiving(udev_monitor* monitor) {
  monitor->descriptor = UsbfsBus::instance().start_monitor();
  return monitor->descriptor < 0 ? -1 : 0;
}
int udev_monitor_get_fd(udev_monitor* monitor) {
  return monitor->descriptor;
}
udev_device* udev_monitor_receive_device(udev_monitor*) {
  BusEvent event;
  if (!UsbfsBus::instance().next_event(event)) return nullptr;
  return new udev_device{event.action, event.identity.port, event.identity.node()};
}
udev_monitor* udev_monitor_unref(udev_monitor* monitor) {
  UsbfsBus::instance().stop_monitor();
  delete monitor;
  return nullptr;
}

}  // extern "C"
