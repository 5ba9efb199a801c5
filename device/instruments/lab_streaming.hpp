/// \file The Lab Streaming Layer: one outlet of markers, one of position and force, and its clock,
///   through the user's liblsl.
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

/// The offset of the layer's clock to the program's monotonic clock.
struct ClockOffset {
  double offset_s = 0.0;       ///< the layer's time less std::chrono::steady_clock's
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

  /// \param rate_hz  nominal, of position and force
  /// \throws DeviceError with the remedy if the library cannot be used or creates no outlet
  LabStreaming(const LabStreamingSettings& settings, double rate_hz);
  ~LabStreaming();
  LabStreaming(const LabStreaming&) = delete;
  LabStreaming& operator=(const LabStreaming&) = delete;

  /// \param text  of the marker
  void mark(const std::string& text, TimePoint at) noexcept;
  /// \param position_mm,force_n  plane frame
  void push(Vec3 position_mm, Vec3 force_n, TimePoint at) noexcept;

  /// Reads both clocks; later timestamps use the offset.
  [[nodiscard]] ClockOffset read_clock() noexcept;

 private:
  struct Outlets;
  std::unique_ptr<Outlets> outlets_;
};

}  // namespace touchtrial::device
