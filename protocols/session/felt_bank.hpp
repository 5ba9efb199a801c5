/// \file Explorations of every stimulus, felt once and used again and again: what planning reuses
/// in place of running the servo for every trial of every simulated study.
#pragma once

#include "core/random.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/session/labelled_fields.hpp"
#include "protocols/session/subject_model.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace touchtrial::session {

struct FeltBankOptions {
  int explorations = 200;  ///< of each stimulus, 1 .. 2^24 - 1
  std::uint64_t seed = 1;  ///< of their paths, which no trial and no training pass has
  int jobs = 1;            ///< threads, >= 1; the bank does not depend on them
};

/// Of each stimulus (class x exemplar x method) what its explorations felt like, before noise. They
/// are made by the same hand, servo, force limit and sense as trials, and independent of each
/// other: exploration i of a stimulus is a draw from what any trial with it feels like. It is a
/// function of study, fields, subject (hand and path alone, no noise or bias), seed, the stimulus's
/// place and i: a larger bank begins with the smaller. Refers to nothing; immutable, thread-safe.
class FeltBank {
 public:
  /// Feels. Cost: explorations x stimuli x explore_s x 0.15 ms a thread (1.5 ms for 10 s);
  /// memory: 184 bytes an exploration.
  /// \param study  that the fields are of: exploration limit and force limit
  /// \param progress  counts explorations; called from one thread at a time
  /// \throws std::invalid_argument if an option is out of range
  FeltBank(const LabelledFields& fields, const design::Study& study, const SubjectModel& subject,
           const FeltBankOptions& options, const design::Progress& progress = {});

  [[nodiscard]] int stimuli() const noexcept { return static_cast<int>(stimuli_.size()); }
  [[nodiscard]] int explorations() const noexcept { return explorations_; }
  /// In the order of LabelledFields::all, which is that of the knowledge's prototypes too.
  [[nodiscard]] const design::StimulusIndex& stimulus(int place) const noexcept {
    return stimuli_[place];
  }
  /// \throws std::invalid_argument if the study does not present it
  [[nodiscard]] int place_of(const design::StimulusIndex& stimulus) const;
  /// All explorations of one stimulus. \param place  0 .. stimuli() - 1
  [[nodiscard]] std::span<const engine::FeltFeatures> felt(int place) const noexcept {
    const auto count = static_cast<std::size_t>(explorations_);
    return {felt_.data() + static_cast<std::size_t>(place) * count, count};
  }

 private:
  int explorations_;
  std::vector<design::StimulusIndex> stimuli_;
  std::vector<engine::FeltFeatures> felt_;
};

/// What a participant of simulate_study feels in one presentation, to the bit: the servo path's
/// exploration without its session. Cost: as one exploration of a bank.
/// \param seed  of the simulation  \param number  of the participant, from 1
/// \param nth  presentation that the participant begins, from 1, unscored ones counted
[[nodiscard]] engine::FeltFeatures feel_trial(const LabelledField& field,
                                              const PlaneGeometry& plane,
                                              const design::Study& study,
                                              const SubjectModel& subject, std::uint64_t seed,
                                              int number, std::uint64_t nth);

}  // namespace touchtrial::session
