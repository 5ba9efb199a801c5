/// \file Checks whether enrolment is balanced over a study's stations and enrolment numbers.
#pragma once

#include "record/study_store.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::merging {

/// The parts of a session that matter for balance.
struct EnrolledSession {
  int station = 0;  ///< from 1
  int enrolment = 0;
  record::SessionState state{};
  bool counts = true;  ///< whether it is neither excluded nor withdrawn nor replaced
};

struct EnrolmentBalance {
  /// Number of complete sessions that count, by station; may be 0.
  std::map<int, int> stations;
  /// Enrolment numbers below the highest without a complete session that counts, ascending; at most
  /// kMaxGaps.
  std::vector<int> gaps;
  int gap_count = 0;
  int highest = 0;  ///< highest enrolment number of all sessions
};

inline constexpr std::size_t kMaxGaps = 20;

/// \throws std::invalid_argument if an enrolment number < 1
[[nodiscard]] EnrolmentBalance enrolment_balance(std::span<const EnrolledSession> sessions);

/// One line for each imbalance: stations that differ by more than one session, and gaps in the
/// enrolment numbers.
[[nodiscard]] std::vector<std::string> imbalances(const EnrolmentBalance& balance);

}  // namespace touchtrial::merging
