#include "analysis/outcomes/identities.hpp"

#include "analysis/statistics/proportion.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// New names by id.
using Names = std::map<std::string, std::string>;

/// Names all participants by the rank of their accuracy, those without counted trials last.
Names names_by_rank(const Outcomes& outcomes) {
  std::map<std::string, Proportion> accuracy;
  for (const SessionOutcome& session : outcomes.sessions) accuracy[session.row.participant];
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted) continue;
    accuracy[trial.participant].add(trial.correct());
  }
  accuracy.erase("");
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [id, proportion] : accuracy) {
    order.emplace_back(-proportion.share().value_or(-1.0), id);
  }
  std::ranges::sort(order);
  Names names;
  const std::size_t width = std::to_string(order.size()).size();
  for (const auto& [share, id] : order) {
    names[id] = fmt::format("{:0>{}}", names.size() + 1, width);
  }
  return names;
}

void rename(const Names& names, std::string& id) {
  if (id.empty()) return;
  const auto found = names.find(id);
  id = found == names.end() ? "somebody" : found->second;
}

void rename(const Names& names, record::SessionRow& row) {
  rename(names, row.participant);
  rename(names, row.replaced_by);
}

std::string public_code_of(const std::string& code, const std::set<std::string>& registered) {
  return registered.contains(code) || study::is_deviation_code(code) ? code : "other";
}

void strip(SessionRecord& session, const Names& names, const std::set<std::string>& registered) {
  rename(names, session.row);
  session.device_serial.clear();
  session.opened_utc = session.opened_utc.substr(0, std::string_view("2026-01-31").size());
  session.exclusion_reason.clear();
  session.replacement_reason.clear();
  session.stop_reason.clear();
  session.withdrawal_reason.clear();
  session.handedness_score.reset();
  std::vector<Deviation> deviations;
  for (const Deviation& one : session.deviations) {
    const std::string code = public_code_of(one.code, registered);
    if (std::ranges::count(deviations, code, &Deviation::code) == 0)
      deviations.push_back({code, ""});
  }
  session.deviations = std::move(deviations);
}

void strip(std::vector<record::PersonLook>& looks, const Names& names) {
  for (record::PersonLook& look : looks) {
    rename(names, look.participant);
    look.reason.clear();
  }
}

}  // namespace

Outcomes without_identities(Outcomes outcomes) {
  const Names names = names_by_rank(outcomes);
  std::set<std::string> registered;
  const auto& analysis = outcomes.design.registration.analysis;
  if (analysis && analysis->exclusion_rules) {
    registered = {analysis->exclusion_rules->deviations.begin(),
                  analysis->exclusion_rules->deviations.end()};
  }
  for (SessionOutcome& session : outcomes.sessions) rename(names, session.row);
  for (TrialOutcome& trial : outcomes.trials) rename(names, trial.participant);
  for (SessionRecord& session : outcomes.collection.sessions) strip(session, names, registered);
  for (QuestionAnswer& answer : outcomes.answers) {
    rename(names, answer.participant);
    answer.words.clear();
  }
  outcomes.incidents.clear();
  outcomes.marks.clear();
  for (Look& look : outcomes.look_record.looks) {
    rename(names, look.participant);
    look.reason.clear();
  }
  outcomes.state.unblinding_reason.clear();
  strip(outcomes.state.looks, names);
  strip(outcomes.collection.looks, names);
  outcomes.collection.flow.exclusion_reasons.clear();
  outcomes.collection.is_public = true;
  return outcomes;
}

}  // namespace touchtrial::analysis
