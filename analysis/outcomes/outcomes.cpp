#include "analysis/outcomes/outcomes.hpp"

#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "record/damage.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string words_of_row(const record::TrialRow& row) {
  return fmt::format("session {}, trial {}", row.session, row.trial);
}

/// The file names of a class's images, with folders only if two images have the same file name.
std::vector<std::string> exemplar_names(const study::StudyClass& stimulus_class) {
  std::set<std::string> distinct;
  for (const auto& image : stimulus_class.images) distinct.insert(image.filename().string());
  const bool unambiguous = distinct.size() == stimulus_class.images.size();
  std::vector<std::string> names;
  for (const auto& image : stimulus_class.images) {
    names.push_back(unambiguous ? image.filename().string() : image.generic_string());
  }
  return names;
}

Outcomes labelled_outcomes(const record::StudyStore& store, const study::Study& study) {
  Outcomes outcomes;
  const record::StudyCommitment& commitment = store.commitment();
  outcomes.study = commitment.study;
  outcomes.design = study;
  outcomes.simulated = commitment.simulated;
  outcomes.pilot = commitment.pilot;
  outcomes.state = store.state();
  for (const study::StudyClass& one : study.classes) {
    outcomes.classes.push_back(one.label);
    outcomes.exemplars.push_back(exemplar_names(one));
  }
  for (const study::Choice& one : study::choices_of(study)) {
    outcomes.choices.push_back(one.label);
  }
  for (int i = 0; i < study.presented_methods(); ++i) {
    outcomes.methods.emplace_back(study.methods[i].label);
  }
  return outcomes;
}

const study::Trial& trial_of(const record::TrialRow& row, const study::Schedule& schedule) {
  const auto found = std::ranges::find_if(
      schedule.trials, [&](const study::Trial& one) { return one.place.trial == row.trial; });
  if (found == schedule.trials.end()) {
    throw VerificationError(words_of_row(row) +
                            ": is not in the session's schedule; run `touchtrial verify`");
  }
  return *found;
}

void require_answer_fits(const record::TrialRow& row, const study::TrialQuestion& question) {
  if (!row.answer) return;
  const std::string mismatch = study::mismatch_of(*row.answer, question);
  if (mismatch.empty()) return;
  throw VerificationError(words_of_row(row) + ": " + mismatch + "; run `touchtrial verify`");
}

TrialOutcome outcome_of(const record::TrialRow& row, const SessionOutcome& session,
                        const study::Schedule& schedule, const study::Study& study) {
  const study::Trial& scheduled = trial_of(row, schedule);
  const bool is_ended =
      row.state == record::TrialState::answered || row.state == record::TrialState::timed_out;
  TrialOutcome trial;
  trial.participant = session.row.participant;
  trial.visit = session.row.visit;
  trial.group = session.group;
  trial.row = row;
  trial.role = scheduled.role;
  trial.right = scheduled.right;
  trial.picture = scheduled.picture;
  trial.planes = scheduled.planes;
  if (scheduled.planes.size() == 1) {
    trial.stimulus = scheduled.field();
    trial.gain_db = scheduled.planes.front().gain_db;
  }
  trial.has_stimulus = scheduled.planes.size() == 1 && !scheduled.planes.front().blank;
  if (row.track && row.level && row.target) {
    trial.chosen = {*row.track, *row.level, *row.target};
    trial.stimulus = study.task->threshold_field(study, {*row.track, *row.level});
    trial.right = *row.target;
    if (row.kind == name_of(study::Role::catch_trial)) trial.role = study::Role::catch_trial;
  }
  trial.scored = trial.role == study::Role::scored;
  trial.counted = session.counted && trial.scored && is_ended;
  require_answer_fits(row, study.task->ask(study, scheduled.place));
  if (row.answer) trial.response = schedule.choice_of(*row.answer);
  return trial;
}

/// The demographics of each counted participant, combined over all sessions.
std::vector<Demographics> demographics_by_participant(
    const Outcomes& outcomes, const std::map<int, Demographics>& by_session) {
  std::map<std::string, Demographics> people;
  for (const SessionOutcome& one : outcomes.sessions) {
    if (one.counted) people[one.row.participant];
  }
  for (const SessionOutcome& one : outcomes.sessions) {
    const auto person = people.find(one.row.participant);
    const auto session = by_session.find(one.row.session);
    if (person != people.end() && session != by_session.end()) {
      person->second.update(session->second);
    }
  }
  std::vector<Demographics> all;
  for (auto& [id, person] : people) all.push_back(std::move(person));
  return all;
}

void add_assignment(const Outcomes& outcomes, Collection& collection) {
  std::map<int, const SessionOutcome*> shown_sessions;
  for (const SessionOutcome& one : outcomes.sessions) shown_sessions[one.row.session] = &one;
  const std::vector<std::string>& groups = outcomes.design.groups.labels;
  for (SessionRecord& record : collection.sessions) {
    const auto found = shown_sessions.find(record.row.session);
    if (found == shown_sessions.end()) continue;
    record.order_block = found->second->order_block;
    const std::optional<int> group = found->second->group;
    if (group && !record.row.erased) record.group = groups[static_cast<std::size_t>(*group)];
  }
}

/// Adds each shown session's answer spread, and removes opened outcome data of hidden sessions.
void add_spreads(const std::vector<record::TrialRow>& trials,
                 const std::map<int, SessionOutcome>& shown_sessions, Collection& collection) {
  std::map<int, std::vector<record::TrialRow>> by_session;
  for (const record::TrialRow& trial : trials) by_session[trial.session].push_back(trial);
  for (SessionRecord& record : collection.sessions) {
    if (!shown_sessions.contains(record.row.session)) {
      record.largest_force_n.reset();
    } else {
      record.spread = spread_of(std::move(by_session[record.row.session]));
    }
  }
}

/// Adds answers, incidents and demographics of the shown sessions.
void add_questionnaires(const OpenedSessions& opened_sessions, const study::Study& study,
                        Outcomes& outcomes) {
  SessionKeys keys;
  for (const SessionOutcome& one : outcomes.sessions) {
    keys.emplace(one.row.session, opened_sessions.keys().at(one.row.session));
  }
  const auto is_unseen = [&](const auto& one) { return !keys.contains(one.session); };
  outcomes.questionnaires = closing_questionnaires(study);
  outcomes.answers = open_answers(opened_sessions.events(), keys);
  std::erase_if(outcomes.answers, is_unseen);
  outcomes.incidents = load_incidents(opened_sessions.events(), keys);
  std::erase_if(outcomes.incidents, is_unseen);
  outcomes.marks = load_marks(opened_sessions.events(), keys);
  const std::map<int, Demographics> by_session = demographics_of(outcomes.answers, study);
  outcomes.demographics = banded_characteristics(demographics_by_participant(outcomes, by_session));
  for (SessionRecord& record : outcomes.collection.sessions) {
    const auto session = by_session.find(record.row.session);
    if (session != by_session.end()) record.handedness_score = session->second.handedness_score;
  }
}

[[noreturn]] void refuse_blinded(const std::string& participant) {
  if (participant.empty()) {
    throw StoreError(
        "the study has not been unblinded, so its outcomes are not shown; run `touchtrial close` "
        "and `touchtrial unblind`");
  }
  throw StoreError(one_line(
      fmt::format("no look at the outcomes of participant {} is recorded, so they are not shown; "
                  "run `touchtrial unblind DB --participant {} --reason TEXT`",
                  participant, participant)));
}

/// Opens the sessions for which `is_shown` is true.
/// \param participant  only this participant's sessions; empty: all sessions
template <typename IsShown>
Outcomes open_outcomes(const record::StudyStore& store, const study::StudyKey& key,
                       IsShown is_shown, const std::string& participant) {
  const std::vector<record::SessionRow> rows = store.sessions();
  Outcomes outcomes = labelled_outcomes(store, key.study);
  OpenedSessions opened_sessions(store, key);
  const SessionKeys& keys = opened_sessions.keys();
  const StudyEvents& events = opened_sessions.events();
  require_sealed_ends(events, keys);
  outcomes.collection = load_collection(events, keys);
  outcomes.visual = outcomes.collection.visual;
  outcomes.look_record = look_record(store, key);
  std::vector<record::SessionRow> shown_rows;
  std::ranges::copy_if(rows, std::back_inserter(shown_rows), is_shown);
  if (participant.empty()) {
    outcomes.sessions_unseen = static_cast<int>(rows.size() - shown_rows.size());
  }
  const std::set<int> counted = counted_sessions(shown_rows, store.commitment());
  std::map<int, SessionOutcome> sessions;
  for (const record::SessionRow& row : shown_rows) {
    const study::Draws draws = draws_of(row);
    sessions[row.session] = {row, counted.contains(row.session),
                             study::order_block_of(key.study, key.stations, row.enrolment, draws),
                             key.group_of(row.enrolment, draws)};
    outcomes.sessions.push_back(sessions[row.session]);
  }
  add_assignment(outcomes, outcomes.collection);
  add_questionnaires(opened_sessions, key.study, outcomes);
  const auto schedules = open_schedules(events, key, keys);
  Measures measures;
  const std::vector<record::TrialRow> trials = opened_sessions.release_trials(measures);
  add_spreads(trials, sessions, outcomes.collection);
  outcomes.trials.reserve(trials.size());
  for (const record::TrialRow& row : trials) {
    const auto schedule = schedules.find(row.session);
    if (schedule == schedules.end()) continue;  // no session-opened event
    const auto session = sessions.find(row.session);
    if (session == sessions.end()) continue;
    TrialOutcome trial = outcome_of(row, session->second, schedule->second, key.study);
    const auto trial_measures = measures.find({row.session, row.trial});
    if (trial_measures != measures.end()) trial.measures = trial_measures->second;
    outcomes.trials.push_back(std::move(trial));
  }
  return outcomes;
}

}  // namespace

std::string shown(const record::ChainFault& fault) {
  return fmt::format("{}, event {}: {}", record::chain_name(fault.session), fault.sequence,
                     one_line(fault.what));
}

Outcomes load_outcomes(const record::StudyStore& store, const study::StudyKey& key,
                       const std::string& participant) {
  require_key_of(store, key);
  const record::StudyState state = store.state();
  const auto is_shown = [&](const record::SessionRow& row) {
    // After a look at only the registered question, state.unblinded is false.
    const bool in_results = state.unblinded && state.reports(row.session);
    if (participant.empty()) return in_results;
    return row.participant == participant && (in_results || state.looked_at.contains(row.session));
  };
  if (participant.empty() ? !state.unblinded : std::ranges::none_of(store.sessions(), is_shown)) {
    refuse_blinded(participant);
  }
  return open_outcomes(store, key, is_shown, participant);
}

Outcomes load_outcomes_for_question(const record::StudyStore& store, const study::StudyKey& key) {
  require_key_of(store, key);
  const record::StudyState state = store.state();
  if (!state.question) refuse_blinded("");
  return open_outcomes(
      store, key, [&](const record::SessionRow& row) { return state.reports(row.session); }, "");
}

}  // namespace touchtrial::analysis
