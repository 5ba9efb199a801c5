#include "protocols/identification/analysis/mixed_model.hpp"

#include "analysis/choices/people.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "core/text.hpp"

#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

DataCell class_or_nothing(const Outcomes& outcomes, const std::optional<int>& index) {
  if (!index) return std::monostate{};
  return outcomes.classes[*index];
}

/// The name of an image, preceded by its class, because two classes may have images of the same
/// name.
std::string image_name(const Outcomes& outcomes, const TrialOutcome& trial) {
  return outcomes.classes[trial.stimulus.class_index] + ": " + image_of(outcomes, trial);
}

choices::OwnTrials in_order_of_presentation(const Outcomes& outcomes) {
  choices::OwnTrials trials;
  for (const TrialOutcome& trial : outcomes.trials) trials.push_back(&trial);
  choices::sort_as_felt(trials);
  return trials;
}

/// The previous presentation, if it is in the same block and is not a catch trial.
const TrialOutcome* before(const TrialOutcome* previous, const TrialOutcome& trial) {
  const bool told = previous != nullptr && previous->row.session == trial.row.session &&
                    previous->row.block == trial.row.block &&
                    previous->role != study::Role::catch_trial;
  return told ? previous : nullptr;
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
          or_nothing(row.confidence),
          or_nothing(row.reaction_time()),
          or_nothing(row.from_contact()),
          flag(trial.valid()),
          1.0 / static_cast<double>(outcomes.classes.size()),
          flag(outcomes.simulated)};
}

/// From this many images on, the script models them as random effects.
constexpr std::size_t kMinRandomImages = 10;

std::size_t images_of(const Outcomes& outcomes) {
  std::size_t images = 0;
  for (const auto& of_class : outcomes.exemplars) images += of_class.size();
  return images;
}

std::string what_of_images(const Outcomes& outcomes) {
  const std::size_t images = images_of(outcomes);
  if (images >= kMinRandomImages) {
    return "Images are random effects of the model, which speaks of images of which these are a "
           "sample; the t does not.";
  }
  return fmt::format(
      "With fewer than {} images, images are fixed effects: the results hold for the {} of this "
      "study, and nothing can be said of others.",
      kMinRandomImages, images);
}

std::string notes(const Outcomes& outcomes) {
  return fmt::format(
      "`mixed_model.csv` has one row a trial that counts. `Rscript "
      "mixed_model.R` prints two analyses; with `--csv`, all their digits.\n\n1. Student's t over "
      "participants' own accuracies: the result to quote. With methods in blocks of their own it "
      "is adjusted for the period.\n2. A binomial model with a logit link (lme4, sum-coded):\n\n   "
      " "
      "{}\n\n   If it is singular or does not converge, the same with `||` in place of `|`; if "
      "that "
      "does not do either, none: a model in which people differ in their accuracy alone takes "
      "chance for a difference between methods too often. Where all trials of some image or method "
      "are right, or wrong (separation), the script leaves out what has no finite estimate, and "
      "says so. Intervals and p have as many degrees of freedom as participants, less one.\n\n{} A "
      "trial without a response is wrong. `period` is the place of a trial's block among its "
      "participant's blocks; `place` the trial's place among its participant's trials of the "
      "method; `previous_class` and `previous_response` are those of the previous presentation in "
      "the same block.\n",
      mixed_model_formula(outcomes), what_of_images(outcomes));
}

/// One row for each counted trial, in the order of presentation, with the class and the answer of
/// the presentation before it, which may be a lead-in. These two cells are empty at the start of a
/// block and after a catch trial.
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

}  // namespace

std::string mixed_model_formula(const Outcomes& outcomes) {
  const bool several = outcomes.methods.size() > 1;
  const std::size_t images = images_of(outcomes);
  const std::string inner = several ? "1 + method" : "1";
  const std::string random = fmt::format("({} | participant)", inner);
  if (images >= kMinRandomImages) {
    return fmt::format("correct ~ {}{} + ({} | image)", several ? "method + period + " : "", random,
                       inner);
  }
  const std::string image = images > 1 ? (several ? " * image" : "image + ") : "";
  return "correct ~ " + (several ? "method" + image + " + period + " : image) + random;
}

RModel mixed_model(const Outcomes& outcomes) {
  return {"Mixed model", "mixed_model", mixed_model_table(outcomes),
          fmt::format("methods <- c({})\n\n{}", listed(outcomes.methods, ", ", r_text),
                      mixed_model_functions()),
          notes(outcomes)};
}

}  // namespace touchtrial::analysis::identification
