/// \file The driver and the emulated Falcon joined: a transport without USB, exchanges in step with
/// the servo in virtual time, and a stand-in for the vendor's firmware, which is licensed.
#pragma once

#include "device/drivers/falcon/emulator/falcon_emulator.hpp"
#include "device/drivers/falcon/falcon_device.hpp"
#include "device/drivers/falcon/ftdi_transport.hpp"
#include "device/passing_device.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace touchtrial::device::falcon {

/// \return bytes in place of the vendor's firmware: as many as a known image has, of every value
inline std::vector<std::uint8_t> dummy_firmware() {
  std::vector<std::uint8_t> image(8492);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  }
  return image;
}

inline std::filesystem::path write_dummy_firmware(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "nvent_firmware.bin";
  const std::vector<std::uint8_t> image = dummy_firmware();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
  return file;
}

/// The driver's transport straight into the emulated Falcon: no USB, no waiting. As with the real
/// chip, a read without payload brings status bytes alone; but at once.
class EmulatorTransport final : public FtdiTransport {
 public:
  /// \param emulator  must outlive this
  explicit EmulatorTransport(FalconEmulator& emulator) : emulator_(emulator) {}

  [[nodiscard]] std::string serial() const override { return "EMULATED"; }
  void control(FtdiRequest request, std::uint16_t value) override;
  [[nodiscard]] std::size_t send(std::span<const std::uint8_t> bytes,
                                 std::chrono::milliseconds limit) override;
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                    std::chrono::milliseconds limit) override;
  void start_stream(FtdiStreamSink& sink) override;
  void stop_stream() noexcept override { sink_ = nullptr; }
  [[nodiscard]] bool post(std::span<const std::uint8_t> bytes) noexcept override;
  void serve(std::chrono::microseconds at_most) noexcept override;
  [[nodiscard]] bool lost() const noexcept override { return !emulator_.plugged(); }

 private:
  FalconEmulator& emulator_;
  FtdiStreamSink* sink_ = nullptr;
};

/// Lets the USB thread of one FalconDevice go on, one exchange at a time, so that nothing in a test
/// depends on the speed of the machine.
class Lockstep {
 public:
  Lockstep();
  ~Lockstep();

  /// For the device's options. Call it once.
  [[nodiscard]] std::unique_ptr<FalconPace> pace();
  /// Runs one whole exchange; returns when the USB thread rests again, or has ended. One thread.
  void step() noexcept;
  /// Runs this many.
  void steps(int count) noexcept;
  /// The USB thread's time: a millisecond for each exchange with a reply, and the limit for one
  /// without.
  [[nodiscard]] FalconPace::Time now() const noexcept;

  struct State;

 private:
  std::shared_ptr<State> state_;
};

/// The same device, with one exchange for each tick of the servo: every `read` runs one, which
/// sends the force of the last `write`.
class LockstepDevice : public PassingDevice {
 public:
  /// \param device,lockstep  must outlive this
  /// \param before_read  on the servo's thread, while the driver's thread rests; may be empty
  LockstepDevice(device::HapticDevice& device, Lockstep& lockstep,
                 std::function<void()> before_read = {})
      : PassingDevice(device), lockstep_(lockstep), before_read_(std::move(before_read)) {}

  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    if (before_read_) before_read_();
    lockstep_.step();
    return PassingDevice::read(sample);
  }

 private:
  Lockstep& lockstep_;
  std::function<void()> before_read_;
};

}  // namespace touchtrial::device::falcon
