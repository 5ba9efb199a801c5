/// \file A USB device on a bus of umockdev's, for programs that are run under umockdev-wrapper. One
/// at a time in a process. Slow, about a thousand transfers a second: for what is plugged in and
/// for whole commands, never for rates.
#pragma once

#include "device/falcon/usbfs_shim/usb_model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::testing {

class UmockdevBus {
 public:
  UmockdevBus();
  ~UmockdevBus();
  UmockdevBus(const UmockdevBus&) = delete;
  UmockdevBus& operator=(const UmockdevBus&) = delete;

  /// Plugs a device in. Its calls come on a thread of umockdev's.
  /// \param model  must outlive this bus
  void plug(UsbModel& model, const UsbIdentity& identity = {});
  void unplug();

  /// How to run a program on this bus: what to put before its path, and its environment.
  [[nodiscard]] std::vector<std::string> command(const std::vector<std::string>& arguments) const;
  [[nodiscard]] std::vector<std::string> environment() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::testing
