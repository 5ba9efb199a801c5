#include "analysis/choices/people_report.hpp"
#include "analysis/outcomes/departures.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis::identification {
namespace {

using WarningTexts = std::vector<std::string>;

constexpr int kMaxSmallClass = 5;
constexpr std::size_t kMaxNames = 5;
constexpr double kFalseSwapRate = 0.05;  ///< among reported swaps
constexpr double kCeiling = 0.95;

/// "bark, brick, linen, pebbles, sand and 3 more"
std::string shortened_list(const std::vector<std::string>& names) {
  const std::size_t shown_count = std::min(names.size(), kMaxNames);
  std::string text = fmt::format(
      "{}", fmt::join(names.begin(), names.begin() + static_cast<long>(shown_count), ", "));
  if (shown_count < names.size()) text += fmt::format(" and {} more", names.size() - shown_count);
  return text;
}

void warn_of_small_classes(const MethodReport& method, const std::vector<std::string>& classes,
                           WarningTexts& warnings) {
  std::vector<std::string> small_classes;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const int n = method.accuracy[i].accuracy.n;
    if (n > 0 && n <= kMaxSmallClass) small_classes.push_back(classes[i]);
  }
  if (small_classes.empty()) return;
  warnings.push_back(
      fmt::format("{}: accuracy with {} is from {} trials or fewer, too few for a conclusion.",
                  method.method, shortened_list(small_classes), kMaxSmallClass));
}

void warn_of_unanswered_classes(const MethodReport& method, const std::vector<std::string>& classes,
                                WarningTexts& warnings) {
  if (method.confusion.answered() == 0) return;
  std::vector<std::string> unanswered_classes;
  for (int j = 0; j < method.confusion.classes(); ++j) {
    if (method.confusion.answered(j) == 0) unanswered_classes.push_back(classes[j]);
  }
  if (unanswered_classes.empty()) return;
  warnings.push_back(
      fmt::format("{}: {} was never answered; its accuracy reflects preference as much as "
                  "sensitivity, and there is no choice model.",
                  method.method, shortened_list(unanswered_classes)));
}

void warn_of_swapped_labels(const MethodReport& method, WarningTexts& warnings) {
  std::vector<std::string> suspects;
  for (const ParticipantAccuracy& participant : method.per_participant) {
    if (participant.swap_p_adjusted > kFalseSwapRate) continue;
    suspects.push_back(fmt::format("{} ({}, but {} under the best exchange)",
                                   participant.participant,
                                   share_figure(participant.accuracy.share()),
                                   share_figure(participant.matching.accuracy.share())));
  }
  if (suspects.empty()) return;
  warnings.push_back(
      fmt::format("{}: labels may have been swapped by {}; consistency is then more informative "
                  "than accuracy. If nobody swaps labels, this warning appears with a probability "
                  "of at most 0.05 (Benjamini, Hochberg 1995, over all participants).",
                  method.method, shortened_list(suspects)));
}

void warn_of_chance(const MethodReport& method, WarningTexts& warnings) {
  if (!method.chance || method.chance->exact) return;
  const double floor = 1.0 / (method.chance->deals + 1.0);
  if (method.chance->p > 1.5 * floor) return;
  warnings.push_back(
      fmt::format("{}: the chance test's p = {} is the smallest possible with {} deals; the true p "
                  "may be smaller.",
                  method.method, p_value(method.chance->p), method.chance->deals));
}

void warn_of_ceiling(const MethodReport& method, WarningTexts& warnings) {
  const Proportion all = method.overall;
  if (all.n == 0) return;
  if (all.correct == all.n) {
    warnings.push_back(method.method +
                       ": every answer was right, so d' has only a lower bound, and differences "
                       "cannot be detected.");
  } else if (all.share().value_or(0.0) >= kCeiling) {
    warnings.push_back(fmt::format(
        "{}: {} right is close to the ceiling; d' and differences there depend on few trials.",
        method.method, share_figure(all.share())));
  }
}

void warn_of_choice_model(const MethodReport& method, WarningTexts& warnings) {
  if (!method.choice || method.choice->converged) return;
  warnings.push_back(method.method +
                     ": the choice model did not converge; do not quote its estimates.");
}

void warn_of_validity(const MethodReport& method, WarningTexts& warnings) {
  const auto accuracy_of = [&](TrialSubset subset) {
    return std::ranges::find(method.robustness, subset, &SubsetAccuracy::subset);
  };
  const auto all = accuracy_of(TrialSubset::counted);
  const auto valid = accuracy_of(TrialSubset::valid);
  if (all == method.robustness.end() || valid == method.robustness.end()) return;
  const int invalid = all->pooled.n - valid->pooled.n;
  if (invalid == 0) return;
  if (!valid->mean.mean) {
    warnings.push_back(method.method + ": no trial is valid by the study's rule.");
    return;
  }
  warnings.push_back(fmt::format(
      "{}: without {} not valid by the study's rule, the mean over participants is {} instead of "
      "{}.",
      method.method, counted(invalid, "trial"), share_figure(valid->mean.mean),
      share_figure(all->mean.mean)));
}

void warn_of_order(const Outcomes& outcomes, WarningTexts& warnings) {
  if (outcomes.design.trials.order != study::TrialOrder::uniform) return;
  warnings.emplace_back(
      "Classes were drawn independently and thus presented unequally often; pooled accuracy "
      "weights them accordingly.");
}

constexpr int kFewParticipants = 10;

/// Warns of the smallest possible p with n participants. All 2^n sign patterns are equally likely,
/// and Holm multiplies the smallest p by the number of pairs. Powers of two print exactly.
void warn_of_floor(int n, std::size_t pairs, WarningTexts& warnings) {
  const double floor = std::ldexp(2.0, -n);
  const double adjusted = std::min(1.0, floor * static_cast<double>(pairs));
  if (adjusted <= kUsualLevel) return;
  std::string text =
      fmt::format("With {} the sign-flip p cannot fall below {}", counted(n, "participant"), floor);
  if (pairs > 1)
    text += fmt::format(", and the smallest p adjusted by Holm not below {}", adjusted);
  warnings.push_back(text + ", regardless of the data.");
}

void warn_of_sign_flips(const StudyReport& report, WarningTexts& warnings) {
  int n = 0;
  for (const MethodPair& pair : report.pairs) {
    const int participants = pair.overall.participants;
    if (participants > 0 && (n == 0 || participants < n)) n = participants;
  }
  if (n > 0) warn_of_floor(n, report.pairs.size(), warnings);
  const auto is_at_floor = [](const MethodPair& pair) {
    constexpr double kFloor = 1.5e-5;  // 1.5 times the smallest p of 99,999 patterns
    return pair.overall.participants > kExactSignFlips && pair.overall.p.value_or(1.0) < kFloor;
  };
  if (std::ranges::any_of(report.pairs, is_at_floor)) {
    warnings.emplace_back(
        "A sign-flip p of 1e-05 is the smallest possible with 99,999 random patterns; the true p "
        "may be smaller.");
  }
}

/// With methods in blocks, the error of tests without adjustment includes the effect of the period.
void warn_of_periods(const Outcomes& outcomes, const StudyReport& report, WarningTexts& warnings) {
  if (report.pairs.empty() || outcomes.design.trials.blocks == study::Blocks::mixed) return;
  const std::string effect = "learning or fatigue widens intervals and raises p.";
  const bool is_adjusted = report.primary && report.primary->crossover;
  warnings.push_back("Methods were presented in blocks. " +
                     (is_adjusted
                          ? "The deciding test adjusts for the period; differences and sign "
                            "flips in the comparison of methods do not: " +
                                effect
                          : "No test here adjusts for the period: " + effect));
}

void warn_of_several_methods(const StudyReport& report, WarningTexts& warnings) {
  if (report.methods.size() < 3) return;
  warnings.push_back(
      fmt::format("{} methods make {} pairs: quote the p adjusted by Holm; the p of single classes "
                  "are not adjusted.",
                  report.methods.size(), report.pairs.size()));
  if (report.all_methods) {
    warnings.emplace_back(
        "Cochran's Q: p under chi-square treats a participant's trials as independent; quote the "
        "permuted p.");
  }
}

void warn_of_images(const Outcomes& outcomes, const StudyReport& report, WarningTexts& warnings) {
  const bool one_image_each = std::ranges::all_of(
      outcomes.exemplars, [](const auto& images) { return images.size() == 1; });
  if (report.pairs.empty() || !one_image_each) return;
  warnings.push_back(
      fmt::format("The comparison holds for these {} images; it does not generalise over images.",
                  outcomes.exemplars.size()));
}

void warn_of_few_participants(const StudyReport& report, WarningTexts& warnings) {
  if (report.participants < 2 || report.participants >= kFewParticipants) return;
  warnings.push_back(
      fmt::format("With only {} participants, only large effects are detectable, and the t "
                  "interval relies on normality.",
                  report.participants));
}

template <typename Predicate>
void warn_of_sessions(const Outcomes& outcomes, const std::string& reason, Predicate is_affected,
                      WarningTexts& warnings) {
  const auto n = std::ranges::count_if(
      outcomes.sessions, [&](const SessionOutcome& session) { return is_affected(session.row); });
  if (n > 0) warnings.push_back(fmt::format("Left out: {}, {}.", counted(n, "session"), reason));
}

void warn_of_state(const Outcomes& outcomes, WarningTexts& warnings) {
  const std::string unadjusted = unadjusted_words(outcomes.look_record.looks);
  if (!unadjusted.empty()) warnings.push_back("Looks at outcomes before the end: " + unadjusted);
  if (outcomes.pilot) warnings.emplace_back("A pilot: do not pool with the study's data.");
  if (outcomes.visual) {
    warnings.emplace_back(
        "Textures were seen on a screen, so not blind: do not pool with data from touch.");
  }
  if (!outcomes.state.closed) {
    warnings.emplace_back(
        "An interim look: the study is still open, and this result must not influence when it "
        "ends.");
  }
  if (outcomes.sessions_unseen > 0) {
    warnings.push_back(fmt::format(
        "Left out: {}, not ended before the interim look; run `touchtrial unblind` again "
        "to see more.",
        counted(outcomes.sessions_unseen, "session")));
  }
  warn_of_sessions(
      outcomes, "erased at the participant's request",
      [](const record::SessionRow& row) { return row.erased; }, warnings);
  warn_of_sessions(
      outcomes, "excluded",
      [](const record::SessionRow& row) { return row.excluded && !row.erased; }, warnings);
  warn_of_sessions(
      outcomes, "not completed",
      [](const record::SessionRow& row) {
        return row.state != record::SessionState::completed && !row.excluded && !row.erased;
      },
      warnings);
  warn_of_sessions(
      outcomes, "a pilot or simulation",
      [&](const record::SessionRow& row) {
        return row.state == record::SessionState::completed && !row.excluded && !row.erased &&
               (row.pilot != outcomes.pilot || row.simulated != outcomes.simulated);
      },
      warnings);
}

void warn_of_trials(const Outcomes& outcomes, WarningTexts& warnings) {
  const std::set<int> session_numbers = choices::counted_sessions(outcomes);
  const auto is_unfinished = [&](const TrialOutcome& trial) {
    return trial.scored && !trial.counted && session_numbers.contains(trial.row.session);
  };
  const auto interrupted =
      std::count_if(outcomes.trials.begin(), outcomes.trials.end(), is_unfinished);
  if (interrupted > 0) {
    warnings.push_back(fmt::format("Left out: {}, interrupted and never repeated.",
                                   counted(interrupted, "trial")));
  }
  const auto invalid =
      std::count_if(outcomes.trials.begin(), outcomes.trials.end(),
                    [](const TrialOutcome& trial) { return trial.counted && !trial.valid(); });
  if (invalid > 0) {
    warnings.push_back(fmt::format("Counted, although not valid by the study's rule: {}.",
                                   counted(invalid, "trial")));
  }
}

void warn_of_time_outs(const StudyReport& report, WarningTexts& warnings) {
  for (const MethodReport& method : report.methods) {
    const int answered = method.confusion.answered();
    const int missed = method.overall.n - answered;
    if (missed == 0) continue;
    warnings.push_back(fmt::format(
        "{}: {} without a response, counted as wrong; without these, {} of {} are correct.",
        method.method, counted(missed, "trial"), method.overall.correct, answered));
  }
}

void warn_of_participants(const StudyReport& report, WarningTexts& warnings) {
  if (report.participants == 0) {
    warnings.emplace_back("No session counts yet, so there are no results.");
  } else if (report.participants == 1) {
    warnings.emplace_back(
        "One participant: there are no intervals over participants, and intervals of single "
        "classes are too wide to use.");
  }
  for (const MethodReport& method : report.methods) {
    if (method.mean.participants > 1 && !method.mean.known_interval()) {
      warnings.push_back(method.method +
                         ": all participants have the same accuracy, so there is no t interval; "
                         "this does not mean that the mean is certain.");
    }
  }
}

void warn_of_information(const StudyReport& report, WarningTexts& warnings) {
  const int minimum = trials_for_information_transfer(static_cast<int>(report.classes.size()));
  for (const MethodReport& method : report.methods) {
    const int answered = method.confusion.answered();
    if (answered == 0 || answered >= minimum) continue;
    warnings.push_back(fmt::format(
        "{}: information transfer from {} is biased upward; {} are the usual minimum for {} "
        "classes.",
        method.method, counted(answered, "trial"), minimum, report.classes.size()));
  }
}

/// Participants who prefer a picture are right with it more often than sensitivity permits, and
/// less often with all others.
void warn_of_preferences(const StudyReport& report, WarningTexts& warnings) {
  if (!report.places) return;
  const choices::Preferences& preferences = report.places->preferences;
  const std::string preferred = choices::preference_words(preferences, report.classes);
  if (!preferred.empty()) {
    std::string text = fmt::format("{} ({}, global test over participants).", preferred,
                                   p_phrase(preferences.global_null.p));
    if (!preferences.people_with_preference().empty()) {
      text +=
          " Whether they prefer the picture or its place cannot be determined; their accuracy with "
          "a texture reflects preference as much as sensitivity.";
    }
    warnings.push_back(std::move(text));
  }
  if (report.places->p > kUsualLevel) return;
  warnings.push_back(
      fmt::format("Participants preferred places on the screen ({}, permutation of layouts): "
                  "answers that follow the place are right only by chance, so accuracy is too low.",
                  p_phrase(report.places->p)));
}

}  // namespace

std::vector<std::string> report_warnings(const Outcomes& outcomes, const StudyReport& report) {
  WarningTexts warnings;
  warn_of_state(outcomes, warnings);
  warn_of_trials(outcomes, warnings);
  warn_of_time_outs(report, warnings);
  warn_of_participants(report, warnings);
  for (const MethodReport& method : report.methods) {
    warn_of_validity(method, warnings);
    warn_of_swapped_labels(method, warnings);
    warn_of_small_classes(method, report.classes, warnings);
    warn_of_unanswered_classes(method, report.classes, warnings);
    warn_of_choice_model(method, warnings);
    warn_of_ceiling(method, warnings);
    warn_of_chance(method, warnings);
  }
  warn_of_preferences(report, warnings);
  warn_of_order(outcomes, warnings);
  warn_of_few_participants(report, warnings);
  warn_of_several_methods(report, warnings);
  warn_of_sign_flips(report, warnings);
  warn_of_periods(outcomes, report, warnings);
  warn_of_images(outcomes, report, warnings);
  warn_of_information(report, warnings);
  return warnings;
}

}  // namespace touchtrial::analysis::identification
