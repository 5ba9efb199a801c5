/// \file The lab's instruments that record during a session: a serial line for event codes, and the
///   Lab Streaming Layer.
#pragma once

#include "device/device_settings.hpp"
#include "protocols/session/instruments.hpp"

#include <memory>

namespace touchtrial::app {

/// \param rate_hz  rate of the servo
/// \return null if the settings name no instrument
/// \throws DeviceError with the remedy if an instrument cannot be used
[[nodiscard]] std::unique_ptr<session::Instruments> session_instruments(
    const device::InstrumentSettings& settings, double rate_hz);

}  // namespace touchtrial::app
