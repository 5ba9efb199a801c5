/// \file Fast simulation of a study: with its schedules, pictures and orders, but without sessions,
/// database and traces; and the source of what participants feel. Source: docs/planning.md, "The
/// fast path".
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
  std::uint64_t nth = 0;         ///< number of the participant's presentation, from 1
  std::uint64_t draw = 0;        ///< random bits of the presentation
  double gain_db = 0.0;          ///< study::Plane::gain_db
};

/// The source of what participants learn and feel. Results depend only on the arguments.
/// Thread-safe.
class Feelings {
 public:
  virtual ~Feelings() = default;
  Feelings() = default;
  Feelings(const Feelings&) = delete;
  Feelings& operator=(const Feelings&) = delete;

  /// The training of a study's participants: `simulation::learn`.
  [[nodiscard]] virtual std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const = 0;
  /// The features of a stimulus in a presentation, without noise.
  [[nodiscard]] virtual engine::FeltFeatures felt(const study::StimulusIndex& stimulus,
                                                  const FeltTrial& trial) const = 0;
};

struct BankedFeelingsOptions {
  int explorations = 1000;  ///< of each stimulus, from which trials draw
  int trainings = 16;       ///< from which studies draw
  std::uint64_t seed = 1;   ///< of the paths
  int jobs = 1;             ///< threads; results do not depend on it
};

/// Precomputed explorations and trainings. Each trial draws one of the explorations, and each study
/// one of the trainings. Holds no references to its arguments.
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

/// Refuses a subject that explores until time is up if the study then rejects answers.
/// \throws StudyError with the subject's file and the remedy
void require_answers(const study::Study& study, const simulation::SubjectModel& subject);

/// Simulates outcomes of one study repeatedly. Study, subject and feelings must outlive it.
/// Thread-safe once constructed.
class RehearsedStudy final : public Rehearsal {
 public:
  /// \param max_participants  of any simulated study, >= 1; schedules are made for so many
  /// \throws StudyError if the study does not permit its orders, or as require_answers
  /// \throws UsageError if the margin exceeds the methods' accuracy
  RehearsedStudy(const study::Study& study, const simulation::SubjectModel& subject,
                 const PrimaryTest& test, const Feelings& feelings, int max_participants);

  /// Outcomes of participants with the numbers and enrolment numbers 1 .. `participants`. Without a
  /// margin, with `population` and features from the servo, the scored trials are exactly those of
  /// `simulate --seed study_seed`. Times, evidence and unscored trials are omitted.
  [[nodiscard]] analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const override;

 private:
  /// The data of a visit that all simulated studies share.
  struct PlannedSchedule {
    study::Schedule schedule;
    std::vector<std::string> pictures;  ///< labels, by position
    int order_block = -1;               ///< as in analysis::SessionOutcome
    simulation::TrialCourse course;     ///< by presentation
    std::vector<bool> break_before;     ///< by presentation
  };
  struct SharedInput;
  struct Person;

  [[nodiscard]] PlannedSchedule planned_visit(const study::Study& study, const study::StudyKey& key,
                                              int number, int visit) const;
  void add_participant(int number, const SharedInput& shared, analysis::Outcomes& outcomes) const;
  void add_visit(Person& person, int visit, const SharedInput& shared,
                 analysis::Outcomes& outcomes) const;
  /// Replaces a right answer by a wrong one with probability `loss`.
  /// \param right  class
  [[nodiscard]] static int with_loss(int position, double loss, Person& person, int right,
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
  double margin_loss_ = 0.0;  ///< share of right answers lost with the first method under `null`
  std::vector<PlannedSchedule> schedules_;       ///< of each participant in turn, by visit
  std::vector<study::StimulusIndex> of_method_;  ///< every stimulus of the test's first method
  analysis::Outcomes empty_;
};

}  // namespace touchtrial::planning::identification
