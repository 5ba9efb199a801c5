/// \file Samples of the servo, tick by tick, into an evenly sampled trace.
#pragma once

#include "device/servo/servo.hpp"
#include "protocols/store/trace.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace touchtrial::session {

/// Height above the plane, mm, at which the stylus is taken to have landed. A height, because the
/// place and time at which a force begins tell of the texture, and first contacts are stored in
/// clear.
inline constexpr double kLandingHeightMm = 3.0;

/// Builds one exploration's trace. Ticks that are missing, because the servo overran or a sample
/// was lost on its way, are filled by holding the sample before them, so that a sample's place is
/// its time; they are counted. `add` never asks for memory. Not thread-safe.
class TraceBuilder {
 public:
  /// \param trace  made empty, with room for `most_samples`; must outlive this
  TraceBuilder(store::Trace& trace, double rate_hz, std::size_t most_samples);

  /// Ticks must increase; those beyond the room, and those that are over, are left out.
  void add(const device::ServoSample& sample) noexcept;

  /// Samples that were filled in.
  [[nodiscard]] std::int64_t held() const noexcept { return held_; }
  /// Those of them whose held sample had a force out of the plane.
  [[nodiscard]] std::int64_t held_in_contact() const noexcept { return held_in_contact_; }
  /// When the stylus landed, since plane-on.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> landed_at() const noexcept;

 private:
  void hold_until(std::size_t tick, const store::TraceSample& first) noexcept;

  store::Trace& trace_;
  std::size_t room_;
  std::int64_t held_ = 0;
  std::int64_t held_in_contact_ = 0;
  std::optional<std::int64_t> landing_tick_;
};

/// When a tick is due, since the first.
[[nodiscard]] std::chrono::nanoseconds time_of_tick(std::int64_t tick, double rate_hz) noexcept;

}  // namespace touchtrial::session
