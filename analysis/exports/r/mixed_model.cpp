#include "analysis/exports/r/mixed_model.hpp"

#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/trial_columns.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

DataCell seconds_between(const std::optional<std::chrono::nanoseconds>& from,
                         const std::optional<std::chrono::nanoseconds>& to) {
  if (!from || !to) return std::monostate{};
  return *to - *from;
}

DataCell class_or_nothing(const Outcomes& outcomes, const std::optional<int>& index) {
  if (!index) return std::monostate{};
  return outcomes.classes[*index];
}

DataCell whole_or_nothing(const std::optional<int>& number) {
  if (!number) return std::monostate{};
  return std::int64_t{*number};
}

/// The class is part of the name: two classes may have an image of one name.
std::string image_name(const Outcomes& outcomes, const TrialOutcome& trial) {
  return outcomes.classes[trial.stimulus.class_index] + ": " + image_of(outcomes, trial);
}

std::vector<const TrialOutcome*> in_order_of_presentation(const Outcomes& outcomes) {
  std::vector<const TrialOutcome*> trials;
  for (const TrialOutcome& trial : outcomes.trials) trials.push_back(&trial);
  std::stable_sort(trials.begin(), trials.end(), [](const TrialOutcome* a, const TrialOutcome* b) {
    return std::pair(a->row.session, a->row.presented_at) <
           std::pair(b->row.session, b->row.presented_at);
  });
  return trials;
}

/// What came before a trial: in the same block, and no catch trial.
const TrialOutcome* before(const TrialOutcome* previous, const TrialOutcome& trial) {
  const bool told = previous != nullptr && previous->row.session == trial.row.session &&
                    previous->row.block == trial.row.block &&
                    previous->kind != design::PresentationKind::catch_trial;
  return told ? previous : nullptr;
}

std::vector<DataCell> row_of(const Outcomes& outcomes, const TrialOutcome& trial,
                             const TrialOutcome* previous, int place) {
  const store::TrialRow& row = trial.row;
  std::optional<int> previous_class;
  std::optional<int> previous_response;
  if (previous != nullptr) {
    previous_class = previous->stimulus.class_index;
    previous_response = previous->response;
  }
  return {trial.participant,
          std::int64_t{row.session},
          outcomes.methods[trial.stimulus.method],
          outcomes.classes[trial.stimulus.class_index],
          image_name(outcomes, trial),
          std::int64_t{row.block},
          std::int64_t{row.trial},
          std::int64_t{place},
          flag(trial.correct()),
          class_or_nothing(outcomes, trial.response),
          class_or_nothing(outcomes, previous_class),
          class_or_nothing(outcomes, previous_response),
          whole_or_nothing(row.confidence),
          seconds_between(row.presented_at, row.answered_at),
          seconds_between(row.contact_at, row.answered_at),
          flag(trial.valid()),
          1.0 / static_cast<double>(outcomes.classes.size()),
          flag(outcomes.simulated)};
}

std::string notes(const Outcomes& outcomes) {
  return fmt::format(
      "# Mixed model of {}\n\n{}`mixed_model.csv` has one row a trial that counts; "
      "`Rscript mixed_model.R` fits\n\n    {}\n\nas a binomial model with a logit link (lme4). "
      "Participants and images are random, so that what it says holds for others like them; with "
      "few images it hardly does. A trial without a response is wrong. `place` is the trial's "
      "place among its participant's trials of the method; `previous_class` and "
      "`previous_response` are of the presentation before in the same block.\n",
      outcomes.study, outcomes.simulated ? "SIMULATED: every participant is a program.\n\n" : "",
      mixed_model_formula(outcomes));
}

}  // namespace

DataTable mixed_model_table(const Outcomes& outcomes) {
  DataTable table{{"participant", "session", "method", "class", "image", "block", "trial", "place",
                   "correct", "response", "previous_class", "previous_response", "confidence",
                   "reaction_time_s", "from_contact_s", "valid", "chance", "simulated"},
                  {}};
  std::map<std::pair<std::string, int>, int> places;
  const TrialOutcome* previous = nullptr;
  for (const TrialOutcome* trial : in_order_of_presentation(outcomes)) {
    if (trial->counted) {
      const int place = ++places[{trial->participant, trial->stimulus.method}];
      table.rows.push_back(row_of(outcomes, *trial, before(previous, *trial), place));
    }
    previous = trial;
  }
  return table;
}

std::string mixed_model_formula(const Outcomes& outcomes) {
  const char* fixed = outcomes.methods.size() > 1 ? "method" : "1";
  return fmt::format("correct ~ {} + (1 | participant) + (1 | image)", fixed);
}

std::vector<std::filesystem::path> export_mixed_model(const store::StudyStore& store,
                                                      const Outcomes& outcomes,
                                                      const std::filesystem::path& folder) {
  const store::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "r"},
                      {text_file("mixed_model.csv", csv_text(mixed_model_table(outcomes))),
                       text_file("mixed_model.R", mixed_model_script(outcomes)),
                       text_file("mixed_model.md", notes(outcomes))});
}

}  // namespace touchtrial::analysis
