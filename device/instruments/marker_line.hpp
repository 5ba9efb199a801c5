/// \file Event codes on a serial line, for instruments that record during a session: EEG
///   amplifiers, trigger boxes, oscilloscopes.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace touchtrial::device {

/// The format of a marker on the line.
enum class MarkerFormat {
  byte,  ///< the code as one byte, then the trial's number, most significant byte first
  text,  ///< for instance "E10 T007" and a line feed
};

struct MarkerLineSettings {
  std::filesystem::path port;  ///< for instance /dev/ttyUSB0; empty: no line
  int baud = 115'200;
  MarkerFormat format = MarkerFormat::byte;
  /// 0 to 4. byte: how many bytes of the trial's number follow the code. text: the minimum number
  /// of digits.
  int width = 0;
  /// After this time the byte 0 is sent, which resets trigger lines; 0: never. byte only.
  double reset_ms = 0.0;
};

/// \param code  1 to 255
/// \param trial  0 outside trials; in the byte format its high bytes are dropped if it is too large
/// \return the bytes of one marker
[[nodiscard]] std::string marker_bytes(const MarkerLineSettings& settings, int code, int trial);

/// The result of one marker.
struct SentMarker {
  /// Time from the event to the end of the write; nothing: the write failed.
  std::optional<std::chrono::nanoseconds> latency;
};

/// A serial line (raw, 8 data bits, no parity, one stop bit, no flow control) and its writing
/// thread, so that callers do not wait for the line. Thread-safe.
class MarkerLine {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// \throws DeviceError with the remedy if the port cannot be opened, is not a serial line, or
  ///   does not support this rate
  explicit MarkerLine(const MarkerLineSettings& settings);
  /// Writes pending markers.
  ~MarkerLine();
  MarkerLine(const MarkerLine&) = delete;
  MarkerLine& operator=(const MarkerLine&) = delete;

  /// \param time  of the event
  void send(int code, int trial, TimePoint time) noexcept;

  /// Waits until all pending markers are written or have failed.
  /// \return the results of markers since the last call, in order
  [[nodiscard]] std::vector<SentMarker> take();

 private:
  struct PendingMarker {
    std::string bytes;
    TimePoint time;
  };

  void run() noexcept;
  [[nodiscard]] bool write(const std::string& bytes) noexcept;

  MarkerLineSettings settings_;
  int descriptor_ = -1;
  std::mutex mutex_;
  std::condition_variable work_ready_;  ///< for the line's thread
  std::condition_variable idle_;        ///< for `take`
  std::deque<PendingMarker> pending_;
  bool is_writing_ = false;
  bool is_closing_ = false;
  std::vector<SentMarker> sent_;
  std::thread thread_;
};

}  // namespace touchtrial::device
