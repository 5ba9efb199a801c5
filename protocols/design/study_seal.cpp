/// What a database says of its study in clear, and what it commits to.
#include "protocols/design/study_key.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>

namespace touchtrial {

std::string blinded_configuration(const StudyKey& key) {
  const Study& study = key.study;
  nlohmann::json methods = nlohmann::json::array();
  for (const StudyMethod& method : study.methods) methods.push_back(to_json(method));
  std::vector<std::string> codes;
  for (const KeyedStimulus& stimulus : key.stimuli) codes.push_back(stimulus.code);
  std::ranges::sort(codes);
  return nlohmann::json{{"study", study.name},
                        {"protocol", name_of(study.protocol)},
                        {"stimuli", codes},
                        {"positions", study.classes.size()},
                        {"methods", methods},
                        {"rendering", to_json(study.rendering)},
                        {"trials", to_json(study.trials)},
                        {"blinding", "double"}}
      .dump();
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

}  // namespace touchtrial
