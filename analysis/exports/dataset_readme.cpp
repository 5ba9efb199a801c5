#include "analysis/exports/dataset_readme.hpp"

#include "analysis/session_rules.hpp"
#include "analysis/text_figures.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// The part that both formats share: how the data were collected, and what is still sealed.
std::string about(const DatasetSource& study) {
  const store::StudyCommitment& commitment = study.store.commitment();
  const std::vector<store::SessionRow> sessions = study.store.sessions();
  const auto counts =
      std::count_if(sessions.begin(), sessions.end(),
                    [&](const store::SessionRow& row) { return session_counts(row, commitment); });
  std::string text;
  if (commitment.simulated) {
    text +=
        "SIMULATED: every participant in this dataset is a program. Nothing in it comes from a "
        "person.\n\n";
  }
  if (commitment.pilot) text += "A pilot: not to be pooled with the study's data.\n\n";
  text += fmt::format(
      "A psychophysical study of textures that are felt through a force-feedback device, recorded "
      "with Touchtrial {}. Protocol: {}; {} textures to choose from; {} scored trials a "
      "participant; {} that count{}.\n\n",
      commitment.program_version, commitment.protocol, commitment.positions,
      commitment.scored_trials, counted(counts, "completed session"), counts == 1 ? "s" : "");
  text += study.outcomes != nullptr
              ? "Participants who withdrew are not in it. A trial enters the report where "
                "`counted` is 1: its session was completed and not excluded, it is scored, and it "
                "ended. A trial without a response counts as wrong.\n\n"
              : "Exported before unblinding: what was presented and answered is sealed, and "
                "practice, lead-ins and catch trials cannot be told from scored trials.\n\n";
  return text;
}

}  // namespace

std::string bids_readme(const DatasetSource& study, const DatasetOptions& options) {
  std::string text = study.store.commitment().study + "\n\n" + about(study);
  text +=
      "One *_beh.tsv a session, one row a trial, in the order of presentation; task-*_beh.json "
      "describes the columns. Labels of participants are their ids with Zd for a hyphen, Zu for "
      "an underscore, Zp for a plus sign and ZZ for Z; participants.tsv has both.\n";
  if (options.traces) {
    text +=
        "*_recording-trial<number>_stim.tsv.gz hold the stylus' position and the force sent, from "
        "the moment the plane could be felt; StartTime counts from the session's opening.\n";
  }
  if (options.stimuli) text += "stimuli/ holds the images that the textures were taken from.\n";
  if (!options.database.empty()) {
    text += "sourcedata/ holds the study's database; its key is not part of the dataset.\n";
  }
  return text + "derivatives/touchtrial holds the program's own report.\n";
}

std::string psych_ds_readme(const DatasetSource& study) {
  return "# " + study.store.commitment().study + "\n\n" + about(study) +
         "`data/*_description-trials_data.csv` has one row a trial, its key the columns `session` "
         "and `trial`; `data/*_description-participants_data.csv` one row a session, its key "
         "`session`. `dataset_description.json` says what each column means.\n";
}

}  // namespace touchtrial::analysis
