#include "analysis/outcomes/study_head.hpp"

#include "analysis/outcomes/departures.hpp"
#include "analysis/report/json_figures.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

struct Samples {
  std::vector<double> answer_s;
  std::vector<double> contact_s;
  std::vector<double> path_mm;
  std::vector<double> speed_mm_s;
  std::vector<double> force_n;
  std::vector<double> saturated;
};

void add_samples(const TrialOutcome& trial, Samples& samples) {
  if (const auto time = trial.row.reaction_time()) {
    samples.answer_s.push_back(std::chrono::duration<double>(*time).count());
  }
  if (!trial.measures || !(trial.measures->contact_s > 0.0)) return;
  const record::TrialMeasures& measures = *trial.measures;
  samples.contact_s.push_back(measures.contact_s);
  samples.path_mm.push_back(measures.path_mm);
  samples.speed_mm_s.push_back(measures.path_mm / measures.contact_s);
  samples.force_n.push_back(measures.force_rms_n);
  samples.saturated.push_back(measures.saturated_share);
}

std::vector<Explorations> explorations_of(const Outcomes& outcomes) {
  std::vector<Explorations> all(outcomes.methods.size());
  std::vector<Samples> samples(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i].method = outcomes.methods[i];
  for (const TrialOutcome& trial : outcomes.trials) {
    const auto method = static_cast<std::size_t>(trial.stimulus.method);
    if (!trial.counted || method >= all.size()) continue;
    ++all[method].trials;
    if (!trial.response && !trial.row.answer) ++all[method].without_response;
    add_samples(trial, samples[method]);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].answer_s = quartiles(std::move(samples[i].answer_s));
    all[i].contact_s = quartiles(std::move(samples[i].contact_s));
    all[i].path_mm = quartiles(std::move(samples[i].path_mm));
    all[i].speed_mm_s = quartiles(std::move(samples[i].speed_mm_s));
    all[i].force_n = quartiles(std::move(samples[i].force_n));
    all[i].saturated = quartiles(std::move(samples[i].saturated));
  }
  return all;
}

Json demographics_array(const std::vector<Characteristic>& characteristics) {
  Json all = Json::array();
  for (const Characteristic& one : characteristics) {
    Json bands = Json::array();
    for (const Band& band : one.bands) {
      bands.push_back({{"band", band.name}, {"participants", band.people}});
    }
    all.push_back(
        {{"characteristic", one.name}, {"bands", std::move(bands)}, {"others", one.others}});
  }
  return all;
}

Json questionnaire_array(const std::vector<QuestionSummary>& questions) {
  Json all = Json::array();
  for (const QuestionSummary& one : questions) {
    Json question{{"question", one.question}, {"wording", one.wording}, {"answered", one.answered}};
    if (one.kind == study::QuestionKind::choice) {
      question["options"] = Json::array();
      for (const Band& option : one.options) {
        question["options"].push_back({{"option", option.name}, {"participants", option.people}});
      }
      question["others"] = one.others;
    } else if (one.kind == study::QuestionKind::number) {
      question["numbers"] = quartiles_json(one.numbers);
    } else {
      question["texts"] = Json::array();
      for (const auto& [participant, text] : one.texts) {
        question["texts"].push_back({{"participant", participant}, {"text", text}});
      }
    }
    all.push_back(std::move(question));
  }
  return all;
}

Json explorations_array(const std::vector<Explorations>& methods) {
  Json all = Json::array();
  for (const Explorations& one : methods) {
    all.push_back({{"method", one.method},
                   {"trials", one.trials},
                   {"without_response", one.without_response},
                   {"answer_s", quartiles_json(one.answer_s)},
                   {"contact_s", quartiles_json(one.contact_s)},
                   {"path_mm", quartiles_json(one.path_mm)},
                   {"speed_mm_s", quartiles_json(one.speed_mm_s)},
                   {"force_rms_n", quartiles_json(one.force_n)},
                   {"saturated_share", quartiles_json(one.saturated)}});
  }
  return all;
}

}  // namespace

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
  head.closing_answers = question_summaries(outcomes);
  head.looks = outcomes.look_record.looks;
  head.departures = departures_of(outcomes);
  head.course = course_of(outcomes, head.participants);
  return head;
}

void put_people(nlohmann::ordered_json& object, const StudyHead& head) {
  object["public"] = head.collection.is_public;
  object["demographics"] = demographics_array(head.demographics);
  object["said"] = questionnaire_array(head.closing_answers);
  object["exploration"] = explorations_array(head.explorations);
}

nlohmann::ordered_json head_object(const StudyHead& head) {
  nlohmann::ordered_json object{{"study", head.study}, {"protocol", head.protocol}};
  put_stamp(object, head.simulated, simulated_devices(head.collection));
  object["unverified_device"] = !head.simulated && any_ran_unverified(head.collection.sessions);
  put_state(object, head.state, head.pilot);
  object["participants"] = head.participants;
  object["trials"] = head.trials;
  return object;
}

std::string framed_json(const StudyHead& head, const std::string& members) {
  nlohmann::ordered_json object = head_object(head);
  object.update(nlohmann::ordered_json::parse(members));
  object["warnings"] = head.warnings;
  object["registration"] = registration_object(head.registration);
  object["collection"] = collection_object(head.collection);
  put_registered(object, head);
  put_people(object, head);
  return json_text(object);
}

}  // namespace touchtrial::analysis
