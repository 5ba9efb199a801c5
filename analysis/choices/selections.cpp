#include "analysis/choices/selections.hpp"

#include "analysis/outcomes/departures.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace touchtrial::choices {
namespace {

std::set<int> union_of(std::set<int> sessions, const std::set<int>& added) {
  sessions.insert(added.begin(), added.end());
  return sessions;
}

}  // namespace

std::vector<Selection> selections(const Outcomes& outcomes) {
  const std::set<int> counted_set = counted_sessions(outcomes);
  const std::set<int> excluded = excluded_sessions(outcomes);
  std::set<int> put_back = counted_set;
  std::ranges::set_intersection(excluded, outcomes.look_record.excluded_afterwards,
                                std::inserter(put_back, put_back.end()));
  std::set<int> registered = put_back;
  for (const auto& [session, rule] : met_exclusion_rules(outcomes)) registered.erase(session);
  std::set<int> inattentive;
  std::ranges::set_intersection(put_back, sessions_with_missed_catches(outcomes),
                                std::inserter(inattentive, inattentive.end()));
  const bool is_registered = outcomes.design.registration.analysis.has_value();
  std::string words = is_registered ? "as registered" : "every session that counts";
  if (put_back != counted_set) words += "; no exclusion that was made after outcomes were seen";
  if (!inattentive.empty()) {
    words += "; left out by the rule on missed catch trials: " +
             counted(static_cast<int>(inattentive.size()), "session");
  }
  return {{"registered", std::move(words), std::move(registered)},
          {"taken", "all exclusions", counted_set},
          {"put_back", "without exclusions made after outcomes were seen", std::move(put_back)},
          {"all", "with all excluded sessions", union_of(counted_set, excluded)},
          {"valid", "all exclusions, valid trials only", counted_set, true},
          {"answered", "all exclusions, only trials with a response", counted_set, false, true}};
}

std::set<int> people_with_all_visits(const Outcomes& outcomes, const Selection& selection,
                                     const FirstSessions& people) {
  int required = 0;
  for (int visit = 1; visit <= outcomes.design.visits.count; ++visit) {
    required += outcomes.design.enters_analysis(visit) ? 1 : 0;
  }
  std::map<int, std::set<int>> visits;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (!selection.sessions.contains(session.row.session)) continue;
    if (outcomes.design.enters_analysis(session.row.visit)) {
      visits[people.first_of(session.row.session)].insert(session.row.visit);
    }
  }
  std::set<int> complete;
  for (const auto& [person, sessions] : visits) {
    if (static_cast<int>(sessions.size()) == required) complete.insert(person);
  }
  return complete;
}

std::string visit_words(const study::Study& study) {
  if (study.visits.count == 1) return "";
  if (study.enters_analysis(1) && study.enters_analysis(study.visits.count))
    return ", over all visits";
  return study.enters_analysis(1) ? ", at the first visit" : ", at the last visit";
}

}  // namespace touchtrial::choices
