#include "protocols/identification/analysis/mixed_model.hpp"

#include "analysis/choices/people.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "core/text.hpp"

#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

DataCell class_cell(const Outcomes& outcomes, const std::optional<int>& index) {
  if (!index) return std::monostate{};
  return outcomes.classes[*index];
}

choices::PersonTrials trials_in_presented_order(const Outcomes& outcomes) {
  choices::PersonTrials trials;
  for (const TrialOutcome& trial : outcomes.trials) trials.push_back(&trial);
  choices::sort_in_felt_order(trials);
  return trials;
}

/// The previous presentation, unless it is of another block or a catch trial.
const TrialOutcome* preceding_trial(const TrialOutcome* previous, const TrialOutcome& trial) {
  const bool is_relevant = previous != nullptr && previous->row.session == trial.row.session &&
                           previous->row.block == trial.row.block &&
                           previous->role != study::Role::catch_trial;
  return is_relevant ? previous : nullptr;
}

std::vector<DataCell> row_of(const Outcomes& outcomes, const TrialOutcome& trial,
                             const TrialOutcome* previous, int place) {
  const record::TrialRow& row = trial.row;
  std::optional<int> previous_class;
  std::optional<int> previous_response;
  if (previous != nullptr) {
    previous_class = previous->stimulus.class_index;
    previous_response = previous->response;
  }
  return {trial.participant, std::int64_t{row.session}, outcomes.methods[trial.stimulus.method],
          outcomes.classes[trial.stimulus.class_index],
          // Two classes may have images of the same name.
          outcomes.classes[trial.stimulus.class_index] + ": " + image_of(outcomes, trial),
          std::int64_t{row.block}, std::int64_t{row.trial}, std::int64_t{place},
          flag(trial.correct()), class_cell(outcomes, trial.response),
          class_cell(outcomes, previous_class), class_cell(outcomes, previous_response),
          optional_cell(row.confidence), optional_cell(row.reaction_time()),
          optional_cell(row.from_contact()), flag(trial.valid()),
          1.0 / static_cast<double>(outcomes.classes.size()), flag(outcomes.simulated)};
}

/// The minimum for random effects of images.
constexpr std::size_t kMinRandomImages = 10;

std::size_t images_of(const Outcomes& outcomes) {
  std::size_t images = 0;
  for (const auto& class_images : outcomes.exemplars) images += class_images.size();
  return images;
}

std::string images_note(const Outcomes& outcomes) {
  const std::size_t images = images_of(outcomes);
  if (images >= kMinRandomImages) {
    return "Images are random effects of the model, so its results generalise to other images; "
           "those of the t test do not.";
  }
  return fmt::format(
      "With fewer than {} images, images are fixed effects: the results hold only for the {} of "
      "this study.",
      kMinRandomImages, images);
}

std::string notes(const Outcomes& outcomes) {
  return fmt::format(
      "`mixed_model.csv` has one row per counted trial. `Rscript mixed_model.R` prints two "
      "analyses; with `--csv`, all digits.\n\n1. Student's t over participants' accuracies: the "
      "result to quote. With methods in separate blocks it is adjusted for the period.\n2. A "
      "binomial model with a logit link (lme4, sum-coded):\n\n    {}\n\n   If it is singular or "
      "does not converge, the same with `||` in place of `|`; if this fails too, none: a model in "
      "which people differ only in accuracy takes chance for a difference between methods too "
      "often. If all trials of an image or method are right, or wrong (separation), the script "
      "omits and reports terms without a finite estimate. Intervals and p have as many degrees of "
      "freedom as participants, minus one.\n\n{} A trial without a response is wrong. `period` is "
      "the place of a trial's block among its participant's blocks; `place` the trial's place "
      "among its participant's trials of the method; `previous_class` and `previous_response` are "
      "those of the previous presentation in the same block.\n",
      mixed_model_formula(outcomes), images_note(outcomes));
}

/// Rows are in the order of presentation. The class and the answer of the previous presentation,
/// which may be a lead-in, are empty at the start of a block and after a catch trial.
DataTable mixed_model_table(const Outcomes& outcomes) {
  DataTable table{{"participant", "session", "method", "class", "image", "block", "trial", "place",
                   "correct", "response", "previous_class", "previous_response", "confidence",
                   "reaction_time_s", "from_contact_s", "valid", "chance", "simulated"},
                  {}};
  std::map<std::pair<std::string, int>, int> places;
  const TrialOutcome* previous = nullptr;
  for (const TrialOutcome* trial : trials_in_presented_order(outcomes)) {
    if (trial->counted) {
      const int place = ++places[{trial->participant, trial->stimulus.method}];
      table.rows.push_back(row_of(outcomes, *trial, preceding_trial(previous, *trial), place));
    }
    previous = trial;
  }
  return table;
}

}  // namespace

std::string mixed_model_formula(const Outcomes& outcomes) {
  const bool has_several_methods = outcomes.methods.size() > 1;
  const std::size_t images = images_of(outcomes);
  const std::string effects = has_several_methods ? "1 + method" : "1";
  const std::string random = fmt::format("({} | participant)", effects);
  if (images >= kMinRandomImages) {
    return fmt::format("correct ~ {}{} + ({} | image)",
                       has_several_methods ? "method + period + " : "", random, effects);
  }
  const std::string image = images > 1 ? (has_several_methods ? " * image" : "image + ") : "";
  return "correct ~ " + (has_several_methods ? "method" + image + " + period + " : image) + random;
}

RModel mixed_model(const Outcomes& outcomes) {
  return {"Mixed model", "mixed_model", mixed_model_table(outcomes),
          fmt::format("methods <- c({})\n\n{}", listed(outcomes.methods, ", ", r_text),
                      mixed_model_functions()),
          notes(outcomes)};
}

}  // namespace touchtrial::analysis::identification
