#include "analysis/exports/bids/export_bids.hpp"

#include "analysis/exports/bids/bids_people.hpp"
#include "analysis/exports/bids/bids_sidecars_json.hpp"
#include "analysis/exports/bids/bids_stimuli.hpp"
#include "analysis/exports/bids/bids_traces.hpp"
#include "analysis/exports/bids/bids_trials.hpp"
#include "analysis/exports/bids/bids_tsv.hpp"
#include "analysis/exports/dataset_readme.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/quality.hpp"
#include "analysis/results.hpp"
#include "core/errors.hpp"
#include "protocols/store/study_store.hpp"

#include <memory>
#include <mutex>
#include <set>

namespace touchtrial::analysis {
namespace {

using Files = std::vector<ExportFile>;

void append(Files& files, Files more) {
  files.insert(files.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

void require_unblinded(const DatasetSource& study, const DatasetOptions& options) {
  if (study.outcomes != nullptr || !(options.traces || options.stimuli)) return;
  throw UsageError(
      "traces and stimuli tell what was presented, and are exported after unblinding; leave out "
      "--traces and --with-stimuli");
}

void add_people(Files& files, const DatasetSource& study,
                const std::vector<BidsSession>& sessions) {
  const bool simulated = study.store.commitment().simulated;
  const DataTable people = bids_participants(study, sessions);
  files.push_back(text_file("participants.tsv", tsv_text(people)));
  files.push_back(text_file("participants.json", columns_json(people.columns, simulated)));
  std::set<std::string> done;
  for (const BidsSession& session : sessions) {
    if (session.label.empty() || !done.insert(session.subject).second) continue;
    const DataTable table = bids_sessions_of(session.subject, sessions);
    const std::string name = session.subject + "/" + session.subject + "_sessions";
    files.push_back(text_file(name + ".tsv", tsv_text(table)));
    files.push_back(text_file(name + ".json", columns_json(table.columns, simulated)));
  }
}

void add_trials(Files& files, const DatasetSource& study, const DatasetOptions& options,
                const std::vector<BidsSession>& sessions, const std::string& task) {
  const BidsTrials trials = bids_trials(study, options.stimuli);
  files.push_back(
      text_file("task-" + task + "_beh.json", task_json(study, options, trials.columns)));
  for (const BidsSession& session : sessions) {
    files.push_back(
        text_file(session.folder() + "/" + session.stem() + "_task-" + task + "_beh.tsv",
                  tsv_text(trials.by_session.at(session.row.session))));
  }
}

void add_report(Files& files, const DatasetSource& study) {
  const std::string folder = "derivatives/touchtrial/";
  files.push_back(
      text_file(folder + "dataset_description.json", derivative_description_json(study)));
  files.push_back(
      study.outcomes != nullptr
          ? text_file(folder + "results.json",
                      analysis_of(study.outcomes->design).results(*study.outcomes, {})->json())
          : text_file(folder + "quality.json", quality_json(make_quality(study.store))));
}

/// Reports how many files are written. One thread reports at a time.
class Progress {
 public:
  Progress(std::function<void(int, int)> tell, int of) : tell_(std::move(tell)), of_(of) {}

  void one_more() {
    const std::lock_guard lock(mutex_);
    tell_(++done_, of_);
  }

 private:
  std::mutex mutex_;
  std::function<void(int, int)> tell_;
  int of_;
  int done_ = 0;
};

void tell_progress(Files& files, const DatasetOptions& options) {
  if (!options.progress) return;
  const auto progress =
      std::make_shared<Progress>(options.progress, static_cast<int>(files.size()));
  for (ExportFile& file : files) {
    file.write = [write = std::move(file.write), progress](const std::filesystem::path& path) {
      write(path);
      progress->one_more();
    };
  }
}

}  // namespace

std::vector<std::filesystem::path> export_bids(const DatasetSource& study,
                                               const DatasetOptions& options,
                                               const std::filesystem::path& folder) {
  require_unblinded(study, options);
  const store::StudyCommitment& commitment = study.store.commitment();
  const std::string task = plain_label(commitment.study);
  const std::vector<BidsSession> sessions = bids_sessions(study.store);
  Files files{text_file("dataset_description.json", dataset_description_json(study, options)),
              text_file("README", bids_readme(study, options))};
  add_people(files, study, sessions);
  add_trials(files, study, options, sessions, task);
  if (options.stimuli) append(files, stimulus_files(study.key->study));
  if (options.traces) append(files, trace_files(study, sessions, task));
  add_report(files, study);
  if (!options.database.empty()) {
    files.push_back({"sourcedata/" + options.database.filename().string(),
                     [from = options.database](const std::filesystem::path& path) {
                       store::copy_database(from, path);
                     }});
  }
  tell_progress(files, options);
  return write_export(folder, {commitment.study, commitment.study_id, "bids"}, files);
}

}  // namespace touchtrial::analysis
