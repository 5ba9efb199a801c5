/// \file The Falcon's FTDI chip, as a host sees it: vendor requests, and a buffer towards the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace touchtrial::device::falcon {

/// A control transfer without data.
struct ControlRequest {
  std::uint8_t type = 0x40;  ///< bmRequestType
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;

  friend bool operator==(const ControlRequest&, const ControlRequest&) = default;
};

/// Not thread-safe.
class FtdiChip {
 public:
  enum Request : std::uint8_t {
    kReset = 0,  ///< values: 0 both buffers, 1 that to the host, 2 that to the device
    kModemControl = 1,
    kFlowControl = 2,
    kBaudDivisor = 3,
    kData = 4,
    kLatency = 9,
  };
  static constexpr std::uint16_t kDivisor9600 = 0x4138;
  static constexpr std::uint16_t kDivisor140k = 0x15;
  static constexpr std::uint16_t kDivisorRunning = 0x02;
  static constexpr std::size_t kBufferSize = 4096;  ///< further bytes are lost

  /// \return false for a stall: a request that the chip does not know
  bool control(const ControlRequest& request);

  /// \name The line's settings
  ///@{
  [[nodiscard]] bool is_set_for_greeting() const;  ///< 9600 baud, 8N1, no flow, RTS low, DTR high
  [[nodiscard]] bool is_set_for_loading() const;   ///< the same, but 140 k baud, DTR low
  [[nodiscard]] bool is_set_for_running() const;   ///< divisor 2
  [[nodiscard]] int latency_ms() const { return latency_ms_; }
  [[nodiscard]] bool dtr() const { return dtr_; }
  ///@}

  void to_host(std::span<const std::uint8_t> bytes);
  /// The latency timer runs out: what waits now goes in a USB packet before all that comes later.
  /// Source: FTDI's application note on latency (AN232B-04): a short packet goes to the host when
  /// the timer has run out, here 1 ms, and a host exchanges no more often.
  void run_out() {
    if (!to_host_.empty()) packet_ends_.push_back(to_host_.size());
  }
  /// \return one bulk IN transfer: packets of 64 bytes, each with two status bytes, up to a shorter
  ///   one; two bytes alone if nothing waits
  [[nodiscard]] std::vector<std::uint8_t> bulk_in(std::size_t most);
  [[nodiscard]] std::size_t waiting() const { return to_host_.size(); }

  /// Returns to the state after plugging in.
  void power_up() { *this = FtdiChip(); }

 private:
  [[nodiscard]] bool is_plain() const { return data_ == 8 && !flow_ && !rts_; }
  void set_modem_lines(std::uint16_t value);

  [[nodiscard]] std::size_t next_packet(std::size_t most) const;
  void take(std::size_t count);

  std::deque<std::uint8_t> to_host_;
  std::deque<std::size_t> packet_ends_;  ///< counts of `to_host_` after which a packet ends
  int divisor_ = 0;
  int data_ = 0;
  int latency_ms_ = 16;
  bool flow_ = true;
  bool rts_ = true;
  bool dtr_ = false;
};

}  // namespace touchtrial::device::falcon
