#include "protocols/threshold/study/threshold_section.hpp"

#include "core/text.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::study::threshold {
namespace {

constexpr auto kTaskNames = std::to_array<Named<Task>>(
    {{"detection", Task::detection}, {"discrimination", Task::discrimination}});
constexpr auto kQuestionNames =
    std::to_array<Named<Question>>({{"which-interval", Question::which_interval},
                                    {"odd-one-out", Question::odd_one_out},
                                    {"same-different", Question::same_different}});
constexpr auto kAlongNames = std::to_array<Named<LevelQuantity>>({{"gain", LevelQuantity::gain},
                                                                  {"pitch", LevelQuantity::pitch},
                                                                  {"order", LevelQuantity::order},
                                                                  {"blend", LevelQuantity::blend}});
constexpr auto kShapeNames =
    std::to_array<Named<procedures::Shape>>({{"weibull", procedures::Shape::weibull},
                                             {"logistic", procedures::Shape::logistic},
                                             {"normal", procedures::Shape::normal}});

constexpr std::size_t kMaxValues = 200;
constexpr NumberRange kLevelRange{-200.0, 40.0};
constexpr double kMaxTables = 20e6;  ///< maximum size of all tracks' posterior tables

void describe_list(ValueIo& io, std::vector<double>& values, const NumberRange& range) {
  io.list(values, {.min = 1, .max = kMaxValues},
          [&range](ValueIo& item, double& value) { item.number(value, range); });
  io.rule([&values](const JsonValue& place) {
    if (std::ranges::adjacent_find(values, std::greater_equal<>()) != values.end()) {
      place.refuse("must be ascending without duplicates; sort the list");
    }
  });
}

/// Describes an object {"from", "to", "step"} that stands for the values from, from + step, ..
void describe_steps(ObjectIo& io, std::vector<double>& values, const NumberRange& range) {
  double from = 0.0;
  double to = 0.0;
  double step = 0.0;
  io.number("from", from, range, {.meaning = "first value", .required = true});
  io.number("to", to, range, {.meaning = "largest possible value", .required = true});
  io.number("step", step, {0.0, 1000.0, true},
            {.meaning = "distance between values", .required = true});
  io.rule([&](const JsonValue& place, const JsonObject& /*object*/) {
    const double steps = std::floor((to - from) / step + 1e-9);
    if (to < from) place.refuse("has \"to\" less than \"from\"; swap them");
    if (steps >= static_cast<double>(kMaxValues)) {
      place.refuse(fmt::format("has more than {} values; use a larger step", kMaxValues));
    }
    values.clear();
    for (int i = 0; i <= static_cast<int>(steps); ++i) values.push_back(from + i * step);
  });
}

/// Describes values as a list, or as {"from", "to", "step"}.
void describe_values(ObjectIo& io, std::string_view key, std::vector<double>& values,
                     const NumberRange& range, const KeyInfo& info) {
  io.member(key, info, true, [&](ValueIo& value) {
    const ValueIo::Form forms[] = {
        {[](const JsonValue& place) { return place.is_object(); },
         [&](ValueIo& one) {
           one.object([&](ObjectIo& keys) { describe_steps(keys, values, range); });
         }},
        {{}, [&](ValueIo& one) { describe_list(one, values, range); }}};
    value.one_of(1, forms);
  });
}

void describe_windows(ObjectIo& io, HandRange& windows) {
  constexpr NumberRange kSpeed{0.0, 1000.0};
  constexpr NumberRange kForce{0.0, 100.0};
  io.number("slowest_mm_s", windows.slowest_mm_s, kSpeed, {"minimum speed along the plane"});
  io.number("fastest_mm_s", windows.fastest_mm_s, kSpeed, {"maximum speed along the plane"});
  io.number("lightest_n", windows.lightest_n, kForce, {"minimum force normal to the plane"});
  io.number("strongest_n", windows.strongest_n, kForce, {"maximum force normal to the plane"});
  io.rule([&windows](const JsonValue& place, const JsonObject& /*object*/) {
    if (windows.slowest_mm_s >= windows.fastest_mm_s) {
      place.refuse("has fastest_mm_s not above slowest_mm_s; raise fastest_mm_s");
    }
    if (windows.lightest_n >= windows.strongest_n) {
      place.refuse("has strongest_n not above lightest_n; raise strongest_n");
    }
  });
}

void describe_first_level(ObjectIo& io, procedures::TrackSettings& track) {
  std::optional<double> first_level;
  if (!track.levels.empty()) first_level = track.levels[track.up_down.first_level];
  io.number(
      "first_level", first_level, kLevelRange,
      {.meaning = "level of the first trial, one of the levels", .default_text = "the highest"});
  io.rule([&](const JsonValue& place, const JsonObject& object) {
    if (!object.find("first_level")) return;
    const auto found = std::ranges::find_if(
        track.levels, [&](double level) { return std::abs(level - *first_level) < 1e-9; });
    if (found == track.levels.end()) {
      place.refuse_below("/first_level", "is not one of the levels; use one of them");
    }
    track.up_down.first_level = static_cast<std::size_t>(found - track.levels.begin());
  });
}

void describe_up_down(ObjectIo& io, procedures::TrackSettings& track) {
  procedures::UpDown& rule = track.up_down;
  io.integer("correct_for_down", rule.correct_for_down, 1, 20,
             {"right answers in a row that lower the level"});
  io.integer("wrong_for_up", rule.wrong_for_up, 1, 20, {"wrong answers in a row that raise it"});
  io.list("steps_down", rule.steps_down, {.min = 1, .max = kMaxValues},
          {"in steps of the list of levels: the next entry after each reversal, then the last one"},
          [](ValueIo& item, int& step) { item.integer(step, 1, kMaxValues); });
  io.integer("up_for_one_down", rule.up_for_one_down, 1, 100, {"size of a step up, in steps down"});
  describe_first_level(io, track);
}

void describe_grid(ObjectIo& io, procedures::ParameterGrid& grid) {
  io.choice("shape", grid.shape, kShapeNames, {"shape of the psychometric function"});
  describe_values(io, "thresholds", grid.thresholds, kLevelRange,
                  {.meaning = "thresholds, ascending", .default_text = "the levels"});
  describe_values(io, "slopes", grid.slopes, {0.0, 1000.0, true}, {"slopes, ascending"});
  describe_values(io, "lapses", grid.lapses, {0.0, 0.5, false, true}, {"lapse rates, ascending"});
}

void describe_practice(ObjectIo& io, ThresholdOptions& options) {
  io.integer("trials", options.practice_trials, 0, 100,
             {.meaning = "trials per round; 0: no practice", .required = true});
  io.rule([&options](const JsonValue& /*place*/, const JsonObject& /*object*/) {
    options.practice_criterion = options.practice_trials;
  });
  io.integer("criterion", options.practice_criterion, 0, 100,
             {.meaning = "right answers in a round that end practice, at most `trials`",
              .default_text = "all"});
  io.rule([&options](const JsonValue& place, const JsonObject& /*object*/) {
    if (options.practice_criterion <= options.practice_trials) return;
    place.refuse_below("/criterion",
                       fmt::format("is {}, must be from 0 to {}", options.practice_criterion,
                                   options.practice_trials));
  });
  io.integer("rounds", options.practice_rounds, 1, 10, {"maximum number of rounds"});
}

void describe_question(ObjectIo& io, ThresholdOptions& options) {
  io.choice("task", options.task, kTaskNames,
            {.meaning = "`detection`: a texture or the same wall without it; `discrimination`: a "
                        "standard or a comparison",
             .required = true});
  io.choice("question", options.question, kQuestionNames,
            {"`which-interval`: which plane had the texture, or was stronger or coarser; "
             "`odd-one-out`: which of three planes differs from the others (each kind is odd "
             "equally often); `same-different`: whether two planes are alike (they differ in half "
             "of the trials; constant stimuli only)"});
  io.choice("along", options.along, kAlongNames, {"the quantity that differs"});
  io.rule([&options](const JsonValue& /*place*/, const JsonObject& /*object*/) {
    options.intervals = options.question == Question::odd_one_out ? 3 : 2;
  });
  io.integer("intervals", options.intervals, 2, 3,
             {.meaning = "planes per trial", .default_text = "2 (odd one out: 3)"});
  io.rule([&options](const JsonValue& place, const JsonObject& /*object*/) {
    if (options.question == Question::odd_one_out && options.intervals != 3) {
      place.refuse_below("/intervals", "must be 3 for the question odd-one-out");
    }
    if (options.question == Question::same_different && options.intervals != 2) {
      place.refuse_below("/intervals", "must be 2 for the question same-different");
    }
    if (options.task == Task::detection && options.along != LevelQuantity::gain) {
      place.refuse_below("/along",
                         "must be \"gain\" for the task detection; set it, or choose the task "
                         "discrimination");
    }
    const bool has_strength =
        options.along == LevelQuantity::gain || options.along == LevelQuantity::pitch;
    if (!has_strength && options.question == Question::which_interval) {
      place.refuse_below("/along",
                         "has no direction, which the question which-interval needs; use the "
                         "question odd-one-out or same-different");
    }
  });
}

/// Sets the defaults that depend on procedure and levels.
void set_procedure_defaults(ThresholdOptions& options) {
  procedures::TrackSettings& track = options.track;
  track.up_down.first_level = track.levels.size() - 1;
  if (track.procedure == "weighted-up-down") {
    track.up_down = {.correct_for_down = 1,
                     .wrong_for_up = 1,
                     .steps_down = {2, 1},
                     .up_for_one_down = 3,
                     .first_level = track.levels.size() - 1};
  }
  track.grid.thresholds = track.levels;
  track.grid.guess = 1.0 / options.intervals;
}

void describe_procedure(ObjectIo& io, ThresholdOptions& options) {
  procedures::TrackSettings& track = options.track;
  std::vector<std::string_view> names;
  for (const auto& kind : procedures::procedure_kinds()) names.push_back(kind.name);
  auto index = static_cast<std::size_t>(std::ranges::find(names, track.procedure) - names.begin());
  io.member("procedure", {"the rule that chooses the next level: [procedures](#procedures)"}, true,
            [&](ValueIo& value) { value.choice(index, names); });
  track.procedure = names.at(index);
  io.rule([&](const JsonValue& place, const JsonObject& /*object*/) {
    if (options.question == Question::same_different && track.procedure != "constant-stimuli") {
      place.refuse_below("/question",
                         "has no fixed guess rate, which adaptive procedures need; set "
                         "/threshold/procedure to \"constant-stimuli\"");
    }
    set_procedure_defaults(options);
  });
  io.integer("trials", track.trials, 1, 2000, {"trials per track"});
  io.integer("tracks", options.tracks_each, 1, 8,
             {"tracks for each class and standard, interleaved; at most 8 in total"});
  io.boolean("blocked", track.blocked,
             {"constant stimuli only: all trials of a level in succession"});
  io.part("up_down", track, {"for staircases"}, describe_up_down);
  if (track.grid.slopes.empty()) {
    track.grid.slopes = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};
    track.grid.lapses = {0.0, 0.02, 0.05, 0.1, 0.15, 0.2};
  }
  io.part("grid", track.grid, {"the possible observers, with equal prior probabilities"},
          describe_grid);
}

void describe_standards(ObjectIo& io, ThresholdOptions& options) {
  const bool is_order = options.along == LevelQuantity::order;
  const bool has_standards =
      options.task == Task::discrimination && (options.along == LevelQuantity::gain || is_order);
  NumberRange range{-100.0, 1.0};
  if (has_standards) {
    range = is_order ? NumberRange{0.0, 1.0, true, true} : NumberRange{-100.0, 0.0};
  }
  io.rule([&](const JsonValue& /*place*/, const JsonObject& object) {
    if (has_standards) {
      static_cast<void>(object.at("standards"));
      return;
    }
    options.standards = {0.0};
    if (const auto standards = object.find("standards")) {
      standards->refuse("belongs to discrimination along gain or order; remove it");
    }
  });
  io.member("standards",
            {.meaning = "the standards, ascending; required for discrimination along gain (dB re "
                        "the pack's gain, at most 0) or order (between 0 and 1)",
             .default_text = "none"},
            true, [&](ValueIo& value) { describe_list(value, options.standards, range); });
}

void describe(ObjectIo& io, ThresholdOptions& options) {
  describe_question(io, options);
  describe_values(io, "levels", options.track.levels, kLevelRange,
                  {.meaning = "all levels that can be presented, ascending: [levels](#levels)",
                   .required = true,
                   .unit = "dB"});
  describe_standards(io, options);
  describe_procedure(io, options);
  io.number("interval_s", options.interval_s, {0.25, 60.0},
            {"exploration of each plane: [intervals](#intervals)"});
  io.part("windows", options.windows, {"the hand movement required for an interval's clock to run"},
          describe_windows);
  io.integer(
      "catch", options.catch_trials, 0, 1000,
      {"trials at the highest level, divided evenly among the tracks: [catch trials](#tracks)"});
  io.number("rove_db", options.rove_db, {0.0, 40.0},
            {"width of the range from which each interval's gain is drawn: centred on the level "
             "along gain, else below the maximum gain"});
  io.boolean("feedback", options.feedback,
             {"whether participants see after each answer if it was right"});
  io.part("practice", options,
          {.meaning = "rounds at the highest level, with feedback, before the first trial",
           .default_text = "none"},
          describe_practice);
  io.integer("control", options.control_trials, 0, 500,
             {"trials at the end with the hand off the device, so that it can only be heard"});
}

}  // namespace

std::string_view name_of(Task task) {
  return name_in(kTaskNames, task);
}
std::string_view name_of(Question question) {
  return name_in(kQuestionNames, question);
}
std::string_view name_of(LevelQuantity along) {
  return name_in(kAlongNames, along);
}
std::string_view name_of(procedures::Shape shape) {
  return name_in(kShapeNames, shape);
}

ThresholdOptions read_section(const JsonValue& section) {
  ThresholdOptions options;
  read_settings(section, [&options](ObjectIo& io) { describe(io, options); });
  return options;
}

std::string section_json(const ThresholdOptions& options) {
  ThresholdOptions copy = options;
  return written_section([&copy](ObjectIo& io) { describe(io, copy); }, [](ObjectIo& /*io*/) {})
      .dump();
}

std::string section_schema() {
  ThresholdOptions defaults;
  return annotated_section({.meaning = "what is compared, at which levels, by which procedure: "
                                       "[thresholds.md](thresholds.md)",
                            .default_text = "required by `threshold`"},
                           [&defaults](ObjectIo& io) { describe(io, defaults); });
}

void check_section(const JsonValue& file, const Study& study) {
  const ThresholdOptions& options = options_of(study);
  const auto refuse = [&](const std::string& key, const std::string& what) {
    file.refuse_below("/threshold" + key, what);
  };
  const std::vector<Standard> standards = standards_of(study);
  const auto tracks = standards.size() * static_cast<std::size_t>(options.tracks_each);
  if (tracks > procedures::kMaxTracks) {
    refuse("/tracks", fmt::format("makes {} tracks for a participant, more than {}; use fewer "
                                  "classes, standards or tracks",
                                  tracks, procedures::kMaxTracks));
  }
  for (const Standard& standard : standards) {
    const std::size_t usable_levels = levels_of(options, standard).size();
    const bool may_drop_levels = options.task == Task::discrimination;
    if (usable_levels < (may_drop_levels ? 1 : options.track.levels.size())) {
      refuse("/levels",
             fmt::format("exceed the pack's gain, which is the maximum, for {}{}; lower "
                         "them{}",
                         words_of(study, standard), options.rove_db > 0.0 ? " with its rove" : "",
                         may_drop_levels ? " or the standard" : ""));
    }
    const double max = comparison_at(options, standard, options.track.levels.back());
    if (options.along == LevelQuantity::order && max >= 1.0) {
      refuse("/levels", fmt::format("reach order {:.3f}, but orders must be below 1; lower the "
                                    "highest level or the standard",
                                    max));
    }
    if (options.along == LevelQuantity::blend && max > 1.0 + 1e-9) {
      refuse("/levels", "exceed a share of 1 of the second texture; end at 0 dB");
    }
    if (options.along == LevelQuantity::pitch && max > 10.0) {
      refuse("/levels", "reach more than ten times the pitch; lower the highest level");
    }
  }
  const double table_size = 2.0 * static_cast<double>(tracks) *
                            static_cast<double>(options.track.levels.size()) *
                            static_cast<double>(options.track.grid.thresholds.size()) *
                            static_cast<double>(options.track.grid.slopes.size()) *
                            static_cast<double>(options.track.grid.lapses.size());
  if (table_size > kMaxTables) {
    refuse("/grid", fmt::format("needs tables of {:.0f} million numbers for all tracks, more than "
                                "{:.0f}; use fewer levels or values",
                                table_size / 1e6, kMaxTables / 1e6));
  }
  try {
    static_cast<void>(procedures::Block(block_settings(study), Digest{}));
  } catch (const std::invalid_argument& error) {
    refuse("", std::string(error.what()) + "; change the section's numbers");
  }
  if (options.along == LevelQuantity::blend && study.classes.size() != 2) {
    file.refuse_below("/classes",
                      fmt::format("has {} entries, but levels along blend need two textures",
                                  study.classes.size()));
  }
  if (options.along == LevelQuantity::blend) {
    const auto mixtures = study.classes.front().images.size() * study.classes.back().images.size() *
                          options.track.levels.size();
    if (mixtures > kMaxValues) {
      refuse("/levels",
             fmt::format("make {} mixtures with the images, more than {}; use fewer levels "
                         "or images",
                         mixtures, kMaxValues));
    }
  }
  if (study.level) {
    file.refuse_below(
        "/rendering/gains",
        "states a level, which a threshold study itself measures; use \"budget\", the "
        "largest gains");
  }
  if (study.rendering.reference_grey != 128.0) {
    file.refuse_below("/rendering/reference_grey",
                      "must be 128, because otherwise the wall of a texture is displaced from the "
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
  if (trials.lead_in > 0) refuse_trials("/lead_in", "must be 0, because tracks have no lead-in");
  if (trials.on_interruption != OnInterruption::repeat) {
    refuse_trials("/on_interruption",
                  "must be \"repeat\", because a track needs the answer to every trial");
  }
  if (trials.on_timeout != OnTimeout::fade) {
    refuse_trials("/on_timeout",
                  "must be \"fade\", because a trial whose interval takes too long is repeated");
  }
  if (trials.explore_limit_s < options.interval_s) {
    refuse_trials("/explore_limit_s",
                  fmt::format("is shorter than an interval of {} s; raise it, for instance to four "
                              "times that",
                              options.interval_s));
  }
}

}  // namespace touchtrial::study::threshold
