/// \file A USB device on a bus of umockdev, for programs that the test starts. The test and these
/// programs run under umockdev-wrapper, as CTest starts them. One bus at a time. About a thousand
/// transfers a second, so use it for plugging in and for whole commands, never for rates.
#pragma once

#include "device/drivers/falcon/usbfs_shim/usb_model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::testing {

class UmockdevBus {
 public:
  /// \throws std::runtime_error if the program does not run under umockdev-wrapper
  UmockdevBus();
  ~UmockdevBus();
  UmockdevBus(const UmockdevBus&) = delete;
  UmockdevBus& operator=(const UmockdevBus&) = delete;

  /// Plugs a device in. Its calls come on a thread of umockdev.
  /// \param model  must outlive this bus
  void plug(UsbModel& model, const UsbIdentity& identity = {});
  void unplug();

  /// For a program that uses this bus.
  [[nodiscard]] std::vector<std::string> environment() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::testing
