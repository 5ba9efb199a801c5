/// \file The events that other instruments are told of, and what a session records of that.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace touchtrial::record {

/// The events that instruments are told of. The values are the codes on the line, and never change.
/// None depends on what is presented or answered.
enum class Mark : int {
  session_begins = 1,  ///< or goes on after the program ended
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
/// With hyphens, for instance "plane-on"; "unknown" for a code of none.
[[nodiscard]] std::string_view name_of(Mark mark) noexcept;

/// Sealed part of `marked`: the event codes that went to other instruments since the last such
/// event, one entry a list for each, and how their clock stood.
struct MarksBody {
  std::vector<std::int64_t> codes{};   ///< Mark
  std::vector<std::int64_t> trials{};  ///< 0 outside trials
  std::vector<std::int64_t> at_ns{};   ///< of the event, since the session's opening
  /// From the event to the end of the write on the serial line; 0: no line, or it took nothing.
  std::vector<std::int64_t> latency_ns{};
  /// The Lab Streaming Layer's time at the session's opening, s, and its uncertainty; empty: no
  /// layer.
  std::optional<double> lsl_zero_s{};
  std::optional<double> lsl_uncertainty_s{};
};

}  // namespace touchtrial::record
