/// \file A study's stimuli and answers after unblinding.
#pragma once

#include "analysis/outcomes/answers.hpp"
#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/demographics.hpp"
#include "analysis/outcomes/incidents.hpp"
#include "analysis/outcomes/looks.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A session, and whether its trials count towards accuracy.
struct SessionOutcome {
  record::SessionRow row;
  bool counted = false;
  int order_block = -1;        ///< study::order_block_of the enrolment number
  std::optional<int> group{};  ///< index into the study's groups
};

/// The level that an adaptive order chose for a trial.
struct ChosenLevel {
  int track = 0;   ///< from 1; 0: none
  int level = 0;   ///< index into the track's levels
  int target = 0;  ///< index of the right choice

  friend bool operator==(const ChosenLevel&, const ChosenLevel&) = default;
};

/// One trial with its stimulus and answer.
struct TrialOutcome {
  std::string participant;
  record::TrialRow row;
  study::StimulusIndex stimulus;       ///< for tracks, the stimulus of the step
  double gain_db = 0.0;                ///< study::Plane::gain_db
  std::vector<study::Plane> planes{};  ///< from the schedule; empty if an adaptive order chose
  study::Role role = study::Role::scored;
  std::optional<ChosenLevel> chosen{};
  std::optional<int> picture{};  ///< class whose picture was shown with the question
  bool has_stimulus = false;     ///< the schedule has exactly one textured plane for the trial
  bool scored = false;           ///< by the schedule: not a lead-in or catch trial
  bool counted = false;          ///< counts towards accuracy
  std::optional<int> response;   ///< index of the chosen alternative; empty: no response
  std::optional<int> right;      ///< index of the right choice; empty: there is none
  std::optional<record::TrialMeasures> measures;
  int visit = 1;
  std::optional<int> group{};  ///< index into the study's groups

  /// Whether the response is right. A trial without a response is wrong.
  [[nodiscard]] bool correct() const noexcept { return response && response == right; }
  /// Whether the trial passes both parts of the validity rule, the unencrypted and the sealed one.
  [[nodiscard]] bool valid() const noexcept {
    return row.valid && (!measures || measures->within_limits);
  }
};

/// A study's trials with the labels of their stimuli and choices.
struct Outcomes {
  std::string study;
  bool simulated = false;
  bool pilot = false;
  bool visual = false;  ///< textures were seen on a screen, not felt
  record::StudyState state;
  std::vector<std::string> classes;                 ///< labels
  std::vector<std::vector<std::string>> exemplars;  ///< image file names, by class
  std::vector<std::string> choices;                 ///< labels of the alternatives
  std::vector<std::string> methods;                 ///< labels of the presented methods
  std::vector<SessionOutcome> sessions;             ///< by number, including erased sessions
  /// Sessions that had not ended at an interim look; not in `sessions` or `trials`.
  int sessions_unseen = 0;
  std::vector<TrialOutcome> trials;  ///< by session and trial, without erased sessions
  study::Study design;               ///< the study file, including the rule for drawing orders
  LookRecord look_record;            ///< looks at outcomes, and decisions after them
  Collection collection;
  std::vector<Characteristic> demographics{};  ///< of counted participants
  std::vector<QuestionAnswer> answers{};       ///< of `sessions`
  std::vector<Incident> incidents{};           ///< of `sessions`, with texts and times
  std::vector<InstrumentMark> marks{};         ///< of `sessions`
  /// The study's questions, to which the caller may add the program's questions.
  Questionnaires questionnaires{};
};

/// "session 2, event 7: <what>"
[[nodiscard]] std::string shown(const record::ChainFault& fault);

/// Opens every sealed schedule and measure and scores the answers.
///
/// A session counts if it was completed and is neither excluded, erased nor replaced, and its
/// participant completed all needed visits. A pilot or simulated session counts only in a pilot or
/// simulated study. A scored trial of a counted session counts if it ended with an answer or timed
/// out. A repeated trial keeps its number, and its last presentation with an answer counts. A trial
/// that was interrupted and never repeated does not count. After an interim look, the result has
/// only the sessions that had ended before it, until the next unblinding.
///
/// First checks chains, sealed ends and derived tables against the events, but not traces.
/// \param participant  opens only this participant's sessions, if a look at the participant or the
///   study permits it; empty: all sessions
/// \throws StoreError if neither the study nor this participant was unblinded
/// \throws VerificationError, naming the session, if the key does not match the database, the
///   database is inconsistent, or a session does not agree with its schedule
[[nodiscard]] Outcomes load_outcomes(const record::StudyStore& store, const study::StudyKey& key,
                                     const std::string& participant = {});

/// Like load_outcomes, but after a look at only the registered question. Show only the result of
/// registered_answer_only (results.hpp).
/// \throws as load_outcomes; StoreError if the last look was not at the registered question
[[nodiscard]] Outcomes load_outcomes_for_question(const record::StudyStore& store,
                                                  const study::StudyKey& key);

}  // namespace touchtrial::analysis
