/// \file A simulated participant who compares the planes of a trial. Thresholds result from the
/// sense of touch and noise, not from a psychometric function. Source: docs/thresholds.md,
/// "Simulated participants".
#pragma once

#include "protocols/simulation/condition.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::simulation::threshold {

/// The change of features at the highest level, which all participants of a study learn before the
/// first trial.
struct ExpectedChange {
  engine::FeltFeatures lower{};   ///< mean features of standards or blank planes
  engine::FeltFeatures higher{};  ///< mean features of the highest levels
};

/// Feels every interval with independent noise and chooses the strongest, the odd one, or
/// "different" if two differ by more than a criterion. In a lapse, chooses at random. With
/// SubjectModel::given_function, answers by that function instead. Subject and study must outlive
/// it.
class ComparingParticipant final : public SimulatedParticipant {
 public:
  /// \param subject  must explore for longer than any interval
  /// \param number  from 1
  ComparingParticipant(const SubjectModel& subject, const study::Study& study,
                       const ExpectedChange& expected, std::uint64_t seed, int number);

  void see_pictures(const std::vector<std::string>& labels) override { labels_ = labels; }
  void interval(const session::IntervalStep& next) override;
  void rest() override { condition_.rest(started_count_); }
  void follow(std::unique_ptr<study::Order> order) override { order_ = std::move(order); }

 protected:
  [[nodiscard]] ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                         RandomStream& random) override;
  void begin_visit(int visit, TrialCourse course) override;

 private:
  /// The perceived strength of a plane: its features projected on the expected change.
  [[nodiscard]] double strength(engine::FeltFeatures felt, double noise_factor,
                                RandomStream& random) const;
  /// The position chosen from the strengths of the intervals.
  [[nodiscard]] int choose_from_strengths(const std::vector<double>& strengths) const;
  /// Answers by SubjectModel::given_function.
  /// \throws UsageError if the trial's level is unknown
  [[nodiscard]] int answer_by_function(RandomStream& random);

  const SubjectModel& subject_;
  const study::threshold::ThresholdOptions& options_;
  std::uint64_t seed_;
  int number_;
  Individual individual_;
  engine::FeltFeatures weights_{};  ///< weights of features in a strength
  double noise_ = 0.0;              ///< standard deviation of a strength
  double criterion_ = 0.0;          ///< minimum difference of strengths for the answer "different"
  Condition condition_;
  std::vector<std::string> labels_;
  std::vector<engine::FeltFeatures> felt_;  ///< by interval of the trial
  bool is_control_ = false;                 ///< the hand is off the device
  std::unique_ptr<study::Order> order_;
  int trial_ = 0;                   ///< number of the current trial in the schedule
  std::set<int> started_trials_{};  ///< numbers of started trials
  int started_count_ = 0;           ///< number of started trials, including repeated trials
};

/// Trains participants by strokes over standards and highest levels.
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] std::unique_ptr<const Population> make_population(const PopulationSetting& setting);

}  // namespace touchtrial::simulation::threshold
