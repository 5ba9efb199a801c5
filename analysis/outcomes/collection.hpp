/// \file How a study's data were collected: facts about sessions for a results section. They reveal
/// nothing about outcomes, so they may be shown at any time.
#pragma once

#include "analysis/outcomes/sealed_sessions.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Whether a session counts: it is completed, neither excluded, erased nor replaced, and of the
/// study's kind (pilot or not, simulated or not).
[[nodiscard]] inline bool session_counts(const record::SessionRow& session,
                                         const record::StudyCommitment& commitment) noexcept {
  return session.state == record::SessionState::completed && !session.excluded && !session.erased &&
         session.replaced_by.empty() && session.pilot == commitment.pilot &&
         session.simulated == commitment.simulated;
}

/// The kind of random draws behind a session's schedule.
[[nodiscard]] inline study::Draws draws_of(const record::SessionRow& session) noexcept {
  return session.pilot || session.simulated ? study::Draws::rehearsal : study::Draws::people;
}

/// The counting sessions of participants who completed all needed visits
/// (study::Study::visits_needed).
/// \param rows  all sessions that may be shown
/// \throws StoreError as prescription_from_json does
[[nodiscard]] std::set<int> counted_sessions(std::span<const record::SessionRow> rows,
                                             const record::StudyCommitment& commitment);

/// A deviation from the protocol: its code (docs/data-dictionary.md) and a description.
/// Descriptions recorded during a session are empty without the key.
struct Deviation {
  std::string code;
  std::string text;
};

/// The course of a session's practice.
struct PracticeRecord {
  int rounds = 0;
  int presentations = 0;
  std::optional<int> correct;  ///< known only with the key
  bool passed = true;          ///< false with a deviation `practice-not-passed`
};

/// The distribution of a session's answers over positions. This is an outcome.
struct AnswerSpread {
  int different = 0;           ///< number of positions used
  double largest_share = 0.0;  ///< of the most frequent position, in (0, 1]
  int longest_run = 0;         ///< largest number of consecutive answers at one position
  /// Median time from plane-on to answer, rounded to 0.1 s; empty if all answers followed a pause.
  std::optional<double> median_s{};

  friend bool operator==(const AnswerSpread&, const AnswerSpread&) = default;
};

/// \param trials  opened trials of one session
/// \return nothing if no trial is answered
[[nodiscard]] std::optional<AnswerSpread> spread_of(std::vector<record::TrialRow> trials);

/// The number of a session's trials with a trace, and for each window (record::HandWindows) the
/// number of trials in which the hand left it.
struct HandCounts {
  int trials = 0;
  int contact = 0;
  int path = 0;
  int force = 0;
  int speed = 0;

  friend bool operator==(const HandCounts&, const HandCounts&) = default;
};

/// One session. An erased session has only its number and state.
struct SessionRecord {
  record::SessionRow row;
  std::string device_serial;                     ///< empty if none
  std::optional<record::StationRecord> station;  ///< only for sessions in real time
  std::string opened_utc;                        ///< ISO 8601; empty for simulated sessions
  std::optional<PracticeRecord> practice;
  std::optional<int> answers;            ///< number of answers; empty while the session is open
  bool one_key = false;                  ///< see session::Session::close
  std::optional<AnswerSpread> spread{};  ///< empty until outcomes are shown
  HandCounts outside{};                  ///< trials with the hand outside its windows
  std::vector<Deviation>
      deviations;  ///< including deviations recorded later; duplicates appear once
  // Free text; "(sealed)" without the key.
  std::string exclusion_reason;
  bool after_outcomes = false;  ///< the exclusion was made after outcomes had been seen
  std::string replacement_reason;
  std::string stop_reason;  ///< free text, or the program's reason
  std::string withdrawal_reason;
  std::optional<double> largest_force_n;  ///< rounded to 0.1 N; empty until outcomes are shown
  int resumed = 0;        ///< number of times it was resumed after the program had ended
  int interruptions = 0;  ///< interrupted presentations, repeated or not
  int pauses = 0;
  int notes = 0;  ///< notes made during the session
  /// Laterality quotient, -100 to 100; empty until outcomes are shown, or if not answered.
  std::optional<double> handedness_score{};
  std::string group{};  ///< the participant's group; empty if there is none or it is hidden
  /// Block of the assigned order of methods; empty until outcomes are shown. Negative: no partner.
  std::optional<int> order_block{};
};

/// Whether a session ran on a device with force that had no valid certificate.
[[nodiscard]] bool ran_unverified(const SessionRecord& session);
/// Whether any unerased session ran unverified.
[[nodiscard]] bool any_ran_unverified(const std::vector<SessionRecord>& sessions);

/// device_words (text_figures.hpp) for the unerased sessions of simulated participants.
[[nodiscard]] std::string simulated_devices(const std::vector<record::SessionRow>& sessions);

/// The servo's timing in one real-time trial.
struct ServoTrial {
  int session = 0;
  int trial = 0;
  record::ServoHealth health;
  std::int64_t overruns = 0;
};

/// The numbers of participants from enrolment to analysis. Each participant is counted once, by
/// the last session.
struct ParticipantFlow {
  int enrolled = 0;
  int erased = 0;    ///< participants who withdrew and had their data erased
  int replaced = 0;  ///< by another participant
  int excluded = 0;
  std::vector<std::string> exclusion_reasons;  ///< one per exclusion, in order of sessions
  int stopped = 0;
  int open = 0;
  int other_kind = 0;  ///< pilot or simulated sessions if the study is not, or the reverse
  int unseen = 0;      ///< completed after an interim look
  int analysed = 0;    ///< enrolled minus all of the above
  int withdrawn = 0;   ///< among all of these, with or without erasure
};

/// What the study prescribes for a session, from its unencrypted configuration.
struct Prescription {
  double explore_limit_s = 0.0;
  std::string on_timeout;
  std::string order;
  int repeats = 0;
  int method_orders = 1;  ///< orders of methods that participants get in turn, by enrolment number
  std::string sight;      ///< "curtain" or "blindfold"
  bool masking_wanted = true;
  double masking_dbfs = 0.0;
  study::ValidityRule validity{};
  int visits = 1;                    ///< per participant
  int visits_needed = 1;             ///< study::Study::visits_needed
  double min_days = 0.0;             ///< minimum time between visits
  std::optional<double> max_days{};  ///< maximum time between visits
  std::vector<std::string> groups{};
  std::string draft{};    ///< study::draft_notice of the participants' language
  int intervals = 0;      ///< planes of a trial; 0: one plane
  bool adaptive = false;  ///< a procedure chooses the level of each trial
};

struct Collection {
  Prescription prescription;
  std::vector<SessionRecord> sessions;   ///< in order of session numbers
  std::vector<ServoTrial> servo_trials;  ///< by session and trial, without erased sessions
  ParticipantFlow flow;
  std::vector<record::PersonLook> looks;  ///< looks at single participants' outcomes, in order
  bool visual = false;     ///< textures were seen on a screen, not felt; the same for all sessions
  bool is_public = false;  ///< has no ids or personal texts, see without_identities
};

/// simulated_devices for a collection's sessions.
[[nodiscard]] std::string simulated_devices(const Collection& collection);

/// \return the reason for an exclusion, prefixed by "after outcomes were seen: " if it was late
[[nodiscard]] std::string exclusion_words(const SessionRecord& session);

/// \param configuration  the unencrypted configuration from the study's commitment
/// \throws StoreError if the configuration has a form that this program does not write
[[nodiscard]] Prescription prescription_from_json(const std::string& configuration);

/// Reads how every session was collected, without schedules, answers and traces.
/// \param keys  by session; without a key, the sealed parts of practice and deviations are missing
/// \throws VerificationError, naming the event, if an event does not open
[[nodiscard]] Collection load_collection(const StudyEvents& study, const SessionKeys& keys = {});

}  // namespace touchtrial::analysis
