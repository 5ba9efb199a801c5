/// The secret part of a session's opening.
#include "core/errors.hpp"
#include "protocols/design/study_key.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;

constexpr std::string_view kScored = "scored";
constexpr std::string_view kLeadIn = "lead-in";

[[noreturn]] void refuse(const std::string& what) {
  throw StoreError("session schedule: " + what + "; use the key that the session was run with");
}

StimulusIndex meaning_of(const json& code, const StudyKey& key) {
  const auto stimulus = key.stimulus_of(code.get<std::string>());
  if (!stimulus) refuse("names a code that this key does not have");
  return *stimulus;
}

Presentation presentation_from(const json& object, const StudyKey& key) {
  const auto& kind = object.at("kind").get_ref<const std::string&>();
  if (kind != kScored && kind != kLeadIn) refuse("has a presentation of an unknown kind");
  return {.trial = object.at("trial").get<int>(),
          .block = object.at("block").get<int>(),
          .kind = kind == kScored ? PresentationKind::scored : PresentationKind::lead_in,
          .stimulus = meaning_of(object.at("code"), key)};
}

void check_layout(const std::vector<int>& layout, const StudyKey& key) {
  std::vector<int> sorted = layout;
  std::ranges::sort(sorted);
  const bool each_once = std::ranges::adjacent_find(sorted) == sorted.end();
  if (!each_once || sorted.size() != key.study.classes.size()) {
    refuse("its layout does not have every class once");
  }
}

Schedule schedule_of(const json& document, const StudyKey& key) {
  Schedule schedule;
  for (const json& object : document.at("presentations")) {
    schedule.presentations.push_back(presentation_from(object, key));
  }
  for (const json& code : document.at("layout")) {
    schedule.layout.push_back(meaning_of(code, key).class_index);
  }
  check_layout(schedule.layout, key);
  return schedule;
}

}  // namespace

std::string schedule_to_json(const Schedule& schedule, const StudyKey& key) {
  json presentations = json::array();
  for (const Presentation& shown : schedule.presentations) {
    const bool scored = shown.kind == PresentationKind::scored;
    presentations.push_back({{"trial", shown.trial},
                             {"block", shown.block},
                             {"kind", scored ? kScored : kLeadIn},
                             {"code", key.code_of(shown.stimulus)}});
  }
  // A picture stands for its class; the code of the class's first stimulus names it.
  json layout = json::array();
  for (const int class_index : schedule.layout) layout.push_back(key.code_of({class_index, 0, 0}));
  return json{{"presentations", presentations}, {"layout", layout}}.dump();
}

Schedule schedule_from_json(const std::string& text, const StudyKey& key) {
  const json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) refuse("is not JSON");
  try {
    return schedule_of(document, key);
  } catch (const json::exception&) {
    refuse("does not have the form of a schedule");
  }
}

}  // namespace touchtrial
