/// \file A tiny study as planning feels it.
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_counts.hpp"
#include "protocols/session/felt_bank.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/tiny_study.hpp"

#include <string>
#include <vector>

namespace touchtrial {

/// Explores for a second and learns in four passes; makes no errors.
[[nodiscard]] inline session::SubjectModel planned_subject() {
  session::SubjectModel subject;
  subject.explore_s = 1.2;
  subject.training_passes = 4;
  return subject;
}

/// A tiny study, what is learnt of it, and a bank of explorations.
struct PlannedStudy {
  explicit PlannedStudy(int explorations, const TinyStudyOptions& options = {})
      : study(options),
        source(study.pack(), study.key().study.rendering),
        fields(study.key(), source),
        knowledge(session::learn_by_feeling(fields, planned_subject(), 3.3, 1, 2)),
        bank(fields, study.key().study, planned_subject(),
             {.explorations = explorations, .seed = 1, .jobs = 2}) {
    for (const design::StudyClass& one : study.key().study.classes) labels.push_back(one.label);
  }

  [[nodiscard]] planning::AnswerModel model(int directions = 4, int jobs = 2) const {
    return {knowledge, bank, labels, {.directions = directions, .seed = 1, .jobs = jobs}};
  }

  TinyStudy study;
  session::StimulusSource source;
  session::LabelledFields fields;
  session::FeltKnowledge knowledge;
  session::FeltBank bank;
  std::vector<std::string> labels;
};

/// So many participants' answers to `repeats` presentations of everything, one by one: each feels
/// an exploration of the bank and decides as simulated participants do. The slow reference of
/// AnswerModel.
[[nodiscard]] planning::FitCounts simulated_counts(const PlannedStudy& planned,
                                                   const session::SubjectModel& subject,
                                                   int participants, int repeats,
                                                   std::uint64_t seed);

}  // namespace touchtrial
