/// \file Simulated people described only by the mean and spread of their accuracy. Device, hand and
/// texture have no effect. Source: docs/planning.md, "From a stated mean and spread".
#pragma once

#include "protocols/identification/planning/primary_test.hpp"
#include "protocols/identification/planning/rehearsal.hpp"
#include "study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::identification {

/// The stated distribution of people. The quantity is a person's accuracy or, if the test compares
/// two methods, the accuracy with the first method minus the accuracy with the second.
struct StatedPeople {
  double mean = 0.0;        ///< mean of the quantity over people
  double sd_between = 0.0;  ///< SD of the quantity between people, without binomial variance
  /// If the test compares two methods: the mean accuracy of both, the same for all people.
  std::optional<double> accuracy{};

  friend bool operator==(const StatedPeople&, const StatedPeople&) = default;
};

/// Checks the numbers for a test. Quantities follow a beta distribution with this mean and spread.
/// Its range is [0, 1] for an accuracy. For a difference, it is the largest range around 0 in which
/// both accuracies stay within [0, 1].
/// \throws UsageError if the mean lies outside that range, the spread is impossible with the mean,
///   or the accuracy is missing or superfluous
void require_possible(const StatedPeople& people, const PrimaryTest& test);

/// \return for instance "stated people: mean accuracy 0.4, SD 0.1 between people"
[[nodiscard]] std::string words_of(const StatedPeople& people);

/// A simulation of a study with stated people. It uses the study's orders. Each scored presentation
/// is answered correctly with the person's probability, otherwise with another picture at random.
/// Under the null hypothesis everybody guesses or, if the test compares two methods, differences
/// have the same spread around 0 or minus the margin.
class StatedRehearsal final : public Rehearsal {
 public:
  /// \param max_participants  maximum of any simulated study, >= 1; determines the number of
  ///   schedules
  /// \throws UsageError as require_possible does, also for people under the null hypothesis
  /// \throws StudyError if the study's orders are impossible
  StatedRehearsal(const study::Study& study, const StatedPeople& people, const PrimaryTest& test,
                  int max_participants);

  [[nodiscard]] analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const override;

 private:
  struct PlannedVisit {
    study::Schedule schedule;
    int order_block = -1;  ///< as in analysis::SessionOutcome
  };

  StatedPeople people_;
  PrimaryTest test_;
  int visits_;                                ///< per participant
  std::vector<PlannedVisit> planned_visits_;  ///< by participant and visit
  analysis::Outcomes empty_;
};

}  // namespace touchtrial::planning::identification
