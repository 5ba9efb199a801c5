#include "device/drivers/falcon/umockdev/umockdev_falcon.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <stdexcept>

#include <umockdev.h>
// Before the next header, which needs it without including it.
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

namespace touchtrial::testing {
namespace {

template <typename T>
struct Unref {
  void operator()(T* object) const { g_object_unref(object); }
};
using Testbed = std::unique_ptr<UMockdevTestbed, Unref<UMockdevTestbed>>;
using Handler = std::unique_ptr<UMockdevIoctlBase, Unref<UMockdevIoctlBase>>;
using Memory = std::unique_ptr<UMockdevIoctlData, Unref<UMockdevIoctlData>>;

/// The other process's memory to which a pointer in this memory leads.
Memory at_pointer(UMockdevIoctlData* data, std::size_t offset, std::size_t length) {
  return Memory(umockdev_ioctl_data_resolve(data, offset, length, nullptr));
}

std::span<std::uint8_t> bytes_of(const Memory& memory) {
  return {memory->data, static_cast<std::size_t>(memory->data_len)};
}

/// Tells umockdev to write these bytes back.
void write_back(const Memory& memory) {
  std::vector<std::uint8_t> copy(memory->data, memory->data + memory->data_len);
  umockdev_ioctl_data_update(memory.get(), 0, copy.data(), static_cast<gint>(copy.size()));
}

/// A transfer of the other process.
struct Urb {
  Memory urb;
  Memory buffer;

  [[nodiscard]] usbdevfs_urb& head() const { return *reinterpret_cast<usbdevfs_urb*>(urb->data); }
};

std::string hex(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::string syspath(const UsbIdentity& identity) {
  return "/sys/devices/pci0000:00/usb1/" + identity.port;
}

std::string description(const UsbIdentity& identity) {
  const std::string bus = std::to_string(identity.bus);
  const std::string address = std::to_string(identity.address);
  const std::string node = identity.node().substr(5);
  return "P: " + syspath(identity).substr(4) + "\nN: " + node +
         "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=" + bus + "\nE: DEVNUM=" + address +
         "\nE: DEVNAME=/dev/" + node + "\nA: busnum=" + bus + "\\n\nA: devnum=" + address +
         "\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n\nH: descriptors=" +
         hex(usb_descriptors(identity)) + "\n";
}

}  // namespace

/// One device's transfers.
struct UmockdevBus::State {
  std::mutex mutex;
  Testbed testbed{umockdev_testbed_new()};
  Handler handler;
  UsbModel* model = nullptr;
  std::optional<UsbIdentity> plugged;
  std::deque<Urb> waiting;    ///< reads
  std::deque<Urb> completed;  ///< for the process to reap

  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto& state = *static_cast<State*>(self);
    const std::lock_guard lock(state.mutex);
    const int error = state.answer(client);
    umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
    return TRUE;
  }

  int answer(UMockdevIoctlClient* client) {
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const gulong request = umockdev_ioctl_client_get_request(client);
    if (request == USBDEVFS_REAPURBNDELAY) return reap(argument);
    if (!plugged) return ENODEV;
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES:
        return tell_capabilities(argument);
      case USBDEVFS_CLAIMINTERFACE:
      case USBDEVFS_RELEASEINTERFACE:
      case USBDEVFS_DISCONNECT_CLAIM:
        return 0;
      case USBDEVFS_SUBMITURB:
        return submit(argument);
      case USBDEVFS_DISCARDURB:
        return discard(*reinterpret_cast<gulong*>(argument->data));
      case USBDEVFS_GETDRIVER:
      case USBDEVFS_IOCTL:
        return ENODATA;
      default:
        return ENOTTY;
    }
  }

  static int tell_capabilities(UMockdevIoctlData* argument) {
    const Memory answer = at_pointer(argument, 0, sizeof(std::uint32_t));
    const std::uint32_t capabilities = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                       USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    std::memcpy(answer->data, &capabilities, sizeof(capabilities));
    write_back(answer);
    return 0;
  }

  int submit(UMockdevIoctlData* argument) {
    Urb transfer;
    transfer.urb = at_pointer(argument, 0, sizeof(usbdevfs_urb));
    if (!transfer.urb) return EFAULT;
    const auto length = static_cast<std::size_t>(transfer.head().buffer_length);
    transfer.buffer = at_pointer(transfer.urb.get(), offsetof(usbdevfs_urb, buffer), length);
    if (!transfer.buffer) return EFAULT;
    if (transfer.head().type == USBDEVFS_URB_TYPE_CONTROL) {
      const auto count = answer_control(*plugged, *model, bytes_of(transfer.buffer));
      complete(std::move(transfer), count ? 0 : -EPIPE, count.value_or(0));
    } else if ((transfer.head().endpoint & 0x80U) != 0) {
      waiting.push_back(std::move(transfer));
    } else {
      model->bulk_out(bytes_of(transfer.buffer));
      complete(std::move(transfer), 0, length);
    }
    return 0;
  }

  void complete(Urb transfer, int status, std::size_t length) {
    transfer.head().status = status;
    transfer.head().actual_length = static_cast<int>(length);
    write_back(transfer.urb);
    if (transfer.buffer && length > 0) write_back(transfer.buffer);
    completed.push_back(std::move(transfer));
  }

  void serve_reads() {
    while (plugged && !waiting.empty()) {
      const std::size_t length = model->bulk_in(bytes_of(waiting.front().buffer));
      if (length == 0) return;
      Urb transfer = std::move(waiting.front());
      waiting.pop_front();
      complete(std::move(transfer), 0, length);
    }
  }

  int reap(UMockdevIoctlData* argument) {
    serve_reads();
    if (completed.empty()) return plugged ? EAGAIN : ENODEV;
    const Urb transfer = std::move(completed.front());
    completed.pop_front();
    const Memory answer = at_pointer(argument, 0, sizeof(void*));
    return umockdev_ioctl_data_set_ptr(answer.get(), 0, transfer.urb.get()) != FALSE ? 0 : EFAULT;
  }

  int discard(gulong address) {
    const auto found = std::ranges::find_if(
        waiting, [&](const Urb& transfer) { return transfer.urb->client_addr == address; });
    if (found == waiting.end()) return EINVAL;
    Urb transfer = std::move(*found);
    waiting.erase(found);
    complete(std::move(transfer), -ENOENT, 0);
    return 0;
  }
};

UmockdevBus::UmockdevBus() : state_(std::make_unique<State>()) {
  // After the bus exists, as the library keeps the answer.
  if (!umockdev_in_mock_environment()) {
    throw std::runtime_error("run this test with ctest, or under umockdev-wrapper");
  }
}

UmockdevBus::~UmockdevBus() {
  if (state_->plugged) unplug();
}

void UmockdevBus::plug(UsbModel& model, const UsbIdentity& identity) {
  State& state = *state_;
  UMockdevTestbed* const testbed = state.testbed.get();
  {
    const std::lock_guard lock(state.mutex);
    state.model = &model;
    state.plugged = identity;
    state.waiting.clear();
    state.completed.clear();
  }
  state.handler.reset(umockdev_ioctl_base_new());
  g_signal_connect(state.handler.get(), "handle-ioctl", G_CALLBACK(&State::on_ioctl), &state);
  if (!umockdev_testbed_attach_ioctl(testbed, identity.node().c_str(), state.handler.get(),
                                     nullptr) ||
      !umockdev_testbed_add_from_string(testbed, description(identity).c_str(), nullptr)) {
    throw std::runtime_error("umockdev does not take the device");
  }
  umockdev_testbed_uevent(testbed, syspath(identity).c_str(), "add");
}

void UmockdevBus::unplug() {
  State& state = *state_;
  const UsbIdentity identity = *state.plugged;
  {
    const std::lock_guard lock(state.mutex);
    state.plugged.reset();
    while (!state.waiting.empty()) {
      Urb transfer = std::move(state.waiting.front());
      state.waiting.pop_front();
      state.complete(std::move(transfer), -ESHUTDOWN, 0);
    }
  }
  umockdev_testbed_uevent(state.testbed.get(), syspath(identity).c_str(), "remove");
  umockdev_testbed_remove_device(state.testbed.get(), syspath(identity).c_str());
  umockdev_testbed_detach_ioctl(state.testbed.get(), identity.node().c_str(), nullptr);
}

std::vector<std::string> UmockdevBus::environment() const {
  gchar* const root = umockdev_testbed_get_root_dir(state_->testbed.get());
  std::vector<std::string> all = {std::string("UMOCKDEV_DIR=") + root,
                                  // umockdev's library comes before the sanitizer's.
                                  "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0"};
  g_free(root);
  return all;
}

}  // namespace touchtrial::testing
