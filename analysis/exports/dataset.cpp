#include "analysis/exports/dataset.hpp"

#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/report/results.hpp"
#include "analysis/report/text_figures.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Whether a character is an ASCII letter or digit, in every locale.
bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

std::string participant_label(const std::string& participant) {
  std::string label;
  for (const char c : participant) {
    if (is_plain(c) && c != 'Z') {
      label += c;
    } else {
      label += 'Z';
      label += c == '-' ? 'd' : c == '_' ? 'u' : c == '+' ? 'p' : 'Z';
    }
  }
  return label;
}

std::string plain_label(const std::string& name) {
  std::string label;
  std::copy_if(name.begin(), name.end(), std::back_inserter(label), is_plain);
  return label.empty() ? "study" : label;
}

std::string study_readme(const DatasetSource& study) {
  const record::StudyCommitment& commitment = study.store.commitment();
  const std::vector<record::SessionRow> sessions = study.store.sessions();
  const auto counts =
      std::count_if(sessions.begin(), sessions.end(),
                    [&](const record::SessionRow& row) { return session_counts(row, commitment); });
  const bool has_choices = commitment.positions > 0;
  const bool has_planes = prescription_from_json(commitment.configuration).intervals > 0;
  std::string text;
  if (commitment.simulated) {
    text +=
        "SIMULATED: every participant in this dataset is a program. No data come from a "
        "person.\n\n";
  }
  if (commitment.pilot) text += "A pilot: do not pool with the study's data.\n\n";
  text += fmt::format(
      "A psychophysical study of textures felt through a force-feedback device, recorded "
      "with Touchtrial {}. Protocol: {}; {}{} scored trials per participant; {} that count{}.\n\n",
      commitment.program_version, commitment.protocol,
      has_choices ? fmt::format("{} {} to choose from; ", commitment.positions,
                                has_planes ? "answers" : "textures")
                  : "",
      commitment.scored_trials, counted(counts, "completed session"), counts == 1 ? "s" : "");
  text +=
      study.outcomes != nullptr
          ? "Participants who had their data erased are not included. A trial enters the report if "
            "`counted` is 1: its session was completed and not excluded, it is scored, and it "
            "ended. " +
                std::string(has_choices ? "A trial without a response counts as wrong.\n\n"
                                        : "A trial without an answer has no rating.\n\n")
          : "Exported before unblinding: stimuli, answers and their times are sealed, and "
            "practice, lead-ins and catch trials cannot be distinguished from scored trials.\n\n";
  return text;
}

std::string report_in_dataset(const DatasetSource& study, FreeText free_text) {
  if (study.outcomes == nullptr) return quality_json(make_quality(study.store));
  Outcomes outcomes = *study.outcomes;
  if (free_text == FreeText::left_out) {
    for (QuestionAnswer& answer : outcomes.answers) answer.words.clear();
  }
  return analysis_of(outcomes.design).results(outcomes, {})->json();
}

}  // namespace touchtrial::analysis
