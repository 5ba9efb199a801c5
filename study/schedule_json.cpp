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
                                                    {"control", Role::control}});

[[noreturn]] void refuse(const std::string& what) {
  throw StoreError("session schedule: " + what + "; use the key that the session was run with");
}

StimulusIndex meaning_of(const json& code, const StudyCodes& codes) {
  const auto stimulus = codes.stimulus_of(code.get<std::string>());
  if (!stimulus) refuse("names a code that this key does not have");
  return *stimulus;
}

Role role_of(const std::string& word) {
  if (const auto role = value_in(kRoles, word)) return *role;
  refuse("has a presentation of an unknown kind");
}

Presentation presentation_from(const json& object, const StudyCodes& codes) {
  Presentation shown{.trial = object.at("trial").get<int>(),
                     .block = object.at("block").get<int>(),
                     .role = role_of(object.at("kind").get_ref<const std::string&>()),
                     .stimulus = {}};
  shown.hand_off = shown.role == Role::control;
  if (shown.role != Role::catch_trial) {
    shown.stimulus = meaning_of(object.at("code"), codes);
    shown.gain_db = object.value("gain_db", 0.0);
  } else if (object.at("code") != codes.catch_code) {
    refuse("names a code that this key does not have");
  }
  return shown;
}

std::vector<Presentation> presentations_from(const json& list, const StudyCodes& codes) {
  std::vector<Presentation> presentations;
  for (const json& object : list) presentations.push_back(presentation_from(object, codes));
  return presentations;
}

json json_of(const std::vector<Presentation>& presentations, const StudyCodes& codes) {
  json list = json::array();
  for (const Presentation& shown : presentations) {
    const bool is_catch = shown.role == Role::catch_trial;
    list.push_back({{"trial", shown.trial},
                    {"block", shown.block},
                    {"kind", name_of(shown.role)},
                    {"code", is_catch ? codes.catch_code : codes.code_of(shown.stimulus)}});
    // Left out where there is none, so that sessions without it keep their bytes.
    if (shown.gain_db != 0.0) list.back()["gain_db"] = shown.gain_db;
  }
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
  const bool each_once = std::ranges::adjacent_find(sorted) == sorted.end();
  const auto in_range = [&](int choice) { return choice >= 0 && choice < std::ssize(sorted); };
  if (!each_once || sorted.size() != choices || !std::ranges::all_of(sorted, in_range)) {
    refuse("its layout does not have every choice once");
  }
}

Schedule schedule_of(const json& document, const StudyCodes& codes) {
  Schedule schedule;
  schedule.presentations = presentations_from(document.at("presentations"), codes);
  for (const json& choice : document.at("layout")) {
    schedule.layout.push_back(choice.is_number() ? choice.get<int>()
                                                 : meaning_of(choice, codes).class_index);
  }
  check_layout(schedule.layout, codes.study.protocol->choices(codes.study).size());
  return schedule;
}

}  // namespace

std::string_view name_of(Role role) {
  return name_in(kRoles, role);
}

std::string schedule_to_json(const Schedule& schedule, const StudyCodes& codes) {
  // The layout names a class's picture by the code of its first stimulus, any other choice by
  // index.
  const std::vector<Choice> choices = codes.study.protocol->choices(codes.study);
  json layout = json::array();
  for (const int choice : schedule.layout) {
    const std::optional<int> class_index = choices[static_cast<std::size_t>(choice)].class_index;
    layout.push_back(class_index ? json(codes.code_of({*class_index, 0, 0})) : json(choice));
  }
  return json{{"presentations", json_of(schedule.presentations, codes)}, {"layout", layout}}.dump();
}

Schedule schedule_from_json(const std::string& text, const StudyCodes& codes) {
  const json document = parsed_json(text);
  try {
    return schedule_of(document, codes);
  } catch (const json::exception&) {
    refuse("does not have the form of a schedule");
  }
}

std::string block_to_json(const std::vector<Presentation>& block, const StudyCodes& codes) {
  return json_of(block, codes).dump();
}

std::vector<Presentation> block_from_json(const std::string& text, const StudyCodes& codes) {
  const json document = parsed_json(text);
  try {
    return presentations_from(document, codes);
  } catch (const json::exception&) {
    refuse("does not have the form of a block");
  }
}

}  // namespace touchtrial::study
