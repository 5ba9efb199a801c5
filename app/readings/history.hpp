/// \file The last seconds of a device's readings, in bins narrow enough to plot.
#pragma once

#include "device/servo/servo.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace touchtrial::app {

/// The least and the greatest value of an interval; empty if least > greatest.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double value) noexcept;
  [[nodiscard]] bool is_empty() const noexcept { return least > greatest; }
};

/// The plotted channels: position in mm, force in N, lateness in µs.
enum class Channel : std::size_t { x, y, z, force_x, force_y, force_z, late };

/// Not thread-safe.
class ReadingsHistory {
 public:
  static constexpr double kBinsPerS = 50.0;
  static constexpr double kBinS = 1.0 / kBinsPerS;
  static constexpr std::size_t kBins = 250;

  /// \param rate_hz  the servo's rate, > 0
  explicit ReadingsHistory(double rate_hz);

  /// Adds samples in the order of their ticks. A tick that is not greater than the last begins a
  /// new run.
  void add(const device::ServoSample& sample);
  /// Adds the lateness of a tick to the newest bin.
  void add_lateness(double late_us);

  /// \name kBins values each, from the oldest to the newest
  ///@{
  [[nodiscard]] std::vector<Extent> values(Channel channel) const;
  /// Ticks per second, each over the preceding tenth of a second.
  [[nodiscard]] std::vector<Extent> rates_hz() const;
  ///@}

 private:
  struct Bin {
    std::array<Extent, 7> channels;
    int samples = 0;
  };
  [[nodiscard]] Bin& bin_at(std::int64_t number) noexcept;
  [[nodiscard]] const Bin& from_oldest(std::size_t index) const noexcept;

  double rate_hz_;
  std::vector<Bin> bins_;     ///< a ring
  std::int64_t newest_ = -1;  ///< number of the newest bin since the run began
  std::int64_t last_tick_ = -1;
};

}  // namespace touchtrial::app
