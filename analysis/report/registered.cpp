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

int unregistered_of(const std::vector<Look>& looks) {
  return static_cast<int>(std::ranges::count_if(looks, &Look::is_unregistered));
}

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

/// StudyCourse::all_left_out
std::string words_on_all_left_out(const Outcomes& outcomes) {
  const std::map<int, std::string> rules = rules_met(outcomes);
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
  if (study::is_of_thresholds(result.estimand)) {
    return plain_figure(value, 1) + " dB";
  }
  return share_text(value, result.estimand == study::Estimand::difference);
}

bool is_equality(const PrimaryResult& result) {
  return result.estimand == study::Estimand::threshold_equality;
}

bool is_estimate(const PrimaryResult& result) {
  return result.estimand == study::Estimand::mean_threshold;
}

/// The interval, unless it has no width.
std::optional<Interval> telling_interval(const PrimaryResult& result) {
  const std::optional<Interval>& interval = result.registered().interval;
  return interval && interval->low < interval->high ? interval : std::nullopt;
}

/// Where the interval lies relative to the smallest registered effect.
std::string words_on_smallest_effect(const PrimaryResult& result) {
  const std::optional<Interval> interval = telling_interval(result);
  if (!result.smallest_effect || !interval) return "";
  const double worth = *result.smallest_effect;
  const std::string least = value_text(result, worth);
  if (interval->low >= worth) {
    return " The interval lies above " + least + ", the smallest effect registered as relevant.";
  }
  if (interval->high < worth) {
    return " The interval lies below " + least + ", the smallest effect registered as relevant.";
  }
  return " The interval contains " + least +
         ", the smallest effect registered as relevant, so it is undecided whether the effect is "
         "that large.";
}

/// Where the interval lies relative to the margin of non-inferiority.
std::string words_on_margin(const PrimaryResult& result) {
  const std::optional<Interval> interval = telling_interval(result);
  if (!result.margin || !interval || is_equality(result)) return "";
  const std::string level = fmt::format(" The {:.6g}% interval", 100.0 * result.interval_level);
  const std::string margin = share_text(-*result.margin, true);
  if (interval->high < -*result.margin) {
    return level + " lies below " + margin +
           ", the registered margin: the first method is worse "
           "by more than that.";
  }
  if (interval->low <= -*result.margin) {
    return level + " contains " + margin + ", the registered margin.";
  }
  const std::string above = level + " lies above " + margin + ", the registered margin";
  if (interval->low > 0.0) return above + ", and above 0: the first method is better.";
  if (interval->high < 0.0) {
    return above + ", and below 0: the first method is worse, but by less than the margin.";
  }
  return above + ", and contains 0.";
}

/// Whether an interval lies beyond the margin of an equality.
bool lies_beyond(const std::optional<Interval>& interval, double margin) {
  return interval && (interval->low >= margin || interval->high <= -margin);
}

/// The differences of an equality that are not shown to lie within the margin.
std::string words_on_pairs(const PrimaryResult& result) {
  if (!is_equality(result)) return "";
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
          lies_beyond(pair.interval, *result.margin) ? "lies beyond" : "does not lie within",
          margin);
    }
  }
  if (words.empty())
    words = fmt::format(" Every {} lies within {}, the registered margin.", level, margin);
  return words;
}

/// Of non-inferiority: the methods that are not shown to be above chance.
std::string words_on_guessing(const PrimaryResult& result) {
  std::vector<std::string> arms;
  for (const AboveChance& one : result.above_chance) {
    if (one.p && *one.p <= result.level) continue;
    const std::string mean = one.mean ? share_text(*one.mean, false) : "no mean";
    arms.push_back(fmt::format("{} ({}{})", one.method, mean,
                               one.p ? fmt::format(", p = {}", p_value(*one.p)) : ""));
  }
  if (arms.empty()) return "";
  return fmt::format(
      " Answers with {} are not shown to be above chance, so non-inferiority cannot be concluded.",
      listed(arms, " and "));
}

/// Whether the interval is truncated to the possible range, or does not exist.
std::string words_on_ends(const PrimaryResult& result) {
  const PrimaryChoice& choice = result.registered();
  if (!result.p || !choice.estimate || choice.participants < 2) return "";
  if (!telling_interval(result)) {
    return std::string(result.crossover ? " Within an order of methods participants"
                                        : " Participants") +
           " do not differ, so there is no t interval; this does not mean that the estimate is "
           "certain.";
  }
  if (study::is_of_thresholds(result.estimand)) return "";
  const double least = result.estimand == study::Estimand::difference ? -1.0 : 0.0;
  const bool low = choice.interval->low == least && *choice.estimate > least;
  const bool high = choice.interval->high == 1.0 && *choice.estimate < 1.0;
  if (low && high) return " The interval contains every possible value and is uninformative.";
  return low || high ? " The interval is truncated to the possible range." : "";
}

/// A one-sided test may reject although the two-sided interval contains the null value.
std::string words_on_sides(const PrimaryResult& result) {
  const std::optional<Interval> interval = telling_interval(result);
  if (!interval || !result.bound || result.margin || interval->low > result.null) return "";
  const bool of_accuracy = result.estimand == study::Estimand::mean_accuracy;
  return fmt::format(
      " The two-sided interval reaches {}; the lower limit of the one-sided test, {}, does not.",
      of_accuracy ? "chance" : "0", value_text(result, *result.bound));
}

bool has_one_order(const PrimaryResult& result) {
  const auto& groups = result.crossover;
  return groups && (groups->first_first == 0) != (groups->second_first == 0);
}

bool may_stop_at_look(const PrimaryResult& result, const StudyCourse& course) {
  return course.at_registered_look && result.p && *result.p <= result.level;
}

/// A caution about estimates that end collection early.
std::string words_on_early_end(const PrimaryResult& result, const StudyCourse& course) {
  if (!may_stop_at_look(result, course) || course.completed >= course.planned) return "";
  const std::string look = fmt::format("the registered look at {}",
                                       counted(course.registered_looks.back(), "participant"));
  return (course.closed ? " Collecting ended at " + look : " At " + look + " collecting may end") +
         "; an estimate that ends it early is too large on average.";
}

/// Collecting more participants than planned is harmless if nobody has seen outcomes.
std::string words_on_number(const StudyCourse& course) {
  if (course.planned == 0 || course.completed <= course.planned) return "";
  return fmt::format(
      " {} completed, {} more than planned; the study's outcomes had not been looked at before.",
      counted(course.completed, "participant"), course.completed - course.planned);
}

/// "p > 0.05.", or with the digits that tell them apart.
std::string compared_p(const PrimaryResult& result) {
  const double p = *result.p;
  if (p == result.level) return fmt::format("p = {:.5g}, the level itself.", p);
  const char sign = p < result.level ? '<' : '>';
  const bool look_alike = fmt::format("{:.3f}", p) == fmt::format("{:.3f}", result.level);
  return look_alike ? fmt::format("p = {:.8f} {} {:.5g}.", p, sign, result.level)
                    : fmt::format("p {} {:.3g}.", sign, result.level);
}

/// Why the registered test cannot decide yet; empty if it can.
std::string obstacle(const PrimaryResult& result, const StudyCourse& course) {
  if (has_one_order(result)) {
    return "All participants had the methods in the same order, so that an effect of the method "
           "and one of the period cannot be told apart.";
  }
  if (!course.all_left_out.empty()) {
    return fmt::format("All completed sessions were left out: {}.", course.all_left_out);
  }
  if (!result.nothing_follows.empty()) return result.nothing_follows;
  if (is_estimate(result) && !result.registered().interval) {
    return "There are too few participants for an interval.";
  }
  if (!is_estimate(result) && !result.p) return "There are too few participants for the test.";
  const bool reached = course.planned == 0 || course.completed >= course.planned;
  const bool may_stop = may_stop_at_look(result, course);
  if (!course.closed && !may_stop) return "Collecting is not over.";
  if (!reached && !may_stop) {
    return fmt::format("Collecting ended with {} of {} planned participants.", course.completed,
                       course.planned);
  }
  if (is_estimate(result)) return "";
  if (course.unregistered_looks > 0 && *result.p <= result.level) {
    return fmt::format("After {} the error rate of the test is not known.",
                       counted(course.unregistered_looks, "unregistered look"));
  }
  if (course.planned == 0 && *result.p <= result.level) {
    return "No number of participants was registered, so collecting could have ended because of "
           "the outcomes.";
  }
  const bool is_over = course.planned > 0 && course.completed > course.planned;
  if (is_over && !course.registered_looks.empty() && *result.p <= result.level) {
    return fmt::format(
        "After a look at outcomes {} more than the {} planned were collected, so the error rate of "
        "the test is not known.",
        counted(course.completed - course.planned, "participant"), course.planned);
  }
  return "";
}

bool is_against(const PrimaryResult& result) {
  if (is_equality(result)) return false;
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
      .unregistered_looks = unregistered_of(looks),
      .excluded_afterwards = static_cast<int>(outcomes.look_record.excluded_afterwards.size())};
  if (analysed == 0) course.all_left_out = words_on_all_left_out(outcomes);
  std::set<int> made;
  for (const Look& look : looks) {
    if (look.kind == LookKind::registered) made.insert(look.participants);
  }
  course.registered_looks = {made.begin(), made.end()};
  // Collecting may end at a registered look.
  const auto is_last_look = [&](int participants) {
    return !made.empty() && participants == *made.rbegin();
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

void judge(PrimaryResult& result, const StudyCourse& course) {
  result.ended_at_look =
      course.closed && course.completed < course.planned && may_stop_at_look(result, course);
  const auto decide = [&](Verdict verdict, const std::string& because) {
    result.verdict = verdict;
    result.because = because;
  };
  if (course.pilot) return decide(Verdict::not_registered, "A pilot decides nothing.");
  if (!course.has_registration) {
    return decide(Verdict::not_registered,
                  "The study file registers no estimand and no test, so nothing is decided here.");
  }
  const std::string worth = words_on_smallest_effect(result) + words_on_margin(result) +
                            words_on_ends(result) + (result.note.empty() ? "" : " " + result.note);
  const std::string hindered = obstacle(result, course);
  if (!hindered.empty()) return decide(Verdict::undecided, hindered + worth);
  if (is_estimate(result)) {
    return decide(Verdict::estimated,
                  "An estimate was registered, and no test." + worth + words_on_number(course));
  }
  if (is_equality(result) && *result.p > result.level) {
    const bool beyond = std::ranges::any_of(result.pairs, [&](const PrimaryPair& pair) {
      return lies_beyond(pair.interval, *result.margin);
    });
    return decide(beyond ? Verdict::not_supported : Verdict::undecided,
                  compared_p(result) + words_on_pairs(result) + worth);
  }
  if (*result.p > result.level) {
    const std::optional<Interval> interval = telling_interval(result);
    const std::optional<double> least =
        result.margin ? std::optional(-*result.margin) : result.smallest_effect;
    const bool open = least && (!interval || interval->high >= *least);
    return decide(open ? Verdict::undecided : Verdict::not_supported, compared_p(result) + worth);
  }
  if (is_against(result)) {
    return decide(Verdict::not_supported,
                  "The test rejects, but in the direction opposite to the hypothesis." + worth);
  }
  const std::string guessing = words_on_guessing(result);
  if (!guessing.empty()) return decide(Verdict::undecided, compared_p(result) + guessing + worth);
  decide(Verdict::supported, compared_p(result) + words_on_sides(result) + words_on_pairs(result) +
                                 worth + words_on_early_end(result, course) +
                                 words_on_number(course));
}

}  // namespace touchtrial::analysis
