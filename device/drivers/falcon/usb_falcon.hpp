/// \file Finds and opens Novint Falcons on the USB, through libusb.
#pragma once

#include "device/drivers/falcon/ftdi_transport.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::device::falcon {

/// A connected Falcon.
struct UsbFalcon {
  std::string where;    ///< for instance "USB bus 1 port 2, address 7"
  std::string serial;   ///< empty if it has none or may not be opened
  std::string problem;  ///< why it cannot be opened, with the remedy, one line; empty if it can
};

/// Opens each Falcon briefly, without motion.
/// \return every connected Falcon
/// \throws DeviceError if USB cannot be used at all
[[nodiscard]] std::vector<UsbFalcon> find_usb_falcons();

/// Opens and claims a Falcon; a kernel driver is detached until it is closed.
/// \param serial  of the Falcon to open; empty: the only one
/// \throws DeviceError with the remedy if there is none, more than one, no permission, or another
///   program uses it
[[nodiscard]] std::unique_ptr<FtdiTransport> open_usb_falcon(const std::string& serial);

}  // namespace touchtrial::device::falcon
