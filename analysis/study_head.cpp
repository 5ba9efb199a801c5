#include "analysis/study_head.hpp"

#include "analysis/json_figures.hpp"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

StudyHead head_of(const Outcomes& outcomes) {
  std::set<std::string> participants;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) participants.insert(session.row.participant);
  }
  StudyHead head;
  head.study = outcomes.study;
  head.protocol = outcomes.design.protocol_name();
  head.simulated = outcomes.simulated;
  head.pilot = outcomes.pilot;
  head.participants = static_cast<int>(participants.size());
  head.trials = static_cast<int>(std::ranges::count_if(outcomes.trials, &TrialOutcome::counted));
  head.classes = outcomes.classes;
  head.collection = outcomes.collection;
  head.state = outcomes.state;
  head.registration = outcomes.design.registration;
  head.explorations = explorations_of(outcomes);
  head.demographics = outcomes.demographics;
  head.looks = outcomes.looked.looks;
  head.departures = departures_of(outcomes);
  head.course = course_of(outcomes, head.participants);
  return head;
}

std::string framed_json(const StudyHead& head, const std::string& members) {
  nlohmann::ordered_json object{{"study", head.study}, {"protocol", head.protocol}};
  put_stamp(object, head.simulated);
  put_state(object, head.state, head.pilot);
  object["participants"] = head.participants;
  object["trials"] = head.trials;
  object.update(nlohmann::ordered_json::parse(members));
  object["warnings"] = head.warnings;
  object["registration"] = registration_object(head.registration);
  object["collection"] = collection_object(head.collection);
  put_registered(object, head);
  put_people(object, head);
  return json_text(object);
}

}  // namespace touchtrial::analysis
