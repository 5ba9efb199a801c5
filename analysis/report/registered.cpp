#include "analysis/report/registered.hpp"

#include "analysis/outcomes/departures.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/statistics/group_sequential.hpp"
#include "core/named.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Whether a session counts towards the planned number, even if it was excluded later.
bool is_completed(const Outcomes& outcomes, const record::SessionRow& row) {
  return row.state == record::SessionState::completed && row.replaced_by.empty() &&
         row.visit == outcomes.design.visits_needed() && row.pilot == outcomes.pilot &&
         row.simulated == outcomes.simulated;
}

int completed_participants(const Outcomes& outcomes) {
  return static_cast<int>(std::ranges::count_if(
      outcomes.sessions,
      [&](const SessionOutcome& session) { return is_completed(outcomes, session.row); }));
}

/// StudyCourse::exclusion_of_all
std::string exclusion_of_all_words(const Outcomes& outcomes) {
  const std::map<int, std::string> rules = met_exclusion_rules(outcomes);
  std::map<std::string, int> sessions;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (!is_completed(outcomes, session.row)) continue;
    const auto rule = rules.find(session.row.session);
    if (rule != rules.end()) {
      ++sessions["by a registered rule (" + rule->second + ")"];
    } else if (session.row.excluded) {
      ++sessions["by the experimenter"];
    } else {
      return "";
    }
  }
  std::vector<std::string> all;
  for (const auto& [cause, n] : sessions) all.push_back(fmt::format("{} {}", n, cause));
  return listed(all, " and ");
}

std::string share_text(double share, bool is_difference) {
  return is_difference ? plain_figure(100.0 * share, 1) + " points" : share_figure(share);
}

/// A value of the estimand, with its unit.
std::string value_text(const PrimaryResult& result, double value) {
  if (result.has_thresholds()) {
    return plain_figure(value, 1) + " dB";
  }
  return share_text(value, result.is_difference());
}

/// The interval, unless its width is 0.
std::optional<Interval> proper_interval(const PrimaryResult& result) {
  const std::optional<Interval>& interval = result.registered().interval;
  return interval && interval->low < interval->high ? interval : std::nullopt;
}

/// Compares the interval with the smallest registered effect.
std::string smallest_effect_words(const PrimaryResult& result) {
  const std::optional<Interval> interval = proper_interval(result);
  if (!result.smallest_effect || !interval) return "";
  const double effect = *result.smallest_effect;
  const bool is_above = interval->low >= effect;
  const bool is_below = interval->high < effect;
  return fmt::format(
      " The interval {} {}, the smallest effect registered as relevant{}.",
      is_above   ? "lies above"
      : is_below ? "lies below"
                 : "contains",
      value_text(result, effect),
      is_above || is_below ? "" : ", so it is undecided whether the effect is that large");
}

/// Compares the interval with the margin of non-inferiority.
std::string margin_words(const PrimaryResult& result) {
  const std::optional<Interval> interval = proper_interval(result);
  if (!result.margin || !interval || result.is_equality()) return "";
  const std::string level = fmt::format(" The {:.6g}% interval", 100.0 * result.interval_level);
  const std::string margin = share_text(-*result.margin, true);
  if (interval->high < -*result.margin) {
    return level + " lies below " + margin +
           ", the registered margin: the first method is worse by more than that.";
  }
  if (interval->low <= -*result.margin) {
    return level + " contains " + margin + ", the registered margin.";
  }
  const std::string above_margin = level + " lies above " + margin + ", the registered margin";
  if (interval->low > 0.0) return above_margin + ", and above 0: the first method is better.";
  if (interval->high < 0.0) {
    return above_margin + ", and below 0: the first method is worse, but by less than the margin.";
  }
  return above_margin + ", and contains 0.";
}

bool is_beyond(const std::optional<Interval>& interval, double margin) {
  return interval && (interval->low >= margin || interval->high <= -margin);
}

/// The differences of an equality that are not shown to be within the margin.
std::string pairs_words(const PrimaryResult& result) {
  if (!result.is_equality()) return "";
  const std::string level = fmt::format("{:.6g}% interval", 100.0 * result.interval_level);
  const std::string margin = "±" + value_text(result, *result.margin);
  std::string words;
  for (const PrimaryPair& pair : result.pairs) {
    if (pair.p && *pair.p <= result.level) continue;
    if (!pair.interval) {
      words += " " + pair.words + " has no interval.";
    } else {
      words += fmt::format(
          " The {} of {} {} {}, the registered margin.", level, pair.words,
          is_beyond(pair.interval, *result.margin) ? "lies beyond" : "does not lie within", margin);
    }
  }
  if (words.empty())
    words = fmt::format(" Every {} lies within {}, the registered margin.", level, margin);
  return words;
}

/// The methods of a non-inferiority question that are not shown to be above chance.
std::string guessing_words(const PrimaryResult& result) {
  std::vector<std::string> methods;
  for (const AboveChance& method : result.above_chance) {
    if (method.p && *method.p <= result.level) continue;
    const std::string mean = method.mean ? share_text(*method.mean, false) : "no mean";
    methods.push_back(fmt::format("{} ({}{})", method.method, mean,
                                  method.p ? fmt::format(", p = {}", p_value(*method.p)) : ""));
  }
  if (methods.empty()) return "";
  return fmt::format(
      " Answers with {} are not shown to be above chance, so non-inferiority cannot be concluded.",
      listed(methods, " and "));
}

/// Notes that the interval is truncated to the possible range, or does not exist.
std::string limits_words(const PrimaryResult& result) {
  const PrimaryChoice& choice = result.registered();
  if (!result.p || !choice.estimate || choice.participants < 2) return "";
  if (!proper_interval(result)) {
    return std::string(result.crossover ? " Participants with the same order of methods"
                                        : " Participants") +
           " do not differ, so there is no t interval; this does not mean that the estimate is "
           "certain.";
  }
  if (result.has_thresholds()) return "";
  const double least = result.is_difference() ? -1.0 : 0.0;
  const bool is_cut_below = choice.interval->low == least && *choice.estimate > least;
  const bool is_cut_above = choice.interval->high == 1.0 && *choice.estimate < 1.0;
  if (is_cut_below && is_cut_above)
    return " The interval contains every possible value and is uninformative.";
  return is_cut_below || is_cut_above ? " The interval is truncated to the possible range." : "";
}

/// Notes that a one-sided test rejects although the two-sided interval contains the null value.
std::string one_sided_words(const PrimaryResult& result) {
  const std::optional<Interval> interval = proper_interval(result);
  if (!interval || !result.bound || result.margin || interval->low > result.null) return "";
  const bool is_accuracy = result.estimand == study::Estimand::mean_accuracy;
  return fmt::format(
      " The two-sided interval reaches {}; the lower limit of the one-sided test, {}, does not.",
      is_accuracy ? "chance" : "0", value_text(result, *result.bound));
}

bool has_one_order(const PrimaryResult& result) {
  const auto& groups = result.crossover;
  return groups && (groups->first_first == 0) != (groups->second_first == 0);
}

bool may_stop_at_look(const PrimaryResult& result, const StudyCourse& course) {
  return course.at_registered_look && result.p && *result.p <= result.level;
}

/// Warns about estimates that end collection early.
std::string early_end_words(const PrimaryResult& result, const StudyCourse& course) {
  if (!may_stop_at_look(result, course) || course.completed >= course.planned) return "";
  const std::string look = fmt::format("the registered look at {}",
                                       counted(course.registered_looks.back(), "participant"));
  return (course.closed ? " Collection ended at " + look : " At " + look + " collection may end") +
         "; an estimate that ends it early is too large on average.";
}

/// More participants than planned are harmless if nobody has seen outcomes.
std::string surplus_words(const StudyCourse& course) {
  if (course.planned == 0 || course.completed <= course.planned) return "";
  return fmt::format(
      " {} completed, {} more than planned; the study's outcomes had not been looked at before.",
      counted(course.completed, "participant"), course.completed - course.planned);
}

/// "p > 0.05.", with more digits if p and level are close.
std::string p_comparison(const PrimaryResult& result) {
  const double p = *result.p;
  if (p == result.level) return fmt::format("p = {:.5g}, the level itself.", p);
  const char sign = p < result.level ? '<' : '>';
  const bool has_same_digits = fmt::format("{:.3f}", p) == fmt::format("{:.3f}", result.level);
  return has_same_digits ? fmt::format("p = {:.8f} {} {:.5g}.", p, sign, result.level)
                         : fmt::format("p {} {:.3g}.", sign, result.level);
}

/// Why the registered test cannot decide; empty if it can.
std::string obstacle_of(const PrimaryResult& result, const StudyCourse& course) {
  if (has_one_order(result)) {
    return "All participants had the methods in the same order, so effects of method and period "
           "cannot be distinguished.";
  }
  if (!course.exclusion_of_all.empty()) {
    return fmt::format("All completed sessions were left out: {}.", course.exclusion_of_all);
  }
  if (!result.obstacle.empty()) return result.obstacle;
  if (result.is_estimate() && !result.registered().interval) {
    return "There are too few participants for an interval.";
  }
  if (!result.is_estimate() && !result.p) return "There are too few participants for the test.";
  const bool has_planned_number = course.planned == 0 || course.completed >= course.planned;
  const bool may_stop = may_stop_at_look(result, course);
  if (!course.closed && !may_stop) return "Collection is not over.";
  if (!has_planned_number && !may_stop) {
    return fmt::format("Collection ended with {} of {} planned participants.", course.completed,
                       course.planned);
  }
  if (result.is_estimate()) return "";
  if (course.unregistered_looks > 0 && *result.p <= result.level) {
    return fmt::format("After {} the error rate of the test is unknown.",
                       counted(course.unregistered_looks, "unregistered look"));
  }
  if (course.planned == 0 && *result.p <= result.level) {
    return "No number of participants was registered, so collection could have ended because of "
           "the outcomes.";
  }
  const bool exceeds_plan = course.planned > 0 && course.completed > course.planned;
  if (exceeds_plan && !course.registered_looks.empty() && *result.p <= result.level) {
    return fmt::format(
        "After a look at outcomes {} more than the {} planned were collected, so the error rate of "
        "the test is unknown.",
        counted(course.completed - course.planned, "participant"), course.planned);
  }
  return "";
}

bool is_opposite_to_hypothesis(const PrimaryResult& result) {
  if (result.is_equality()) return false;
  return result.registered().estimate.value_or(result.null) <= result.null;
}

}  // namespace

std::string name_of(Verdict verdict) {
  using enum Verdict;
  static constexpr auto kNames =
      std::to_array<Named<Verdict>>({{"supported", supported},
                                     {"not supported", not_supported},
                                     {"undecided", undecided},
                                     {"estimated", estimated},
                                     {"not registered", not_registered}});
  return std::string(name_in(kNames, verdict));
}

StudyCourse course_of(const Outcomes& outcomes, int analysed) {
  const std::vector<Look>& looks = outcomes.look_record.looks;
  StudyCourse course{
      .planned = outcomes.design.registration.participants,
      .completed = completed_participants(outcomes),
      .analysed = analysed,
      .closed = outcomes.state.closed,
      .pilot = outcomes.pilot,
      .has_registration = outcomes.design.registration.analysis.has_value(),
      .unregistered_looks = static_cast<int>(std::ranges::count_if(looks, &Look::is_unregistered)),
      .excluded_afterwards = static_cast<int>(outcomes.look_record.excluded_afterwards.size())};
  if (analysed == 0) course.exclusion_of_all = exclusion_of_all_words(outcomes);
  std::set<int> registered;
  for (const Look& look : looks) {
    if (look.kind == LookKind::registered) registered.insert(look.participants);
  }
  course.registered_looks = {registered.begin(), registered.end()};
  const auto is_last_look = [&](int participants) {
    return !registered.empty() && participants == *registered.rbegin();
  };
  course.at_registered_look = is_last_look(course.completed) || is_last_look(analysed);
  return course;
}

double level_of(const PrimaryResult& result, const StudyCourse& course, study::Spending spending) {
  if (course.registered_looks.empty() || course.planned <= 0) return result.alpha;
  std::vector<double> shares;
  for (const int look : course.registered_looks) {
    shares.push_back(std::min(1.0, static_cast<double>(look) / course.planned));
  }
  if (!course.at_registered_look && shares.back() < 1.0) shares.push_back(1.0);
  const AlphaSpending kind =
      spending == study::Spending::pocock ? AlphaSpending::pocock : AlphaSpending::obrien_fleming;
  constexpr double kMinLevel = 1e-9;
  return std::max(kMinLevel, nominal_levels(result.alpha, result.sides, kind, shares).back());
}

void set_verdict(PrimaryResult& result, const StudyCourse& course) {
  result.ended_at_look =
      course.closed && course.completed < course.planned && may_stop_at_look(result, course);
  const auto decide = [&](Verdict verdict, const std::string& reason) {
    result.verdict = verdict;
    result.reason = reason;
  };
  if (course.pilot) return decide(Verdict::not_registered, "A pilot decides nothing.");
  if (!course.has_registration) {
    return decide(Verdict::not_registered,
                  "The study file registers no estimand and no test, so there is no decision.");
  }
  const std::string notes = smallest_effect_words(result) + margin_words(result) +
                            limits_words(result) + (result.note.empty() ? "" : " " + result.note);
  const std::string obstacle = obstacle_of(result, course);
  if (!obstacle.empty()) return decide(Verdict::undecided, obstacle + notes);
  if (result.is_estimate()) {
    return decide(Verdict::estimated,
                  "Only an estimate was registered, no test." + notes + surplus_words(course));
  }
  if (result.is_equality() && *result.p > result.level) {
    const bool is_any_beyond = std::ranges::any_of(result.pairs, [&](const PrimaryPair& pair) {
      return is_beyond(pair.interval, *result.margin);
    });
    return decide(is_any_beyond ? Verdict::not_supported : Verdict::undecided,
                  p_comparison(result) + pairs_words(result) + notes);
  }
  if (*result.p > result.level) {
    const std::optional<Interval> interval = proper_interval(result);
    const std::optional<double> least =
        result.margin ? std::optional(-*result.margin) : result.smallest_effect;
    const bool is_open = least && (!interval || interval->high >= *least);
    return decide(is_open ? Verdict::undecided : Verdict::not_supported,
                  p_comparison(result) + notes);
  }
  if (is_opposite_to_hypothesis(result)) {
    return decide(Verdict::not_supported,
                  "The test rejects, but in the direction opposite to the hypothesis." + notes);
  }
  const std::string guessing = guessing_words(result);
  if (!guessing.empty()) return decide(Verdict::undecided, p_comparison(result) + guessing + notes);
  decide(Verdict::supported, p_comparison(result) + one_sided_words(result) + pairs_words(result) +
                                 notes + early_end_words(result, course) + surplus_words(course));
}

}  // namespace touchtrial::analysis
