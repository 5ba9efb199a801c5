// export: writes a study's data for other programs.
#include "analysis/exports/bids/export_bids.hpp"
#include "analysis/exports/export_people.hpp"
#include "analysis/exports/export_psych_ds.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/results.hpp"
#include "analysis/verification/head_check.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path database;
  fs::path key;
  fs::path folder;
  std::string format = "csv";
  std::string participant;
  bool safety = false;
  bool with_database = false;
  bool with_texts = false;
  bool for_excel = false;
  analysis::DatasetOptions dataset;
};

/// Refuses options that do not apply to the format.
void require_applicable_options(const ExportArguments& arguments) {
  const analysis::DatasetOptions& dataset = arguments.dataset;
  const bool has_bids_options =
      dataset.traces || dataset.stimuli || arguments.with_database || !dataset.institution.empty();
  if (has_bids_options && arguments.format != "bids") {
    throw UsageError(
        "--traces, --with-stimuli, --with-database and --institution belong to --format bids");
  }
  const bool is_csv = arguments.format == "csv" && arguments.participant.empty();
  if (arguments.for_excel && (!is_csv || arguments.safety)) {
    throw UsageError("--for-excel belongs to --format csv");
  }
  const bool has_dataset_options =
      !dataset.authors.empty() || !dataset.license.empty() || arguments.with_texts;
  if (has_dataset_options && arguments.format != "bids" && arguments.format != "psych-ds") {
    throw UsageError(
        "--author, --license and --with-texts belong to --format bids and --format psych-ds");
  }
}

/// Refuses an export of a study that is not unblinded.
/// \param reason  reason why the export reveals stimuli or answers
void require_outcomes(const record::StudyStore& store,
                      const std::optional<analysis::Outcomes>& outcomes,
                      const std::string& reason) {
  if (outcomes) return;
  throw StoreError("the study is " + blind_words(store.state()) + ", and " + reason +
                   "; run `touchtrial close` and `touchtrial unblind`");
}

/// The consents. If they cannot be read, prints a warning and returns none.
std::vector<record::PersonalRecord> consents_if_readable(const fs::path& database) {
  try {
    return consents_beside(database);
  } catch (const Error& error) {
    spdlog::warn("consents are left out: {}", error.what());
    return {};
  }
}

std::vector<fs::path> write_files(const ExportArguments& arguments, const record::StudyStore& store,
                                  const std::optional<study::StudyKey>& key,
                                  const std::optional<analysis::Outcomes>& outcomes) {
  const std::string& format = arguments.format;
  const auto consents = consents_if_readable(arguments.database);
  if (format == "csv") {
    return analysis::export_csv(store, outcomes, arguments.folder, consents,
                                arguments.for_excel ? analysis::kByteOrderMark : "");
  }
  if (format == "json") {
    return {analysis::export_json(store, outcomes, arguments.folder, consents)};
  }
  if (format == "r") {
    require_outcomes(store, outcomes, "a model contains outcomes");
    std::vector<fs::path> files = analysis::export_r_model(store, *outcomes, arguments.folder);
    for (fs::path& file :
         analysis::export_typed_text(store, *outcomes, arguments.folder, consents)) {
      files.push_back(std::move(file));
    }
    return files;
  }
  if (format == "events") {
    require_outcomes(store, outcomes, "forces before a fault reveal what was presented");
    return analysis::export_events(store, *key, *outcomes, arguments.folder);
  }
  const analysis::DatasetSource study{store, outcomes ? &*outcomes : nullptr,
                                      key ? &*key : nullptr};
  analysis::DatasetOptions options = arguments.dataset;
  options.free_text =
      arguments.with_texts ? analysis::FreeText::shown : analysis::FreeText::left_out;
  options.consents = consents;
  if (format == "psych-ds") return analysis::export_psych_ds(study, options, arguments.folder);
  if (arguments.with_database) options.database = arguments.database;
  if (options.traces) options.progress = progress_bar("export");
  return analysis::export_bids(study, options, arguments.folder);
}

/// Exports outcomes only with the key, after `unblind --participant`.
std::vector<fs::path> export_one_participant(const ExportArguments& arguments,
                                             const record::StudyStore& store) {
  std::optional<study::StudyKey> key;
  std::optional<analysis::Outcomes> outcomes;
  if (!arguments.key.empty()) {
    key = key_of_database(store, arguments.database, arguments.key);
    outcomes = outcomes_of(store, *key, arguments.participant);
  }
  std::vector<record::PersonalRecord> consents = consents_beside(arguments.database);
  std::erase_if(consents, [&](const record::PersonalRecord& consent) {
    return consent.participant != arguments.participant;
  });
  return analysis::export_participant(
      {store, outcomes ? &*outcomes : nullptr, key ? &*key : nullptr}, arguments.participant,
      consents, arguments.folder);
}

std::vector<fs::path> export_safety_record(const ExportArguments& arguments,
                                           const record::StudyStore& store) {
  if (arguments.key.empty()) return analysis::export_safety(store, nullptr, arguments.folder);
  const study::StudyKey key = key_of_database(store, arguments.database, arguments.key);
  return analysis::export_safety(store, &key, arguments.folder);
}

std::vector<fs::path> export_all(const ExportArguments& arguments,
                                 const record::StudyStore& store) {
  std::optional<study::StudyKey> key;
  std::optional<analysis::Outcomes> outcomes;
  if (store.state().unblinded) {
    key = key_of_database(store, arguments.database, arguments.key);
    outcomes = outcomes_of(store, *key);
  }
  return write_files(arguments, store, key, outcomes);
}

int export_study(const ExportArguments& arguments) {
  require_applicable_options(arguments);
  const record::StudyStore store =
      record::StudyStore::open(arguments.database, record::StudyStore::Access::read_only);
  const analysis::HeadCheck heads = analysis::check_heads(store, arguments.database);
  if (!heads.fault().empty())
    spdlog::warn("{}: {}", one_line(arguments.database.string()), heads.fault());
  const std::vector<fs::path> files = arguments.safety ? export_safety_record(arguments, store)
                                      : arguments.participant.empty()
                                          ? export_all(arguments, store)
                                          : export_one_participant(arguments, store);
  std::string paths;
  for (const fs::path& file : files) paths += file.string() + "\n";
  print(paths);
  return 0;
}

void add_dataset_options(CLI::App& command, ExportArguments& arguments) {
  analysis::DatasetOptions& dataset = arguments.dataset;
  command.add_flag("--traces", dataset.traces,
                   "bids: positions and forces of every trial (25 trials of 10 s: about 13 MB)");
  command.add_flag("--with-stimuli", dataset.stimuli, "bids: the study's images");
  command.add_flag("--with-database", arguments.with_database,
                   "bids: a copy of the database in sourcedata/, never its key");
  command.add_flag("--with-texts", arguments.with_texts,
                   "bids, psych-ds: typed text (answers in words, ages, notes, reasons), which may "
                   "contain names");
  command.add_option("--author", dataset.authors, "bids, psych-ds: an author; may be repeated");
  command.add_option("--license", dataset.license, "bids, psych-ds: license, for instance CC0");
  command.add_option("--institution", dataset.institution, "bids: where the data were collected");
}

}  // namespace

void add_export_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "export", "Write a study's data for other programs", export_study);
  add_database_argument(command, arguments.database);
  CLI::Option* format = command.add_option("--format", arguments.format, "Format of the export");
  format->check(CLI::IsMember({"csv", "json", "bids", "psych-ds", "r", "events"}))
      ->capture_default_str();
  command.add_option("-o,--out", arguments.folder, "Folder to write into")
      ->check(place_validator())
      ->required();
  add_force_flag(command);
  add_key_option(command, arguments.key);
  CLI::Option* participant = command.add_option(
      "--participant", arguments.participant,
      "Everything about one participant, as CSV; outcomes only with --key, after `unblind "
      "--participant`");
  command
      .add_flag(
          "--safety", arguments.safety,
          "Stops, faults, largest forces, reasons and deviations of all participants, as CSV, "
          "without outcomes; with --key also typed text")
      ->excludes(participant)
      ->excludes(format);
  participant->excludes(format);
  command.add_flag(
      "--for-excel", arguments.for_excel,
      "csv: begin each file with a byte order mark, which Excel needs for letters beyond ASCII");
  add_dataset_options(command, arguments);
}

}  // namespace touchtrial::app
