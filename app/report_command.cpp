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

namespace touchtrial::app {
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

void write_report(const ReportArguments& arguments, const analysis::ReportFiles& files) {
  analysis::write_report_folder(arguments.folder, files);
  print((arguments.folder / "report.html").string() + "\n");
}

analysis::Provenance provenance_for(const store::StudyStore& store,
                                    const ReportArguments& arguments) {
  return analysis::provenance_of(store, collect::study_name(arguments.database.string()));
}

/// Both show what was presented.
void refuse_while_blind(const ReportArguments& arguments) {
  if (arguments.trial.empty() && arguments.cues != "yes") return;
  throw UsageError(one_line(collect::study_name(arguments.database.string())) +
                   ": not unblinded, and --trial and --cues yes are of outcomes; run `touchtrial "
                   "close` and `touchtrial unblind`, or leave them out");
}

int report_quality(const store::StudyStore& store, const ReportArguments& arguments) {
  const analysis::QualityReport quality = analysis::make_quality(store);
  if (arguments.folder.empty()) {
    print(arguments.json ? analysis::quality_json(quality) : analysis::quality_text(quality));
    return 0;
  }
  const analysis::Document document = analysis::quality_document(
      quality, analysis::load_collection(store), provenance_for(store, arguments));
  write_report(arguments, analysis::report_files(document, analysis::quality_json(quality)));
  return 0;
}

bool reads_traces(const ReportArguments& arguments, const analysis::Outcomes& outcomes) {
  if (arguments.cues != "auto") return arguments.cues == "yes";
  return !arguments.folder.empty() && analysis::traces_to_read(outcomes) <= kTracesUnasked;
}

std::vector<analysis::ExplorationPath> explorations(const store::StudyStore& store,
                                                    const design::StudyKey& key,
                                                    const analysis::Outcomes& outcomes,
                                                    const ReportArguments& arguments) {
  if (!arguments.trial.empty()) {
    return {
        analysis::exploration_named(store, key, outcomes, analysis::trial_name(arguments.trial))};
  }
  if (arguments.folder.empty() || !reads_traces(arguments, outcomes)) return {};
  return analysis::first_explorations(store, key, outcomes);
}

int write_outcomes(const store::StudyStore& store, const analysis::StudyReport& report,
                   const std::vector<analysis::ExplorationPath>& paths,
                   const ReportArguments& arguments) {
  const analysis::FigureOptions options{
      .paper_values = arguments.paper_values,
      .cues = report.cues ? &*report.cues : nullptr,
      .explorations = paths,
      .stamp = analysis::further_stamp(report, provenance_for(store, arguments))};
  const analysis::DrawnFigures figures =
      analysis::draw_report_figures(analysis::report_figures(report, options));
  if (!figures.missing.empty()) {
    std::fputs(("touchtrial: warning: without figures: " + figures.missing + "\n").c_str(), stderr);
  }
  const analysis::Document document =
      analysis::study_document(report, provenance_for(store, arguments), figures.pictures);
  analysis::ReportFiles files = analysis::report_files(document, analysis::report_json(report));
  files.insert(figures.files.begin(), figures.files.end());
  write_report(arguments, files);
  return 0;
}

int report(const ReportArguments& arguments) {
  const store::StudyStore store = collect::open_study(arguments.database.string());
  if (!arguments.folder.empty()) {
    analysis::refuse_other_study(arguments.folder, store.commitment().study);
    analysis::refuse_strangers(arguments.folder);
  }
  if (!store.state().unblinded) {
    refuse_while_blind(arguments);
    return report_quality(store, arguments);
  }
  const design::StudyKey key = key_of_database(store, arguments.database, arguments.key);
  const analysis::Outcomes outcomes = analysis::load_outcomes(store, key);
  // First what may be refused.
  const std::vector<analysis::ExplorationPath> paths =
      explorations(store, key, outcomes, arguments);
  analysis::StudyReport study = analysis::make_report(outcomes);
  if (reads_traces(arguments, outcomes)) {
    study.cues =
        analysis::make_cues(store, key, outcomes, {.progress = progress_bar("reading traces")});
  }
  if (!arguments.folder.empty()) return write_outcomes(store, study, paths, arguments);
  print(arguments.json ? analysis::report_json(study) : analysis::report_text(study));
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

}  // namespace touchtrial::app
