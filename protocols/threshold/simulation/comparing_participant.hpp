/// \file A simulated participant who compares the planes of a trial. It has no psychometric function;
/// the threshold results from sense and noise. Source: docs/thresholds.md, "Simulated
/// participants".
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

/// What all participants of a study learn before the first trial: the direction in which features
/// change with the level, and the change at the highest level.
struct ExpectedChange {
  engine::FeltFeatures lower{};   ///< mean features of standards or blank planes
  engine::FeltFeatures higher{};  ///< mean features of the highest levels
};

/// Feels every interval with independent noise and chooses the strongest, the odd one, or
/// "different" if two differ by more than a criterion; in a lapse, chooses at random. With
/// SubjectModel::given_function it answers by that function instead. Subject and study must outlive
/// it.
class ComparingParticipant final : public SimulatedParticipant {
 public:
  /// \param subject  explores for as long as an interval may last
  /// \param number  from 1
  ComparingParticipant(const SubjectModel& subject, const study::Study& study,
                       const ExpectedChange& expected, std::uint64_t seed, int number);

  void see_pictures(const std::vector<std::string>& labels) override { labels_ = labels; }
  void interval(const session::IntervalStep& next) override;
  void rest() override { condition_.rest(trials_); }
  void follow(std::unique_ptr<study::Order> order) override { order_ = std::move(order); }

 protected:
  [[nodiscard]] ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                         RandomStream& random) override;
  void begin_visit(int visit, TrialCourse course) override;

 private:
  /// The perceived strength of a plane, along the expected change.
  [[nodiscard]] double strength(engine::FeltFeatures felt, double noise_factor,
                                RandomStream& random) const;
  /// The position chosen from the strengths of the intervals.
  [[nodiscard]] int choice_from(const std::vector<double>& strengths) const;
  /// The answer by SubjectModel::given_function.
  /// \throws UsageError if the level is not known
  [[nodiscard]] int answer_by_function(RandomStream& random);

  const SubjectModel& subject_;
  const study::threshold::ThresholdOptions& options_;
  std::uint64_t seed_;
  int number_;
  Individual individual_;
  engine::FeltFeatures weights_{};
  double noise_ = 0.0;      ///< standard deviation of a strength
  double criterion_ = 0.0;  ///< of a difference
  Condition condition_;
  std::vector<std::string> labels_;
  std::vector<engine::FeltFeatures> felt_;  ///< of the trial's earlier intervals
  bool hears_only_ = false;
  std::unique_ptr<study::Order> order_;
  int trial_ = 0;          ///< number in the schedule
  std::set<int> begun_{};  ///< by that number
  int trials_ = 0;
};

/// Strokes standards and highest levels, as before a first trial, and learns what changes.
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] std::unique_ptr<const Population> make_population(const PopulationSetting& setting);

}  // namespace touchtrial::simulation::threshold
