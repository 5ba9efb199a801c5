/// \file A study that is simulated again and again, straight to its outcomes, and what every kind of
/// simulated people has in common. Source: docs/planning.md.
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

/// The population that a study is simulated with. If the test has a margin, methods are alike in
/// the population too (as under `null` without one), and under `null` the first is worse by the
/// margin: people miss some of their right answers with it.
enum class Hypothesis {
  population,  ///< people as in the subject file
  /// The same people, with no effect to find. For a test against chance, they feel a random
  /// stimulus of the method, whatever is presented. For a test between two methods, they feel the
  /// presented stimulus with one of the two methods at random.
  null,
};
[[nodiscard]] std::string_view name_of(Hypothesis hypothesis);

/// Makes outcomes of one study. Thread-safe.
class Rehearsal {
 public:
  virtual ~Rehearsal() = default;
  Rehearsal() = default;
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  /// Outcomes of participants with the numbers and enrolment numbers 1 .. `participants`: a
  /// function of the arguments alone.
  [[nodiscard]] virtual analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                                    std::uint64_t study_seed) const = 0;
};

/// The outcomes of a study without participants.
[[nodiscard]] analysis::Outcomes nobody_yet(const study::Study& study);
/// A session that was held to its end.
/// \param order_block  analysis::SessionOutcome
[[nodiscard]] analysis::SessionOutcome completed_session(int number, int session_number, int visit,
                                                         int order_block);
/// A scored trial that was answered.
/// \param position  of the answer, in the schedule's layout
[[nodiscard]] analysis::TrialOutcome answered_trial(int number, int session, int visit,
                                                    const study::Trial& presented,
                                                    const study::Schedule& schedule, int position);
/// Another picture than that at a position, each equally likely.
/// \pre pictures >= 2
[[nodiscard]] int another_position(int position, std::size_t pictures, RandomStream& random);

}  // namespace touchtrial::planning::identification
