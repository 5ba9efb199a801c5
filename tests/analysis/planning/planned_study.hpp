/// \file A tiny study as planning feels it.
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_evidence.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/felt_bank.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <string>
#include <vector>

namespace touchtrial {

/// A subject who explores for 1.2 s, learns in four passes and makes no errors.
[[nodiscard]] inline simulation::SubjectModel planned_subject() {
  return {.explore_s = 1.2, .training_passes = 4};
}

/// A tiny study, what the subject learns of it, and a bank of explorations.
struct PlannedStudy {
  explicit PlannedStudy(int explorations, const TinyStudyOptions& options = {})
      : study(options),
        source(study.pack(), study.key().study.rendering),
        fields(study.key(), source),
        knowledge(simulation::learn_by_feeling(fields, planned_subject(), 3.3, 1, 2)),
        bank(fields, study.key().study, planned_subject(),
             {.explorations = explorations, .seed = 1, .jobs = 2}) {
    for (const study::StudyClass& one : study.key().study.classes) labels.push_back(one.label);
  }

  [[nodiscard]] planning::AnswerModel model(int directions = 4, int jobs = 2) const {
    return {knowledge, bank, labels, {.directions = directions, .seed = 1, .jobs = jobs}};
  }

  TinyStudy study;
  session::StimulusSource source;
  simulation::LabelledFields fields;
  simulation::FeltKnowledge knowledge;
  simulation::FeltBank bank;
  std::vector<std::string> labels;
};

/// The slow reference of AnswerModel: participants' answers to `repeats` presentations of every
/// stimulus, one by one. Each answer draws an exploration of the bank and decides as simulated
/// participants do.
[[nodiscard]] planning::FitCounts simulated_counts(const PlannedStudy& planned,
                                                   const simulation::SubjectModel& subject,
                                                   int participants, int repeats,
                                                   std::uint64_t seed);

}  // namespace touchtrial
