/// \file The Lab Streaming Layer, through the user's liblsl: an outlet for markers, an outlet for
///   position and force, and the layer's clock.
#pragma once

#include "core/vec.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

namespace touchtrial::device {

struct LabStreamingSettings {
  /// The library: a path, or a name that the dynamic linker looks up. Empty: no outlets.
  std::filesystem::path library;
  std::string name = "Touchtrial";  ///< of the streams: "<name> markers" and "<name> hand"
};

/// The offset between the layer's clock and the program's monotonic clock.
struct ClockOffset {
  double offset_s = 0.0;       ///< the layer's time minus std::chrono::steady_clock's
  double uncertainty_s = 0.0;  ///< half the duration of the reading
};

/// Two outlets, visible to recorders on the network during the object's lifetime. Thread-safe, like
/// the library.
///
/// Written from the library's public header and tested with a fake library; not verified with
/// liblsl itself.
class LabStreaming {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// \param rate_hz  nominal rate of position and force
  /// \throws DeviceError with the remedy if the library cannot be used or creates no outlet
  LabStreaming(const LabStreamingSettings& settings, double rate_hz);
  ~LabStreaming();
  LabStreaming(const LabStreaming&) = delete;
  LabStreaming& operator=(const LabStreaming&) = delete;

  void mark(const std::string& text, TimePoint time) noexcept;
  /// \param position_mm,force_n  plane frame
  void push(Vec3 position_mm, Vec3 force_n, TimePoint time) noexcept;

  /// Reads both clocks; later timestamps use the offset.
  [[nodiscard]] ClockOffset read_clock() noexcept;

 private:
  struct Outlets;
  std::unique_ptr<Outlets> outlets_;
};

}  // namespace touchtrial::device
