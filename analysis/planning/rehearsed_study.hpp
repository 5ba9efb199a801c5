/// \file A study with simulated participants, straight to its outcomes: its own schedules, pictures
/// and orders, and no session, database or trace. Source: docs/power.md, "The fast path".
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/planning/feelings.hpp"
#include "analysis/planning/primary_test.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::planning {

/// Whom a study is simulated with.
enum class Hypothesis {
  population,  ///< people as the subject file says
  /// The same people, for whom there is nothing to find. Against chance: whatever is presented,
  /// they feel any stimulus of the method, each as likely. Between methods: with either of the two
  /// methods they feel one of both, each as likely, of what is presented.
  null,
};
[[nodiscard]] std::string_view name_of(Hypothesis hypothesis);

/// Makes outcomes of one study again and again. Refers to study, subject and feelings, which must
/// outlive it. Thread-safe once made.
class RehearsedStudy {
 public:
  /// \param most_participants  of any simulated study, >= 1: that many schedules are made
  /// \throws StudyError if the study's orders are impossible, or participants who explore as long
  ///   as the subject file says would never answer
  RehearsedStudy(const design::Study& study, const session::SubjectModel& subject,
                 const PrimaryTest& test, const Feelings& feelings, int most_participants);

  /// Participants with the numbers and enrolment numbers 1 .. `participants`. With `population` and
  /// ServoFeelings the scored trials are those of `simulate --seed study_seed`, to the bit; places
  /// in time, evidence and unscored trials are left out.
  [[nodiscard]] analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const;

 private:
  /// What does not change from study to study.
  struct PlannedSchedule {
    design::Schedule schedule;
    std::vector<std::string> pictures;  ///< labels, by position
  };
  struct Answering;

  void add_participant(int number, const Answering& answering, analysis::Outcomes& outcomes) const;
  /// \param draw  random bits
  [[nodiscard]] design::StimulusIndex felt_stimulus(const design::StimulusIndex& presented,
                                                    Hypothesis hypothesis,
                                                    std::uint64_t draw) const;

  const session::SubjectModel& subject_;
  PrimaryTest test_;
  const Feelings& feelings_;
  std::vector<PlannedSchedule> schedules_;
  std::vector<design::StimulusIndex> of_method_;  ///< every stimulus of the test's first method
  analysis::Outcomes empty_;
};

}  // namespace touchtrial::planning
