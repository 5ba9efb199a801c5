#include "device/drivers/falcon/usbfs_shim/usbfs_bus.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace touchtrial::testing {
namespace {

constexpr std::string_view kNodes = "/dev/bus/usb/";
constexpr std::string_view kAttributes = "/sys/bus/usb/devices/";
constexpr int kPipeBytes = 4096;
constexpr unsigned kBulkOut = 0x02;

int failed(int error) {
  errno = error;
  return -1;
}

/// The system's close, as the program's own is the shim's.
void system_close(int descriptor) {
  syscall(SYS_close, descriptor);
}

void fill_pipe(int descriptor) {
  static constexpr std::array<char, kPipeBytes> kFiller{};
  [[maybe_unused]] const ssize_t written = ::write(descriptor, kFiller.data(), kFiller.size());
}

void drain_pipe(int reader) {
  std::array<char, kPipeBytes> filler{};
  [[maybe_unused]] const ssize_t taken = ::read(reader, filler.data(), filler.size());
}

/// \return a file with this content, at its beginning
int file_of(std::span<const std::uint8_t> bytes) {
  const int descriptor = memfd_create("usb-attribute", MFD_CLOEXEC);
  if (descriptor < 0) return -1;
  [[maybe_unused]] const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
  lseek(descriptor, 0, SEEK_SET);
  return descriptor;
}

std::vector<std::uint8_t> attribute(const UsbIdentity& identity, const std::string& name) {
  if (name == "descriptors") return usb_descriptors(identity);
  std::string text;
  if (name == "busnum") text = std::to_string(identity.bus) + "\n";
  if (name == "devnum") text = std::to_string(identity.address) + "\n";
  if (name == "speed") text = "12\n";
  if (name == "bConfigurationValue") text = "1\n";
  return {text.begin(), text.end()};
}

}  // namespace

UsbfsBus& UsbfsBus::instance() {
  // Never destroyed: libusb's threads and the last calls of close may outlive static objects.
  static auto* const bus = new UsbfsBus;
  return *bus;
}

void UsbfsBus::add(const std::shared_ptr<BusDevice>& device) {
  const std::lock_guard lock(mutex_);
  devices_.insert(device);
  notify("add", device->identity);
}

void UsbfsBus::remove(const std::shared_ptr<BusDevice>& device) {
  const std::lock_guard lock(mutex_);
  if (devices_.erase(device) == 0) return;
  device->claimed_by = -1;
  for (auto& [descriptor, handle] : handles_) {
    if (handle.device != device) continue;
    for (auto* queue : {&handle.stuck, &handle.waiting}) {
      for (usbdevfs_urb* urb : *queue) complete(handle, *urb, -ESHUTDOWN, 0);
      queue->clear();
    }
    system_close(handle.reader);
    handle.reader = -1;
  }
  notify("remove", device->identity);
}

void UsbfsBus::change(const std::function<void()>& action) {
  const std::lock_guard lock(mutex_);
  action();
  serve_all();
}

int UsbfsBus::handles_of(const BusDevice& device) {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::ranges::count_if(
      handles_, [&](const auto& entry) { return entry.second.device.get() == &device; }));
}

bool UsbfsBus::serves(const std::string& path) const {
  return path.starts_with(kNodes) || path.starts_with(kAttributes);
}

int UsbfsBus::open(const std::string& path) {
  const std::lock_guard lock(mutex_);
  return path.starts_with(kNodes) ? open_node(path) : open_attribute(path);
}

int UsbfsBus::open_node(const std::string& path) {
  const auto device = std::ranges::find_if(
      devices_, [&](const auto& candidate) { return candidate->identity.node() == path; });
  if (device == devices_.end()) return failed(ENOENT);
  if (!(*device)->permitted) return failed(EACCES);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) != 0) return -1;
  fcntl(ends[1], F_SETPIPE_SZ, kPipeBytes);
  fill_pipe(ends[1]);
  handles_[ends[1]] = BusHandle{*device, ends[0], false, {}, {}, {}};
  return ends[1];
}

int UsbfsBus::open_attribute(const std::string& path) {
  const std::string rest = path.substr(kAttributes.size());
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos) return failed(ENOENT);
  for (const auto& device : devices_) {
    if (device->identity.port != rest.substr(0, slash)) continue;
    const auto bytes = attribute(device->identity, rest.substr(slash + 1));
    return bytes.empty() ? failed(ENOENT) : file_of(bytes);
  }
  return failed(ENOENT);
}

bool UsbfsBus::is_node(int descriptor) {
  const std::lock_guard lock(mutex_);
  return handles_.contains(descriptor);
}

void UsbfsBus::close(int descriptor) {
  const std::lock_guard lock(mutex_);
  const auto found = handles_.find(descriptor);
  BusHandle& handle = found->second;
  if (handle.device->claimed_by == descriptor) handle.device->claimed_by = -1;
  if (handle.reader >= 0) system_close(handle.reader);
  handles_.erase(found);
  system_close(descriptor);
}

int UsbfsBus::ioctl(int descriptor, unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  BusHandle& handle = handles_.at(descriptor);
  if (request == USBDEVFS_REAPURBNDELAY) return reap(handle, argument);
  if (handle.reader < 0) return failed(ENODEV);
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<__u32*>(argument) = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                       USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return 0;
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
      return claim(descriptor, handle);
    case USBDEVFS_RELEASEINTERFACE:
      handle.device->claimed_by = -1;
      return 0;
    case USBDEVFS_SETINTERFACE:  // it has one setting alone
      return 0;
    case USBDEVFS_SUBMITURB:
      return submit(handle, *static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_DISCARDURB:
      return discard(handle, static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_GETDRIVER:
      if (!handle.device->kernel_driver) return failed(ENODATA);
      std::strcpy(static_cast<usbdevfs_getdriver*>(argument)->driver, "ftdi_sio");
      return 0;
    case USBDEVFS_CLEAR_HALT:
      if (*static_cast<unsigned*>(argument) == kBulkOut) handle.device->out_halted = false;
      return 0;
    case USBDEVFS_IOCTL:
      return driver_request(handle, *static_cast<usbdevfs_ioctl*>(argument));
    default:
      return failed(ENOTTY);
  }
}

int UsbfsBus::claim(int descriptor, BusHandle& handle) {
  BusDevice& device = *handle.device;
  const bool by_other = device.claimed_by >= 0 && device.claimed_by != descriptor;
  if (device.used_elsewhere || by_other) return failed(EBUSY);
  device.kernel_driver = false;
  device.claimed_by = descriptor;
  return 0;
}

int UsbfsBus::driver_request(BusHandle& handle, usbdevfs_ioctl& request) {
  BusDevice& device = *handle.device;
  const auto code = static_cast<unsigned>(request.ioctl_code);
  if (code == USBDEVFS_CONNECT) {
    device.kernel_driver = true;
    return 0;
  }
  if (code != USBDEVFS_DISCONNECT) return failed(ENOTTY);
  if (!device.kernel_driver) return failed(ENODATA);
  device.kernel_driver = false;
  return 0;
}

int UsbfsBus::submit(BusHandle& handle, usbdevfs_urb& urb) {
  const std::span bytes(static_cast<std::uint8_t*>(urb.buffer),
                        static_cast<std::size_t>(urb.buffer_length));
  UsbModel& model = *handle.device->model;
  if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
    const auto length = answer_control(handle.device->identity, model, bytes);
    complete(handle, urb, length ? 0 : -EPIPE, length.value_or(0));
  } else if ((urb.endpoint & 0x80U) != 0) {
    handle.waiting.push_back(&urb);
  } else if (handle.device->out_stuck) {
    handle.stuck.push_back(&urb);
  } else {
    write(handle, urb);
  }
  serve_reads(handle);
  return 0;
}

void UsbfsBus::write(BusHandle& handle, usbdevfs_urb& urb) {
  if (handle.device->out_halted) return complete(handle, urb, -EPIPE, 0);
  const auto size = static_cast<std::size_t>(urb.buffer_length);
  handle.device->model->bulk_out({static_cast<std::uint8_t*>(urb.buffer), size});
  complete(handle, urb, 0, size);
}

void UsbfsBus::serve_writes(BusHandle& handle) {
  if (handle.device->out_stuck) return;
  for (usbdevfs_urb* urb : std::exchange(handle.stuck, {})) write(handle, *urb);
}

void UsbfsBus::serve_reads(BusHandle& handle) {
  while (!handle.waiting.empty() && handle.reader >= 0) {
    usbdevfs_urb& urb = *handle.waiting.front();
    const std::size_t length = handle.device->model->bulk_in(
        {static_cast<std::uint8_t*>(urb.buffer), static_cast<std::size_t>(urb.buffer_length)});
    if (length == 0) return;
    handle.waiting.pop_front();
    complete(handle, urb, 0, length);
  }
}

void UsbfsBus::serve_all() {
  for (auto& [descriptor, handle] : handles_) {
    serve_writes(handle);
    serve_reads(handle);
  }
}

void UsbfsBus::complete(BusHandle& handle, usbdevfs_urb& urb, int status, std::size_t length) {
  urb.status = status;
  urb.actual_length = static_cast<int>(length);
  handle.completed.push_back(&urb);
  if (handle.signalled || handle.reader < 0) return;
  drain_pipe(handle.reader);
  handle.signalled = true;
}

int UsbfsBus::reap(BusHandle& handle, void* argument) {
  if (handle.device->deaf) return failed(EIO);
  if (!handle.completed.empty()) {
    *static_cast<usbdevfs_urb**>(argument) = handle.completed.front();
    handle.completed.pop_front();
    return 0;
  }
  if (handle.reader < 0) return failed(ENODEV);
  if (handle.signalled) {
    const auto self =
        std::ranges::find_if(handles_, [&](const auto& entry) { return &entry.second == &handle; });
    fill_pipe(self->first);
    handle.signalled = false;
  }
  return failed(EAGAIN);
}

int UsbfsBus::discard(BusHandle& handle, usbdevfs_urb* urb) {
  for (auto* queue : {&handle.stuck, &handle.waiting}) {
    const auto found = std::ranges::find(*queue, urb);
    if (found == queue->end()) continue;
    queue->erase(found);
    complete(handle, *urb, -ENOENT, 0);
    return 0;
  }
  return failed(EINVAL);
}

std::vector<UsbIdentity> UsbfsBus::present() {
  const std::lock_guard lock(mutex_);
  std::vector<UsbIdentity> all;
  for (const auto& device : devices_) all.push_back(device->identity);
  std::ranges::sort(all, {}, &UsbIdentity::address);
  return all;
}

int UsbfsBus::start_monitor() {
  const std::lock_guard lock(mutex_);
  events_.clear();
  monitor_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK | EFD_SEMAPHORE);
  return monitor_;
}

void UsbfsBus::stop_monitor() {
  const std::lock_guard lock(mutex_);
  if (monitor_ >= 0) system_close(monitor_);
  monitor_ = -1;
}

void UsbfsBus::notify(const std::string& action, const UsbIdentity& identity) {
  if (monitor_ < 0) return;
  events_.push_back({action, identity});
  eventfd_write(monitor_, 1);
}

bool UsbfsBus::next_event(BusEvent& event) {
  const std::lock_guard lock(mutex_);
  eventfd_t count = 0;
  if (monitor_ < 0 || eventfd_read(monitor_, &count) != 0 || events_.empty()) return false;
  event = events_.front();
  events_.pop_front();
  return true;
}

}  // namespace touchtrial::testing
