/// \file How a simulated participant changes from trial to trial within a visit: learning, fatigue
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

/// The effects of a participant's condition on the decision in one trial. The defaults have no
/// effect.
struct Moment {
  double noise_factor = 1.0;    ///< on the noise of all features
  double lapse_log_odds = 0.0;  ///< added to the log odds of a lapse
  /// Support that the previous trial adds to the picture at a position.
  struct Leaning {
    std::size_t position = 0;
    double log_odds = 0.0;
  };
  std::optional<Leaning> to_answer{};    ///< towards the previous answer
  std::optional<Leaning> to_stimulus{};  ///< towards the previous stimulus
  /// The model of thinking time; null: independent of what is felt.
  const ThoughtTime* thought = nullptr;
};

/// The condition of one participant in one visit, with learning, fatigue and serial dependence. It
/// depends only on subject, seed, number, visit and the calls made, with or without a session. The
/// subject must outlive it.
class Condition {
 public:
  /// \param number  of the participant, from 1
  /// \param visit  from 1
  /// \param presentations  of each visit, >= 0; only those of earlier visits matter
  Condition(const SubjectModel& subject, std::uint64_t seed, int number, int visit = 1,
            int presentations = 0);

  /// The effects on the next presentation.
  /// \param nth  presentation of the visit, from 1
  /// \param block  of the presentation, from 0
  [[nodiscard]] Moment before(int nth, int block);

  /// Takes a break.
  /// \param begun  number of presentations of the visit so far
  void rest(int begun);

  /// Ends a trial.
  /// \param answered  position of the picture
  /// \param presented  position of the picture that the presented class is matched to, if known
  void after(std::size_t answered, std::optional<std::size_t> presented);

  /// Forgets the previous trial, so that nothing carries over.
  void forget() noexcept;

 private:
  [[nodiscard]] double period_log(int block);
  void tire(int done);

  const SubjectModel* subject_;
  std::uint64_t seed_;
  std::uint64_t number_;
  int visit_;
  double first_log_;        ///< natural logarithm of the noise factor at the first presentation
  double felt_before_;      ///< presentations felt at earlier visits and not forgotten
  double tired_min_ = 0.0;  ///< minutes of exploring, less the recovery in breaks
  int tired_by_ = 0;        ///< presentations counted in `tired_min_`
  double to_answer_;
  double to_stimulus_;
  std::map<int, double> period_logs_;  ///< by block
  std::optional<std::size_t> answered_;
  std::optional<std::size_t> presented_;
};

}  // namespace touchtrial::simulation
