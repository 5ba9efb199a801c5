#include "study/study_key.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"
#include "study/protocol.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <iterator>
#include <set>

namespace touchtrial::study {
namespace {

constexpr std::size_t kStudyIdBytes = 16;
constexpr std::size_t kCodeBytes = 8;

std::string first_hex(const Digest& digest, std::size_t bytes) {
  return to_hex(ByteView(digest).first(bytes));
}

/// The code of a stimulus. It does not change when other stimuli are added or removed.
std::string code_for(const SecretKey& code_key, const Study& study, const StimulusIndex& stimulus) {
  const StudyClass& study_class = study.class_at(stimulus.class_index);
  const bool is_practice = study.is_practice_class(stimulus.class_index);
  const auto& image = study_class.images[static_cast<std::size_t>(stimulus.exemplar)];
  const auto& method = study.methods[static_cast<std::size_t>(stimulus.method)];
  const Digest identity = FieldHasher()
                              .add(is_practice ? "touchtrial practice code 1" : "touchtrial code 1")
                              .add(study_class.label)
                              .add(image.string())
                              .add(method.label)
                              .finish();
  return first_hex(keyed_hash(code_key, ByteView(identity)), kCodeBytes);
}

/// Makes the codes of all fields of the key's study.
void assign_codes(StudyKey& key) {
  const SecretKey code_key = derive_key(key.master, "codes");
  key.stimuli.clear();
  key.practice.clear();
  std::set<std::string> codes;
  for (const StimulusIndex& field : presented_fields(key.study)) {
    auto& list = key.study.is_practice_class(field.class_index) ? key.practice : key.stimuli;
    list.push_back({code_for(code_key, key.study, field), field});
    if (codes.insert(list.back().code).second) continue;
    throw StudyError("study " + key.study.name + ": " + place_of_image(key.study, field) +
                     ": has the same code as another stimulus; rename the image or the label");
  }
}

std::string catch_code_of(const SecretKey& master) {
  const Digest identity = FieldHasher().add("touchtrial catch code 1").finish();
  return first_hex(keyed_hash(derive_key(master, "codes"), ByteView(identity)), kCodeBytes);
}

SecretKey station_secret(const SecretKey& master, const std::string& name) {
  return derive_key(master, "station " + name);
}

Signer station_signer(const SecretKey& secret) {
  return Signer(derive_key(secret, "signature"));
}

/// A keyed hash of all sections with texts, which only the holder of the key can verify. The texts
/// include names of textures, so they are not stored unencrypted.
std::string texts_tag(const StudyKey& key) {
  const Study& study = key.study;
  const nlohmann::json texts = {{"practice", to_json(study.practice)},
                                {"session", to_json(study.session)},
                                {"registration", to_json(study.registration)}};
  const Digest hash = sha256(bytes_of(texts.dump()));
  return to_hex(keyed_hash(derive_key(key.master, "texts"), ByteView(hash)));
}

/// Whether a value with this JSON Schema may be or contain free text.
bool may_contain_text(const nlohmann::json& schema) {
  if (schema.is_object()) {
    const auto type = schema.find("type");
    if (type != schema.end() && *type == "string" && !schema.contains("enum")) return true;
    if (type != schema.end() && *type == "object" && !schema.contains("properties")) return true;
  }
  return schema.is_structured() && std::ranges::any_of(schema, may_contain_text);
}

/// The session's settings without free text, which may name textures.
nlohmann::json without_texts(const SessionPlan& session) {
  SessionPlan defaults;
  const auto schema = nlohmann::json::parse(
      annotated_section({}, [&defaults](ObjectIo& io) { describe(io, defaults); }));
  nlohmann::json settings = to_json(session);
  for (const auto& [key, property] : schema.at("properties").items()) {
    if (may_contain_text(property)) settings.erase(key);
  }
  return settings;
}

/// Adds the sections that older studies do not have. A section with default values is omitted, so
/// that the configuration of an older study stays the same.
void add_plans(nlohmann::json& configuration, const StudyKey& key) {
  const Study& study = key.study;
  if (study.practice != PracticePlan{}) {
    configuration["practice"] = {{"positions", study.practice.classes.size()},
                                 {"criterion", study.practice.criterion},
                                 {"rounds", study.practice.rounds}};
  }
  if (study.session != SessionPlan{}) configuration["session"] = without_texts(study.session);
  if (study.visits != VisitPlan{}) {
    configuration["visits"] = to_json(study.visits);
    configuration["visits"]["needed"] = study.visits_needed();
  }
  if (study.groups != GroupPlan{}) configuration["groups"] = to_json(study.groups);
  if (configuration.contains("practice") || configuration.contains("session") ||
      study.registration != Registration{}) {
    configuration["texts"] = texts_tag(key);
  }
}

}  // namespace

std::vector<KeyedStimulus> StudyCodes::fields() const {
  std::vector<KeyedStimulus> fields = stimuli;
  std::ranges::copy(practice, std::back_inserter(fields));
  return fields;
}

std::optional<StimulusIndex> StudyCodes::stimulus_of(const std::string& code) const {
  const auto found = std::ranges::find(stimuli, code, &KeyedStimulus::code);
  if (found == stimuli.end()) return std::nullopt;
  return found->stimulus;
}

const std::string& StudyCodes::code_of(const StimulusIndex& stimulus) const {
  const auto& list = study.is_practice_class(stimulus.class_index) ? practice : stimuli;
  const auto found = std::ranges::find(list, stimulus, &KeyedStimulus::stimulus);
  if (found == list.end()) {
    throw StudyError("study " + study.name + ": the key has no code for class " +
                     std::to_string(stimulus.class_index) + ", image " +
                     std::to_string(stimulus.exemplar) + ", method " +
                     std::to_string(stimulus.method) +
                     "; use the key that was made for this study");
  }
  return found->code;
}

ScheduleDraw StudyKey::draw_of(int enrolment, Draws draws, int visit) const {
  const Station* const station = station_of(stations, enrolment);
  if (station == nullptr) {
    throw UsageError("study " + study.name + ": enrolment number " + std::to_string(enrolment) +
                     " belongs to no station of this key; assign more with `touchtrial plan "
                     "--extend`, or use the key that `plan --extend` wrote last");
  }
  return draw_for(study, *station, enrolment, draws, visit);
}

std::optional<int> StudyKey::group_of(int enrolment, Draws draws) const {
  const Station* const station = station_of(stations, enrolment);
  return station == nullptr ? std::nullopt : group_for(study, *station, enrolment, draws);
}

BoxKeys StudyKey::box() const {
  return box_keys(derive_key(master, "investigator's box"));
}

Signer StudyKey::signer() const {
  return Signer(derive_key(master, "investigator's signature"));
}

ScheduleDraw StationKey::draw_of(int enrolment, Draws draws, int visit) const {
  return draw_for(study, station, enrolment, draws, visit);
}

Signer StationKey::signer() const {
  return station_signer(station.secret);
}

StudyKey make_study_key(const Study& study, Entropy& entropy, bool simulated) {
  StudyKey key;
  key.master = entropy.secret("touchtrial study key master");
  key.study_id = first_hex(derive_key(key.master, "identity"), kStudyIdBytes);
  key.simulated = simulated;
  key.catch_code = catch_code_of(key.master);
  key.investigator_box = key.box().public_half;
  key.investigator_signature = key.signer().public_half();
  assign_stations(key, {{.name = kOnlyStation, .ranges = {{1, kMaxEnrolments}}}});
  return rekeyed(key, study);
}

StudyKey simulated_study_key(const Study& study) {
  SeededEntropy entropy(study.seed);
  return make_study_key(study, entropy, true);
}

StudyKey rekeyed(const StudyKey& key, const Study& study) {
  StudyKey changed = key;
  changed.study = study;
  assign_codes(changed);
  changed.configuration = blinded_configuration(changed);
  changed.seal = study_seal(changed);
  return changed;
}

void assign_stations(StudyKey& key, std::vector<Station> stations) {
  for (Station& station : stations) station.secret = station_secret(key.master, station.name);
  key.stations = std::move(stations);
}

StationKey station_key(const StudyKey& key, const std::string& name) {
  const auto found = std::ranges::find(key.stations, name, &Station::name);
  if (found == key.stations.end()) {
    throw UsageError("study " + key.study.name + ": has no station " + in_quotes(name) +
                     "; it has " + listed(key.stations, ", ", &Station::name));
  }
  StationKey station{key, *found};
  station.certificate =
      key.signer().sign(station_statement(key.study_id, name, station.signer().public_half()));
  return station;
}

std::string blinded_configuration(const StudyKey& key) {
  const Study& study = key.study;
  nlohmann::json methods = nlohmann::json::array();
  for (const StudyMethod& method : study.methods) methods.push_back(to_json(method));
  std::vector<std::string> codes;
  for (const KeyedStimulus& stimulus : key.stimuli) codes.push_back(stimulus.code);
  std::ranges::sort(codes);
  nlohmann::json configuration = {{"study", study.name},
                                  {"protocol", study.protocol_name()},
                                  {"stimuli", codes},
                                  {"positions", choices_of(study).size()},
                                  {"methods", methods},
                                  {"rendering", to_json(study.rendering)},
                                  {"trials", to_json(study.trials)},
                                  {"blinding", study.double_blind ? "double" : "participant"}};
  if (const int planes = trial_question_of(study).planes; planes > 1)
    configuration["intervals"] = planes;
  const std::string options = study.task->plaintext_settings();
  if (!options.empty()) {
    configuration[std::string(study.protocol->section)] = nlohmann::json::parse(options);
  }
  add_plans(configuration, key);
  return configuration.dump();
}

namespace {

/// The parts of a study file, by their keys.
nlohmann::json parts_of(const Study& study) {
  nlohmann::json classes = nlohmann::json::array();
  for (const StudyClass& study_class : study.classes) {
    nlohmann::json images = nlohmann::json::array();
    for (const auto& image : study_class.images) images.push_back(image.string());
    classes.push_back({study_class.label, images});
  }
  nlohmann::json methods = nlohmann::json::array();
  for (const StudyMethod& method : study.methods) methods.push_back(to_json(method));
  return {{"study", study.name},
          {"protocol", {study.protocol_name(), study.task->plaintext_settings()}},
          {"classes", classes},
          {"methods", methods},
          {"rendering", to_json(study.rendering)},
          {"device", study.device},
          {"level", study.level ? nlohmann::json{study.level->db, study.level->curve} : nullptr},
          {"trials", to_json(study.trials)},
          {"practice", to_json(study.practice)},
          {"session", to_json(study.session)},
          {"visits", to_json(study.visits)},
          {"groups", to_json(study.groups)},
          {"registration", to_json(study.registration)},
          {"blinding", study.double_blind},
          {"protocol's own section", study.task->plaintext_settings()},
          {"seed", study.seed}};
}

}  // namespace

bool are_same(const Study& a, const Study& b) {
  return parts_of(a) == parts_of(b);
}

std::string mismatch_of(const Study& study, const StudyCodes& key,
                        const std::filesystem::path& file, const std::string& option) {
  const std::string what = option == "--key" ? "key" : "file";
  const std::string text = file.string() + ": is not the " + what + " of " + study.source;
  if (study.name != key.study.name) {
    return one_line(text + " (study " + in_quotes(study.name) + "), but of study " +
                    in_quotes(key.study.name) + "; give the right one with " + option);
  }
  const nlohmann::json study_parts = parts_of(study);
  const nlohmann::json key_parts = parts_of(key.study);
  std::vector<std::string> differing_parts;
  for (const auto& [part, content] : study_parts.items()) {
    if (content != key_parts.at(part)) differing_parts.push_back(part);
  }
  const std::string parts = differing_parts.empty() ? "seal" : listed(differing_parts, ", ");
  return one_line(text + ", which has changed since it was prepared: its " + parts +
                  (differing_parts.size() > 1 ? " differ" : " differs") + " from study " +
                  in_quotes(key.study.name) + " of that " + what +
                  "; undo the change, give the right " + what + " with " + option +
                  ", or, only if nobody has taken part yet, run `touchtrial prepare`");
}

Digest study_seal(const StudyKey& key) {
  FieldHasher hasher;
  hasher.add("touchtrial seal 2").add(ByteView(key.master));
  hasher.add(static_cast<std::int64_t>(key.simulated ? 1 : 0));
  hasher.add(static_cast<std::int64_t>(key.stimuli.size()));
  for (const auto& [code, stimulus] : key.stimuli) {
    const StudyClass& study_class =
        key.study.classes[static_cast<std::size_t>(stimulus.class_index)];
    const auto& method = key.study.methods[static_cast<std::size_t>(stimulus.method)];
    hasher.add(code).add(study_class.label);
    hasher.add(study_class.images[static_cast<std::size_t>(stimulus.exemplar)].string());
    hasher.add(method.label);
  }
  hasher.add(key.study.task->rule(key.study)).add(static_cast<std::int64_t>(key.study.seed));
  hasher.add(blinded_configuration(key));
  return hasher.finish();
}

}  // namespace touchtrial::study
