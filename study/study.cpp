#include "study/study.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "study/protocol.hpp"
#include "study/study_schema.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <span>

namespace touchtrial::study {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{16} << 20U;
constexpr std::int64_t kMaxSeed = std::int64_t{1} << 53U;  // exact in every JSON reader
constexpr auto kBlindingNames =
    std::to_array<Named<bool>>({{"double", true}, {"participant", false}});

}  // namespace

std::string read_plain_name(const JsonValue& place) {
  constexpr std::size_t kMaxLength = 64;
  const std::string& name = place.text();
  const bool has_only_plain_letters = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-';
  });
  if (name.empty() || name.size() > kMaxLength || !has_only_plain_letters) {
    place.refuse(in_quotes(name) + " must have 1 to 64 of the characters 0-9 A-Z a-z _ -");
  }
  if (is_read_as_missing(name)) {
    place.refuse(
        in_quotes(name) +
        " is read by other programs as a missing value or a truth value; give another name");
  }
  return name;
}

namespace {

/// Describes the sections of all protocols; the section of the study's protocol creates its task.
void describe_tasks(ObjectIo& io, Study& study) {
  for (const Protocol* protocol : protocols()) {
    const auto has_section = [protocol](const Protocol* other) {
      return other->section == protocol->section;
    };
    const bool is_first = *std::ranges::find_if(protocols(), has_section) == protocol;
    if (protocol->section.empty() || !is_first) continue;
    std::vector<std::string_view> owners;
    for (const Protocol* other : protocols()) {
      if (has_section(other)) owners.push_back(other->name);
    }
    io.only_for("protocol", owners, std::span(&protocol->section, 1),
                "belongs to the protocol " + std::string(protocol->name) +
                    "; remove it, or choose that protocol");
    io.member(protocol->section, {}, false, [&](ValueIo& value) {
      value.custom(
          protocol->section_schema == nullptr ? R"({"type": "object"})"
                                              : protocol->section_schema(),
          [&study](const JsonValue& place) { study.task = study.protocol->read(place); },
          [] { return "{}"; });
    });
  }
}

void check_trials(const JsonValue& place, const Study& study) {
  if (study.scored_trials() <= kMaxScoredTrials) return;
  place.refuse_below("/trials/repeats", "makes " + std::to_string(study.scored_trials()) +
                                            " trials for a participant, more than " +
                                            std::to_string(kMaxScoredTrials) +
                                            "; lower the number of repeats");
}

void check_size(const JsonValue& place, const Study& study) {
  std::size_t images = 0;
  for (const StudyClass& study_class : study.classes) images += study_class.images.size();
  if (images * study.methods.size() > kMaxStimuli) {
    place.refuse_below("/classes", "has " + std::to_string(images) + " images for " +
                                       std::to_string(study.methods.size()) +
                                       " methods, more than " + std::to_string(kMaxStimuli) +
                                       " stimuli; remove images or methods");
  }
}

/// Checks that a practice class shares neither label nor image with the study, nor its image with
/// another practice class.
void check_practice_class(const JsonValue& place, const Study& study, std::size_t index) {
  const StudyClass& practice_class = study.practice.classes[index];
  const std::string pointer = "/practice/classes/" + std::to_string(index);
  const auto image = practice_class.images.front().lexically_normal();
  const auto has_image = [&](const StudyClass& other) {
    return std::ranges::any_of(other.images,
                               [&](const auto& path) { return path.lexically_normal() == image; });
  };
  const auto has_label = [&](const StudyClass& other) {
    return skeleton_of(practice_class.label) == skeleton_of(other.label);
  };
  if (std::ranges::any_of(study.classes, has_label)) {
    place.refuse_below(pointer + "/label",
                       in_quotes(practice_class.label) +
                           " is also a class of the study; practise with another texture");
  }
  if (std::ranges::any_of(study.classes, has_image)) {
    place.refuse_below(pointer + "/images/0",
                       in_quotes(practice_class.images.front().string()) +
                           " is also an image of the study; use another image");
  }
  const std::span<const StudyClass> earlier_classes(study.practice.classes.data(), index);
  if (std::ranges::any_of(earlier_classes, has_image)) {
    place.refuse_below(pointer + "/images/0",
                       in_quotes(practice_class.images.front().string()) +
                           " is the image of another practice class; use another "
                           "image");
  }
}

void check_practice(const JsonValue& place, const Study& study) {
  for (std::size_t i = 0; i < study.practice.classes.size(); ++i) {
    check_practice_class(place, study, i);
  }
  const int trials = study.trials.practice;
  if (trials == 0) return;
  if (study.practice.classes.empty()) {
    place.refuse_below("/trials/practice",
                       "is " + std::to_string(trials) +
                           ", but the study has no textures to practise with; add a section "
                           "\"practice\", or set it to 0");
  }
  if (study.practice.criterion > trials) {
    place.refuse_below("/practice/criterion", "is " + std::to_string(study.practice.criterion) +
                                                  ", more than the practice trials of a round, " +
                                                  std::to_string(trials) +
                                                  "; lower it, or raise /trials/practice");
  }
}

/// Checks that the methods can be divided between the visits.
void check_visits(const JsonValue& place, const Study& study) {
  if (study.visits.methods != VisitMethods::divided) return;
  if (study.trials.blocks == Blocks::mixed) {
    place.refuse_below(
        "/visits/methods",
        "is \"divided\", which needs a block for each method, but the trials' blocks are "
        "\"mixed\"; set /trials/blocks to \"by-method\"");
  }
  if (study.presented_methods() % study.visits.count != 0) {
    place.refuse_below("/visits/methods",
                       "is \"divided\", but " + std::to_string(study.presented_methods()) +
                           " methods cannot be divided evenly between " +
                           std::to_string(study.visits.count) + " visits; change either number");
  }
}

/// Describes the sections with settings of trials, sessions and participants.
void describe_plans(ObjectIo& io, Study& study) {
  const auto describe_plan = [](ObjectIo& keys, auto& plan) { describe(keys, plan); };
  io.part("trials", study.trials, {"the trials of a participant, see below"}, describe_plan);
  io.part("practice", study.practice,
          {.meaning = "textures on which participants learn the task, see below",
           .default_text = "none"},
          describe_plan);
  io.part("session", study.session,
          {"texts, questions and other settings of sessions with people, see below"},
          describe_plan);
  io.part("visits", study.visits,
          {.meaning = "visits of each participant, see below", .default_text = "one visit"},
          describe_plan);
  io.part(
      "groups", study.groups,
      {.meaning = "groups to which participants are assigned, see below", .default_text = "none"},
      describe_plan);
  io.member("registration",
            {.meaning = "content of the preregistration, see below", .default_text = "empty"}, true,
            [&study](ValueIo& value) {
              value.object([&study](ObjectIo& keys) {
                const bool has_methods = !study.methods.empty();
                describe(keys, study.registration,
                         has_methods ? default_test_of(study) : RegisteredTest::t);
              });
            });
}

void describe_protocol(ObjectIo& io, Study& study) {
  std::vector<std::string_view> names;
  for (const Protocol* protocol : protocols()) names.push_back(protocol->name);
  std::size_t index = 0;
  io.member("protocol",
            {.meaning = "`classification`: which texture was presented? `comparison`: the same "
                        "question with several methods. `threshold`: how weak a texture, or how "
                        "small a difference, can still be felt? `rating`: how well does a texture "
                        "fit its picture?",
             .required = true},
            true, [&](ValueIo& value) { value.choice(index, names); });
  io.rule([&](const JsonValue& /*place*/, const JsonObject& /*object*/) {
    study.protocol = protocols().at(index);
  });
}

void describe_study(ObjectIo& io, Study& study) {
  io.text("study", study.name, kPlainName,
          {.meaning = "name, used in tables and file names", .required = true});
  describe_protocol(io, study);
  describe_tasks(io, study);
  describe_classes(io, study.classes, study.protocol == nullptr ? 1 : study.protocol->min_classes,
                   kMaxImagesOfClass,
                   {.meaning = "the textures that participants tell apart, see below",
                    .required = true,
                    .range = "2 to 64 entries (`threshold` and `rating`: 1 to 64)"});
  describe_methods(io, study.methods,
                   {.meaning = "how textures are extracted from images, see below",
                    .required = true,
                    .range = "1 to 8 entries (`threshold`: 1), each label once"});
  RenderingSection rendering{study.rendering, study.device, study.level};
  io.part("rendering", rendering, {"how a texture becomes force, see below"},
          [](ObjectIo& keys, RenderingSection& section) { describe(keys, section); });
  study.rendering = rendering.options;
  study.device = rendering.device;
  study.level = rendering.level;
  describe_plans(io, study);
  io.choice("blinding", study.double_blind, kBlindingNames,
            {"`double`: neither participant nor experimenter knows what is presented; "
             "`participant`: the experimenter adjusts something by hand and may know what is "
             "presented. This is reported, and does not affect what the program shows"});
  io.member(
      "seed",
      {.meaning =
           "seed of simulations and control textures; does not affect the schedules of people",
       .range = "0 to 2^53"},
      true, [&study](ValueIo& value) { value.integer(study.seed, 0, kMaxSeed); });
}

Study read_study(const JsonValue& place) {
  Study study;
  read_settings(place, [&study](ObjectIo& io) { describe_study(io, study); });
  if (!study.task) study.task = study.protocol->read(std::nullopt);
  check_trials(place, study);
  study.task->check(place, study);
  study.methods = study.task->fields(study).methods;
  check_size(place, study);
  check_practice(place, study);
  check_visits(place, study);
  check_registration(place, study);
  return study;
}

}  // namespace

std::string_view name_of(TrialOrder order) {
  return name_in(kTrialOrderNames, order);
}

std::string_view name_of(Blocks blocks) {
  return name_in(kBlocksNames, blocks);
}

std::string_view name_of(engine::ModelKind model) {
  return name_in(kModelNames, model);
}

std::string Study::protocol_name() const {
  return std::string(protocol->name);
}

int Study::presented_methods() const {
  return protocol->all_methods ? static_cast<int>(methods.size()) : 1;
}

std::string Study::presented_labels() const {
  const auto presented = static_cast<std::size_t>(presented_methods());
  return listed(std::span(methods).first(presented), ", ", &StudyMethod::label);
}

const StudyClass& Study::class_at(int class_index) const {
  if (!is_practice_class(class_index)) return classes.at(static_cast<std::size_t>(class_index));
  return practice.classes.at(static_cast<std::size_t>(class_index) - classes.size());
}

bool Study::is_practice_class(int class_index) const noexcept {
  return class_index >= static_cast<int>(classes.size());
}

int Study::scored_trials() const {
  return task->scored_trials(*this) * (visits.methods == VisitMethods::all ? visits.count : 1);
}

int Study::visits_needed() const {
  const bool only_first =
      registration.analysis && registration.analysis->visits == RegisteredVisits::first;
  return only_first ? 1 : visits.count;
}

bool Study::enters_analysis(int visit) const {
  switch (registration.analysis ? registration.analysis->visits : RegisteredVisits::all) {
    case RegisteredVisits::first:
      return visit == 1;
    case RegisteredVisits::last:
      return visit == visits.count;
    case RegisteredVisits::all:
      break;
  }
  return true;
}

std::string study_schema() {
  Study defaults;
  defaults.registration.analysis.emplace();
  return annotated_schema(
      "Touchtrial study",
      "The stimuli, their rendering, and the trials. docs/study-file.md explains "
      "every key.",
      "", [&defaults](ObjectIo& io) { describe_study(io, defaults); });
}

Study parse_study(std::string_view text, const std::filesystem::path& folder,
                  const std::string& source) {
  Study study = read_study(parse_strict_json(text, source));
  study.folder = folder;
  study.source = source;
  study.text = std::string(text);
  return study;
}

Study load_study(const std::filesystem::path& path) {
  Bytes content;
  try {
    content = read_file(path, kMaxFileBytes);
  } catch (const FileError& error) {
    throw StudyError(error.what());
  }
  return parse_study(text_of(content), path.parent_path(), path.string());
}

}  // namespace touchtrial::study
