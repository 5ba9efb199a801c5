/// \file The interface of fast simulations of a study, which compute outcomes without running
/// sessions, and their common functions. Source: docs/planning.md.
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

/// The simulated population. If the test has a margin, methods are equal in `population` (as in
/// `null` without a margin); in `null` the first method is worse by the margin, because some right
/// answers with it are replaced by wrong answers.
enum class Hypothesis {
  population,  ///< participants as in the subject file
  /// The same participants without an effect. In a test against chance, they feel a random stimulus
  /// of the method, independent of the presented one. In a test between two methods, they feel the
  /// presented stimulus with one of the two methods at random.
  null,
};
[[nodiscard]] std::string_view name_of(Hypothesis hypothesis);

/// Simulates the outcomes of a study. Thread-safe.
class Rehearsal {
 public:
  virtual ~Rehearsal() = default;
  Rehearsal() = default;
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  /// Outcomes of participants with the numbers and enrolment numbers 1 .. `participants`; depend
  /// only on the arguments.
  [[nodiscard]] virtual analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                                    std::uint64_t study_seed) const = 0;
};

/// The outcomes of a study without participants.
[[nodiscard]] analysis::Outcomes empty_outcomes(const study::Study& study);
/// A completed session.
/// \param order_block  as in analysis::SessionOutcome
[[nodiscard]] analysis::SessionOutcome completed_session(int number, int session_number, int visit,
                                                         int order_block);
/// An answered scored trial.
/// \param position  index of the answer in the schedule's layout
[[nodiscard]] analysis::TrialOutcome answered_trial(int number, int session, int visit,
                                                    const study::Trial& presented,
                                                    const study::Schedule& schedule, int position);
/// Draws one of the other positions, each equally likely. \pre pictures >= 2
[[nodiscard]] int another_position(int position, std::size_t pictures, RandomStream& random);

}  // namespace touchtrial::planning::identification
