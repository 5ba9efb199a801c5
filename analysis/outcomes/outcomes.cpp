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

std::string shown(const record::TrialRow& row) {
  return fmt::format("session {}, trial {}", row.session, row.trial);
}

/// The file names of a class's images, with folders only if two images have the same file name.
std::vector<std::string> exemplar_names(const study::StudyClass& of) {
  std::set<std::string> distinct;
  for (const auto& image : of.images) distinct.insert(image.filename().string());
  const bool unambiguous = distinct.size() == of.images.size();
  std::vector<std::string> names;
  for (const auto& image : of.images) {
    names.push_back(unambiguous ? image.filename().string() : image.generic_string());
  }
  return names;
}

Outcomes labelled(const record::StudyStore& store, const study::Study& study) {
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
    throw VerificationError(shown(row) +
                            ": is not in the session's schedule; run `touchtrial verify`");
  }
  return *found;
}

void require_fit(const record::TrialRow& row, const study::Ask& ask) {
  if (!row.answer) return;
  const std::string misfit = study::mismatch_of(*row.answer, ask);
  if (misfit.empty()) return;
  throw VerificationError(shown(row) + ": " + misfit + "; run `touchtrial verify`");
}

TrialOutcome outcome_of(const record::TrialRow& row, const SessionOutcome& session,
                        const study::Schedule& schedule, const study::Study& study) {
  const study::Trial& scheduled = trial_of(row, schedule);
  const bool ended =
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
    trial.stimulus = study.task->about(study, {*row.track, *row.level});
    trial.right = *row.target;
    if (row.kind == name_of(study::Role::catch_trial)) trial.role = study::Role::catch_trial;
  }
  trial.scored = trial.role == study::Role::scored;
  trial.counted = session.counted && trial.scored && ended;
  require_fit(row, study.task->ask(study, scheduled.place));
  if (row.answer) trial.response = schedule.choice_of(*row.answer);
  return trial;
}

/// The demographics of each participant who counts, combined over all of their sessions.
std::vector<Demographics> demographics_by_participant(
    const Outcomes& outcomes, const std::map<int, Demographics>& by_session) {
  std::map<std::string, Demographics> people;
  for (const SessionOutcome& one : outcomes.sessions) {
    if (one.counted) people[one.row.participant];
  }
  for (const SessionOutcome& one : outcomes.sessions) {
    const auto person = people.find(one.row.participant);
    const auto said = by_session.find(one.row.session);
    if (person == people.end() || said == by_session.end()) continue;
    const Demographics& own = said->second;
    if (own.age_band) person->second.age_band = own.age_band;
    if (own.sex) person->second.sex = own.sex;
    if (own.handedness_score) person->second.handedness_score = own.handedness_score;
  }
  std::vector<Demographics> all;
  for (auto& [id, said] : people) all.push_back(std::move(said));
  return all;
}

/// Adds each shown session's assigned group and order.
void add_assignment(const Outcomes& outcomes, Collection& collection) {
  std::map<int, const SessionOutcome*> shown;
  for (const SessionOutcome& one : outcomes.sessions) shown[one.row.session] = &one;
  const std::vector<std::string>& groups = outcomes.design.groups.labels;
  for (SessionRecord& record : collection.sessions) {
    const auto found = shown.find(record.row.session);
    if (found == shown.end()) continue;
    record.order_block = found->second->order_block;
    const std::optional<int> group = found->second->group;
    if (group && !record.row.erased) record.group = groups[static_cast<std::size_t>(*group)];
  }
}

/// Adds the answer spread of each shown session, and removes the opened outcome data of the others.
void add_spreads(const std::vector<record::TrialRow>& trials,
                 const std::map<int, SessionOutcome>& shown, Collection& collection) {
  std::map<int, std::vector<record::TrialRow>> by_session;
  for (const record::TrialRow& trial : trials) by_session[trial.session].push_back(trial);
  for (SessionRecord& record : collection.sessions) {
    if (!shown.contains(record.row.session)) {
      record.largest_force_n.reset();
    } else {
      record.spread = spread_of(std::move(by_session[record.row.session]));
    }
  }
}

/// Answers, incidents and demographics of the sessions that are shown.
void add_questionnaires(const OpenedSessions& opened, const study::Study& study,
                        Outcomes& outcomes) {
  SessionKeys keys;
  for (const SessionOutcome& one : outcomes.sessions) {
    keys.emplace(one.row.session, opened.keys().at(one.row.session));
  }
  const auto is_unseen = [&](const auto& one) { return !keys.contains(one.session); };
  outcomes.asked = own_questions(study);
  outcomes.answers = open_answers(opened.events(), keys);
  std::erase_if(outcomes.answers, is_unseen);
  outcomes.incidents = load_incidents(opened.events(), keys);
  std::erase_if(outcomes.incidents, is_unseen);
  outcomes.marks = load_marks(opened.events(), keys);
  const std::map<int, Demographics> said = demographics_of(outcomes.answers, study);
  outcomes.demographics = in_bands(demographics_by_participant(outcomes, said));
  for (SessionRecord& record : outcomes.collection.sessions) {
    const auto own = said.find(record.row.session);
    if (own != said.end()) record.handedness_score = own->second.handedness_score;
  }
}

[[noreturn]] void refuse_unseen(const std::string& participant) {
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

/// Opens the sessions for which `shows` is true.
/// \param participant  only this participant's sessions; empty: all sessions
template <typename Shows>
Outcomes opened(const record::StudyStore& store, const study::StudyKey& key, Shows shows,
                const std::string& participant) {
  const std::vector<record::SessionRow> rows = store.sessions();
  Outcomes outcomes = labelled(store, key.study);
  OpenedSessions sessions_opened(store, key);
  const SessionKeys& keys = sessions_opened.keys();
  const StudyEvents& events = sessions_opened.events();
  require_sealed_ends(events, keys);
  outcomes.collection = load_collection(events, keys);
  outcomes.visual = outcomes.collection.visual;
  outcomes.look_record = look_record(store, key);
  std::vector<record::SessionRow> shown;
  std::ranges::copy_if(rows, std::back_inserter(shown), shows);
  if (participant.empty()) {
    outcomes.sessions_unseen = static_cast<int>(rows.size() - shown.size());
  }
  const std::set<int> counted = counted_sessions(shown, store.commitment());
  std::map<int, SessionOutcome> sessions;
  for (const record::SessionRow& row : shown) {
    const study::Draws draws = draws_of(row);
    sessions[row.session] = {row, counted.contains(row.session),
                             study::order_block_of(key.study, key.stations, row.enrolment, draws),
                             key.group_of(row.enrolment, draws)};
    outcomes.sessions.push_back(sessions[row.session]);
  }
  add_assignment(outcomes, outcomes.collection);
  add_questionnaires(sessions_opened, key.study, outcomes);
  const auto schedules = open_schedules(events, key, keys);
  Measures measures;
  const std::vector<record::TrialRow> trials = sessions_opened.take_trials(measures);
  add_spreads(trials, sessions, outcomes.collection);
  outcomes.trials.reserve(trials.size());
  for (const record::TrialRow& row : trials) {
    const auto schedule = schedules.find(row.session);
    if (schedule == schedules.end()) continue;  // no session-opened event
    const auto session = sessions.find(row.session);
    if (session == sessions.end()) continue;
    TrialOutcome trial = outcome_of(row, session->second, schedule->second, key.study);
    const auto measured = measures.find({row.session, row.trial});
    if (measured != measures.end()) trial.measures = measured->second;
    outcomes.trials.push_back(std::move(trial));
  }
  return outcomes;
}

}  // namespace

std::string shown(const record::ChainFault& fault) {
  return fmt::format("{}, event {}: {}", record::chain_named(fault.session), fault.sequence,
                     one_line(fault.what));
}

Outcomes load_outcomes(const record::StudyStore& store, const study::StudyKey& key,
                       const std::string& participant) {
  require_key_of(store, key);
  const record::StudyState state = store.state();
  const auto shows = [&](const record::SessionRow& row) {
    // A look at only the registered question shows no single outcomes.
    const bool in_results = state.unblinded && state.reports(row.session);
    if (participant.empty()) return in_results;
    return row.participant == participant && (in_results || state.looked_at.contains(row.session));
  };
  if (participant.empty() ? !state.unblinded : std::ranges::none_of(store.sessions(), shows)) {
    refuse_unseen(participant);
  }
  return opened(store, key, shows, participant);
}

Outcomes load_for_question(const record::StudyStore& store, const study::StudyKey& key) {
  require_key_of(store, key);
  const record::StudyState state = store.state();
  if (!state.question) refuse_unseen("");
  return opened(
      store, key, [&](const record::SessionRow& row) { return state.reports(row.session); }, "");
}

}  // namespace touchtrial::analysis
