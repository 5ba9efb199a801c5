/// \file The driver's transport straight into the emulated Falcon: no USB, no waiting.
#pragma once

#include "device/falcon/emulator/falcon_emulator.hpp"
#include "device/falcon/ftdi_transport.hpp"

namespace touchtrial::device::falcon {

/// As the real chip, a read brings status bytes alone where there is nothing else; but at once.
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

}  // namespace touchtrial::device::falcon
