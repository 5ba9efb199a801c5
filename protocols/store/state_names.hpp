/// \file How states of sessions and trials are written in the derived tables.
#pragma once

#include "protocols/store/study_store.hpp"

#include <array>
#include <string_view>

namespace touchtrial::store {

/// In the order of the enumerators.
inline constexpr std::array<std::string_view, 3> kSessionStates = {"open", "completed", "stopped"};
inline constexpr std::array<std::string_view, 5> kTrialStates = {
    "presented", "answered", "timed-out", "interrupted", "voided"};

[[nodiscard]] constexpr std::string_view name_of(SessionState state) {
  return kSessionStates[static_cast<std::size_t>(state)];
}
[[nodiscard]] constexpr std::string_view name_of(TrialState state) {
  return kTrialStates[static_cast<std::size_t>(state)];
}

}  // namespace touchtrial::store
