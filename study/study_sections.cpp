/// \file The study file's "classes", "trials", "practice", "visits" and "groups".
#include "study/study_sections.hpp"

#include "core/labels.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::study {
namespace {

constexpr std::size_t kLongestPath = 1024;  // bytes

std::string read_label(const JsonValue& place) {
  const std::string& label = place.text();
  const std::string fault = fault_of_label(label);
  if (!fault.empty()) place.refuse(fault + "; give another label");
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

namespace {

void read_bound(const JsonObject& object, std::string_view key, double high, double& bound) {
  if (const auto member = object.find(key)) bound = member->number({.low = 0.0, .high = high});
}

constexpr double kLongest_s = 3600.0;
constexpr double kLongest_mm = 1e6;

ValidityRule read_validity(const JsonValue& place) {
  constexpr double kLargest_n = 100.0;
  const JsonObject object = place.object({"exploring_s", "contact_s", "path_mm", "least_median_n",
                                          "largest_median_n", "saturated_share"});
  ValidityRule rule;
  read_bound(object, "exploring_s", kLongest_s, rule.least_exploring_s);
  read_bound(object, "contact_s", kLongest_s, rule.least_contact_s);
  read_bound(object, "path_mm", kLongest_mm, rule.least_path_mm);
  read_bound(object, "least_median_n", kLargest_n, rule.least_median_n);
  read_bound(object, "largest_median_n", kLargest_n, rule.largest_median_n);
  if (const auto member = object.find("saturated_share")) {
    rule.saturated_share = member->number({.low = 0.0, .high = 1.0, .open_low = true});
  }
  return rule;
}

LeastTouch read_least_touch(const JsonValue& place) {
  const JsonObject object = place.object({"contact_s", "path_mm"});
  LeastTouch touch;
  read_bound(object, "contact_s", kLongest_s, touch.contact_s);
  read_bound(object, "path_mm", kLongest_mm, touch.path_mm);
  return touch;
}

}  // namespace

void refuse_same_label(const JsonValue& place, const std::string& label, const std::string& other,
                       const std::string& of) {
  if (label == other) {
    place.refuse(in_quotes(label) + " is the label of another " + of + "; labels must be unique");
  }
  if (skeleton_of(label) == skeleton_of(other)) {
    place.refuse(in_quotes(label) + " and " + in_quotes(other) +
                 " look alike; give one of them another name");
  }
}

std::vector<StudyClass> read_classes(const JsonValue& place, int fewest, std::size_t most_images) {
  std::vector<StudyClass> classes;
  for (const JsonValue& item : place.items(static_cast<std::size_t>(fewest), kMaxClasses)) {
    const JsonObject object = item.object({"label", "images"});
    StudyClass study_class{read_label(object.at("label")),
                           read_images(object.at("images"), most_images)};
    for (const StudyClass& other : classes) {
      refuse_same_label(object.at("label"), study_class.label, other.label, "class");
    }
    classes.push_back(std::move(study_class));
  }
  return classes;
}

TrialOptions read_trials(const JsonValue& place) {
  const JsonObject object =
      place.object({"repeats", "order", "explore_limit_s", "on_timeout", "practice", "break_every",
                    "break_after_min", "catch", "lead_in", "blocks", "max_run", "rove_db",
                    "on_interruption", "resume_within_h", "validity", "answer_after"});
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
  if (const auto member = object.find("rove_db")) options.rove_db = member->number({0.0, 40.0});
  if (const auto member = object.find("break_after_min")) {
    options.break_after_min = member->number({0.0, 240.0});
  }
  if (const auto member = object.find("order")) options.order = member->choice(kTrialOrderNames);
  if (const auto member = object.find("on_timeout")) {
    options.on_timeout = member->choice(kOnTimeoutNames);
  }
  if (const auto member = object.find("blocks")) options.blocks = member->choice(kBlocksNames);
  read_resumption(object, options);
  if (const auto member = object.find("validity")) options.validity = read_validity(*member);
  if (const auto member = object.find("answer_after")) {
    options.answer_after = read_least_touch(*member);
  }
  return options;
}

nlohmann::json to_json(const TrialOptions& trials) {
  nlohmann::json text = {{"repeats", trials.repeats},
                         {"order", name_in(kTrialOrderNames, trials.order)},
                         {"explore_limit_s", trials.explore_limit_s},
                         {"on_timeout", name_in(kOnTimeoutNames, trials.on_timeout)},
                         {"practice", trials.practice},
                         {"break_every", trials.break_every},
                         {"catch", trials.catch_trials},
                         {"lead_in", trials.lead_in},
                         {"blocks", name_in(kBlocksNames, trials.blocks)}};
  const TrialOptions usual;
  if (trials.max_run != usual.max_run) text["max_run"] = trials.max_run;
  if (trials.rove_db != usual.rove_db) text["rove_db"] = trials.rove_db;
  if (trials.break_after_min != usual.break_after_min) {
    text["break_after_min"] = trials.break_after_min;
  }
  if (trials.on_interruption != usual.on_interruption) {
    text["on_interruption"] = name_in(kOnInterruptionNames, trials.on_interruption);
  }
  if (trials.resume_within_h != usual.resume_within_h) {
    text["resume_within_h"] = trials.resume_within_h;
  }
  if (const ValidityRule& rule = trials.validity; rule != usual.validity) {
    text["validity"] = {{"exploring_s", rule.least_exploring_s},
                        {"contact_s", rule.least_contact_s},
                        {"path_mm", rule.least_path_mm},
                        {"least_median_n", rule.least_median_n},
                        {"largest_median_n", rule.largest_median_n},
                        {"saturated_share", rule.saturated_share}};
  }
  if (const LeastTouch& touch = trials.answer_after; touch != usual.answer_after) {
    text["answer_after"] = {{"contact_s", touch.contact_s}, {"path_mm", touch.path_mm}};
  }
  return text;
}

PracticePlan read_practice(const JsonValue& place) {
  const JsonObject object = place.object({"classes", "criterion", "rounds"});
  PracticePlan practice;
  practice.classes = read_classes(object.at("classes"), 2, 1);
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

VisitPlan read_visits(const JsonValue& place) {
  constexpr double kMaxDays = 3650.0;
  const JsonObject object = place.object({"count", "least_days", "most_days", "methods"});
  VisitPlan visits;
  visits.count = static_cast<int>(object.at("count").integer(2, 100));
  if (const auto member = object.find("least_days")) {
    visits.least_days = member->number({.low = 0.0, .high = kMaxDays});
  }
  if (const auto member = object.find("most_days")) {
    visits.most_days = member->number({.low = 0.0, .high = kMaxDays, .open_low = true});
    if (*visits.most_days < visits.least_days) {
      member->refuse("is less than \"least_days\", so that no visit could come; raise it");
    }
  }
  if (const auto member = object.find("methods")) {
    visits.methods = member->choice(kVisitMethodsNames);
  }
  return visits;
}

nlohmann::json to_json(const VisitPlan& visits) {
  nlohmann::json text = {{"count", visits.count},
                         {"least_days", visits.least_days},
                         {"methods", name_in(kVisitMethodsNames, visits.methods)}};
  if (visits.most_days) text["most_days"] = *visits.most_days;
  return text;
}

GroupPlan read_groups(const JsonValue& place) {
  constexpr std::size_t kMaxGroups = 16;
  const JsonObject object = place.object({"labels", "open"});
  GroupPlan groups;
  for (const JsonValue& item : object.at("labels").items(2, kMaxGroups)) {
    std::string label = read_plain_name(item);
    if (std::ranges::count(groups.labels, label) > 0) {
      item.refuse(in_quotes(label) + " is the label of another group; labels must be unique");
    }
    groups.labels.push_back(std::move(label));
  }
  if (const auto member = object.find("open")) groups.open = member->truth();
  return groups;
}

nlohmann::json to_json(const GroupPlan& groups) {
  return {{"labels", groups.labels}, {"open", groups.open}};
}

}  // namespace touchtrial::study
