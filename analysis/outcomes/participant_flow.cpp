#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/collection_records.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>

namespace touchtrial::analysis {
namespace {

/// The session that counts for each participant, by session number: the participant's last session
/// among the needed visits.
std::map<int, const record::SessionRow*> counting_sessions(
    const std::vector<record::SessionRow>& rows, int visits_needed) {
  std::map<std::string, const record::SessionRow*> last_sessions;
  for (const record::SessionRow& row : rows) {
    if (row.visit <= visits_needed) last_sessions[row.participant] = &row;
  }
  std::map<int, const record::SessionRow*> sessions;
  for (const auto& [participant, row] : last_sessions) sessions[row->session] = row;
  return sessions;
}

bool is_unseen_after_interim_look(const record::SessionRow& row, const record::StudyState& state) {
  return (state.unblinded || state.question) && !state.reports(row.session);
}

/// The flow counter that a participant's session belongs to.
int& flow_counter(const record::SessionRow& row, const record::StudyCommitment& commitment,
                  int visits_needed, const record::StudyState& state, ParticipantFlow& flow) {
  if (row.erased) return flow.erased;
  if (!row.replaced_by.empty() && row.replaced_by != row.participant) return flow.replaced;
  if (row.excluded) return flow.excluded;
  if (row.state == record::SessionState::stopped) return flow.stopped;
  if (row.state == record::SessionState::open) return flow.open;
  if (!session_counts(row, commitment)) return flow.other_kind;
  if (row.visit < visits_needed) return flow.open;  // further visits are due
  if (is_unseen_after_interim_look(row, state)) return flow.unseen;
  return flow.analysed;
}

}  // namespace

std::set<int> counted_sessions(std::span<const record::SessionRow> rows,
                               const record::StudyCommitment& commitment) {
  const int visits_needed = prescription_from_json(commitment.configuration).visits_needed;
  std::map<std::pair<std::string, int>, std::set<int>> visits;  // counting visits by participant
  const auto visits_of = [&](const record::SessionRow& row) -> std::set<int>& {
    return visits[{row.participant, row.enrolment}];
  };
  for (const record::SessionRow& row : rows) {
    if (session_counts(row, commitment) && row.visit <= visits_needed)
      visits_of(row).insert(row.visit);
  }
  std::set<int> counted;
  for (const record::SessionRow& row : rows) {
    const bool is_complete = static_cast<int>(visits_of(row).size()) == visits_needed;
    if (is_complete && session_counts(row, commitment)) counted.insert(row.session);
  }
  return counted;
}

ParticipantFlow participant_flow(const std::vector<record::SessionRow>& rows,
                                 const std::vector<SessionRecord>& records,
                                 const record::StudyCommitment& commitment,
                                 const record::StudyState& state) {
  std::map<int, std::string> reasons;
  for (const SessionRecord& record : records) {
    reasons[record.row.session] = exclusion_words(record);
  }
  const int visits_needed = prescription_from_json(commitment.configuration).visits_needed;
  ParticipantFlow flow;
  for (const auto& [session, row] : counting_sessions(rows, visits_needed)) {
    ++flow.enrolled;
    if (row->withdrawn) ++flow.withdrawn;
    int& counter = flow_counter(*row, commitment, visits_needed, state, flow);
    ++counter;
    if (&counter == &flow.excluded) flow.exclusion_reasons.push_back(reasons[session]);
  }
  return flow;
}

}  // namespace touchtrial::analysis
