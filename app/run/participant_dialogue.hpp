/// \file Choosing the participant: what the experimenter is asked before a session for which no option names the
/// participant.
#pragma once

#include "app/run/run_session.hpp"
#include "app/windows/participant/participant_window.hpp"
#include "record/study_store.hpp"
#include "study/session_plan.hpp"
#include "study/study_key.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The id of a station's next participant: next_id, or for the first one their enrolment number, so
/// that stations have different ids.
/// \param sessions  of the station so far, by number
/// \return for instance "P07"; empty if the last id does not end in a number
[[nodiscard]] std::string proposed_participant(const std::vector<record::SessionRow>& sessions,
                                               const study::Station& station);

struct ParticipantQuestions {
  study::SessionPlan session{};  ///< the study's: language, texts and version of the form
  std::string proposed{};        ///< id; may be empty
  std::string note{};            ///< on the proposed id, as a sentence; may be empty
  /// Why a participant of this id cannot come, as a sentence; empty: they can.
  std::function<std::string(const std::string& id)> why_not;
};

struct ParticipantAnswers {
  std::string id;
  bool has_consented = false;
  std::string age_band{};  ///< for instance "20-29", in English; empty: not given
  std::string hand{};      ///< that holds the pen, "right" or "left"; empty: not given
};

/// Shows questions until there are answers, as StepReply has them.
using AskQuestions = std::function<std::vector<std::string>(const session::QuestionStep&)>;

/// Asks for id and consent, again while a participant of that id cannot come; then, of whoever has
/// consented, for age and hand. In the study's language: the participant may read along.
[[nodiscard]] ParticipantAnswers ask_participant(const AskQuestions& ask,
                                                 const ParticipantQuestions& questions);

/// Asks who comes, in a window of its own on the experimenter's monitor, or on the participant's if
/// there is no other, and records the consent beside the database.
/// \return the options with the participant's id, the visit that it is, and a remark
/// \throws UsageError if the window is gone or a signal ends the program before there are answers,
///   or if the study names a consent form and the participant has not signed it
/// \throws DeviceError as ParticipantWindow
[[nodiscard]] RunOptions with_participant(const RunOptions& options, const study::StationKey& key);

}  // namespace touchtrial::app
