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

std::string line(const std::string& name, const std::string& value) {
  return "- " + name + ": " + value + "\n";
}

/// Lists the labels in alphabetical order, so that their order in the study is not revealed.
std::string labels_of(const study::Study& study) {
  std::vector<std::string> labels;
  for (const study::StudyClass& study_class : study.classes) labels.push_back(study_class.label);
  std::ranges::sort(labels);
  return listed(labels);
}

std::string participants_of(const study::Registration& registration) {
  if (registration.participants == 0) return "";
  return counted(registration.participants, "participant") + ".";
}

std::string lines_of(const study::SettingFields& fields) {
  std::string lines;
  for (const auto& [name, value] : fields) lines += line(name, value);
  return lines;
}

/// Describes trials with timed contact. The rule of orders, on another line, states the number of
/// trials.
std::string timed_contact_lines(const study::Study& study, const study::TrialQuestion& question,
                                const study::TimedContact& exploring) {
  return line("planes per trial", std::to_string(question.planes)) +
         line("exploration of each", number_text(exploring.seconds) + " s in contact, at " +
                                         study::range_words(exploring.range) + ", within " +
                                         number_text(study.trials.explore_limit_s) +
                                         " s; otherwise the trial is repeated") +
         line("practice", study::practice_words(study)) +
         line("feedback in trials", question.feedback ? "yes" : "no");
}

std::string exploration_lines(const study::Study& study) {
  const study::TrialQuestion question = study::trial_question_of(study);
  if (const auto* const exploring = std::get_if<study::TimedContact>(&question.exploring)) {
    return timed_contact_lines(study, question, *exploring);
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

/// The settings that every database stores unencrypted, without the stimuli's codes.
std::string unencrypted_settings(const study::StudyCodes& key) {
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
         "that a database belongs to the study registered here; without it, that this "
         "investigator and the stations that the investigator named signed all of it.\n";
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
  if (key.simulated) refuse("its key is only for simulations; run `touchtrial prepare`");
  if (!study::are_same(study, key.study)) {
    throw UsageError(study::mismatch_of(study, key, key_file, "--key"));
  }
  const engine::PackManifest& manifest = pack.manifest();
  if (manifest.study_id != key.study_id) {
    refuse("the key " + key_file.string() + " belongs to study " + key.study_id +
           ", but the pack " + pack.folder().string() + " belongs to study " + manifest.study_id +
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
         section("Settings", unencrypted_settings(key)) +
         section("Commitment", hashes_of(key, pack));
}

std::vector<std::string> missing_statements(const study::Registration& registration) {
  std::vector<std::string> places;
  const auto check = [&places](const char* key, bool is_stated) {
    if (!is_stated) places.push_back(std::string("/registration/") + key);
  };
  check("hypothesis", !registration.hypothesis.empty());
  check("participants", registration.participants > 0);
  check("stopping_rule", !registration.stopping_rule.empty());
  check("exclusions", !registration.exclusions.empty());
  check("primary_test", !registration.primary_test.empty());
  check("estimand", registration.analysis.has_value());
  return places;
}

}  // namespace touchtrial::session
