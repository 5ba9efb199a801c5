/// \file An emulated Falcon behind its USB cable: FTDI chip, boot loader, firmware, legs, and a
/// hand on the grip. It knows nothing of the driver and shares no code with it. A carrier of
/// transfers (a shim of usbfs, a test) calls `control`, `bulk_out` and `bulk_in`.
///
/// Time is virtual: each command to the running Falcon is one millisecond of the hand's time, in
/// which the chip's latency timer runs out.
///
/// Threads: any thread may call every function; one mutex guards all. The emulator calls the hand's
/// function under it, on the thread of `bulk_out`; that function must not call back.
#pragma once

#include "device/drivers/falcon/emulator/boot_loader.hpp"
#include "device/drivers/falcon/emulator/ftdi_chip.hpp"
#include "device/drivers/falcon/emulator/running_falcon.hpp"

#include <mutex>
#include <optional>
#include <type_traits>

namespace touchtrial::device::falcon {

/// How a transfer ended.
enum class UsbStatus {
  ok,
  stall,  ///< refused (EPIPE)
  gone,   ///< unplugged (ENODEV)
};

struct EmulatorOptions {
  bool firmware_runs = false;  ///< as after a load by another program
  bool homed = false;          ///< likewise; only with firmware that runs
  BootLoaderOptions boot_loader{};
};

class FalconEmulator {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// \param hand  without one the grip stands still in the middle
  explicit FalconEmulator(EmulatorOptions options = {}, HandModel hand = {});

  /// \name The cable
  ///@{
  [[nodiscard]] UsbStatus control(const ControlRequest& request);
  [[nodiscard]] UsbStatus bulk_out(std::span<const std::uint8_t> bytes);
  /// Gives the bytes of an IN transfer of `most` bytes, at once. A real chip that has only status
  /// bytes waits for its latency time first: see `waiting`.
  [[nodiscard]] UsbStatus bulk_in(std::size_t most, Bytes& bytes);
  /// \return the number of bytes that wait for the host, without status bytes
  [[nodiscard]] std::size_t waiting() const;
  [[nodiscard]] bool plugged() const;
  ///@}

  /// \name Mishaps. Those of replies begin with the next reply.
  ///@{
  void drop_replies(int count) { set(to_drop_, count); }
  /// Cuts the ends off this many replies.
  /// \param kept  bytes of each, 0 to 15
  void shorten_replies(int count, std::size_t kept);
  /// Keeps this many replies back, each until the host has sent one more command. Then it comes in
  /// a USB packet of its own before that command's reply.
  void delay_replies(int count) { set(to_delay_, count); }
  /// Sends bytes to the host at once, without a command.
  void send_garbage(std::span<const std::uint8_t> bytes);
  void stick_encoders(bool stuck) {
    post_order([=](RunningFalcon& falcon) { falcon.stick_encoders(stuck); });
  }
  void unplug();
  /// \param keeps_power  the Falcon has its own supply: then firmware and homing survive
  void replug(bool keeps_power);
  void forget_homing() {
    post_order([](RunningFalcon& falcon) { falcon.forget_homing(); });
  }
  ///@}

  /// \name The person
  ///@{
  /// \param buttons  bits 0 to 3: plus, forward, centre, minus
  void press(std::uint32_t buttons) {
    post_order([=](RunningFalcon& falcon) { falcon.press(buttons); });
  }
  void set_hand(HandModel hand);
  ///@}

  /// \name For checks of a test; of the running firmware, zeros before it runs
  ///@{
  [[nodiscard]] bool firmware_runs() const;
  [[nodiscard]] bool all_homed() const { return ask(&RunningFalcon::all_homed); }
  [[nodiscard]] std::uint64_t exchanges() const { return ask(&RunningFalcon::exchanges); }
  /// Of the grip, device frame.
  [[nodiscard]] Vec3 position_mm() const { return ask(&RunningFalcon::position_mm); }
  /// Of the motors on the hand, device frame.
  [[nodiscard]] Vec3 force_n() const { return ask(&RunningFalcon::force_n); }
  [[nodiscard]] std::array<std::int16_t, 3> motors() const { return ask(&RunningFalcon::motors); }
  [[nodiscard]] Lamps lamps() const { return ask(&RunningFalcon::lamps); }
  [[nodiscard]] int loads() const;    ///< of firmware, that began since power came on
  [[nodiscard]] Bytes image() const;  ///< of the last load
  /// Every control request that was not stalled, in order.
  [[nodiscard]] std::vector<ControlRequest> requests() const;
  /// \return what would damage a real device, or what it would silently misread, one line each;
  ///   empty at the end of a test of a correct driver
  [[nodiscard]] std::vector<std::string> complaints() const;
  ///@}

 private:
  void reset_to_boot_loader();
  void start_if_loaded();
  void check_greeting_order();
  void serve_boot_loader(std::span<const std::uint8_t> bytes);
  void serve_firmware(std::span<const std::uint8_t> bytes);
  void deliver(const RunningFalcon::Packet& reply);
  void deliver_late();
  void complain(const std::string& what);
  [[nodiscard]] bool runs() const { return running_.has_value(); }
  template <typename Answer>
  [[nodiscard]] std::decay_t<Answer> ask(Answer (RunningFalcon::*question)() const) const {
    const std::scoped_lock lock(mutex_);
    return runs() ? ((*running_).*question)() : std::decay_t<Answer>{};
  }
  template <typename Order>
  void post_order(const Order& order) {
    const std::scoped_lock lock(mutex_);
    if (runs()) order(*running_);
  }
  void set(int& count, int value) {
    const std::scoped_lock lock(mutex_);
    count = value;
  }

  mutable std::mutex mutex_;
  EmulatorOptions options_;
  HandModel hand_;
  FtdiChip chip_;
  BootLoader boot_loader_;
  std::optional<RunningFalcon> running_;
  bool plugged_ = true;
  std::vector<RunningFalcon::Packet> late_;
  int to_delay_ = 0;
  int to_drop_ = 0;
  int to_shorten_ = 0;
  std::size_t kept_of_short_ = 0;
  std::vector<ControlRequest> requests_;
  std::vector<std::string> complaints_;
};

}  // namespace touchtrial::device::falcon
