/// \file People of whom nothing is known but how often they are right: a mean and a spread between
/// them. Nobody feels anything, so neither device nor hand nor texture enters. Source:
/// docs/planning.md, "From a stated mean and spread".
#pragma once

#include "protocols/identification/planning/primary_test.hpp"
#include "protocols/identification/planning/rehearsal.hpp"
#include "study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::identification {

/// What is stated of people. Without two methods the quantity is a person's accuracy; with two it
/// is a person's accuracy with the first method less that with the second.
struct StatedPeople {
  double mean = 0.0;  ///< of the quantity, over people
  double sd_between =
      0.0;  ///< of the quantity, between people, without the chance of single trials
  /// Of two methods: everybody's accuracy, the mean of both methods.
  std::optional<double> accuracy{};

  friend bool operator==(const StatedPeople&, const StatedPeople&) = default;
};

/// Checks the numbers against a test: people's quantities follow a beta distribution with this mean
/// and spread, on [0, 1] for an accuracy, and for a difference on the largest range around 0 in
/// which both accuracies stay within [0, 1].
/// \throws UsageError if the mean lies outside that range, the spread is impossible with it, or the
///   accuracy is missing or not asked for
void require_possible(const StatedPeople& people, const PrimaryTest& test);

/// \return for instance "stated people: mean accuracy 0.4, SD 0.1 between people"
[[nodiscard]] std::string words_of(const StatedPeople& people);

/// A study with stated people: its own orders, and each scored presentation answered rightly with
/// the person's probability, otherwise with one of the other pictures. Under the null everybody
/// guesses; or, of two methods, differences keep their spread around 0; or, with a margin, around
/// the margin that the first method is worse by.
class StatedRehearsal final : public Rehearsal {
 public:
  /// \param most_participants  of any simulated study, >= 1: the number of schedules that are made
  /// \throws UsageError as require_possible does, also for people under the null; StudyError if the
  ///   study's orders are impossible
  StatedRehearsal(const study::Study& study, const StatedPeople& people, const PrimaryTest& test,
                  int most_participants);

  [[nodiscard]] analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const override;

 private:
  struct PlannedVisit {
    study::Schedule schedule;
    int order_block = -1;  ///< analysis::SessionOutcome
  };

  StatedPeople people_;
  PrimaryTest test_;
  int visits_;                         ///< of each participant
  std::vector<PlannedVisit> planned_;  ///< of each participant in turn, by visit
  analysis::Outcomes empty_;
};

}  // namespace touchtrial::planning::identification
