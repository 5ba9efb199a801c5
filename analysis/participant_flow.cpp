#include "analysis/collection_records.hpp"
#include "analysis/session_rules.hpp"

#include <map>

namespace touchtrial::analysis {
namespace {

/// The session by which each participant is counted, in order of these sessions. This is the
/// participant's last session; it replaced all earlier ones.
std::map<int, const store::SessionRow*> sessions_that_stand(
    const std::vector<store::SessionRow>& rows) {
  std::map<std::string, const store::SessionRow*> last;
  for (const store::SessionRow& row : rows) last[row.participant] = &row;
  std::map<int, const store::SessionRow*> standing;
  for (const auto& [participant, row] : last) standing[row->session] = row;
  return standing;
}

bool unseen_after_interim_look(const store::SessionRow& row, const store::StudyState& state) {
  return state.unblinded && !state.reports(row.session);
}

/// The one counter of the flow that a participant's session belongs to.
int& end_of(const store::SessionRow& row, const store::StudyCommitment& commitment,
            const store::StudyState& state, ParticipantFlow& flow) {
  if (row.erased) return flow.erased;
  if (!row.replaced_by.empty() && row.replaced_by != row.participant) return flow.replaced;
  if (row.excluded) return flow.excluded;
  if (row.state == store::SessionState::stopped) return flow.stopped;
  if (row.state == store::SessionState::open) return flow.open;
  if (!session_counts(row, commitment)) return flow.other_kind;
  if (unseen_after_interim_look(row, state)) return flow.unseen;
  return flow.analysed;
}

}  // namespace

ParticipantFlow participant_flow(const std::vector<store::SessionRow>& rows,
                                 const std::vector<SessionRecord>& records,
                                 const store::StudyCommitment& commitment,
                                 const store::StudyState& state) {
  std::map<int, std::string> reasons;
  for (const SessionRecord& record : records) {
    reasons[record.row.session] = record.exclusion_reason;
  }
  ParticipantFlow flow;
  for (const auto& [session, row] : sessions_that_stand(rows)) {
    ++flow.enrolled;
    if (row->withdrawn) ++flow.withdrawn;
    int& end = end_of(*row, commitment, state, flow);
    ++end;
    if (&end == &flow.excluded) flow.exclusion_reasons.push_back(reasons[session]);
  }
  return flow;
}

}  // namespace touchtrial::analysis
