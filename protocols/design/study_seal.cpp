/// What a database says of its study in clear, and what it commits to.
#include "protocols/design/study_key.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>

namespace touchtrial::design {
namespace {

/// Everything that people read, as a hash that only the key's holder can check: names of textures
/// are among it.
std::string texts_tag(const StudyKey& key) {
  const Study& study = key.study;
  const nlohmann::json texts = {{"practice", to_json(study.practice)},
                                {"session", to_json(study.session)},
                                {"registration", to_json(study.registration)}};
  const Digest hash = sha256(bytes_of(texts.dump()));
  return to_hex(keyed_hash(derive_key(key.master, "texts"), ByteView(hash)));
}

/// What is said of the sections that are not in studies from before they existed: nothing where
/// they are as if they were not there, so that such a study's configuration stays as it was.
void add_plans(nlohmann::json& configuration, const StudyKey& key) {
  const Study& study = key.study;
  if (study.practice != PracticePlan{}) {
    configuration["practice"] = {{"positions", study.practice.classes.size()},
                                 {"criterion", study.practice.criterion},
                                 {"rounds", study.practice.rounds}};
  }
  if (study.session != SessionPlan{}) {
    nlohmann::json session = to_json(study.session);
    for (const char* text :
         {"instructions", "day_sheet", "consent_version", "ethics_number", "closing_questions"}) {
      session.erase(text);
    }
    configuration["session"] = std::move(session);
  }
  if (configuration.contains("practice") || configuration.contains("session") ||
      study.registration != Registration{}) {
    configuration["texts"] = texts_tag(key);
  }
}

}  // namespace

std::string blinded_configuration(const StudyKey& key) {
  const Study& study = key.study;
  nlohmann::json methods = nlohmann::json::array();
  for (const StudyMethod& method : study.methods) methods.push_back(to_json(method));
  std::vector<std::string> codes;
  for (const KeyedStimulus& stimulus : key.stimuli) codes.push_back(stimulus.code);
  std::ranges::sort(codes);
  nlohmann::json configuration = {{"study", study.name},
                                  {"protocol", name_of(study.protocol)},
                                  {"stimuli", codes},
                                  {"positions", study.classes.size()},
                                  {"methods", methods},
                                  {"rendering", to_json(study.rendering)},
                                  {"trials", to_json(study.trials)},
                                  {"blinding", "double"}};
  add_plans(configuration, key);
  return configuration.dump();
}

Digest study_seal(const StudyKey& key) {
  FieldHasher hasher;
  hasher.add("touchtrial seal 1").add(ByteView(key.master));
  hasher.add(static_cast<std::int64_t>(key.simulated ? 1 : 0));
  hasher.add(static_cast<std::int64_t>(key.stimuli.size()));
  for (const auto& [code, stimulus] : key.stimuli) {
    const StudyClass& shown = key.study.classes[static_cast<std::size_t>(stimulus.class_index)];
    const auto& method = key.study.methods[static_cast<std::size_t>(stimulus.method)];
    hasher.add(code).add(shown.label);
    hasher.add(shown.images[static_cast<std::size_t>(stimulus.exemplar)].string());
    hasher.add(method.label);
  }
  hasher.add(schedule_rule(key.study)).add(static_cast<std::int64_t>(key.study.seed));
  hasher.add(blinded_configuration(key)).add(ByteView(key.nonce));
  return hasher.finish();
}

}  // namespace touchtrial::design
