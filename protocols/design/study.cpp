#include "protocols/design/study.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/order_rules.hpp"
#include "protocols/design/study_names.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{16} << 20U;
constexpr std::int64_t kMaxSeed = std::int64_t{1} << 53U;  // what every JSON reader holds exactly
constexpr std::array kBlindingNames = {Named<int>{"double", 0}};

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
  return name;
}

namespace {

void check_protocol(const JsonValue& place, const Study& study) {
  if (study.protocol == Protocol::comparison && study.methods.size() < 2) {
    place.refuse_below("/methods",
                       "has 1 entry; the protocol comparison needs at least 2: add one, or choose "
                       "the protocol classification");
  }
  std::size_t images = 0;
  for (const StudyClass& study_class : study.classes) images += study_class.images.size();
  if (images * study.methods.size() > kMaxStimuli) {
    place.refuse_below("/classes", "has " + std::to_string(images) + " images for " +
                                       std::to_string(study.methods.size()) +
                                       " methods, more than " + std::to_string(kMaxStimuli) +
                                       " stimuli; list fewer");
  }
}

void check_trials(const JsonValue& place, const Study& study) {
  if (study.scored_trials() > kMaxScoredTrials) {
    place.refuse_below("/trials/repeats", "makes " + std::to_string(study.scored_trials()) +
                                              " trials for a participant, more than " +
                                              std::to_string(kMaxScoredTrials) +
                                              "; give fewer repeats");
  }
  if (const auto obstacle = obstacle_to_order(study)) {
    place.refuse_below("/trials" + obstacle->key, obstacle->what);
  }
}

Study read_study(const JsonValue& place) {
  const JsonObject root = place.object(
      {"study", "protocol", "classes", "methods", "rendering", "trials", "blinding", "seed"});
  Study study;
  study.name = read_plain_name(root.at("study"));
  study.protocol = root.at("protocol").choice(kProtocolNames);
  study.classes = read_classes(root.at("classes"));
  study.methods = read_methods(root.at("methods"));
  if (const auto member = root.find("rendering")) study.rendering = read_rendering(*member);
  if (const auto member = root.find("trials")) study.trials = read_trials(*member);
  if (const auto member = root.find("blinding")) static_cast<void>(member->choice(kBlindingNames));
  if (const auto member = root.find("seed")) {
    study.seed = static_cast<std::uint64_t>(member->integer(0, kMaxSeed));
  }
  check_protocol(place, study);
  check_trials(place, study);
  return study;
}

}  // namespace

std::string_view name_of(Protocol protocol) {
  return word_for(kProtocolNames, protocol);
}

int Study::presented_methods() const noexcept {
  return protocol == Protocol::classification ? 1 : static_cast<int>(methods.size());
}

int Study::scored_trials() const noexcept {
  return static_cast<int>(classes.size()) * presented_methods() * trials.repeats;
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

}  // namespace touchtrial
