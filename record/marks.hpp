/// \file The marks that are sent to other instruments, and what a session records about them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace touchtrial::record {

/// The marks. The values are the codes on the serial line, and never change. None depends on what
/// is presented or answered.
enum class Mark : int {
  session_begins = 1,  ///< or is resumed after the program ended
  session_ends = 2,
  plane_on = 10,
  contact = 11,  ///< the stylus comes near the plane, see session::kLandingHeightMm
  plane_off = 12,
  time_up = 13,
  answered = 20,
  interrupted = 30,
  paused = 40,
  resumed = 41,
  break_taken = 42,
  stopped = 43,
  practised = 50,  ///< a practice presentation is answered
};
/// With hyphens, for instance "plane-on"; "unknown" for another code.
[[nodiscard]] std::string_view name_of(Mark mark) noexcept;

/// Sealed part of `marked`: the marks sent to other instruments since the last such event, one
/// entry in each list, and the offset of their clock.
struct MarksBody {
  std::vector<std::int64_t> codes{};   ///< Mark
  std::vector<std::int64_t> trials{};  ///< 0 outside trials
  std::vector<std::int64_t> at_ns{};   ///< of the event, since the session's opening
  /// From the event to the end of the write on the serial line; 0: no line, or the write failed.
  std::vector<std::int64_t> latency_ns{};
  /// The Lab Streaming Layer's time at the session's opening, s, and its uncertainty; empty: no
  /// layer.
  std::optional<double> lsl_zero_s{};
  std::optional<double> lsl_uncertainty_s{};
};

}  // namespace touchtrial::record
