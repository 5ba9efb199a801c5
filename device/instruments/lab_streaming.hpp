/// \file The Lab Streaming Layer: an outlet of markers, one of position and force, and its clock,
/// through the user's own liblsl.
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

/// How the layer's clock stands to the program's monotonic clock.
struct ClockOffset {
  double offset_s = 0.0;       ///< the layer's time less std::chrono::steady_clock's
  double uncertainty_s = 0.0;  ///< half the time that the reading took
};

/// Two outlets, visible to recorders on the network as long as the object lives. The library's
/// functions may be called from any thread, and so may these.
///
/// Written from the library's public header and tested with a stand-in for it: unverified with
/// liblsl itself.
class LabStreaming {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// \param rate_hz  nominal, of position and force
  /// \throws DeviceError with the remedy if the library cannot be used or makes no outlet
  LabStreaming(const LabStreamingSettings& settings, double rate_hz);
  ~LabStreaming();
  LabStreaming(const LabStreaming&) = delete;
  LabStreaming& operator=(const LabStreaming&) = delete;

  /// \param text  of the marker
  void mark(const std::string& text, TimePoint at) noexcept;
  /// \param position_mm,force_n  plane frame
  void push(Vec3 position_mm, Vec3 force_n, TimePoint at) noexcept;

  /// Reads both clocks, and dates what follows by them.
  [[nodiscard]] ClockOffset read_clock() noexcept;

 private:
  struct Outlets;
  std::unique_ptr<Outlets> outlets_;
};

}  // namespace touchtrial::device
