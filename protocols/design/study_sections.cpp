/// \file The study file's "classes", "trials" and "practice".
#include "protocols/design/study_sections.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::design {
namespace {

constexpr std::size_t kLongestLabel = 64;   // bytes
constexpr std::size_t kLongestPath = 1024;  // bytes

std::string read_label(const JsonValue& place) {
  const std::string& label = place.text();
  if (label.empty()) place.refuse("is empty; give the class a label");
  if (label.size() > kLongestLabel) {
    place.refuse("has " + std::to_string(label.size()) + " bytes, must have at most " +
                 std::to_string(kLongestLabel) + "; shorten it");
  }
  if (has_control_character(label)) place.refuse("has a control character; remove it");
  if (label.front() == ' ' || label.back() == ' ') {
    place.refuse("begins or ends with a blank; remove it");
  }
  return label;
}

std::string read_image(const JsonValue& place) {
  const std::string& path = place.text();
  if (path.empty()) place.refuse("is empty; give the path of an image");
  if (path.size() > kLongestPath) {
    place.refuse("is longer than " + std::to_string(kLongestPath) + " bytes; shorten the path");
  }
  if (has_control_character(path)) place.refuse("has a control character; rename the image");
  return path;
}

std::vector<std::filesystem::path> read_images(const JsonValue& place, std::size_t most) {
  std::vector<std::filesystem::path> images;
  std::set<std::string> seen;
  for (const JsonValue& item : place.items(1, most)) {
    const std::string path = read_image(item);
    if (!seen.insert(path).second) {
      item.refuse(in_quotes(path) + " is there twice; list each image of a class once");
    }
    images.emplace_back(path);
  }
  return images;
}

void read_count(const JsonObject& object, std::string_view key, int low, int high, int& count) {
  if (const auto member = object.find(key)) count = static_cast<int>(member->integer(low, high));
}

/// Reads what follows an interrupted presentation, and how long a session can be resumed.
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

std::vector<StudyClass> read_classes(const JsonValue& place, std::size_t most_images) {
  std::vector<StudyClass> classes;
  for (const JsonValue& item : place.items(2, kMaxClasses)) {
    const JsonObject object = item.object({"label", "images"});
    StudyClass study_class{read_label(object.at("label")),
                           read_images(object.at("images"), most_images)};
    const bool taken = std::any_of(classes.begin(), classes.end(), [&](const StudyClass& other) {
      return other.label == study_class.label;
    });
    if (taken) {
      object.at("label").refuse(in_quotes(study_class.label) +
                                " is the label of another class; labels must be unique");
    }
    classes.push_back(std::move(study_class));
  }
  return classes;
}

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

PracticePlan read_practice(const JsonValue& place) {
  const JsonObject object = place.object({"classes", "criterion", "rounds"});
  PracticePlan practice;
  practice.classes = read_classes(object.at("classes"), 1);
  if (const auto member = object.find("criterion")) {
    practice.criterion = static_cast<int>(member->integer(0, 100));
  }
  if (const auto member = object.find("rounds")) {
    practice.rounds = static_cast<int>(member->integer(1, 10));
  }
  return practice;
}

nlohmann::json to_json(const PracticePlan& practice) {
  nlohmann::json classes = nlohmann::json::array();
  for (const StudyClass& shown : practice.classes) {
    classes.push_back({{"label", shown.label}, {"images", {shown.images.front().string()}}});
  }
  return {{"classes", classes}, {"criterion", practice.criterion}, {"rounds", practice.rounds}};
}

}  // namespace touchtrial::design
