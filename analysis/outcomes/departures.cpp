#include "analysis/outcomes/departures.hpp"

#include "analysis/report/registered.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Whether a trial ended as it was planned to.
bool has_ended(const TrialOutcome& trial) {
  return trial.row.state == record::TrialState::answered ||
         trial.row.state == record::TrialState::timed_out;
}

/// The sessions with more than this share of scored trials that break the validity rule.
std::set<int> with_invalid_trials(const Outcomes& outcomes, double share) {
  std::map<int, Proportion> invalid;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.scored || !has_ended(trial)) continue;
    Proportion& own = invalid[trial.row.session];
    ++own.n;
    if (!trial.valid()) ++own.correct;
  }
  std::set<int> sessions;
  for (const auto& [session, own] : invalid) {
    if (own.share().value_or(0.0) > share) sessions.insert(session);
  }
  return sessions;
}

using Departures = std::vector<std::string>;

std::string named_with(const SessionOutcome& session, const std::string& why) {
  return session.row.participant + (why.empty() ? "" : " (" + why + ")");
}

/// ": <text>", or nothing for a text that is empty or was left out.
std::string after_colon(const std::string& text) {
  return text.empty() ? "" : ": " + text;
}

/// The number of sessions for which `why` returns a text, and their participants: "P01 (asleep),
/// P02 (left)"; a public report names nobody.
template <typename Why>
std::pair<int, std::string> sessions_with(const Outcomes& outcomes, Why why) {
  std::vector<std::string> names;
  for (const SessionOutcome& session : outcomes.sessions) {
    const std::optional<std::string> reason = why(session);
    if (reason) names.push_back(named_with(session, *reason));
  }
  return {static_cast<int>(names.size()), outcomes.collection.is_public ? "" : listed(names)};
}

/// The reasons of exclusions by session.
std::map<int, std::string> exclusion_reasons(const Outcomes& outcomes) {
  std::map<int, std::string> reasons;
  for (const SessionRecord& record : outcomes.collection.sessions) {
    reasons[record.row.session] = record.exclusion_reason;
  }
  return reasons;
}

void add_looks(const Outcomes& outcomes, Departures& departures) {
  const int planned = outcomes.design.registration.participants;
  for (const Look& look : outcomes.look_record.looks) {
    if (!look.is_unregistered() && look.kind != LookKind::person) continue;
    const std::string station = look.station > 0 ? fmt::format(" at station {}", look.station) : "";
    if (look.kind == LookKind::person) {
      const std::string who =
          outcomes.collection.is_public ? "one participant" : "participant " + look.participant;
      departures.push_back(
          fmt::format("The outcomes of {} alone were looked at{} on {}{}.{}", who, station,
                      utc_words(look.at), after_colon(look.reason),
                      look.is_one_of_several
                          ? " Together with those of others, they showed how the study was going."
                          : ""));
      continue;
    }
    const std::string of = planned > 0 ? fmt::format(" of {} planned", planned) : "";
    departures.push_back(fmt::format(
        "Outcomes were looked at{} on {}, with {}{} {} complete{}. This look was not registered.",
        station, utc_words(look.at), look.participants, of,
        look.participants == 1 && of.empty() ? "participant" : "participants",
        after_colon(look.reason)));
  }
}

void add_numbers(const Outcomes& outcomes, Departures& departures) {
  const int planned = outcomes.design.registration.participants;
  const int completed = course_of(outcomes, 0).completed;
  const auto analysed =
      std::ranges::count_if(outcomes.sessions, [&](const SessionOutcome& session) {
        return session.counted && session.row.visit == outcomes.design.visits_needed();
      });
  if (planned == 0 && outcomes.design.registration.analysis) {
    departures.emplace_back("No number of participants was registered.");
  }
  if (planned == 0 || !outcomes.state.closed || completed == planned) return;
  departures.push_back(
      fmt::format("{} planned; collecting ended with {} complete{}.",
                  counted(planned, "participant") + (planned == 1 ? " was" : " were"), completed,
                  analysed == completed ? ""
                                        : fmt::format(", of whom {} {} left after all exclusions",
                                                      analysed, analysed == 1 ? "is" : "are")));
}

void add_late_decisions(const Outcomes& outcomes, Departures& departures) {
  const auto late = [&](const std::set<int>& sessions, auto reason) {
    return sessions_with(outcomes, [&](const SessionOutcome& one) -> std::optional<std::string> {
      if (!sessions.contains(one.row.session)) return std::nullopt;
      return reason(one);
    });
  };
  const LookRecord& looked = outcomes.look_record;
  std::map<int, std::string> reasons = exclusion_reasons(outcomes);
  std::set<int> without_rule = looked.excluded_afterwards;
  for (const int session : with_missed_catches(outcomes)) without_rule.erase(session);
  const auto [excluded, who] =
      late(without_rule, [&](const SessionOutcome& one) { return reasons[one.row.session]; });
  if (excluded > 0) {
    departures.push_back(counted(excluded, "session") + " excluded after outcomes were seen" +
                         after_colon(who) + ".");
  }
  const auto [replaced, whom] = late(looked.replaced_afterwards, [](const SessionOutcome& one) {
    return "by " + one.row.replaced_by;
  });
  if (replaced > 0) {
    departures.push_back(counted(replaced, "session") + " replaced after outcomes were seen" +
                         after_colon(whom) + ".");
  }
  if (!looked.erased_afterwards.empty()) {
    departures.push_back(counted(static_cast<int>(looked.erased_afterwards.size()), "session") +
                         " erased at the participant's request after outcomes were seen.");
  }
}

void add_rules(const Outcomes& outcomes, Departures& departures) {
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered || !registered->exclusion_rules) return;
  const std::map<int, std::string> met = rules_met(outcomes);
  std::map<int, std::string> reasons = exclusion_reasons(outcomes);
  const auto [without, who] =
      sessions_with(outcomes, [&](const SessionOutcome& one) -> std::optional<std::string> {
        const bool excluded = one.row.excluded && !one.row.erased;
        if (!excluded || met.contains(one.row.session)) return {};
        // Another departure gives the reason of a late exclusion.
        const bool is_late = outcomes.look_record.excluded_afterwards.contains(one.row.session);
        return is_late ? "" : reasons[one.row.session];
      });
  if (without > 0) {
    departures.push_back(counted(without, "session") + " excluded for an unregistered reason" +
                         after_colon(who) + ".");
  }
  const std::set<int> left_out = with_missed_catches(outcomes);
  const auto [kept, whose] =
      sessions_with(outcomes, [&](const SessionOutcome& one) -> std::optional<std::string> {
        const auto rule = met.find(one.row.session);
        if (!one.counted || rule == met.end() || left_out.contains(one.row.session)) return {};
        return rule->second;
      });
  if (kept > 0) {
    departures.push_back(counted(kept, "session") +
                         " not excluded although a registered rule requires it" +
                         after_colon(whose) + ".");
  }
}

void add_deviations(const Outcomes& outcomes, Departures& departures) {
  std::map<std::string, std::set<int>> sessions;
  std::set<int> all;
  for (const SessionRecord& record : outcomes.collection.sessions) {
    if (!outcomes.state.reports(record.row.session)) continue;
    for (const Deviation& one : record.deviations) {
      sessions[one.code].insert(record.row.session);
      all.insert(record.row.session);
    }
  }
  if (all.empty()) return;
  std::vector<std::string> codes;
  for (const auto& [code, of] : sessions) codes.push_back(fmt::format("{} ({})", code, of.size()));
  departures.push_back(fmt::format("Deviations from the protocol were recorded in {}: {}.",
                                   counted(static_cast<int>(all.size()), "session"),
                                   listed(codes)));
}

}  // namespace

std::map<int, std::string> rules_met(const Outcomes& outcomes) {
  std::map<int, std::string> met;
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered || !registered->exclusion_rules) return met;
  const study::ExclusionRules& rules = *registered->exclusion_rules;
  for (const SessionRecord& record : outcomes.collection.sessions) {
    for (const std::string& code : rules.deviations) {
      if (std::ranges::count(record.deviations, code, &Deviation::code) > 0) {
        met.emplace(record.row.session, code);
      }
    }
  }
  if (rules.invalid_trials) {
    for (const int session : with_invalid_trials(outcomes, *rules.invalid_trials)) {
      met.emplace(session, fmt::format("more than {:.4g}% of trials not valid",
                                       100.0 * *rules.invalid_trials));
    }
  }
  for (const int session : with_missed_catches(outcomes)) {
    met.emplace(session, "more than " + counted(*rules.missed_catch, "missed catch trial"));
  }
  return met;
}

std::set<int> with_missed_catches(const Outcomes& outcomes) {
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered || !registered->exclusion_rules) return {};
  const std::optional<int>& most = registered->exclusion_rules->missed_catch;
  if (!most) return {};
  std::map<int, int> missed;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool asked = trial.role == study::Role::catch_trial && trial.right.has_value();
    if (asked && has_ended(trial) && !trial.correct()) ++missed[trial.row.session];
  }
  std::set<int> sessions;
  for (const auto& [session, own] : missed) {
    if (own > *most) sessions.insert(session);
  }
  return sessions;
}

std::vector<std::string> departures_of(const Outcomes& outcomes, bool ended_at_look) {
  Departures departures;
  add_looks(outcomes, departures);
  add_late_decisions(outcomes, departures);
  if (!ended_at_look) add_numbers(outcomes, departures);
  add_rules(outcomes, departures);
  add_deviations(outcomes, departures);
  return departures;
}

std::string unadjusted_words(const std::vector<Look>& looks) {
  const auto unregistered = static_cast<int>(std::ranges::count_if(looks, &Look::is_unregistered));
  if (unregistered == 0) return "";
  return "p is not adjusted for " + counted(unregistered, "unregistered look") + " at outcomes.";
}

}  // namespace touchtrial::analysis
