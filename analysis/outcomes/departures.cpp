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

/// Whether a trial ended as planned.
bool has_ended(const TrialOutcome& trial) {
  return trial.row.state == record::TrialState::answered ||
         trial.row.state == record::TrialState::timed_out;
}

/// Sessions in which more than this share of scored trials breaks the validity rule.
std::set<int> sessions_with_invalid_trials(const Outcomes& outcomes, double share) {
  std::map<int, Proportion> invalid;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.scored || !has_ended(trial)) continue;
    invalid[trial.row.session].add(!trial.valid());
  }
  std::set<int> sessions;
  for (const auto& [session, proportion] : invalid) {
    if (proportion.share().value_or(0.0) > share) sessions.insert(session);
  }
  return sessions;
}

using Departures = std::vector<std::string>;

std::string participant_with_reason(const SessionOutcome& session, const std::string& reason) {
  return session.row.participant + (reason.empty() ? "" : " (" + reason + ")");
}

/// ": <text>"; empty for an empty text.
std::string after_colon(const std::string& text) {
  return text.empty() ? "" : ": " + text;
}

/// The number of sessions for which `reason_of` returns a text, and their participants, for example
/// "P01 (asleep), P02 (left)"; a public report lists no participants.
template <typename ReasonOf>
std::pair<int, std::string> sessions_with(const Outcomes& outcomes, ReasonOf reason_of) {
  std::vector<std::string> names;
  for (const SessionOutcome& session : outcomes.sessions) {
    const std::optional<std::string> reason = reason_of(session);
    if (reason) names.push_back(participant_with_reason(session, *reason));
  }
  return {static_cast<int>(names.size()), outcomes.collection.is_public ? "" : listed(names)};
}

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
      const std::string subject =
          outcomes.collection.is_public ? "one participant" : "participant " + look.participant;
      departures.push_back(
          fmt::format("The outcomes of {} were viewed separately{} on {}{}.{}", subject, station,
                      utc_words(look.at), after_colon(look.reason),
                      look.is_one_of_several ? " Together with other participants' outcomes, they "
                                               "showed the study's results so far."
                                             : ""));
      continue;
    }
    const std::string total = planned > 0 ? fmt::format(" of {} planned", planned) : "";
    departures.push_back(fmt::format(
        "Outcomes were viewed{} on {}, with {}{} {} complete{}. This look was not registered.",
        station, utc_words(look.at), look.participants, total,
        look.participants == 1 && total.empty() ? "participant" : "participants",
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
  departures.push_back(fmt::format(
      "{} planned; collection ended with {} complete{}.",
      counted(planned, "participant") + (planned == 1 ? " was" : " were"), completed,
      analysed == completed ? ""
                            : fmt::format(", of whom {} {} after all exclusions", analysed,
                                          analysed == 1 ? "remains" : "remain")));
}

void add_late_decisions(const Outcomes& outcomes, Departures& departures) {
  const auto late_sessions = [&](const std::set<int>& sessions, auto reason) {
    return sessions_with(outcomes, [&](const SessionOutcome& one) -> std::optional<std::string> {
      if (!sessions.contains(one.row.session)) return std::nullopt;
      return reason(one);
    });
  };
  const LookRecord& looks = outcomes.look_record;
  std::map<int, std::string> reasons = exclusion_reasons(outcomes);
  std::set<int> excluded_without_rule = looks.excluded_afterwards;
  for (const int session : sessions_with_missed_catches(outcomes))
    excluded_without_rule.erase(session);
  const auto [excluded, excluded_participants] = late_sessions(
      excluded_without_rule, [&](const SessionOutcome& one) { return reasons[one.row.session]; });
  if (excluded > 0) {
    departures.push_back(counted(excluded, "session") + " excluded after outcomes were seen" +
                         after_colon(excluded_participants) + ".");
  }
  const auto [replaced, replaced_participants] =
      late_sessions(looks.replaced_afterwards,
                    [](const SessionOutcome& one) { return "by " + one.row.replaced_by; });
  if (replaced > 0) {
    departures.push_back(counted(replaced, "session") + " replaced after outcomes were seen" +
                         after_colon(replaced_participants) + ".");
  }
  if (!looks.erased_afterwards.empty()) {
    departures.push_back(counted(static_cast<int>(looks.erased_afterwards.size()), "session") +
                         " erased at the participant's request after outcomes were seen.");
  }
}

void add_rules(const Outcomes& outcomes, Departures& departures) {
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered || !registered->exclusion_rules) return;
  const std::map<int, std::string> met_rules = met_exclusion_rules(outcomes);
  std::map<int, std::string> reasons = exclusion_reasons(outcomes);
  const auto [unregistered, unregistered_participants] =
      sessions_with(outcomes, [&](const SessionOutcome& one) -> std::optional<std::string> {
        const bool excluded = one.row.excluded && !one.row.erased;
        if (!excluded || met_rules.contains(one.row.session)) return {};
        // Another departure gives the reason of a late exclusion.
        const bool is_late = outcomes.look_record.excluded_afterwards.contains(one.row.session);
        return is_late ? "" : reasons[one.row.session];
      });
  if (unregistered > 0) {
    departures.push_back(counted(unregistered, "session") + " excluded for an unregistered reason" +
                         after_colon(unregistered_participants) + ".");
  }
  const std::set<int> omitted = sessions_with_missed_catches(outcomes);
  const auto [retained, retained_participants] =
      sessions_with(outcomes, [&](const SessionOutcome& one) -> std::optional<std::string> {
        const auto rule = met_rules.find(one.row.session);
        if (!one.counted || rule == met_rules.end() || omitted.contains(one.row.session)) return {};
        return rule->second;
      });
  if (retained > 0) {
    departures.push_back(counted(retained, "session") +
                         " not excluded although a registered rule requires it" +
                         after_colon(retained_participants) + ".");
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
  for (const auto& [code, numbers] : sessions) {
    codes.push_back(fmt::format("{} ({})", code, numbers.size()));
  }
  departures.push_back(fmt::format("Deviations from the protocol were recorded in {}: {}.",
                                   counted(static_cast<int>(all.size()), "session"),
                                   listed(codes)));
}

}  // namespace

std::map<int, std::string> met_exclusion_rules(const Outcomes& outcomes) {
  std::map<int, std::string> met_rules;
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered || !registered->exclusion_rules) return met_rules;
  const study::ExclusionRules& rules = *registered->exclusion_rules;
  for (const SessionRecord& record : outcomes.collection.sessions) {
    for (const std::string& code : rules.deviations) {
      if (std::ranges::count(record.deviations, code, &Deviation::code) > 0) {
        met_rules.emplace(record.row.session, code);
      }
    }
  }
  if (rules.invalid_trials) {
    for (const int session : sessions_with_invalid_trials(outcomes, *rules.invalid_trials)) {
      met_rules.emplace(session, fmt::format("more than {:.4g}% of trials not valid",
                                             100.0 * *rules.invalid_trials));
    }
  }
  for (const int session : sessions_with_missed_catches(outcomes)) {
    met_rules.emplace(session, "more than " + counted(*rules.missed_catch, "missed catch trial"));
  }
  return met_rules;
}

std::set<int> sessions_with_missed_catches(const Outcomes& outcomes) {
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered || !registered->exclusion_rules) return {};
  const std::optional<int>& max_missed = registered->exclusion_rules->missed_catch;
  if (!max_missed) return {};
  std::map<int, int> missed_counts;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool has_answer_key = trial.role == study::Role::catch_trial && trial.right.has_value();
    if (has_answer_key && has_ended(trial) && !trial.correct()) ++missed_counts[trial.row.session];
  }
  std::set<int> sessions;
  for (const auto& [session, count] : missed_counts) {
    if (count > *max_missed) sessions.insert(session);
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
