#include "protocols/session/commitment.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>

namespace touchtrial::session {
namespace {

std::string section(const std::string& title, const std::string& text) {
  return "\n## " + title + "\n\n" + (text.empty() ? "Not stated." : text) + "\n";
}

std::string line(const std::string& what, const std::string& value) {
  return "- " + what + ": " + value + "\n";
}

/// In alphabetical order, which does not reveal their order in the study.
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

std::string practice_words(const study::Study& study) {
  if (study.trials.practice == 0) return "none";
  const study::PracticePlan& practice = study.practice;
  return counted(study.trials.practice, "presentation") + " a round of " +
         counted(static_cast<int>(practice.classes.size()), "texture") +
         " that are not in the study; criterion " + std::to_string(practice.criterion) +
         " correct, " + counted(practice.rounds, "round") + " at most";
}

/// The participants' language; texts are part of the instrument.
std::string language_of(const study::Study& study) {
  const std::string draft = study::draft_notice(study.session.language);
  return study::language_of(study.session.language).name + (draft.empty() ? "" : ": " + draft);
}

/// Empty in a study with one visit.
std::string visits_of(const study::VisitPlan& visits) {
  if (visits.count == 1) return "";
  std::string days = "at least " + number_text(visits.least_days);
  if (visits.most_days) days += " and at most " + number_text(*visits.most_days);
  const bool divided = visits.methods == study::VisitMethods::divided;
  return line("visits", std::to_string(visits.count) + ", " + days + " days between them, " +
                            (divided ? "the methods divided between them" : "all methods at each"));
}

std::string touch_of(const study::LeastTouch& touch) {
  if (touch == study::LeastTouch{0.0, 0.0}) return "no touch needed";
  return "at least " + number_text(touch.contact_s) + " s at the plane and " +
         number_text(touch.path_mm) + " mm along it, unless time is up";
}

/// What a trial asks for whose planes have a clock; the numbers of its trials are in the rule of
/// orders.
std::string clocked(const study::Study& study, const study::Ask& ask,
                    const study::InContact& exploring) {
  const study::HandRange& range = exploring.range;
  const study::Practice practice = study::practice_of(study);
  return line("planes a trial", std::to_string(ask.planes)) +
         line("exploration of each",
              number_text(exploring.seconds) + " s in contact, at " +
                  number_text(range.slowest_mm_s) + " to " + number_text(range.fastest_mm_s) +
                  " mm/s and " + number_text(range.lightest_n) + " to " +
                  number_text(range.strongest_n) + " N, within " +
                  number_text(study.trials.explore_limit_s) + " s; else the trial is repeated") +
         line("practice", practice.trials.empty()
                              ? std::string("none")
                              : counted(static_cast<int>(practice.trials.size()), "trial") +
                                    " a round at the highest level; criterion " +
                                    std::to_string(practice.criterion) + " correct, " +
                                    counted(practice.rounds, "round") + " at most") +
         line("feedback in trials", ask.feedback ? "yes" : "no");
}

std::string exploring_of(const study::Study& study) {
  const study::Ask ask = study::ask_of(study);
  if (const auto* const exploring = std::get_if<study::InContact>(&ask.exploring)) {
    return clocked(study, ask, *exploring);
  }
  const study::TrialOptions& trials = study.trials;
  return line("time to explore", number_text(trials.explore_limit_s) + " s") +
         line("before an answer", touch_of(trials.answer_after)) +
         line("practice", practice_words(study)) +
         line("catch trials (not scored)", std::to_string(trials.catch_trials));
}

std::string design_of(const study::Study& study) {
  return line("protocol", study.protocol_name()) +
         line("classes", std::to_string(study.classes.size()) + " (" + labels_of(study) + ")") +
         line("methods presented", study.presented_labels()) +
         line("scored trials a participant", std::to_string(study.scored_trials())) +
         visits_of(study.visits) +
         (study.groups.labels.empty()
              ? ""
              : line("groups", listed(study.groups.labels) +
                                   (study.groups.open ? ", open to the experimenter" : ""))) +
         exploring_of(study) + line("language", language_of(study)) +
         line("orders", study.task->rule(study));
}

std::string validity_of(const study::ValidityRule& rule) {
  return "A trial is valid if all of this holds:\n\n" +
         line("exploration from landing",
              "at least " + number_text(rule.least_exploring_s) + " s") +
         line("contact", "at least " + number_text(rule.least_contact_s) + " s") +
         line("path in contact", "at least " + number_text(rule.least_path_mm) + " mm") +
         line("median force in contact", "from " + number_text(rule.least_median_n) + " to " +
                                             number_text(rule.largest_median_n) + " N") +
         line("samples at the force limit",
              "less than " + number_text(100 * rule.saturated_share) + " % of those in contact") +
         line("servo", "no tick missed in contact");
}

/// The registered analysis, which the program holds the study against.
std::string analysis_of(const study::Registration& registration) {
  std::string lines;
  for (const auto& [what, value] : study::fields_of(registration)) lines += line(what, value);
  return lines;
}

std::string hashes_of(const study::StudyCodes& key, const engine::Pack& pack) {
  return line("seal", "`" + to_hex(key.seal) + "`") +
         line("pack", "`" + to_hex(pack.digest()) + "`") +
         line("study identity", "`" + key.study_id + "`") +
         line("investigator", "`" + to_hex(key.investigator_signature) + "`") +
         line("program", "Touchtrial " + std::string(program_version())) +
         "\nThe seal is SHA-256 over key, schedule rule, seed and configuration; "
         "every database of the study begins with it. With the key, `touchtrial verify` tells "
         "whether a database is of the study that is registered here; without it, whether all "
         "of it was signed by this investigator and the stations that the investigator named.\n";
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
  if (key.simulated) refuse("its key belongs to a simulated study; run `touchtrial prepare`");
  if (!study::are_same(study, key.study)) {
    throw UsageError(study::misfit_of(study, key, key_file, "--key"));
  }
  const engine::PackManifest& manifest = pack.manifest();
  if (manifest.study_id != key.study_id) {
    refuse("the key " + key_file.string() + " is of study " + key.study_id + " and the pack " +
           pack.folder().string() + " of study " + manifest.study_id +
           "; name the pack's own key with --key, or the key's own pack with --pack");
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
         section("Analysis, as the program checks it", analysis_of(registration)) +
         section("Design", design_of(study)) + section("Commitment", hashes_of(key, pack));
}

std::vector<std::string> unstated(const study::Registration& registration) {
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
