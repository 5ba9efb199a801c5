/// \file Changes of a simulated participant from trial to trial within a visit: learning, fatigue
/// and serial dependence. Source: docs/planning.md, "From trial to trial".
#pragma once

#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/trial_course.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace touchtrial::simulation {

/// The effects of a participant's condition on the decision in one trial. The default values have
/// no effect.
struct ConditionEffects {
  double noise_factor = 1.0;    ///< on the noise of all features
  double lapse_log_odds = 0.0;  ///< added to the log odds of a lapse
  /// Support that the previous trial adds to the picture at a position.
  struct Leaning {
    std::size_t position = 0;
    double log_odds = 0.0;
  };
  std::optional<Leaning> answer_leaning{};    ///< towards the previous answer
  std::optional<Leaning> stimulus_leaning{};  ///< towards the previous stimulus
  /// The model of thinking time; null: independent of felt features.
  const ThoughtTime* thought = nullptr;
};

/// The condition of one participant in one visit: learning, fatigue and serial dependence. It
/// depends only on subject, seed, number, visit and the calls made. The subject must outlive it.
class Condition {
 public:
  /// \param number  the participant's number, from 1
  /// \param visit  from 1
  /// \param presentations  number at each visit, >= 0; only earlier visits matter
  Condition(const SubjectModel& subject, std::uint64_t seed, int number, int visit = 1,
            int presentations = 0);

  /// The effects on the next presentation.
  /// \param nth  number of the presentation in the visit, from 1
  /// \param block  the presentation's block, from 0
  [[nodiscard]] ConditionEffects effects_on(int nth, int block);

  /// Records a break, which reduces fatigue.
  /// \param presentations  number of presentations of the visit so far
  void rest(int presentations);

  /// Records a trial.
  /// \param answered  position of the picture
  /// \param presented  position of the picture that the presented class is matched to, if known
  void record_trial(std::size_t answered, std::optional<std::size_t> presented);

  /// Forgets the previous trial, so that it does not affect the next one.
  void forget() noexcept;

 private:
  [[nodiscard]] double period_log(int block);
  void tire(int presentations);

  const SubjectModel* subject_;
  std::uint64_t seed_;
  std::uint64_t number_;
  int visit_;
  double first_log_;  ///< natural logarithm of the noise factor at the first presentation
  double earlier_presentations_;  ///< number at earlier visits, less those forgotten
  double tired_min_ = 0.0;        ///< minutes of exploring, less the recovery in breaks
  int tired_presentations_ = 0;   ///< presentations counted in `tired_min_`
  double answer_leaning_;
  double stimulus_leaning_;
  std::map<int, double> period_logs_;  ///< by block
  std::optional<std::size_t> answered_;
  std::optional<std::size_t> presented_;
};

}  // namespace touchtrial::simulation
