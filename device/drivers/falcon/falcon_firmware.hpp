/// \file Loads the vendor's firmware into a Falcon, which needs it after every power-up. The user
/// provides the image; this program does not contain it.
#pragma once

#include "device/drivers/falcon/ftdi_transport.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace touchtrial::device::falcon {

/// Limits of an image's size: the known images have 7,914 and 8,492 bytes.
constexpr std::size_t kMinFirmwareBytes = 4'096;
constexpr std::size_t kMaxFirmwareBytes = 16'384;

/// \throws FileError with the remedy if no file is named, it cannot be read, or its size is out of
///   range
[[nodiscard]] std::vector<std::uint8_t> read_falcon_firmware(const std::filesystem::path& file);

/// Attempts before giving up, because loading is known to fail occasionally.
constexpr int kFirmwareLoads = 10;
constexpr int kFirmwareHandshakes = 100;

/// Resets the device into its loader, sends the image, compares every byte with its echo, and sets
/// the chip up for running. Takes about 2.5 s if nothing fails.
/// \throws DeviceError with the last failure and the remedy after `kFirmwareLoads` loads, or at
///   once if the device was disconnected
void load_falcon_firmware(FtdiTransport& transport, std::span<const std::uint8_t> image);

/// Sets the chip up for loaded firmware: latency 1 ms, running speed, empty buffers.
void set_up_running_falcon(FtdiTransport& transport);

}  // namespace touchtrial::device::falcon
