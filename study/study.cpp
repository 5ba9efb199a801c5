#include "study/study.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "study/protocol.hpp"
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
  constexpr std::size_t kLongest = 64;
  const std::string& name = place.text();
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-';
  });
  if (name.empty() || name.size() > kLongest || !plain) {
    place.refuse(in_quotes(name) + " must have 1 to 64 of the characters 0-9 A-Z a-z _ -");
  }
  if (is_read_as_missing(name)) {
    place.refuse(in_quotes(name) +
                 " is what other programs take for a missing or truth value; give another " +
                 "name");
  }
  return name;
}

namespace {

/// The protocol that the file names.
const Protocol& read_protocol(const JsonValue& place) {
  std::vector<std::string_view> names;
  for (const Protocol* one : protocols()) names.push_back(one->name);
  return *protocols()[place.choice(names)];
}

/// The keys of every study, and the sections of all protocols, so that the error for another
/// protocol's section can name that protocol.
std::vector<std::string_view> keys_of_studies() {
  std::vector<std::string_view> keys = {
      "study",   "protocol",     "classes",  "methods", "rendering", "trials", "practice",
      "session", "registration", "blinding", "seed",    "visits",    "groups"};
  for (const Protocol* one : protocols()) {
    if (!one->section.empty()) keys.push_back(one->section);
  }
  return keys;
}

std::shared_ptr<const Task> read_task(const JsonObject& root, const Protocol& protocol) {
  for (const Protocol* other : protocols()) {
    if (other->section.empty() || other->section == protocol.section) continue;
    if (const auto member = root.find(other->section)) {
      member->refuse("belongs to the protocol " + std::string(other->name) +
                     "; remove it, or choose that protocol");
    }
  }
  if (protocol.section.empty()) return protocol.read(std::nullopt);
  return protocol.read(root.find(protocol.section));
}

void check_trials(const JsonValue& place, const Study& study) {
  if (study.scored_trials() <= kMaxScoredTrials) return;
  place.refuse_below("/trials/repeats", "makes " + std::to_string(study.scored_trials()) +
                                            " trials for a participant, more than " +
                                            std::to_string(kMaxScoredTrials) +
                                            "; give fewer repeats");
}

void check_size(const JsonValue& place, const Study& study) {
  std::size_t images = 0;
  for (const StudyClass& study_class : study.classes) images += study_class.images.size();
  if (images * study.methods.size() > kMaxStimuli) {
    place.refuse_below("/classes", "has " + std::to_string(images) + " images for " +
                                       std::to_string(study.methods.size()) +
                                       " methods, more than " + std::to_string(kMaxStimuli) +
                                       " stimuli; list fewer");
  }
}

/// Checks that a practice class shares neither label nor image with the study, nor its image with
/// another practice class.
void check_practice_class(const JsonValue& place, const Study& study, std::size_t index) {
  const StudyClass& learnt = study.practice.classes[index];
  const std::string at = "/practice/classes/" + std::to_string(index);
  const auto image = learnt.images.front().lexically_normal();
  const auto has_image = [&](const StudyClass& other) {
    return std::ranges::any_of(other.images,
                               [&](const auto& path) { return path.lexically_normal() == image; });
  };
  const auto has_label = [&](const StudyClass& other) {
    return skeleton_of(learnt.label) == skeleton_of(other.label);
  };
  if (std::ranges::any_of(study.classes, has_label)) {
    place.refuse_below(
        at + "/label",
        in_quotes(learnt.label) + " is a class of the study; practise with another texture");
  }
  if (std::ranges::any_of(study.classes, has_image)) {
    place.refuse_below(at + "/images/0", in_quotes(learnt.images.front().string()) +
                                             " is an image of the study; practise with another");
  }
  const std::span<const StudyClass> before(study.practice.classes.data(), index);
  if (std::ranges::any_of(before, has_image)) {
    place.refuse_below(at + "/images/0", in_quotes(learnt.images.front().string()) +
                                             " is the image of another practice class; choose "
                                             "another");
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

/// Whether the methods can be divided between the visits.
void check_visits(const JsonValue& place, const Study& study) {
  if (study.visits.methods != VisitMethods::divided) return;
  if (study.trials.blocks == Blocks::mixed) {
    place.refuse_below(
        "/visits/methods",
        "is \"divided\", but the trials' blocks are \"mixed\", so that no method has "
        "a block of its own; set /trials/blocks to \"by-method\"");
  }
  if (study.presented_methods() % study.visits.count != 0) {
    place.refuse_below("/visits/methods",
                       "is \"divided\", but " + std::to_string(study.presented_methods()) +
                           " methods are not a multiple of " + std::to_string(study.visits.count) +
                           " visits; change either number");
  }
}

Study read_study(const JsonValue& place) {
  const JsonObject root = place.object(keys_of_studies());
  Study study;
  study.name = read_plain_name(root.at("study"));
  study.protocol = &read_protocol(root.at("protocol"));
  study.task = read_task(root, *study.protocol);
  study.classes = read_classes(root.at("classes"), study.protocol->min_classes);
  study.methods = read_methods(root.at("methods"));
  if (const auto member = root.find("rendering")) {
    ReadRendering read = read_rendering(*member);
    study.rendering = read.options;
    study.device = std::move(read.device);
    study.level = std::move(read.level);
  }
  if (const auto member = root.find("trials")) study.trials = read_trials(*member);
  if (const auto member = root.find("practice")) study.practice = read_practice(*member);
  if (const auto member = root.find("session")) study.session = read_session(*member);
  if (const auto member = root.find("visits")) study.visits = read_visits(*member);
  if (const auto member = root.find("groups")) study.groups = read_groups(*member);
  if (const auto member = root.find("registration")) {
    study.registration = read_registration(*member, usual_test_of(study));
  }
  if (const auto member = root.find("blinding")) {
    study.double_blind = member->choice(kBlindingNames);
  }
  if (const auto member = root.find("seed")) {
    study.seed = static_cast<std::uint64_t>(member->integer(0, kMaxSeed));
  }
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
  if (!is_practised(class_index)) return classes.at(static_cast<std::size_t>(class_index));
  return practice.classes.at(static_cast<std::size_t>(class_index) - classes.size());
}

bool Study::is_practised(int class_index) const noexcept {
  return class_index >= static_cast<int>(classes.size());
}

int Study::scored_trials() const {
  return task->scored_trials(*this) * (visits.methods == VisitMethods::all ? visits.count : 1);
}

int Study::visits_needed() const {
  const bool first_alone =
      registration.analysis && registration.analysis->visits == RegisteredVisits::first;
  return first_alone ? 1 : visits.count;
}

bool Study::decides(int visit) const {
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
