/// \file The state behind the shim: devices on the bus, open nodes, transfers. Private to the shim.
#pragma once

#include "device/drivers/falcon/usbfs_shim/usbfs_shim.hpp"

#include <deque>
#include <map>
#include <mutex>
#include <set>

// Before the next header, which needs it without including it.
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

namespace touchtrial::testing {

/// An open node. Its descriptor is the writing end of a pipe that is kept full, so that POLLOUT
/// comes only with a completed transfer, and POLLERR, by closing the reading end, with unplugging.
struct BusHandle {
  std::shared_ptr<BusDevice> device;
  int reader = -1;  ///< -1: unplugged
  bool signalled = false;
  std::deque<usbdevfs_urb*> waiting;  ///< reads without data yet
  std::deque<usbdevfs_urb*> stuck;    ///< writes that the device has not taken yet
  std::deque<usbdevfs_urb*> completed;
};

/// An event for libudev's monitor.
struct BusEvent {
  std::string action;
  UsbIdentity identity;
};

/// One a program. Every function takes the lock itself.
class UsbfsBus {
 public:
  static UsbfsBus& instance();

  void add(const std::shared_ptr<BusDevice>& device);
  void remove(const std::shared_ptr<BusDevice>& device);
  /// Runs under the lock, then serves waiting writes and reads.
  void change(const std::function<void()>& action);
  [[nodiscard]] int handles_of(const BusDevice& device);

  /// \name For libusb; results as of the system calls, with errno
  ///@{
  [[nodiscard]] bool serves(const std::string& path) const;
  int open(const std::string& path);
  [[nodiscard]] bool is_node(int descriptor);
  int ioctl(int descriptor, unsigned long request, void* argument);
  void close(int descriptor);
  ///@}

  /// \name In place of libudev
  ///@{
  [[nodiscard]] std::vector<UsbIdentity> present();
  int start_monitor();
  void stop_monitor();
  bool next_event(BusEvent& event);
  ///@}

 private:
  int open_node(const std::string& path);
  int open_attribute(const std::string& path);
  int claim(int descriptor, BusHandle& handle);
  int submit(BusHandle& handle, usbdevfs_urb& urb);
  int reap(BusHandle& handle, void* argument);
  int discard(BusHandle& handle, usbdevfs_urb* urb);
  int driver_request(BusHandle& handle, usbdevfs_ioctl& request);
  void complete(BusHandle& handle, usbdevfs_urb& urb, int status, std::size_t length);
  void write(BusHandle& handle, usbdevfs_urb& urb);
  void serve_writes(BusHandle& handle);
  void serve_reads(BusHandle& handle);
  void serve_all();
  void notify(const std::string& action, const UsbIdentity& identity);

  std::mutex mutex_;
  std::set<std::shared_ptr<BusDevice>> devices_;
  std::map<int, BusHandle> handles_;
  std::deque<BusEvent> events_;
  int monitor_ = -1;  ///< an eventfd that counts events
};

}  // namespace touchtrial::testing
