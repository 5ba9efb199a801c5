/// \file A USB device on a bus of umockdev's, for programs that the test starts. The test itself
/// has to run under umockdev-wrapper, as CTest runs it, and they with it. One bus at a time. Slow,
/// about a thousand transfers a second: for what is plugged in and for whole commands, never for
/// rates.
#pragma once

#include "device/falcon/usbfs_shim/usb_model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::testing {

class UmockdevBus {
 public:
  /// \throws std::runtime_error unless umockdev-wrapper is around
  UmockdevBus();
  ~UmockdevBus();
  UmockdevBus(const UmockdevBus&) = delete;
  UmockdevBus& operator=(const UmockdevBus&) = delete;

  /// Plugs a device in. Its calls come on a thread of umockdev's.
  /// \param model  must outlive this bus
  void plug(UsbModel& model, const UsbIdentity& identity = {});
  void unplug();

  /// Of a program that is to see this bus.
  [[nodiscard]] std::vector<std::string> environment() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::testing
