/// The study file's "trials".
#include "protocols/design/study_names.hpp"
#include "protocols/design/study_sections.hpp"

namespace touchtrial {
namespace {

void read_count(const JsonObject& object, std::string_view key, int low, int high, int& count) {
  if (const auto member = object.find(key)) count = static_cast<int>(member->integer(low, high));
}

/// A feature that the format foresees and this version does not have.
void require_zero(const JsonObject& object, std::string_view key) {
  const auto member = object.find(key);
  if (!member || member->integer(0, 1000) == 0) return;
  member->refuse("must be 0: this version has no " + std::string(key) + " trials");
}

}  // namespace

TrialOptions read_trials(const JsonValue& place) {
  const JsonObject object = place.object({"repeats", "order", "explore_limit_s", "on_timeout",
                                          "practice", "break_every", "catch", "lead_in", "blocks"});
  require_zero(object, "practice");
  require_zero(object, "catch");
  TrialOptions options;
  read_count(object, "repeats", 1, 1000, options.repeats);
  read_count(object, "break_every", 0, 10'000, options.break_every);
  read_count(object, "lead_in", 0, 100, options.lead_in);
  if (const auto member = object.find("explore_limit_s")) {
    options.explore_limit_s = member->number({.low = 0.0, .high = 3600.0, .open_low = true});
  }
  if (const auto member = object.find("order")) options.order = member->choice(kTrialOrderNames);
  if (const auto member = object.find("on_timeout")) {
    options.on_timeout = member->choice(kOnTimeoutNames);
  }
  if (const auto member = object.find("blocks")) options.blocks = member->choice(kBlocksNames);
  return options;
}

nlohmann::json to_json(const TrialOptions& trials) {
  return {{"repeats", trials.repeats},
          {"order", word_for(kTrialOrderNames, trials.order)},
          {"explore_limit_s", trials.explore_limit_s},
          {"on_timeout", word_for(kOnTimeoutNames, trials.on_timeout)},
          {"practice", trials.practice},
          {"break_every", trials.break_every},
          {"catch", trials.catch_trials},
          {"lead_in", trials.lead_in},
          {"blocks", word_for(kBlocksNames, trials.blocks)}};
}

}  // namespace touchtrial
