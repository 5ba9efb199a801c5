/// \file Describes the study file's "classes", "trials", "practice", "visits" and "groups".
#include "study/study_sections.hpp"

#include "core/labels.hpp"
#include "core/text.hpp"

#include <algorithm>

namespace touchtrial::study {
namespace {

constexpr std::size_t kMaxPathBytes = 1024;

constexpr TextRule kLabel{
    .check =
        [](const JsonValue& place) {
          const std::string fault = fault_of_label(place.text());
          if (!fault.empty()) place.refuse(fault + "; give another label");
        },
    .min_length = 1,
    .max_length = 64,
    .pattern = R"(^[^\u0000-\u0020\u007f-\u009f]([^\u0000-\u001f\u007f-\u009f]*)"
               R"([^\u0000-\u0020\u007f-\u009f])?$)",
    .description =
        "1 to 64 bytes of UTF-8, no control characters, no space at either end, unique; two labels "
        "may not look alike, that is, differ only by capitals, blanks, hyphens, the encoding of "
        "accents, the width of letters, or the alphabet of similar letters (a Cyrillic or Greek "
        "o); no word that mixes Latin with other letters; no word that other programs read as a "
        "missing value (NA), and no =, +, - or @ at the start"};

void check_image(const JsonValue& place) {
  const std::string& path = place.text();
  if (path.empty()) place.refuse("is empty; give the path of an image");
  if (path.size() > kMaxPathBytes) {
    place.refuse("is longer than " + std::to_string(kMaxPathBytes) + " bytes; shorten the path");
  }
  if (has_control_character(path)) place.refuse("has a control character; rename the image");
}

constexpr TextRule kImage{.check = check_image,
                          .min_length = 1,
                          .max_length = kMaxPathBytes,
                          .pattern = R"(^[^\u0000-\u001f\u007f-\u009f]+$)"};

void describe_class(ObjectIo& io, StudyClass& study_class, std::size_t max_images) {
  io.text("label", study_class.label, kLabel, {.meaning = "name of the texture", .required = true});
  io.list("images", study_class.images, {.min = 1, .max = max_images, .unique = true},
          {.meaning = "the exemplars of the class; paths are relative to the study file",
           .required = true},
          [](ValueIo& value, std::filesystem::path& image) {
            std::string path = image.string();
            value.text(path, kImage);
            image = path;
          });
  io.rule([&images = study_class.images](const JsonValue& place, const JsonObject& /*object*/) {
    for (auto image = images.begin(); image != images.end(); ++image) {
      if (std::find(images.begin(), image, *image) == image) continue;
      place.refuse_below(
          "/images/" + std::to_string(image - images.begin()),
          in_quotes(image->string()) + " occurs twice; list each image of a class once");
    }
  });
}

constexpr double kMaxTime_s = 3600.0;
constexpr NumberRange kTime_s{.low = 0.0, .high = kMaxTime_s};
constexpr NumberRange kPath_mm{.low = 0.0, .high = 1e6};

void describe_validity(ObjectIo& io, ValidityRule& rule) {
  constexpr NumberRange kMedian_n{.low = 0.0, .high = 100.0};
  io.number("exploring_s", rule.min_exploring_s, kTime_s,
            {"minimum exploration, from first contact to the last sample"});
  io.number("contact_s", rule.min_contact_s, kTime_s, {"minimum time in contact"});
  io.number("path_mm", rule.min_path_mm, kPath_mm, {"minimum path in contact"});
  io.number("least_median_n", rule.min_median_n, kMedian_n, {"minimum median force in contact"});
  io.number("largest_median_n", rule.max_median_n, kMedian_n, {"maximum median force in contact"});
  io.number("saturated_share", rule.saturated_share, {.low = 0.0, .high = 1.0, .open_low = true},
            {"a trial is invalid if at least this share of its samples in contact is at the force "
             "limit"});
}

void describe_min_touch(ObjectIo& io, MinTouch& touch) {
  io.number("contact_s", touch.contact_s, kTime_s,
            {"minimum time at the plane (at most 3 mm above it)"});
  io.number("path_mm", touch.path_mm, kPath_mm,
            {"minimum path along it; 0 here and in `contact_s`: no touch needed"});
}

/// Describes the order of presentations.
void describe_order(ObjectIo& io, TrialOptions& trials) {
  io.integer("catch", trials.catch_trials, 0, 1000,
             {"unscored presentations of a plane without texture, at random places among the "
              "others, see [Catch trials](#catch-trials)"});
  io.integer("lead_in", trials.lead_in, 0, 100,
             {"presentations at the start of each block that are not scored"});
  io.choice("blocks", trials.blocks, kBlocksNames,
            {"`by-method`: a block for each method, in a balanced order, so that the analysis must "
             "adjust for the period; `mixed`: all methods in one block. Use `mixed` in new "
             "studies, see [Blocks and schedules](#blocks-and-schedules)"});
  io.integer("max_run", trials.max_run, 0, kMaxScoredTrials,
             {.meaning = "maximum number of presentations of one class in a row within a block; 0: "
                         "no limit. See [Orders](#orders)",
              .if_changed = true});
  io.number("rove_db", trials.rove_db, {0.0, 40.0},
            {.meaning = "width of the range from which each presentation's gain is drawn, which "
                        "ends at the prepared gain; prevents identification by strength alone "
                        "([roving](perception.md#a-studys-level)). A threshold study has [its "
                        "own](thresholds.md#the-study-files-threshold)",
             .if_changed = true});
}

/// Describes the handling of interruptions.
void describe_resumption(ObjectIo& io, TrialOptions& trials) {
  constexpr double kYear_h = 8760.0;
  io.choice(
      "on_interruption", trials.on_interruption, kOnInterruptionNames,
      {.meaning = "what happens to a presentation interrupted by a device fault, a comfort stop or "
                  "the end of the program. `repeat`: it is repeated at the end (in the protocol "
                  "`threshold`, at the end of its block); `leave-out`: it is omitted; "
                  "`restart-block`: its whole block is void and is repeated in a new order",
       .if_changed = true});
  io.number(
      "resume_within_h", trials.resume_within_h, {.low = 0.0, .high = kYear_h, .open_low = true},
      {.meaning = "time for which an interrupted session can be resumed", .if_changed = true});
}

}  // namespace

nlohmann::json written_section(const Description& section, const Description& defaults) {
  return nlohmann::json::parse(described_json(section, defaults));
}

void refuse_same_label(const JsonValue& place, const std::string& pointer, const std::string& label,
                       const std::string& other, const std::string& category) {
  if (label == other) {
    place.refuse_below(pointer, in_quotes(label) + " is the label of another " + category +
                                    "; labels must be unique");
  }
  if (skeleton_of(label) == skeleton_of(other)) {
    place.refuse_below(pointer, in_quotes(label) + " and " + in_quotes(other) +
                                    " look alike; give one of them another name");
  }
}

void describe_classes(ObjectIo& io, std::vector<StudyClass>& classes, int min_classes,
                      std::size_t max_images, const KeyInfo& info) {
  io.list("classes", classes, {.min = static_cast<std::size_t>(min_classes), .max = kMaxClasses},
          info, [max_images](ValueIo& value, StudyClass& study_class) {
            value.object([&](ObjectIo& keys) { describe_class(keys, study_class, max_images); });
          });
  io.rule([&classes](const JsonValue& place, const JsonObject& /*object*/) {
    for (std::size_t i = 1; i < classes.size(); ++i) {
      for (std::size_t other = 0; other < i; ++other) {
        refuse_same_label(place, "/classes/" + std::to_string(i) + "/label", classes[i].label,
                          classes[other].label, "class");
      }
    }
  });
}

void describe(ObjectIo& io, TrialOptions& trials) {
  io.integer("repeats", trials.repeats, 1, 1000,
             {"presentations of each class (and presented method) per participant"});
  io.choice("order", trials.order, kTrialOrderNames, {"see [Orders](#orders)"});
  io.number("explore_limit_s", trials.explore_limit_s,
            {.low = 0.0, .high = kMaxTime_s, .open_low = true},
            {"time limit for exploring a presentation"});
  io.choice("on_timeout", trials.on_timeout, kOnTimeoutNames,
            {"`fade`: the force fades and the participant still answers; `no-response`: the trial "
             "ends without an answer and counts as wrong"});
  io.integer("practice", trials.practice, 0, 100,
             {"presentations in a practice round; requires the section `practice`"});
  io.integer("break_every", trials.break_every, 0, 10'000,
             {.meaning = "trials between breaks; 0: no breaks", .unit = "trials"});
  io.number("break_after_min", trials.break_after_min, {0.0, 240.0},
            {.meaning = "time between breaks, from the first trial after one; 0: no breaks by time",
             .if_changed = true});
  describe_order(io, trials);
  describe_resumption(io, trials);
  io.part("validity", trials.validity,
          {.meaning = "when a trial is valid; fixed before outcomes are seen", .if_changed = true},
          describe_validity);
  io.part("answer_after", trials.answer_after,
          {.meaning = "minimum touch before a presentation can be answered, unless time is up",
           .if_changed = true},
          describe_min_touch);
}

void describe(ObjectIo& io, PracticePlan& practice) {
  describe_classes(
      io, practice.classes, 2, 1,
      {.meaning = "the textures, one image each; labels and images must differ from the study's",
       .required = true});
  io.integer("criterion", practice.criterion, 0, 100,
             {"number of correct answers in a round that ends practice, at most `trials.practice`; "
              "0: practice ends after one round"});
  io.integer("rounds", practice.rounds, 1, 10,
             {"maximum number of rounds; participants who do not reach the criterion are flagged "
              "and continue"});
}

void describe(ObjectIo& io, VisitPlan& visits) {
  constexpr double kMaxDays = 3650.0;
  io.integer("count", visits.count, 2, 100,
             {.meaning = "number of visits of each participant", .required = true});
  io.number("least_days", visits.min_days, {.low = 0.0, .high = kMaxDays},
            {"minimum from start to start of two visits; an earlier visit is refused"});
  io.number("most_days", visits.max_days, {.low = 0.0, .high = kMaxDays, .open_low = true},
            {.meaning = "maximum from start to start of two visits, at least `least_days`; a later "
                        "visit causes a warning and the deviation `visit-late`",
             .default_text = "any"});
  io.rule([&visits](const JsonValue& place, const JsonObject& /*object*/) {
    if (!visits.max_days || *visits.max_days >= visits.min_days) return;
    place.refuse_below("/most_days",
                       "is less than \"least_days\", so no visit would be possible; raise it");
  });
  io.choice("methods", visits.methods, kVisitMethodsNames,
            {"`all`: every visit presents all methods in the participant's order of methods, with "
             "new orders of trials; `divided`: the methods are divided evenly among the visits, in "
             "that order. Needs blocks by method, and a multiple of `count` methods"});
}

void describe(ObjectIo& io, GroupPlan& groups) {
  constexpr std::size_t kMaxGroups = 16;
  io.list("labels", groups.labels, {.min = 2, .max = kMaxGroups, .unique = true},
          {.meaning = "names of the groups", .required = true},
          [](ValueIo& value, std::string& label) { value.text(label, kPlainName); });
  io.rule([&groups](const JsonValue& place, const JsonObject& /*object*/) {
    const std::vector<std::string>& labels = groups.labels;
    for (auto label = labels.begin(); label != labels.end(); ++label) {
      if (std::find(labels.begin(), label, *label) == label) continue;
      place.refuse_below(
          "/labels/" + std::to_string(label - labels.begin()),
          in_quotes(*label) + " is the label of another group; labels must be unique");
    }
  });
  io.boolean("open", groups.open, {"whether the experimenter sees participants' groups"});
}

}  // namespace touchtrial::study
