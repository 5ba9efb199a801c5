#include "protocols/threshold/study/threshold_section.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::study::threshold {
namespace {

using nlohmann::json;

constexpr auto kTaskNames = std::to_array<Named<Task>>(
    {{"detection", Task::detection}, {"discrimination", Task::discrimination}});
constexpr auto kQuestionNames =
    std::to_array<Named<Question>>({{"which-interval", Question::which_interval},
                                    {"odd-one-out", Question::odd_one_out},
                                    {"same-different", Question::same_different}});
constexpr auto kAlongNames = std::to_array<Named<Along>>({{"gain", Along::gain},
                                                          {"pitch", Along::pitch},
                                                          {"order", Along::order},
                                                          {"blend", Along::blend}});
constexpr auto kShapeNames =
    std::to_array<Named<procedures::Shape>>({{"weibull", procedures::Shape::weibull},
                                             {"logistic", procedures::Shape::logistic},
                                             {"normal", procedures::Shape::normal}});

constexpr std::size_t kMaxValues = 200;
constexpr NumberRange kLevelRange{-200.0, 40.0};
constexpr double kMaxTables = 20e6;  ///< numbers of all tracks' posteriors

/// A list, or {"from", "to", "step"}.
std::vector<double> read_values(const JsonValue& place, const NumberRange& range,
                                bool may_be_range) {
  std::vector<double> values;
  if (may_be_range && place.is_object()) {
    const JsonObject object = place.object({"from", "to", "step"});
    const double from = object.at("from").number(range);
    const double to = object.at("to").number(range);
    const double step = object.at("step").number({0.0, 1000.0, true});
    const double steps = std::floor((to - from) / step + 1e-9);
    if (to < from) place.refuse("must not end below its beginning; exchange from and to");
    if (steps >= static_cast<double>(kMaxValues)) {
      place.refuse(fmt::format("has more than {} values; give a larger step", kMaxValues));
    }
    for (int i = 0; i <= static_cast<int>(steps); ++i) values.push_back(from + i * step);
    return values;
  }
  for (const JsonValue& item : place.items(1, kMaxValues)) values.push_back(item.number(range));
  if (std::ranges::adjacent_find(values, std::greater_equal<>()) != values.end()) {
    place.refuse("must ascend, each value once; sort the list");
  }
  return values;
}

int read_count(const JsonValue& place, std::int64_t low, std::int64_t high) {
  return static_cast<int>(place.integer(low, high));
}

HandRange read_windows(const JsonValue& place) {
  const JsonObject object =
      place.object({"slowest_mm_s", "fastest_mm_s", "lightest_n", "strongest_n"});
  HandRange windows;
  const auto read = [&](std::string_view key, double& value, double most) {
    if (const auto member = object.find(key)) value = member->number({0.0, most});
  };
  read("slowest_mm_s", windows.slowest_mm_s, 1000.0);
  read("fastest_mm_s", windows.fastest_mm_s, 1000.0);
  read("lightest_n", windows.lightest_n, 100.0);
  read("strongest_n", windows.strongest_n, 100.0);
  if (windows.slowest_mm_s >= windows.fastest_mm_s) {
    place.refuse("has no speed between slowest_mm_s and fastest_mm_s; raise the second");
  }
  if (windows.lightest_n >= windows.strongest_n) {
    place.refuse("has no force between lightest_n and strongest_n; raise the second");
  }
  return windows;
}

void read_up_down(const JsonValue& place, procedures::TrackSettings& track) {
  const JsonObject object = place.object(
      {"correct_for_down", "wrong_for_up", "steps_down", "up_for_one_down", "first_level"});
  procedures::UpDown& rule = track.up_down;
  if (const auto m = object.find("correct_for_down")) rule.correct_for_down = read_count(*m, 1, 20);
  if (const auto m = object.find("wrong_for_up")) rule.wrong_for_up = read_count(*m, 1, 20);
  if (const auto m = object.find("up_for_one_down")) rule.up_for_one_down = read_count(*m, 1, 100);
  if (const auto m = object.find("steps_down")) {
    rule.steps_down.clear();
    for (const JsonValue& item : m->items(1, kMaxValues)) {
      rule.steps_down.push_back(read_count(item, 1, kMaxValues));
    }
  }
  if (const auto m = object.find("first_level")) {
    const double wanted = m->number(kLevelRange);
    const auto found = std::ranges::find_if(
        track.levels, [&](double level) { return std::abs(level - wanted) < 1e-9; });
    if (found == track.levels.end()) m->refuse("is none of the levels; give one of them");
    rule.first_level = static_cast<std::size_t>(found - track.levels.begin());
  }
}

void read_grid(const JsonValue& place, procedures::ParameterGrid& grid) {
  const JsonObject object = place.object({"shape", "thresholds", "slopes", "lapses"});
  if (const auto m = object.find("shape")) grid.shape = m->choice(kShapeNames);
  if (const auto m = object.find("thresholds")) {
    grid.thresholds = read_values(*m, kLevelRange, true);
  }
  if (const auto m = object.find("slopes")) {
    grid.slopes = read_values(*m, {0.0, 1000.0, true}, true);
  }
  if (const auto m = object.find("lapses")) {
    grid.lapses = read_values(*m, {0.0, 0.5, false, true}, true);
  }
}

void read_practice(const JsonValue& place, ThresholdOptions& options) {
  const JsonObject object = place.object({"trials", "criterion", "rounds"});
  options.practice_trials = read_count(object.at("trials"), 0, 100);
  options.practice_criterion = options.practice_trials;
  if (const auto m = object.find("criterion")) {
    options.practice_criterion = read_count(*m, 0, options.practice_trials);
  }
  if (const auto m = object.find("rounds")) options.practice_rounds = read_count(*m, 1, 10);
}

/// What the task makes of the question, before the other keys.
void settle_question(const JsonObject& object, ThresholdOptions& options) {
  const bool needs_three = options.question == Question::odd_one_out;
  const bool needs_two = options.question == Question::same_different;
  options.intervals = needs_three ? 3 : 2;
  if (const auto m = object.find("intervals")) {
    options.intervals = read_count(*m, 2, 3);
    if (needs_three && options.intervals != 3) m->refuse("must be 3 to find the odd one; set 3");
    if (needs_two && options.intervals != 2) m->refuse("must be 2 for same or different; set 2");
  }
  const auto along = object.find("along");
  if (options.task == Task::detection && options.along != Along::gain) {
    along->refuse(
        "must be \"gain\" for detection, which asks for the weakest texture that is "
        "felt; or choose the task discrimination");
  }
  const bool has_strength = options.along == Along::gain || options.along == Along::pitch;
  if (!has_strength && options.question == Question::which_interval) {
    along->refuse(
        "has no more or less that a participant could name; ask the question "
        "odd-one-out or same-different");
  }
}

void read_tracks(const JsonObject& object, ThresholdOptions& options) {
  procedures::TrackSettings& track = options.track;
  track.levels = read_values(object.at("levels"), kLevelRange, true);
  if (const auto m = object.find("procedure")) {
    std::vector<std::string_view> names;
    for (const auto& kind : procedures::procedure_kinds()) names.push_back(kind.name);
    track.procedure = names[m->choice(names)];
  }
  const bool is_constant = track.procedure == "constant-stimuli";
  if (options.question == Question::same_different && !is_constant) {
    object.at("question")
        .refuse(
            "has no fixed guess rate, which procedures that follow answers need; set /threshold/"
            "procedure to \"constant-stimuli\"");
  }
  if (const auto m = object.find("trials")) track.trials = read_count(*m, 1, 2000);
  if (const auto m = object.find("blocked")) track.blocked = m->truth();
  track.up_down.first_level = track.levels.size() - 1;
  if (track.procedure == "weighted-up-down") {
    track.up_down = {.correct_for_down = 1,
                     .wrong_for_up = 1,
                     .steps_down = {2, 1},
                     .up_for_one_down = 3,
                     .first_level = track.levels.size() - 1};
  }
  if (const auto m = object.find("up_down")) read_up_down(*m, track);
  procedures::ParameterGrid& grid = track.grid;
  grid.thresholds = track.levels;
  grid.slopes = {1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0};
  grid.lapses = {0.0, 0.01, 0.02, 0.03, 0.04, 0.05};
  if (const auto m = object.find("grid")) read_grid(*m, grid);
  grid.guess = 1.0 / options.intervals;
}

json values_json(const std::vector<double>& values) {
  return json(values);
}

}  // namespace

std::string_view name_of(Task task) {
  return name_in(kTaskNames, task);
}
std::string_view name_of(Question question) {
  return name_in(kQuestionNames, question);
}
std::string_view name_of(Along along) {
  return name_in(kAlongNames, along);
}
std::string_view name_of(procedures::Shape shape) {
  return name_in(kShapeNames, shape);
}

ThresholdOptions read_section(const JsonValue& section) {
  const JsonObject object =
      section.object({"task", "question", "along", "intervals", "interval_s", "windows",
                      "procedure", "trials", "tracks", "levels", "standards", "up_down", "blocked",
                      "grid", "catch", "rove_db", "feedback", "practice", "control"});
  ThresholdOptions options;
  options.task = object.at("task").choice(kTaskNames);
  if (const auto m = object.find("question")) options.question = m->choice(kQuestionNames);
  if (const auto m = object.find("along")) options.along = m->choice(kAlongNames);
  settle_question(object, options);
  if (const auto m = object.find("interval_s")) options.interval_s = m->number({0.25, 60.0});
  if (const auto m = object.find("windows")) options.windows = read_windows(*m);
  read_tracks(object, options);
  const bool has_standards = options.task == Task::discrimination &&
                             (options.along == Along::gain || options.along == Along::order);
  if (has_standards) {
    const NumberRange range =
        options.along == Along::gain ? NumberRange{-100.0, 0.0} : NumberRange{0.0, 1.0, true, true};
    options.standards = read_values(object.at("standards"), range, false);
  } else {
    options.standards = {0.0};
    if (const auto m = object.find("standards")) {
      m->refuse("belongs to discrimination along gain or order; remove it");
    }
  }
  if (const auto m = object.find("tracks")) options.tracks_each = read_count(*m, 1, 8);
  if (const auto m = object.find("catch")) options.catch_trials = read_count(*m, 0, 1000);
  if (const auto m = object.find("rove_db")) options.rove_db = m->number({0.0, 40.0});
  if (const auto m = object.find("feedback")) options.feedback = m->truth();
  if (const auto m = object.find("practice")) read_practice(*m, options);
  if (const auto m = object.find("control")) options.control_trials = read_count(*m, 0, 500);
  return options;
}

std::string section_json(const ThresholdOptions& o) {
  const procedures::TrackSettings& track = o.track;
  const json whole = {{"task", name_of(o.task)},
                      {"question", name_of(o.question)},
                      {"along", name_of(o.along)},
                      {"intervals", o.intervals},
                      {"interval_s", o.interval_s},
                      {"windows",
                       {{"slowest_mm_s", o.windows.slowest_mm_s},
                        {"fastest_mm_s", o.windows.fastest_mm_s},
                        {"lightest_n", o.windows.lightest_n},
                        {"strongest_n", o.windows.strongest_n}}},
                      {"procedure", track.procedure},
                      {"trials", track.trials},
                      {"tracks", o.tracks_each},
                      {"levels", values_json(track.levels)},
                      {"standards", values_json(o.standards)},
                      {"up_down",
                       {{"correct_for_down", track.up_down.correct_for_down},
                        {"wrong_for_up", track.up_down.wrong_for_up},
                        {"steps_down", track.up_down.steps_down},
                        {"up_for_one_down", track.up_down.up_for_one_down},
                        {"first_level", track.levels[track.up_down.first_level]}}},
                      {"blocked", track.blocked},
                      {"grid",
                       {{"shape", name_in(kShapeNames, track.grid.shape)},
                        {"thresholds", values_json(track.grid.thresholds)},
                        {"slopes", values_json(track.grid.slopes)},
                        {"lapses", values_json(track.grid.lapses)}}},
                      {"catch", o.catch_trials},
                      {"rove_db", o.rove_db},
                      {"feedback", o.feedback},
                      {"practice",
                       {{"trials", o.practice_trials},
                        {"criterion", o.practice_criterion},
                        {"rounds", o.practice_rounds}}},
                      {"control", o.control_trials}};
  return whole.dump();
}

void check_section(const JsonValue& file, const Study& study) {
  const ThresholdOptions& options = options_of(study);
  const auto refuse = [&](const std::string& key, const std::string& what) {
    file.refuse_below("/threshold" + key, what);
  };
  const std::vector<Standard> standards = standards_of(study);
  const auto tracks = standards.size() * static_cast<std::size_t>(options.tracks_each);
  if (tracks > procedures::kMaxTracks) {
    refuse("/tracks", fmt::format("makes {} tracks for a participant, more than {}; give fewer "
                                  "classes, standards or tracks",
                                  tracks, procedures::kMaxTracks));
  }
  for (const Standard& standard : standards) {
    const std::size_t own = levels_of(options, standard).size();
    const bool may_clip = options.task == Task::discrimination;
    if (own < (may_clip ? 1 : options.track.levels.size())) {
      refuse("/levels",
             fmt::format("exceed the pack's gain, the stiffness ceiling, for {}{}; lower "
                         "them{}",
                         words_of(study, standard), options.rove_db > 0.0 ? " with its rove" : "",
                         may_clip ? " or the standard" : ""));
    }
    const double most = comparison_at(options, standard, options.track.levels.back());
    if (options.along == Along::order && most >= 1.0) {
      refuse("/levels", fmt::format("reach order {:.3f}; orders are below 1: lower the highest "
                                    "level or the standard",
                                    most));
    }
    if (options.along == Along::blend && most > 1.0 + 1e-9) {
      refuse("/levels", "reach more than the whole of the second texture; end at 0 dB");
    }
    if (options.along == Along::pitch && most > 10.0) {
      refuse("/levels", "reach more than ten times the pitch; lower the highest level");
    }
  }
  const double tables = 2.0 * static_cast<double>(tracks) *
                        static_cast<double>(options.track.levels.size()) *
                        static_cast<double>(options.track.grid.thresholds.size()) *
                        static_cast<double>(options.track.grid.slopes.size()) *
                        static_cast<double>(options.track.grid.lapses.size());
  if (tables > kMaxTables) {
    refuse("/grid", fmt::format("needs tables of {:.0f} million numbers for all tracks, more than "
                                "{:.0f}; give fewer levels or values",
                                tables / 1e6, kMaxTables / 1e6));
  }
  try {
    static_cast<void>(procedures::Block(block_settings(study), Digest{}));
  } catch (const std::invalid_argument& error) {
    refuse("", std::string(error.what()) + "; change the section's numbers");
  }
  if (options.along == Along::blend && study.classes.size() != 2) {
    file.refuse_below("/classes", "must be two textures, of which one is blended into the other");
  }
  if (options.along == Along::blend) {
    const auto mixtures = study.classes.front().images.size() * study.classes.back().images.size() *
                          options.track.levels.size();
    if (mixtures > kMaxValues) {
      refuse("/levels", fmt::format("and images make {} mixtures, more than {}; give fewer",
                                    mixtures, kMaxValues));
    }
  }
  if (study.level) {
    file.refuse_below("/rendering/gains",
                      "states a level, which a threshold study is there to find; give \"budget\", "
                      "the largest gains");
  }
  if (study.rendering.reference_grey != 128.0) {
    file.refuse_below("/rendering/reference_grey",
                      "must be 128: with another one the wall of a texture lies elsewhere than the "
                      "blank one, which could be felt");
  }
  const TrialOptions& trials = study.trials;
  const auto refuse_trials = [&](const std::string& key, const std::string& what) {
    file.refuse_below("/trials" + key, what);
  };
  if (trials.practice > 0) {
    refuse_trials("/practice", "belongs to studies with pictures; use /threshold/practice");
  }
  if (trials.catch_trials > 0) {
    refuse_trials("/catch", "belongs to other protocols; use /threshold/catch");
  }
  if (trials.rove_db > 0.0) {
    refuse_trials("/rove_db", "belongs to other protocols; use /threshold/rove_db");
  }
  if (trials.lead_in > 0) refuse_trials("/lead_in", "must be 0: a track has no lead-in");
  if (trials.on_interruption != OnInterruption::repeat) {
    refuse_trials("/on_interruption",
                  "must be \"repeat\": a track needs every answer that it asks for");
  }
  if (trials.on_timeout != OnTimeout::fade) {
    refuse_trials("/on_timeout",
                  "must be \"fade\": a trial whose interval takes too long comes "
                  "again");
  }
  if (trials.explore_limit_s < options.interval_s) {
    refuse_trials("/explore_limit_s",
                  fmt::format("is shorter than an interval, {} s; raise it, for instance to four "
                              "times that",
                              options.interval_s));
  }
}

}  // namespace touchtrial::study::threshold
