/// \file Choosing the participant: the questions to the experimenter before a session without
///   --participant.
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

/// The id of a station's next participant: next_id, or for the first one the enrolment number, so
/// that stations have different ids.
/// \param sessions  the station's sessions so far, by number
/// \return for instance "P07"; empty if the last id does not end in a number
[[nodiscard]] std::string proposed_participant(const std::vector<record::SessionRow>& sessions,
                                               const study::Station& station);

struct ParticipantQuestions {
  study::SessionPlan session{};  ///< the study's: language, texts and version of the form
  std::string proposed_id{};     ///< id; may be empty
  std::string note{};            ///< a sentence about the proposed id; may be empty
  /// Why a participant with this id is refused, as a sentence; empty: accepted.
  std::function<std::string(const std::string& id)> refusal;
};

struct ParticipantAnswers {
  std::string id;
  bool has_consented = false;
  std::string age_band{};  ///< for instance "20-29", in English; empty: not given
  std::string hand{};      ///< the pen hand, "right" or "left"; empty: not given
};

/// Shows questions and returns the answers in the format of StepReply.
using AskQuestions = std::function<std::vector<std::string>(const session::QuestionStep&)>;

/// Asks for id and consent until the id is accepted; then, after consent, for age and hand. Uses
/// the study's language, because the participant may read along.
[[nodiscard]] ParticipantAnswers ask_participant(const AskQuestions& ask,
                                                 const ParticipantQuestions& questions);

/// Asks for the participant in a separate window on the experimenter's monitor, or on the
/// participant's if there is no other, and records the consent beside the database.
/// \return the options with the participant's id, the visit number, and a remark
/// \throws UsageError if the window is closed or a signal ends the program before there are answers,
///   or if the study names a consent form and the participant has not signed it
/// \throws DeviceError as ParticipantWindow
[[nodiscard]] RunOptions with_participant(const RunOptions& options, const study::StationKey& key);

}  // namespace touchtrial::app
