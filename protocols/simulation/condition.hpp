/// \file The condition that a simulated participant is in, from trial to trial of one visit.
/// Source: docs/planning.md, "From trial to trial".
#pragma once

#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/trial_course.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace touchtrial::simulation {

/// What one trial's condition adds to a decision. Without anything: a decision that depends on
/// nothing but the trial.
struct Moment {
  double noise_factor = 1.0;    ///< on the noise of all features
  double lapse_log_odds = 0.0;  ///< added to those of the participant's lapses
  /// Support that the trial before gives to pictures, and their positions.
  struct Leaning {
    std::size_t position = 0;
    double log_odds = 0.0;
  };
  std::optional<Leaning> to_answer{};    ///< of the trial before
  std::optional<Leaning> to_stimulus{};  ///< likewise
  /// How long thought takes; null: as long, whatever is felt.
  const ThoughtTime* thought = nullptr;
};

/// One participant in one visit. Learns, tires, and leans on the trial before. A function of
/// subject, seed, number, visit and of the calls that were made: the same in a session and without
/// one. Refers to the subject, which must outlive it.
class Condition {
 public:
  /// \param number  of the participant, from 1
  /// \param visit  from 1
  /// \param presentations  of each visit, >= 0; only those of earlier visits matter
  Condition(const SubjectModel& subject, std::uint64_t seed, int number, int visit = 1,
            int presentations = 0);

  /// The condition in which the next presentation is felt and answered.
  /// \param nth  presentation of the visit, from 1
  /// \param block  of the presentation, from 0
  [[nodiscard]] Moment before(int nth, int block);

  /// A break.
  /// \param begun  presentations of the visit so far
  void rest(int begun);

  /// Ends a trial.
  /// \param answered  position of the picture
  /// \param presented  position of the picture that the presented class is matched to, if known
  void after(std::size_t answered, std::optional<std::size_t> presented);

  /// Forgets the trial before: nothing of it carries over.
  void forget() noexcept;

 private:
  [[nodiscard]] double period_log(int block);
  void tire(int done);

  const SubjectModel* subject_;
  std::uint64_t seed_;
  std::uint64_t number_;
  int visit_;
  double first_log_;        ///< ln of the factor on the noise before anything is felt
  double felt_before_;      ///< presentations felt at earlier visits and not forgotten
  double tired_min_ = 0.0;  ///< minutes of exploring that breaks have left
  int tired_by_ = 0;        ///< presentations that are counted in them
  double to_answer_;
  double to_stimulus_;
  std::map<int, double> period_logs_;  ///< by block
  std::optional<std::size_t> answered_;
  std::optional<std::size_t> presented_;
};

}  // namespace touchtrial::simulation
