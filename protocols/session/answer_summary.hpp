/// \file How a participant answered in a session, without what was right.
#pragma once

#include "protocols/store/payload.hpp"

#include <chrono>
#include <optional>
#include <span>

namespace touchtrial::session {

struct GivenAnswer {
  int position = 0;
  std::chrono::nanoseconds took{};  ///< from plane-on
};

/// \param answers  in the order in which they were given
/// \return nothing if there are none
[[nodiscard]] std::optional<store::AnswerSummary> summary_of(std::span<const GivenAnswer> answers);

}  // namespace touchtrial::session
