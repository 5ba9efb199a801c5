#include "protocols/identification/analysis/mixed_model.hpp"

#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

DataCell class_or_nothing(const Outcomes& outcomes, const std::optional<int>& index) {
  if (!index) return std::monostate{};
  return outcomes.classes[*index];
}

DataCell whole_or_nothing(const std::optional<int>& number) {
  if (!number) return std::monostate{};
  return std::int64_t{*number};
}

/// The name of an image, preceded by its class, because two classes may have images of the same
/// name.
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

/// The presentation before a trial, if it is in the same block and is not a catch trial.
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
          time_between(row.presented_at, row.answered_at),
          time_between(row.contact_at, row.answered_at),
          flag(trial.valid()),
          1.0 / static_cast<double>(outcomes.classes.size()),
          flag(outcomes.simulated)};
}

std::string notes(const Outcomes& outcomes) {
  return fmt::format(
      "# Mixed model of {}\n\n{}`mixed_model.csv` has one row a trial that counts; `Rscript "
      "mixed_model.R` fits\n\n    {}\n\nas a binomial model with a logit link (lme4). "
      "Participants and images are random effects, so that the results hold for others like them; "
      "with few images they hardly do. A trial without a response is wrong. `place` is the "
      "trial's place among its participant's trials of the method; `previous_class` and "
      "`previous_response` are those of the previous presentation in the same block.\n",
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

namespace {

constexpr std::string_view kReading = R"R(
arguments <- commandArgs(trailingOnly = FALSE)
script <- sub("^--file=", "", grep("^--file=", arguments, value = TRUE))
folder <- if (length(script) == 1) dirname(normalizePath(script)) else getwd()
trials <- read.csv(file.path(folder, "mixed_model.csv"), na.strings = "", encoding = "UTF-8",
                   colClasses = c(participant = "character", method = "character",
                                  class = "character", image = "character",
                                  response = "character", previous_class = "character",
                                  previous_response = "character"))

stop_with <- function(...) {
  message(...)
  quit(save = "no", status = 1)
}

simulated <- any(trials$simulated == 1)
stamp <- function() {
  if (simulated) cat("SIMULATED: every participant is a program.\n")
}
stamp()
if (nrow(trials) == 0) stop_with("No trial counts yet: there is nothing to fit.")
if (length(unique(trials$correct)) < 2) {
  stop_with("Every trial is ", if (trials$correct[1] == 1) "correct" else "wrong",
            ": a logit model has no finite estimate; report the interval of the report instead.")
}
if (!requireNamespace("lme4", quietly = TRUE)) {
  stop_with("The package lme4 is missing. Install it with install.packages(\"lme4\"), or on ",
            "Debian with: apt-get install r-cran-lme4")
}

trials$participant <- factor(trials$participant)
trials$image <- factor(trials$image)
trials$method <- factor(trials$method, levels = methods)
several_methods <- nlevels(droplevels(trials$method)) > 1

# A random term needs two levels or more.
if (nlevels(trials$participant) < 2) model <- update(model, . ~ . - (1 | participant))
if (nlevels(trials$image) < 2) model <- update(model, . ~ . - (1 | image))
if (!several_methods) model <- update(model, . ~ . - method)
is_mixed <- length(lme4::findbars(model)) > 0

fit_of <- function(formula) {
  tryCatch({
    if (length(lme4::findbars(formula)) > 0) {
      lme4::glmer(formula, data = trials, family = binomial,
                  control = lme4::glmerControl(optimizer = "bobyqa"))
    } else {
      glm(formula, data = trials, family = binomial)
    }
  }, error = function(failure) {
    stop_with("The model cannot be fitted: ", conditionMessage(failure))
  })
}

cat("Model:", deparse(model, width.cutoff = 500), "\n")
fit <- fit_of(model)
print(summary(fit))
if (is_mixed && lme4::isSingular(fit)) {
  cat("The fit is singular: a variance is estimated as zero, because the data show no spread\n",
      "between those participants or images beyond chance. The fixed effects still hold; say so\n",
      "when you report them.\n", sep = "")
}

estimates <- if (is_mixed) lme4::fixef(fit) else coef(fit)
errors <- sqrt(diag(as.matrix(vcov(fit))))
low <- estimates - qnorm(0.975) * errors
high <- estimates + qnorm(0.975) * errors
as_p <- function(p) if (p < 1e-4) "p < 0.0001" else sprintf("p = %.3g", p)
p_of <- function(z) as_p(2 * pnorm(-abs(z)))
)R";

constexpr std::string_view kOneMethod = R"R(
chance <- trials$chance[1]
cat(sprintf("\nTypical participant and image: %.1f %% correct, 95 %% Wald interval %.1f to %.1f %%\n",
            100 * plogis(estimates[1]), 100 * plogis(low[1]), 100 * plogis(high[1])))
cat(sprintf("Odds ratio against chance (%.3g): %.2f, interval %.2f to %.2f, %s\n", chance,
            exp(estimates[1] - qlogis(chance)), exp(low[1] - qlogis(chance)),
            exp(high[1] - qlogis(chance)), p_of((estimates[1] - qlogis(chance)) / errors[1])))
stamp()
)R";

constexpr std::string_view kSeveralMethods = R"R(
if (several_methods) {
  cat(sprintf("\nOdds ratios against the method %s, with 95 %% Wald intervals:\n",
              levels(droplevels(trials$method))[1]))
  for (i in seq_along(estimates)[-1]) {
    cat(sprintf("  %s: %.2f, %.2f to %.2f, %s\n", sub("^method", "", names(estimates)[i]),
                exp(estimates[i]), exp(low[i]), exp(high[i]), p_of(estimates[i] / errors[i])))
  }
  without <- fit_of(update(model, . ~ . - method))
  ratio <- 2 * (as.numeric(logLik(fit)) - as.numeric(logLik(without)))
  degrees <- length(estimates) - 1
  cat(sprintf("Likelihood ratio of all methods together: chi-squared(%d) = %.2f, %s\n",
              degrees, ratio, as_p(pchisq(ratio, degrees, lower.tail = FALSE))))
} else {
  cat("\nTrials of one method alone count: there is nothing to compare.\n")
}
stamp()
)R";

/// The text as a quoted R string.
std::string r_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string method_names(const Outcomes& outcomes) {
  return listed(outcomes.methods, ", ", r_text);
}

}  // namespace

std::string mixed_model_script(const Outcomes& outcomes) {
  const std::string head = fmt::format(
      "# Mixed model of the study {}{}. Run: Rscript mixed_model.R\n"
      "# Needs lme4; reads mixed_model.csv beside this file. What it means: mixed_model.md.\n"
      "model <- {}\nmethods <- c({})\n",
      outcomes.study, outcomes.simulated ? " (SIMULATED)" : "", mixed_model_formula(outcomes),
      method_names(outcomes));
  return head + std::string(kReading) +
         std::string(outcomes.methods.size() > 1 ? kSeveralMethods : kOneMethod);
}

}  // namespace touchtrial::analysis::identification
