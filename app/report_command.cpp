#include "analysis/cues/chosen_explorations.hpp"
#include "analysis/cues/cue_report.hpp"
#include "analysis/figures/figures.hpp"
#include "analysis/outcomes.hpp"
#include "analysis/page/drawn_figures.hpp"
#include "analysis/page/report_folder.hpp"
#include "analysis/page/study_document.hpp"
#include "analysis/report/quality.hpp"
#include "analysis/report/report.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/key_of_database.hpp"
#include "core/errors.hpp"
#include "protocols/collect/open_study.hpp"
#include "protocols/store/study_store.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

/// More traces than these are read only if somebody asks: it takes seconds.
constexpr int kTracesUnasked = 2500;

struct ReportArguments {
  fs::path database;
  fs::path key;
  fs::path folder;
  std::string cues = "auto";
  std::string trial;
  bool paper_values = false;
  bool json = false;
};

void write_report(const ReportArguments& arguments, const ReportFiles& files) {
  write_report_folder(arguments.folder, files);
  print((arguments.folder / "report.html").string() + "\n");
}

Provenance provenance_for(const StudyStore& store, const ReportArguments& arguments) {
  return provenance_of(store, study_name(arguments.database.string()));
}

/// Both show what was presented.
void refuse_while_blind(const ReportArguments& arguments) {
  if (arguments.trial.empty() && arguments.cues != "yes") return;
  throw UsageError(one_line(study_name(arguments.database.string())) +
                   ": not unblinded, and --trial and --cues yes are of outcomes; run `touchtrial "
                   "close` and `touchtrial unblind`, or leave them out");
}

int report_quality(const StudyStore& store, const ReportArguments& arguments) {
  const QualityReport quality = make_quality(store);
  if (arguments.folder.empty()) {
    print(arguments.json ? quality_json(quality) : quality_text(quality));
    return 0;
  }
  const Document document =
      quality_document(quality, load_collection(store), provenance_for(store, arguments));
  write_report(arguments, report_files(document, quality_json(quality)));
  return 0;
}

bool reads_traces(const ReportArguments& arguments, const Outcomes& outcomes) {
  if (arguments.cues != "auto") return arguments.cues == "yes";
  return !arguments.folder.empty() && traces_to_read(outcomes) <= kTracesUnasked;
}

std::vector<ExplorationPath> explorations(const StudyStore& store, const StudyKey& key,
                                          const Outcomes& outcomes,
                                          const ReportArguments& arguments) {
  if (!arguments.trial.empty()) {
    return {exploration_named(store, key, outcomes, trial_name(arguments.trial))};
  }
  if (arguments.folder.empty() || !reads_traces(arguments, outcomes)) return {};
  return first_explorations(store, key, outcomes);
}

int write_outcomes(const StudyStore& store, const StudyReport& report,
                   const std::vector<ExplorationPath>& paths, const ReportArguments& arguments) {
  const FigureOptions options{.paper_values = arguments.paper_values,
                              .cues = report.cues ? &*report.cues : nullptr,
                              .explorations = paths,
                              .stamp = further_stamp(report, provenance_for(store, arguments))};
  const DrawnFigures figures = draw_report_figures(report_figures(report, options));
  if (!figures.missing.empty()) {
    std::fputs(("touchtrial: warning: without figures: " + figures.missing + "\n").c_str(), stderr);
  }
  const Document document =
      study_document(report, provenance_for(store, arguments), figures.pictures);
  ReportFiles files = report_files(document, report_json(report));
  files.insert(figures.files.begin(), figures.files.end());
  write_report(arguments, files);
  return 0;
}

int report(const ReportArguments& arguments) {
  const StudyStore store = open_study(arguments.database.string());
  if (!arguments.folder.empty()) {
    refuse_other_study(arguments.folder, store.commitment().study);
    refuse_strangers(arguments.folder);
  }
  if (!store.state().unblinded) {
    refuse_while_blind(arguments);
    return report_quality(store, arguments);
  }
  const StudyKey key = key_of_database(store, arguments.database, arguments.key);
  const Outcomes outcomes = load_outcomes(store, key);
  // First what may be refused.
  const std::vector<ExplorationPath> paths = explorations(store, key, outcomes, arguments);
  StudyReport study = make_report(outcomes);
  if (reads_traces(arguments, outcomes)) {
    study.cues = make_cues(store, key, outcomes, {.progress = progress_bar("reading traces")});
  }
  if (!arguments.folder.empty()) return write_outcomes(store, study, paths, arguments);
  print(arguments.json ? report_json(study) : report_text(study));
  return 0;
}

}  // namespace

void add_report_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = program.add_subcommand(
      "report", "Accuracy tables; before unblinding, the quality of the data alone");
  command
      ->add_option("DB", arguments->database, "Database of the study, or its postgresql:// address")
      ->check(study_place_validator())
      ->required();
  command->add_option("--key", arguments->key, "Key of the study (default: DB.key)");
  auto* json = command->add_flag("--json", arguments->json, "One JSON object in place of tables");
  auto* folder = command->add_option(
      "-o,--out", arguments->folder,
      "Folder for a page with all tables and figures, the tables as Markdown and "
      "LaTeX, the figures as SVG and PDF, and results.json");
  folder->check(place_validator())->excludes(json);
  command
      ->add_option("--cues", arguments->cues,
                   "Read all traces for ideal observers; auto: with --out, up to 2,500 traces")
      ->check(CLI::IsMember({"auto", "yes", "no"}))
      ->capture_default_str();
  command
      ->add_option("--trial", arguments->trial,
                   "Trial whose exploration is drawn over its texture, as P01:3; else, if traces "
                   "are read, each method's first counted one")
      ->type_name("PARTICIPANT:N")
      ->needs(folder);
  command
      ->add_flag("--paper-values", arguments->paper_values,
                 "The source paper's accuracies as marks in the figure by class: other images, "
                 "another device")
      ->needs(folder);
  command->callback([=, &action] { action = [=] { return report(*arguments); }; });
}

}  // namespace touchtrial
