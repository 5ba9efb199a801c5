#include "analysis/exports/bids/export_bids.hpp"

#include "analysis/exports/bids/bids_motion.hpp"
#include "analysis/exports/bids/bids_people.hpp"
#include "analysis/exports/bids/bids_sidecars_json.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "record/marks.hpp"
#include "record/study_store.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using Files = std::vector<ExportFile>;

std::string bids_readme(const DatasetSource& study, const DatasetOptions& options) {
  std::string text = study.store.commitment().study + "\n\n" + study_readme(study);
  text += fmt::format(
      "Each *_beh.tsv has a session's trials, one row per trial, {}; task-*_beh.json describes the "
      "columns. Labels "
      "of participants are their ids with Zd for a hyphen, Zu for an underscore, Zp for a plus "
      "sign and ZZ for Z; participants.tsv has both.\n",
      study.outcomes != nullptr ? "in the order of presentation" : "by number");
  if (options.traces) {
    text +=
        "*_motion.tsv contain the stylus's position and the force sent while a plane could be "
        "felt. "
        "Each run is a trial; *_channels.tsv names the columns; times in the *_events.tsv beside "
        "them start at the run's first sample. *_scans.tsv give the time of that sample, with "
        "shifted dates.\n";
  }
  if (study.outcomes != nullptr) {
    text +=
        "beh/*_events.tsv list what happened besides trials, such as interruptions and pauses; "
        "phenotype/ has answers to questions";
    text += options.free_text == FreeText::shown ? ".\n" : ", without free text.\n";
  }
  if (options.stimuli)
    text += "stimuli/ contains the images from which the textures were extracted.\n";
  if (!options.database.empty()) {
    text += "sourcedata/ contains the study's database; its key is not part of the dataset.\n";
  }
  return text + "derivatives/touchtrial contains the program's report.\n";
}

/// The name of an image in stimuli/: the number of its class, the class's letters and digits, and
/// the number of the image, for example "01-bark-01.png".
std::string stimulus_name(const study::Study& study, int class_index, int exemplar) {
  const study::StudyClass& stimulus_class = study.classes.at(class_index);
  return fmt::format("{:02}-{}-{:02}{}", class_index + 1, plain_label(stimulus_class.label),
                     exemplar + 1, stimulus_class.images.at(exemplar).extension().string());
}

/// Copies of every image.
/// \throws FileError if an image is missing
Files stimulus_files(const study::Study& study) {
  Files files;
  for (int i = 0; i < static_cast<int>(study.classes.size()); ++i) {
    for (int k = 0; k < static_cast<int>(study.classes[i].images.size()); ++k) {
      const std::filesystem::path image = study.folder / study.classes[i].images[k];
      if (!path_exists(image)) {
        throw FileError(one_line(image.string()) +
                        ": the study's image is missing; restore it, or leave out --with-stimuli");
      }
      files.push_back(
          {"stimuli/" + stimulus_name(study, i, k), [image](const std::filesystem::path& path) {
             write_output(path, ByteView(read_file(image)));
           }});
    }
  }
  return files;
}

/// A column's BIDS name if there is one, otherwise its own name.
std::string bids_name(std::string_view column) {
  if (column == "class") return "trial_type";
  if (column == "reaction_time_s") return "response_time";
  return std::string(column);
}

bool is_shown(const TrialColumn& column, bool unblinded) {
  const std::string_view name = column.name;
  return name != "participant" && name != "session" && (unblinded || !column.after_unblinding);
}

DataCell stimulus_file(const TrialView& trial) {
  if (!trial.outcome->has_stimulus) return std::monostate{};
  const study::StimulusIndex& index = trial.outcome->stimulus;
  return stimulus_name(trial.study->design, index.class_index, index.exemplar);
}

/// The trials with their outcomes, or before unblinding the unencrypted rows.
std::vector<TrialView> views_of(const DatasetSource& study,
                                const std::vector<record::TrialRow>& unencrypted) {
  static const std::string kNoParticipant;
  const bool simulated = study.store.commitment().simulated;
  std::vector<TrialView> views;
  for (const record::TrialRow& row : unencrypted) views.push_back({kNoParticipant, row, simulated});
  if (study.outcomes == nullptr) return views;
  std::vector<const TrialOutcome*> trials;
  for (const TrialOutcome& trial : study.outcomes->trials) trials.push_back(&trial);
  std::ranges::stable_sort(trials, {}, [](const TrialOutcome* trial) {
    return std::pair(trial->row.session, trial->row.presented_at);
  });
  for (const TrialOutcome* trial : trials) {
    views.push_back({kNoParticipant, trial->row, simulated, study.outcomes, trial});
  }
  return views;
}

/// Tables of each session's scored and unscored trials, in the order of presentation (before
/// unblinding, by number). The columns of trials.csv have their BIDS names here. A session without
/// trials has an empty table.
struct BidsTrials {
  std::vector<std::string> columns;
  std::map<int, DataTable> by_session;
};

/// \param options  stim_file and motion_file exist only if the dataset includes images and
///   recordings
BidsTrials bids_trials(const DatasetSource& study, const DatasetOptions& options,
                       const std::vector<BidsSession>& sessions, const std::string& task) {
  const bool unblinded = study.outcomes != nullptr;
  const std::vector<TrialColumn> columns = trial_columns_of(study.outcomes);
  BidsTrials trials;
  for (const TrialColumn& column : columns) {
    if (is_shown(column, unblinded)) trials.columns.push_back(bids_name(column.name));
  }
  if (options.stimuli) trials.columns.emplace_back("stim_file");
  if (options.traces) trials.columns.emplace_back("motion_file");
  std::map<int, const BidsSession*> by_number;
  for (const BidsSession& session : sessions) {
    by_number[session.row.session] = &session;
    trials.by_session[session.row.session].columns = trials.columns;
  }
  const std::vector<record::TrialRow> unencrypted =
      unblinded ? std::vector<record::TrialRow>() : study.store.trials();
  for (const TrialView& trial : views_of(study, unencrypted)) {
    const auto table = trials.by_session.find(trial.row.session);
    if (table == trials.by_session.end()) continue;
    std::vector<DataCell>& row = table->second.rows.emplace_back();
    for (const TrialColumn& column : columns) {
      if (is_shown(column, unblinded)) row.push_back(column.value(trial));
    }
    if (options.stimuli) row.push_back(stimulus_file(trial));
    if (!options.traces) continue;
    row.push_back(trial.row.has_trace() ? DataCell(motion_file(*by_number.at(trial.row.session),
                                                               task, trial.row.trial))
                                        : DataCell());
  }
  return trials;
}

void append(Files& files, Files added) {
  files.insert(files.end(), std::make_move_iterator(added.begin()),
               std::make_move_iterator(added.end()));
}

void require_unblinded(const DatasetSource& study, const DatasetOptions& options) {
  if (study.outcomes != nullptr || !(options.traces || options.stimuli)) return;
  throw UsageError(
      "traces and stimuli reveal what was presented, so they are exported only after unblinding; "
      "leave out --traces and --with-stimuli");
}

void add_people(Files& files, const DatasetSource& study, const DatasetOptions& options,
                const std::vector<BidsSession>& sessions) {
  const bool simulated = study.store.commitment().simulated;
  const Collection collection =
      study.outcomes != nullptr ? study.outcomes->collection : load_collection(study.store);
  const DataTable people = bids_participants(study, sessions, collection, options.consents);
  files.push_back(text_file("participants.tsv", tsv_text(people)));
  files.push_back(text_file("participants.json", columns_json(people.columns, simulated)));
  std::set<std::string> written_subjects;
  for (const BidsSession& session : sessions) {
    if (session.label.empty() || !written_subjects.insert(session.subject).second) continue;
    const DataTable table = bids_sessions_of(session.subject, sessions, collection);
    const std::string name = session.subject + "/" + session.subject + "_sessions";
    files.push_back(text_file(name + ".tsv", tsv_text(table)));
    files.push_back(text_file(name + ".json", columns_json(table.columns, simulated)));
  }
}

void add_trials(Files& files, const DatasetSource& study, const DatasetOptions& options,
                const std::vector<BidsSession>& sessions, const std::string& task) {
  const BidsTrials trials = bids_trials(study, options, sessions, task);
  files.push_back(
      text_file("task-" + task + "_beh.json", task_json(study, options, trials.columns)));
  for (const BidsSession& session : sessions) {
    files.push_back(
        text_file(session.folder() + "/beh/" + session.stem() + "_task-" + task + "_beh.tsv",
                  tsv_text(trials.by_session.at(session.row.session))));
  }
}

/// A mark as a row of events.tsv.
std::vector<DataCell> mark_cells(const InstrumentMark& mark,
                                 const std::vector<std::string>& columns) {
  std::vector<DataCell> row(columns.size());
  const auto set = [&](std::string_view column, DataCell cell) {
    row[static_cast<std::size_t>(std::ranges::find(columns, column) - columns.begin())] =
        std::move(cell);
  };
  set("onset", mark.at);
  set("incident", std::string(name_of(static_cast<record::Mark>(mark.code))));
  if (mark.trial > 0) set("trial", std::int64_t{mark.trial});
  set("value", std::int64_t{mark.code});
  if (mark.lsl_s) set("lsl_time", *mark.lsl_s);
  return row;
}

/// Adds questionnaires in phenotype/, and the incidents of sessions.
void add_questionnaires_and_incidents(Files& files, const DatasetSource& study,
                                      const DatasetOptions& options,
                                      const std::vector<BidsSession>& sessions,
                                      const std::string& task) {
  if (study.outcomes == nullptr || sessions.empty()) return;
  const bool simulated = study.store.commitment().simulated;
  const std::string& language = study.outcomes->design.session.language;
  for (const BidsQuestionnaire& questionnaire :
       bids_questionnaires(study, sessions, options.free_text)) {
    files.push_back(
        text_file("phenotype/" + questionnaire.name + ".tsv", tsv_text(questionnaire.table)));
    files.push_back(text_file("phenotype/" + questionnaire.name + ".json",
                              questionnaire_json(questionnaire, language, simulated)));
  }
  std::vector<std::string> columns{"onset", "duration",     "incident",    "trial",
                                   "code",  "safety_fault", "device_fault"};
  const bool has_marks = !study.outcomes->marks.empty();
  if (has_marks) columns.insert(columns.end(), {"value", "lsl_time"});
  if (options.free_text == FreeText::shown) columns.emplace_back("text");
  bool has_events = false;
  for (const BidsSession& session : sessions) {
    DataTable table{columns, {}};
    for (const Incident& incident : study.outcomes->incidents) {
      if (incident.session != session.row.session || !incident.at) continue;
      table.rows.push_back({*incident.at, std::monostate{},
                            std::string(record::name_of(incident.kind)),
                            incident.trial ? DataCell(std::int64_t{*incident.trial}) : DataCell(),
                            incident.code, incident.safety_fault, incident.device_fault});
      if (has_marks) table.rows.back().resize(table.rows.back().size() + 2);
      if (options.free_text == FreeText::shown) table.rows.back().emplace_back(incident.text);
    }
    for (const InstrumentMark& mark : study.outcomes->marks) {
      if (mark.session == session.row.session) table.rows.push_back(mark_cells(mark, columns));
    }
    std::ranges::stable_sort(table.rows, {}, [](const std::vector<DataCell>& row) {
      return std::get<std::chrono::nanoseconds>(row.front());
    });
    if (table.rows.empty()) continue;
    files.push_back(
        text_file(session.folder() + "/beh/" + session.stem() + "_task-" + task + "_events.tsv",
                  tsv_text(table)));
    has_events = true;
  }
  // One file describes the events of all datatypes, because BIDS allows only one per run and level.
  std::vector<std::string> event_columns;
  if (has_events) event_columns = columns;
  if (options.traces) {
    for (const std::string& column : motion_event_columns()) {
      if (std::ranges::count(event_columns, column) == 0) event_columns.push_back(column);
    }
  }
  if (event_columns.empty()) return;
  files.push_back(text_file("task-" + task + "_events.json", events_json(study, event_columns)));
}

void add_report(Files& files, const DatasetSource& study, FreeText free_text) {
  const std::string folder = "derivatives/touchtrial/";
  files.push_back(
      text_file(folder + "dataset_description.json", derivative_description_json(study)));
  files.push_back(text_file(folder + ".bidsignore", "results.json\nquality.json\n"));
  files.push_back(text_file(folder + (study.outcomes != nullptr ? "results.json" : "quality.json"),
                            report_in_dataset(study, free_text)));
}

/// Reports the number of written files; thread-safe.
class Progress {
 public:
  Progress(std::function<void(int, int)> report_progress, int total)
      : report_progress_(std::move(report_progress)), total_(total) {}

  void count_file() {
    const std::lock_guard lock(mutex_);
    report_progress_(++done_, total_);
  }

 private:
  std::mutex mutex_;
  std::function<void(int, int)> report_progress_;
  int total_;
  int done_ = 0;
};

void report_progress_of(Files& files, const DatasetOptions& options) {
  if (!options.progress) return;
  const auto progress =
      std::make_shared<Progress>(options.progress, static_cast<int>(files.size()));
  for (ExportFile& file : files) {
    file.write = [write = std::move(file.write), progress](const std::filesystem::path& path) {
      write(path);
      progress->count_file();
    };
  }
}

}  // namespace

std::vector<std::filesystem::path> export_bids(const DatasetSource& study,
                                               const DatasetOptions& options,
                                               const std::filesystem::path& folder) {
  require_unblinded(study, options);
  const record::StudyCommitment& commitment = study.store.commitment();
  const std::string task = plain_label(commitment.study);
  const std::vector<BidsSession> sessions = bids_sessions(study.store);
  Files files{text_file("dataset_description.json", dataset_description_json(study, options)),
              text_file("README", bids_readme(study, options))};
  add_people(files, study, options, sessions);
  add_trials(files, study, options, sessions, task);
  add_questionnaires_and_incidents(files, study, options, sessions, task);
  if (options.stimuli) append(files, stimulus_files(study.key->study));
  if (options.traces) append(files, motion_files(study, options, sessions, task));
  add_report(files, study, options.free_text);
  if (!options.database.empty()) {
    files.push_back({"sourcedata/" + options.database.filename().string(),
                     [from = options.database](const std::filesystem::path& path) {
                       record::copy_database(from, path);
                     }});
  }
  report_progress_of(files, options);
  return write_export(folder, {commitment.study, commitment.study_id, "bids"}, files);
}

}  // namespace touchtrial::analysis
