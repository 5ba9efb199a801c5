#include "protocols/session/commitment.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "study/protocol.hpp"
#include "study/setting_words.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial::session {
namespace {

std::string section(const std::string& title, const std::string& text) {
  return "\n## " + title + "\n\n" + (text.empty() ? "Not stated." : text) + "\n";
}

std::string line(const std::string& what, const std::string& value) {
  return "- " + what + ": " + value + "\n";
}

/// Labels in alphabetical order, so that their order in the study is not revealed.
std::string labels_of(const study::Study& study) {
  std::vector<std::string> labels;
  for (const study::StudyClass& shown : study.classes) labels.push_back(shown.label);
  std::ranges::sort(labels);
  return listed(labels);
}

std::string participants_of(const study::Registration& registration) {
  if (registration.participants == 0) return "";
  return counted(registration.participants, "participant") + ".";
}

std::string lines_of(const study::SettingFields& fields) {
  std::string lines;
  for (const auto& [what, value] : fields) lines += line(what, value);
  return lines;
}

/// Describes trials with clocked planes; the rule of orders states the numbers of trials.
std::string clocked_lines(const study::Study& study, const study::Ask& ask,
                          const study::InContact& exploring) {
  return line("planes per trial", std::to_string(ask.planes)) +
         line("exploration of each", number_text(exploring.seconds) + " s in contact, at " +
                                         study::range_words(exploring.range) + ", within " +
                                         number_text(study.trials.explore_limit_s) +
                                         " s; otherwise the trial is repeated") +
         line("practice", study::practice_words(study)) +
         line("feedback in trials", ask.feedback ? "yes" : "no");
}

std::string exploration_lines(const study::Study& study) {
  const study::Ask ask = study::ask_of(study);
  if (const auto* const exploring = std::get_if<study::InContact>(&ask.exploring)) {
    return clocked_lines(study, ask, *exploring);
  }
  const study::TrialOptions& trials = study.trials;
  return line("time to explore", number_text(trials.explore_limit_s) + " s") +
         line("before an answer", study::touch_words(trials.answer_after)) +
         line("practice", study::practice_words(study)) +
         line("catch trials (not scored)", std::to_string(trials.catch_trials));
}

std::string design_lines(const study::Study& study) {
  const std::string visits = study::visits_words(study.visits);
  return line("protocol", study.protocol_name()) +
         line("classes", std::to_string(study.classes.size()) + " (" + labels_of(study) + ")") +
         line("methods presented", study.presented_labels()) +
         line("scored trials per participant", std::to_string(study.scored_trials())) +
         (visits.empty() ? "" : line("visits", visits)) +
         (study.groups.labels.empty()
              ? ""
              : line("groups", listed(study.groups.labels) +
                                   (study.groups.open ? ", open to the experimenter" : ""))) +
         exploration_lines(study) + line("language", study::language_words(study.session)) +
         line("what participants see", study::sight_words(study)) +
         line("masking noise", study::masking_words(study.session.masking)) +
         line("orders", study.task->rule(study));
}

std::string validity_of(const study::ValidityRule& rule) {
  return "A trial is valid if all of these conditions hold:\n\n" + lines_of(study::fields_of(rule));
}

/// The settings as every database has them in clear, without the stimuli's codes.
std::string settings_in_clear(const study::StudyCodes& key) {
  const auto settings = nlohmann::json::parse(key.configuration);
  std::string lines;
  for (const auto& [name, value] : settings.items()) {
    if (name != "stimuli") lines += line(name, "`" + value.dump() + "`");
  }
  return lines;
}

std::string hashes_of(const study::StudyCodes& key, const engine::Pack& pack) {
  return line("seal", "`" + to_hex(key.seal) + "`") +
         line("pack", "`" + to_hex(pack.digest()) + "`") +
         line("study identity", "`" + key.study_id + "`") +
         line("investigator", "`" + to_hex(key.investigator_signature) + "`") +
         line("program", "Touchtrial " + std::string(program_version())) +
         "\nThe seal is SHA-256 over key, schedule rule, seed and configuration; "
         "every database of the study begins with it. With the key, `touchtrial verify` checks "
         "that a database belongs to the study registered here; without it, that all of it was "
         "signed by this investigator and the stations that the investigator named.\n";
}

}  // namespace

record::StudyCommitment commitment_of(const study::StationKey& key, const engine::Pack& pack,
                                      bool simulated, bool pilot) {
  record::StudyCommitment commitment;
  commitment.study = key.study.name;
  commitment.protocol = key.study.protocol_name();
  commitment.study_id = key.study_id;
  commitment.seal = key.seal;
  commitment.pack = pack.digest();
  commitment.configuration = key.configuration;
  commitment.scored_trials = key.study.scored_trials();
  commitment.positions = static_cast<int>(study::choices_of(key.study).size());
  commitment.simulated = simulated;
  commitment.pilot = pilot;
  commitment.safety_record_years = key.study.registration.safety_record_years;
  commitment.program_version = program_version();
  commitment.investigator = key.investigator_signature;
  commitment.station = {
      .name = key.station.name, .key = key.signer().public_half(), .certificate = key.certificate};
  return commitment;
}

record::StudyCommitment commitment_of(const study::StudyKey& key, const engine::Pack& pack,
                                      bool simulated, bool pilot) {
  return commitment_of(study::station_key(key, key.stations.front().name), pack, simulated, pilot);
}

void require_prepared(const study::Study& study, const study::StudyCodes& key,
                      const std::filesystem::path& key_file, const engine::Pack& pack) {
  const auto refuse = [&study](const std::string& what) {
    throw UsageError(one_line(study.source + ": " + what));
  };
  if (key.simulated) refuse("its key is for simulations only; run `touchtrial prepare`");
  if (!study::are_same(study, key.study)) {
    throw UsageError(study::mismatch_of(study, key, key_file, "--key"));
  }
  const engine::PackManifest& manifest = pack.manifest();
  if (manifest.study_id != key.study_id) {
    refuse("the key " + key_file.string() + " belongs to study " + key.study_id +
           ", but the pack " + pack.folder().string() + " to study " + manifest.study_id +
           "; give the pack's key with --key, or the key's pack with --pack");
  }
  study::require_signed(pack, key.study_id, key.seal, key.investigator_signature);
}

std::string registration_page(const study::StudyCodes& key, const engine::Pack& pack) {
  const study::Study& study = key.study;
  const study::Registration& registration = study.registration;
  return "# Preregistration of the study " + study.name + "\n" +
         section("Hypothesis", registration.hypothesis) +
         section("Sample size", participants_of(registration)) +
         section("Stopping rule", registration.stopping_rule) +
         section("Exclusions", registration.exclusions) +
         section("Validity of trials", validity_of(study.trials.validity)) +
         section("Primary test", registration.primary_test) +
         section("Analysis, as the program checks it", lines_of(study::fields_of(registration))) +
         section("Design", design_lines(study)) +
         section("Extraction methods", lines_of(study::fields_of_methods(study))) +
         section("Rendering", lines_of(study::fields_of_rendering(study))) +
         section("Settings", settings_in_clear(key)) + section("Commitment", hashes_of(key, pack));
}

std::vector<std::string> missing_statements(const study::Registration& registration) {
  std::vector<std::string> places;
  const auto look = [&places](const char* key, bool stated) {
    if (!stated) places.push_back(std::string("/registration/") + key);
  };
  look("hypothesis", !registration.hypothesis.empty());
  look("participants", registration.participants > 0);
  look("stopping_rule", !registration.stopping_rule.empty());
  look("exclusions", !registration.exclusions.empty());
  look("primary_test", !registration.primary_test.empty());
  look("estimand", registration.analysis.has_value());
  return places;
}

}  // namespace touchtrial::session
