/// \file Schedules and blocks as JSON, for the secret parts of a session's events.
#include "core/errors.hpp"
#include "core/named.hpp"
#include "study/protocol.hpp"
#include "study/study_key.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial::study {
namespace {

using nlohmann::json;

constexpr auto kRoles = std::to_array<Named<Role>>({{"scored", Role::scored},
                                                    {"lead-in", Role::lead_in},
                                                    {"catch", Role::catch_trial},
                                                    {"control", Role::control},
                                                    {"practice", Role::practice}});

[[noreturn]] void refuse(const std::string& what) {
  throw StoreError("session schedule: " + what + "; use the key that the session was run with");
}

StimulusIndex stimulus_of(const json& code, const StudyCodes& codes) {
  const auto stimulus = codes.stimulus_of(code.get<std::string>());
  if (!stimulus) refuse("contains a code that this key does not have");
  return *stimulus;
}

Role role_of(const std::string& word) {
  if (const auto role = value_in(kRoles, word)) return *role;
  refuse("contains a presentation of unknown kind " + in_quotes(word));
}

/// All fields have the same wall, so blank planes share one code.
json json_of(const Plane& plane, const StudyCodes& codes) {
  const bool is_plain_blank = plane == Plane{.field = {}, .blank = true};
  json object = {{"code", is_plain_blank ? codes.catch_code : codes.code_of(plane.field)}};
  // Default values are omitted.
  if (plane.blank && !is_plain_blank) object["blank"] = true;
  if (plane.gain_db != 0.0) object["gain_db"] = plane.gain_db;
  if (plane.pitch != 1.0) object["pitch"] = plane.pitch;
  if (plane.mix) object["mix"] = {codes.code_of(plane.mix->other), plane.mix->share};
  return object;
}

Plane plane_from(const json& object, const StudyCodes& codes) {
  Plane plane;
  if (object.at("code") == codes.catch_code) {
    plane.blank = true;
    return plane;
  }
  plane.field = stimulus_of(object.at("code"), codes);
  plane.blank = object.value("blank", false);
  plane.gain_db = object.value("gain_db", 0.0);
  plane.pitch = object.value("pitch", 1.0);
  if (const auto mix = object.find("mix"); mix != object.end()) {
    plane.mix = Mix{stimulus_of(mix->at(0), codes), mix->at(1).get<double>()};
  }
  return plane;
}

json json_of(const Trial& trial, const StudyCodes& codes) {
  json object = json::object();
  if (trial.planes.size() == 1) object = json_of(trial.planes.front(), codes);
  object["trial"] = trial.place.trial;
  object["block"] = trial.place.block;
  object["kind"] = name_of(trial.role);
  if (trial.place.hand_off) object["hand_off"] = true;
  if (trial.right) object["right"] = *trial.right;
  if (trial.level) object["level"] = {trial.level->track, trial.level->level};
  if (trial.picture) object["picture"] = codes.code_of({*trial.picture, 0, 0});
  if (trial.planes.size() > 1) {
    for (const Plane& plane : trial.planes) object["planes"].push_back(json_of(plane, codes));
  }
  return object;
}

Trial trial_from(const json& object, const StudyCodes& codes) {
  Trial trial;
  trial.place = {object.at("trial").get<int>(), object.at("block").get<int>(),
                 object.value("hand_off", false)};
  trial.role = role_of(object.at("kind").get_ref<const std::string&>());
  if (const auto right = object.find("right"); right != object.end()) {
    trial.right = right->get<int>();
  }
  if (const auto level = object.find("level"); level != object.end()) {
    trial.level = Level{level->at(0).get<int>(), level->at(1).get<int>()};
  }
  if (const auto picture = object.find("picture"); picture != object.end()) {
    trial.picture = stimulus_of(*picture, codes).class_index;
  }
  if (object.contains("code")) trial.planes.push_back(plane_from(object, codes));
  if (const auto planes = object.find("planes"); planes != object.end()) {
    for (const json& plane : *planes) trial.planes.push_back(plane_from(plane, codes));
  }
  return trial;
}

std::vector<Trial> trials_from(const json& list, const StudyCodes& codes) {
  std::vector<Trial> trials;
  for (const json& object : list) trials.push_back(trial_from(object, codes));
  return trials;
}

json json_of(const std::vector<Trial>& trials, const StudyCodes& codes) {
  json list = json::array();
  for (const Trial& trial : trials) list.push_back(json_of(trial, codes));
  return list;
}

json parsed_json(const std::string& text) {
  json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) refuse("is not JSON");
  return document;
}

void check_layout(const std::vector<int>& layout, std::size_t choices) {
  std::vector<int> sorted = layout;
  std::ranges::sort(sorted);
  const bool are_unique = std::ranges::adjacent_find(sorted) == sorted.end();
  const auto in_range = [&](int choice) { return choice >= 0 && choice < std::ssize(sorted); };
  if (!are_unique || sorted.size() != choices || !std::ranges::all_of(sorted, in_range)) {
    refuse("its layout does not contain every choice exactly once");
  }
}

Schedule schedule_of(const json& document, const StudyCodes& codes) {
  Schedule schedule;
  schedule.trials = trials_from(document.at("presentations"), codes);
  for (const json& choice : document.at("layout")) {
    schedule.layout.push_back(choice.is_number() ? choice.get<int>()
                                                 : stimulus_of(choice, codes).class_index);
  }
  check_layout(schedule.layout, choices_of(codes.study).size());
  return schedule;
}

}  // namespace

std::string_view name_of(Role role) {
  return name_in(kRoles, role);
}

std::string schedule_to_json(const Schedule& schedule, const StudyCodes& codes) {
  // The layout names a class's picture by the code of its first stimulus, any other choice by
  // index.
  const std::vector<Choice> choices = choices_of(codes.study);
  json layout = json::array();
  for (const int choice : schedule.layout) {
    const std::optional<int> class_index = choices[static_cast<std::size_t>(choice)].class_index;
    layout.push_back(class_index ? json(codes.code_of({*class_index, 0, 0})) : json(choice));
  }
  return json{{"presentations", json_of(schedule.trials, codes)}, {"layout", layout}}.dump();
}

Schedule schedule_from_json(const std::string& text, const StudyCodes& codes) {
  const json document = parsed_json(text);
  try {
    return schedule_of(document, codes);
  } catch (const json::exception&) {
    refuse("is not a valid schedule");
  }
}

std::string block_to_json(const std::vector<Trial>& block, const StudyCodes& codes) {
  return json_of(block, codes).dump();
}

std::vector<Trial> block_from_json(const std::string& text, const StudyCodes& codes) {
  const json document = parsed_json(text);
  try {
    return trials_from(document, codes);
  } catch (const json::exception&) {
    refuse("is not a valid block");
  }
}

}  // namespace touchtrial::study
