/// \file The interface of fast simulations of a study, which produce outcomes without sessions, and
/// functions that they share. Source: docs/planning.md.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "study/schedule.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace touchtrial {
class RandomStream;
}

namespace touchtrial::planning::identification {

/// The population with which a study is simulated. If the test has a margin, methods are equal in
/// `population` (as in `null` without a margin), and in `null` the first method is worse by the
/// margin, because participants miss some of their right answers with it.
enum class Hypothesis {
  population,  ///< participants as in the subject file
  /// The same participants without an effect. For a test against chance, they feel a random
  /// stimulus of the method, independent of the presented stimulus. For a test between two methods,
  /// they feel the presented stimulus with one of the two methods at random.
  null,
};
[[nodiscard]] std::string_view name_of(Hypothesis hypothesis);

/// Simulates outcomes of one study. Thread-safe.
class Rehearsal {
 public:
  virtual ~Rehearsal() = default;
  Rehearsal() = default;
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  /// Outcomes of participants with the numbers and enrolment numbers 1 .. `participants`. They
  /// depend only on the arguments.
  [[nodiscard]] virtual analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                                    std::uint64_t study_seed) const = 0;
};

/// The outcomes of a study without participants.
[[nodiscard]] analysis::Outcomes no_participants(const study::Study& study);
/// A completed session.
/// \param order_block  as in analysis::SessionOutcome
[[nodiscard]] analysis::SessionOutcome completed_session(int number, int session_number, int visit,
                                                         int order_block);
/// An answered scored trial.
/// \param position  of the answer, in the schedule's layout
[[nodiscard]] analysis::TrialOutcome answered_trial(int number, int session, int visit,
                                                    const study::Trial& presented,
                                                    const study::Schedule& schedule, int position);
/// Draws a position other than the given one, each equally likely.
/// \pre pictures >= 2
[[nodiscard]] int another_position(int position, std::size_t pictures, RandomStream& random);

}  // namespace touchtrial::planning::identification
