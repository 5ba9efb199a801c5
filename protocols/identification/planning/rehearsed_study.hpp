/// \file A study with simulated participants, straight to its outcomes: with its own schedules,
/// pictures and orders, but without sessions, a database or traces; and where the participants'
/// feelings come from. Source: docs/planning.md, "The fast path".
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/identification/planning/primary_test.hpp"
#include "protocols/identification/planning/rehearsal.hpp"
#include "protocols/simulation/felt_bank.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/trial_course.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::planning::identification {

/// One presentation to one participant of one simulated study.
struct FeltTrial {
  std::uint64_t study_seed = 0;  ///< as in `simulate --seed`
  int participant = 0;           ///< number, from 1
  std::uint64_t nth = 0;         ///< the participant's presentation, from 1
  std::uint64_t draw = 0;        ///< the presentation's own random bits
  double gain_db = 0.0;          ///< study::Plane::gain_db
};

/// What participants learn and feel: functions of the arguments alone. Thread-safe.
class Feelings {
 public:
  virtual ~Feelings() = default;
  Feelings() = default;
  Feelings(const Feelings&) = delete;
  Feelings& operator=(const Feelings&) = delete;

  /// What the participants of a study learn from before it: `simulation::learn`.
  [[nodiscard]] virtual std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const = 0;
  /// What a stimulus feels like in a presentation, before noise.
  [[nodiscard]] virtual engine::FeltFeatures felt(const study::StimulusIndex& stimulus,
                                                  const FeltTrial& trial) const = 0;
};

struct BankedFeelingsOptions {
  int explorations = 1000;  ///< of each stimulus, for trials to draw from
  int trainings = 16;       ///< for studies to draw from
  std::uint64_t seed = 1;   ///< of the paths
  int jobs = 1;             ///< threads; feelings do not depend on them
};

/// Explorations and trainings that are felt once. Each trial draws one of the explorations, and
/// each study one of the trainings. Refers to none of its arguments.
class BankedFeelings final : public Feelings {
 public:
  /// \param study  of the fields
  /// \param progress  called from one thread at a time
  BankedFeelings(const simulation::LabelledFields& fields, const study::Study& study,
                 const simulation::SubjectModel& subject, const BankedFeelingsOptions& options,
                 const study::Progress& progress = {});

  [[nodiscard]] std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const override;
  [[nodiscard]] engine::FeltFeatures felt(const study::StimulusIndex& stimulus,
                                          const FeltTrial& trial) const override;

 private:
  simulation::FeltBank bank_;
  std::vector<std::shared_ptr<const simulation::FeltKnowledge>> trainings_;
};

/// Refuses people who explore until the time is up in a study that then takes no answer.
/// \throws StudyError naming the subject's file
void require_answers(const study::Study& study, const simulation::SubjectModel& subject);

/// Makes outcomes of one study again and again. Refers to study, subject and feelings, which must
/// outlive it. Thread-safe once constructed.
class RehearsedStudy final : public Rehearsal {
 public:
  /// \param most_participants  of any simulated study, >= 1: the number of schedules that are made
  /// \throws StudyError if the study's orders are impossible, or if participants explore so long
  ///   that they would never answer; UsageError if the margin is more than the methods' accuracy
  RehearsedStudy(const study::Study& study, const simulation::SubjectModel& subject,
                 const PrimaryTest& test, const Feelings& feelings, int most_participants);

  /// Outcomes of participants with the numbers and enrolment numbers 1 .. `participants`. With
  /// `population` and feelings through the servo, without margin, the scored trials are exactly
  /// those of `simulate --seed study_seed`; times, evidence and unscored trials are left out.
  [[nodiscard]] analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const override;

 private:
  /// What does not change from study to study.
  struct PlannedSchedule {
    study::Schedule schedule;
    std::vector<std::string> pictures;  ///< labels, by position
    int order_block = -1;               ///< analysis::SessionOutcome
    simulation::TrialCourse course;     ///< by presentation
    std::vector<bool> break_before;     ///< by presentation
  };
  struct Answering;
  struct Person;

  [[nodiscard]] PlannedSchedule planned_visit(const study::Study& study, const study::StudyKey& key,
                                              int number, int visit) const;
  void add_participant(int number, const Answering& answering, analysis::Outcomes& outcomes) const;
  void add_visit(Person& person, int visit, const Answering& answering,
                 analysis::Outcomes& outcomes) const;
  /// Misses a right answer with a probability.
  /// \param right  class
  [[nodiscard]] static int lost(int position, double loss, Person& person, int right,
                                const study::Schedule& schedule);
  /// \param draw  random bits
  [[nodiscard]] study::StimulusIndex felt_stimulus(const study::StimulusIndex& presented,
                                                   Hypothesis hypothesis, std::uint64_t draw) const;

  /// The population's accuracy with the test's first method.
  [[nodiscard]] double accuracy_of(int people) const;
  void set_margin();

  const simulation::SubjectModel& subject_;
  PrimaryTest test_;
  const Feelings& feelings_;
  int visits_;                ///< of each participant
  double margin_loss_ = 0.0;  ///< share of right answers missed with the first method, if worse
  std::vector<PlannedSchedule> schedules_;       ///< of each participant in turn, by visit
  std::vector<study::StimulusIndex> of_method_;  ///< every stimulus of the test's first method
  analysis::Outcomes empty_;
};

}  // namespace touchtrial::planning::identification
