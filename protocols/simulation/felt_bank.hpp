/// \file Precomputed explorations of every stimulus. Planning draws from them, so that the servo
/// need not run for every trial of every simulated study.
#pragma once

#include "core/random.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/prepare.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace touchtrial::simulation {

struct FeltBankOptions {
  int explorations = 200;  ///< number per stimulus, 1 .. 2^24 - 1
  std::uint64_t seed = 1;  ///< of the paths, which are not those of trials or training
  int jobs = 1;            ///< threads, >= 1; results do not depend on it
};

/// Features without noise, from many explorations of each stimulus (class x exemplar x method).
/// Hand, servo, force limit and sense are the same as in trials. Each exploration is thus an
/// independent draw from the features of a trial with that stimulus, including its gain.
/// Exploration i depends only on study, fields, seed, the stimulus's place, i, and the subject's
/// hand and path, so that a larger bank begins with the smaller one. Contains no references;
/// immutable and thread-safe.
class FeltBank {
 public:
  /// Explores every stimulus. Time: explorations x stimuli x explore_s x 0.15 ms of one thread
  /// (1.5 ms for 10 s). Memory: 184 bytes per exploration.
  /// \param study  the study of the fields; it sets the exploration limit and the force limit
  /// \param progress  counts explorations; called from one thread at a time
  /// \throws std::invalid_argument if an option is out of range
  FeltBank(const LabelledFields& fields, const study::Study& study, const SubjectModel& subject,
           const FeltBankOptions& options, const study::Progress& progress = {});

  [[nodiscard]] int stimuli() const noexcept { return static_cast<int>(stimuli_.size()); }
  [[nodiscard]] int explorations() const noexcept { return explorations_; }
  /// The stimulus at a place. Places are in the order of LabelledFields::all and of the knowledge's
  /// prototypes.
  [[nodiscard]] const study::StimulusIndex& stimulus(int place) const noexcept {
    return stimuli_[place];
  }
  /// \throws std::invalid_argument if the study does not present it
  [[nodiscard]] int place_of(const study::StimulusIndex& stimulus) const;
  /// All explorations of one stimulus.
  /// \param place  0 .. stimuli() - 1
  [[nodiscard]] std::span<const engine::FeltFeatures> felt(int place) const noexcept {
    const auto count = static_cast<std::size_t>(explorations_);
    return {felt_.data() + static_cast<std::size_t>(place) * count, count};
  }

 private:
  int explorations_;
  std::vector<study::StimulusIndex> stimuli_;
  std::vector<engine::FeltFeatures> felt_;
};

/// The features that a participant of simulate_study feels in one presentation, computed without a
/// session but with bit-identical results. Takes as long as one exploration of a bank.
/// \param gain_db  the presentation's gain
/// \param seed  the simulation's seed
/// \param number  the participant's number, from 1
/// \param nth  number of the presentation for this participant, from 1, including unscored ones
[[nodiscard]] engine::FeltFeatures feel_trial(const LabelledField& field, double gain_db,
                                              const PlaneGeometry& plane, const study::Study& study,
                                              const SubjectModel& subject, std::uint64_t seed,
                                              int number, std::uint64_t nth);

}  // namespace touchtrial::simulation
