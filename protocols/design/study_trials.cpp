/// The study file's "trials".
#include "protocols/design/study_names.hpp"
#include "protocols/design/study_sections.hpp"

namespace touchtrial::design {
namespace {

void read_count(const JsonObject& object, std::string_view key, int low, int high, int& count) {
  if (const auto member = object.find(key)) count = static_cast<int>(member->integer(low, high));
}

/// What becomes of what was broken off.
void read_resumption(const JsonObject& object, TrialOptions& options) {
  constexpr double kYear_h = 8760.0;
  if (const auto member = object.find("on_interruption")) {
    options.on_interruption = member->choice(kOnInterruptionNames);
  }
  if (const auto member = object.find("resume_within_h")) {
    options.resume_within_h = member->number({.low = 0.0, .high = kYear_h, .open_low = true});
  }
}

}  // namespace

TrialOptions read_trials(const JsonValue& place) {
  const JsonObject object =
      place.object({"repeats", "order", "explore_limit_s", "on_timeout", "practice", "break_every",
                    "catch", "lead_in", "blocks", "max_run", "on_interruption", "resume_within_h"});
  TrialOptions options;
  read_count(object, "repeats", 1, 1000, options.repeats);
  read_count(object, "break_every", 0, 10'000, options.break_every);
  read_count(object, "practice", 0, 100, options.practice);
  read_count(object, "catch", 0, 1000, options.catch_trials);
  read_count(object, "lead_in", 0, 100, options.lead_in);
  read_count(object, "max_run", 0, kMaxScoredTrials, options.max_run);
  if (const auto member = object.find("explore_limit_s")) {
    options.explore_limit_s = member->number({.low = 0.0, .high = 3600.0, .open_low = true});
  }
  if (const auto member = object.find("order")) options.order = member->choice(kTrialOrderNames);
  if (const auto member = object.find("on_timeout")) {
    options.on_timeout = member->choice(kOnTimeoutNames);
  }
  if (const auto member = object.find("blocks")) options.blocks = member->choice(kBlocksNames);
  read_resumption(object, options);
  return options;
}

nlohmann::json to_json(const TrialOptions& trials) {
  nlohmann::json text = {{"repeats", trials.repeats},
                         {"order", word_for(kTrialOrderNames, trials.order)},
                         {"explore_limit_s", trials.explore_limit_s},
                         {"on_timeout", word_for(kOnTimeoutNames, trials.on_timeout)},
                         {"practice", trials.practice},
                         {"break_every", trials.break_every},
                         {"catch", trials.catch_trials},
                         {"lead_in", trials.lead_in},
                         {"blocks", word_for(kBlocksNames, trials.blocks)}};
  const TrialOptions usual;
  if (trials.max_run != usual.max_run) text["max_run"] = trials.max_run;
  if (trials.on_interruption != usual.on_interruption) {
    text["on_interruption"] = word_for(kOnInterruptionNames, trials.on_interruption);
  }
  if (trials.resume_within_h != usual.resume_within_h) {
    text["resume_within_h"] = trials.resume_within_h;
  }
  return text;
}

}  // namespace touchtrial::design
