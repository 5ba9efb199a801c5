/// \file A study as its simulated participants feel it, for the models of planning.
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/session/subject_model.hpp"

namespace touchtrial::planning {

struct FeltStudyOptions {
  int explorations = 1000;  ///< of each stimulus
  int directions = 1;       ///< of noise on each
  /// Of training, as simulate's: the same seed teaches the same. Of the bank's paths too.
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// Trains the subject, feels a bank, and makes the model of answers. Cost: as FeltBank.
/// \throws StudyError if the subject names a class that the study does not have
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] AnswerModel answer_model_of(const design::StudyKey& key, const engine::Pack& pack,
                                          const session::SubjectModel& subject,
                                          const FeltStudyOptions& options,
                                          const design::Progress& progress = {});

/// The study's stimuli in the order of banks.
[[nodiscard]] std::vector<design::StimulusIndex> stimuli_of(const design::StudyKey& key);

/// The layouts of the first participants, each once.
[[nodiscard]] std::vector<PictureLayout> layouts_of(const design::Study& study, int participants);

}  // namespace touchtrial::planning
