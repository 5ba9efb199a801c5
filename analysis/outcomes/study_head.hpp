/// \file The part common to the reports of all protocols.
#pragma once

#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/registered.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/prevalence.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// How hands explored in the counted trials of one method, with equal weight for each trial.
/// Contact, path, force and speed come from traces that touched the plane.
struct Explorations {
  std::string method;
  int trials = 0;
  int without_response = 0;  ///< timed out
  Quartiles answer_s;        ///< from the moment the plane can be felt to the answer
  Quartiles contact_s;       ///< at the plane
  Quartiles path_mm;         ///< along the plane, while in contact
  Quartiles speed_mm_s;      ///< path over contact
  Quartiles force_n;         ///< root mean square over the contact
  Quartiles saturated;       ///< share of the contact with the force at its limit, 0 .. 1
};

struct StudyHead {
  std::string study;
  std::string protocol;
  bool simulated = false;
  bool pilot = false;
  int participants = 0;  ///< participants with a counted session
  int trials = 0;        ///< counted trials
  std::vector<std::string> classes;
  Collection collection;                           ///< how it was collected
  record::StudyState state{};                      ///< unblinded; an interim look if not closed
  study::Registration registration;                ///< the registration deposited before collection
  std::vector<std::string> warnings;               ///< cautions about reading the numbers
  std::vector<Explorations> explorations{};        ///< by method, in the order of Outcomes
  std::vector<Characteristic> demographics{};      ///< of counted participants, in bands
  std::vector<QuestionSummary> closing_answers{};  ///< answers to closing questions
  std::vector<Look> looks{};                       ///< all looks at outcomes
  std::vector<std::string> departures{};           ///< departures_of
  StudyCourse course{};                    ///< planned and actual numbers of people and looks
  std::optional<PrimaryResult> primary{};  ///< if the protocol has a registered question
  std::optional<Prevalence> prevalence{};  ///< if each participant is tested against chance
};

/// Fills in everything except the warnings, `primary` and `prevalence`.
[[nodiscard]] StudyHead head_of(const Outcomes& outcomes);

/// The JSON object of a report, indented, ending with a line feed: the head's members, the
/// protocol's members, then warnings, registration, collection, and the registered question with
/// its answer.
/// \param members  the protocol's members, as a JSON object
[[nodiscard]] std::string framed_json(const StudyHead& head, const std::string& members);

}  // namespace touchtrial::analysis
