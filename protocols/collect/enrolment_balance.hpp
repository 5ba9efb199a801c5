/// \file Whether a study's places fill evenly: over its stations, the order of enrolment, and the
/// orders of methods.
#pragma once

#include "protocols/store/study_store.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::collect {

/// One session, as far as balance goes.
struct EnrolledSession {
  int station = 0;  ///< from 1
  int enrolment = 0;
  store::SessionState state{};
  bool counts = true;          ///< neither excluded nor withdrawn nor replaced
  std::string station_name{};  ///< of its file; may be empty
};

struct EnrolmentBalance {
  /// Of sessions that are complete and count, by station; a station may have 0.
  std::map<int, int> stations;
  std::map<int, std::string> names;  ///< of stations' files, where they are known
  /// The same by row of the methods' orders (enrolment mod rows); each row is there.
  std::vector<int> rows;
  /// Numbers below the highest that no session that counts has, ascending; at most kMostGaps.
  std::vector<int> gaps;
  int gap_count = 0;
  int highest = 0;  ///< enrolment number, of all sessions
};

inline constexpr std::size_t kMostGaps = 20;

/// \param method_rows  of the Williams design, at least 1
/// \throws std::invalid_argument if method_rows < 1 or an enrolment number < 1
[[nodiscard]] EnrolmentBalance enrolment_balance(std::span<const EnrolledSession> sessions,
                                                 int method_rows);

/// One line each for what is uneven: rows or stations that differ by more than one session, numbers
/// that were passed over. Empty: nothing.
[[nodiscard]] std::vector<std::string> imbalances(const EnrolmentBalance& balance);

}  // namespace touchtrial::collect
