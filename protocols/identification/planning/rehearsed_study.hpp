/// \file Fast simulation of a study with its schedules, pictures and orders, but without sessions,
/// database and traces; and the source of participants' perception. Source: docs/planning.md, "The
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
  std::uint64_t draw = 0;        ///< random bits for the presentation
  double gain_db = 0.0;          ///< study::Plane::gain_db
};

/// The source of participants' training and perception. Results depend only on the arguments.
/// Thread-safe.
class PerceptionSource {
 public:
  virtual ~PerceptionSource() = default;
  PerceptionSource() = default;
  PerceptionSource(const PerceptionSource&) = delete;
  PerceptionSource& operator=(const PerceptionSource&) = delete;

  /// The result of training a study's participants with `simulation::learn`.
  [[nodiscard]] virtual std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const = 0;
  /// The felt features of a stimulus in a presentation, without noise.
  [[nodiscard]] virtual engine::FeltFeatures felt(const study::StimulusIndex& stimulus,
                                                  const FeltTrial& trial) const = 0;
};

struct PrecomputedPerceptionOptions {
  int explorations = 1000;  ///< precomputed explorations per stimulus
  int trainings = 16;       ///< precomputed trainings
  std::uint64_t seed = 1;   ///< of the exploration paths
  int jobs = 1;             ///< number of threads; does not affect results
};

/// Precomputed explorations and trainings. Each trial draws one exploration, and each study draws
/// one training. Keeps no references to its arguments.
class PrecomputedPerception final : public PerceptionSource {
 public:
  /// \param study  the study that the fields belong to
  /// \param progress  called from one thread at a time
  PrecomputedPerception(const simulation::LabelledFields& fields, const study::Study& study,
                        const simulation::SubjectModel& subject,
                        const PrecomputedPerceptionOptions& options,
                        const study::Progress& progress = {});

  [[nodiscard]] std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const override;
  [[nodiscard]] engine::FeltFeatures felt(const study::StimulusIndex& stimulus,
                                          const FeltTrial& trial) const override;

 private:
  simulation::FeltBank bank_;
  std::vector<std::shared_ptr<const simulation::FeltKnowledge>> trainings_;
};

/// Checks that the subject answers within the study's time limit.
/// \throws StudyError, naming the subject's file and the remedy, if the subject explores until the
///   limit and the study then rejects answers
void require_answers(const study::Study& study, const simulation::SubjectModel& subject);

/// Simulates outcomes of one study repeatedly. Study, subject and perception must outlive it.
/// Thread-safe once constructed.
class RehearsedStudy final : public Rehearsal {
 public:
  /// \param max_participants  maximum of any simulated study, >= 1; determines the number of
  ///   schedules
  /// \throws StudyError if the study's orders are impossible, or as require_answers does
  /// \throws UsageError if the margin is not below the methods' accuracy
  RehearsedStudy(const study::Study& study, const simulation::SubjectModel& subject,
                 const PrimaryTest& test, const PerceptionSource& perception, int max_participants);

  /// See Rehearsal. Without a margin, with `population` and features from the servo, the scored
  /// trials equal the scored trials of `simulate --seed study_seed`. Times, evidence and unscored
  /// trials are omitted.
  [[nodiscard]] analysis::Outcomes outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const override;

 private:
  /// A visit's data common to all simulated studies.
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
  /// Replaces a right answer with a wrong one with probability `loss`.
  /// \param right  the presented class
  [[nodiscard]] static int position_after_loss(int position, double loss, Person& person, int right,
                                               const study::Schedule& schedule);
  /// \param draw  random bits
  [[nodiscard]] study::StimulusIndex felt_stimulus(const study::StimulusIndex& presented,
                                                   Hypothesis hypothesis, std::uint64_t draw) const;

  /// The population's accuracy with the test's first method.
  [[nodiscard]] double accuracy_of(int people) const;
  void set_margin();

  const simulation::SubjectModel& subject_;
  PrimaryTest test_;
  const PerceptionSource& perception_;
  int visits_;                ///< per participant
  double margin_loss_ = 0.0;  ///< share of right answers lost with the first method under `null`
  std::vector<PlannedSchedule> schedules_;                  ///< by participant and visit
  std::vector<study::StimulusIndex> first_method_stimuli_;  ///< stimuli of the test's first method
  analysis::Outcomes empty_;
};

}  // namespace touchtrial::planning::identification
