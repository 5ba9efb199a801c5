/// \file The marks that are sent to other instruments; a session records them in MarksBody.
#pragma once

#include <string_view>

namespace touchtrial::record {

/// The marks. The values are the codes on the serial line, and never change. None depends on the
/// stimulus or the answer.
enum class Mark : int {
  session_begins = 1,  ///< or is resumed by a new run of the program
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
/// The name with hyphens, for instance "plane-on"; "unknown" for another code.
[[nodiscard]] std::string_view name_of(Mark mark) noexcept;

}  // namespace touchtrial::record
