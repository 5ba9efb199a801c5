// report: prints the results of a study, or the quality of its data before unblinding.
#include "analysis/outcomes/identities.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/planning/level_report.hpp"
#include "analysis/report/page/report_folder.hpp"
#include "analysis/report/page/study_document.hpp"
#include "analysis/report/results.hpp"
#include "analysis/verification/head_check.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/study_store.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  fs::path database;
  fs::path key;
  fs::path folder;
  std::string cues = "auto";
  std::string trial;
  bool paper_values = false;
  bool json = false;
  bool is_public = false;
  analysis::HeadCheck heads{};  ///< the comparison, once the database is open
};

void write_report(const ReportArguments& arguments, const analysis::ReportFiles& files) {
  analysis::write_report_folder(arguments.folder, files);
  print((arguments.folder / "report.html").string() + "\n");
}

/// Compares the database with its head files; a public report shows neither folders nor ids.
analysis::HeadCheck heads_for(const record::StudyStore& store, const ReportArguments& arguments) {
  analysis::HeadCheck heads = analysis::check_heads(store, arguments.database);
  if (!heads.missing.empty())
    spdlog::warn("{}: {}", one_line(arguments.database.string()), heads.words());
  if (!arguments.is_public) return heads;
  if (!heads.missing.empty())
    heads.missing = "the database lacks events that its head file records";
  if (!heads.missing_files.empty()) heads.missing_files = "a head file is missing";
  return heads;
}

analysis::Provenance provenance_for(const record::StudyStore& store,
                                    const ReportArguments& arguments) {
  analysis::Provenance provenance =
      analysis::provenance_of(store, arguments.database.filename().string());
  provenance.head_summary = arguments.heads.words();
  provenance.is_incomplete = !arguments.heads.missing.empty();
  if (arguments.is_public) provenance.state.unblinding_reason.clear();
  return provenance;
}

/// Adds the confirmed head of the database to the JSON object of a report.
std::string with_confirmed_head(const std::string& text, const analysis::HeadCheck& heads) {
  auto object = nlohmann::ordered_json::parse(text);
  object["vouched"] = {{"head", nullptr}, {"head_files", heads.compared}, {"fault", heads.fault()}};
  if (heads.confirmed) {
    object["vouched"]["head"] = {{"length", heads.confirmed->file.length},
                                 {"hash", to_hex(heads.confirmed->file.hash)}};
  }
  return json_text(object);
}

/// Refuses --trial and --cues yes, which show what was presented, and --public.
void refuse_while_blind(const record::StudyState& state, const ReportArguments& arguments) {
  const std::string place =
      one_line(arguments.database.filename().string()) + ": " + blind_words(state);
  if (arguments.is_public) {
    throw UsageError(place + ", and --public applies to results only; omit it");
  }
  if (arguments.trial.empty() && arguments.cues != "yes") return;
  throw UsageError(place +
                   ", and --trial and --cues yes show outcomes; run `touchtrial "
                   "close` and `touchtrial unblind`, or omit them");
}

int report_quality(const record::StudyStore& store, const ReportArguments& arguments) {
  const analysis::QualityReport quality = analysis::make_quality(store);
  const std::string json = with_confirmed_head(analysis::quality_json(quality), arguments.heads);
  const analysis::Document document =
      analysis::quality_document(quality, provenance_for(store, arguments));
  if (!arguments.folder.empty()) {
    write_report(arguments, analysis::report_files(document, json));
  } else {
    print(arguments.json ? json : analysis::document_text(document, columns_of_output()));
  }
  return 0;
}

analysis::ReportOptions report_options(const ReportArguments& arguments,
                                       const analysis::TraceSource& traces) {
  using Traces = analysis::ReportOptions::Traces;
  return {.source = &traces,
          .page = !arguments.folder.empty(),
          .traces = arguments.cues == "auto"  ? Traces::if_few
                    : arguments.cues == "yes" ? Traces::yes
                                              : Traces::no,
          .trial = arguments.trial,
          .published_values = arguments.paper_values,
          .progress = progress_bar("reading traces")};
}

int write_outcomes(const record::StudyStore& store, const analysis::Outcomes& outcomes,
                   const analysis::Results& results, const ReportArguments& arguments) {
  const analysis::Provenance provenance = provenance_for(store, arguments);
  const analysis::DrawnFigures figures = analysis::draw_report_figures(
      results.figures(analysis::further_stamp(outcomes.pilot, provenance)));
  if (!figures.missing.empty()) {
    std::fputs(("touchtrial: warning: figures are left out: " + figures.missing + "\n").c_str(),
               stderr);
  }
  analysis::ReportFiles files =
      analysis::report_files(results.document(provenance, figures.pictures),
                             with_confirmed_head(results.json(), arguments.heads));
  files.insert(figures.files.begin(), figures.files.end());
  write_report(arguments, files);
  return 0;
}

void print_results(const record::StudyStore& store, const analysis::Results& results,
                   const ReportArguments& arguments) {
  print(arguments.json
            ? with_confirmed_head(results.json(), arguments.heads)
            : analysis::document_text(results.document(provenance_for(store, arguments), {}),
                                      columns_of_output()));
}

/// Reports only the registered question, after a registered interim look.
int report_question(const record::StudyStore& store, const ReportArguments& arguments) {
  const study::StudyKey key = key_of_database(store, arguments.database, arguments.key);
  const analysis::Outcomes outcomes = analysis::load_outcomes_for_question(store, key);
  const auto results = analysis::analysis_of(outcomes.design).results(outcomes, {});
  const auto answer = analysis::registered_answer_only(*results, store);
  if (arguments.folder.empty()) {
    print_results(store, *answer, arguments);
  } else {
    write_report(arguments,
                 analysis::report_files(answer->document(provenance_for(store, arguments), {}),
                                        with_confirmed_head(answer->json(), arguments.heads)));
  }
  return 0;
}

/// Adds the levels of the stimuli. Computing them takes most of the time of a small study's report,
/// so a report on the terminal has only a note on where to find them.
std::unique_ptr<const analysis::Results> with_levels_or_note(
    std::unique_ptr<const analysis::Results> results, const study::StudyKey& key,
    const ReportArguments& arguments) {
  if (!arguments.folder.empty() || arguments.json) return with_levels(std::move(results), key);
  if (!path_exists(key.pack_folder / "pack.json")) return results;
  return planning::with_levels_note(std::move(results));
}

int report(const ReportArguments& initial) {
  ReportArguments arguments = initial;
  const record::StudyStore store =
      record::StudyStore::open(arguments.database, record::StudyStore::Access::read_only);
  arguments.heads = heads_for(store, arguments);
  if (!arguments.folder.empty()) {
    analysis::refuse_other_study(arguments.folder, store.commitment().study);
    analysis::refuse_foreign_files(arguments.folder);
  }
  const record::StudyState state = store.state();
  if (!state.unblinded) refuse_while_blind(state, arguments);
  if (state.question) return report_question(store, arguments);
  if (!state.unblinded) return report_quality(store, arguments);
  const study::StudyKey key = key_of_database(store, arguments.database, arguments.key);
  analysis::Outcomes outcomes = outcomes_of(store, key);
  if (arguments.is_public) outcomes = analysis::without_identities(std::move(outcomes));
  const analysis::TraceSource traces{store, key};
  const auto results = with_levels_or_note(
      analysis::analysis_of(outcomes.design).results(outcomes, report_options(arguments, traces)),
      key, arguments);
  if (!arguments.folder.empty()) return write_outcomes(store, outcomes, *results, arguments);
  print_results(store, *results, arguments);
  return 0;
}

}  // namespace

void add_report_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "report",
                  "Print the results; before unblinding, only the quality of the data", report);
  add_database_argument(command, arguments.database);
  add_key_option(command, arguments.key);
  CLI::Option* json = add_json_flag(command, arguments.json);
  CLI::Option* folder = command.add_option("-o,--out", arguments.folder,
                                           "Folder for a page with all tables and figures, the "
                                           "tables as Markdown and LaTeX, the figures "
                                           "as SVG and PDF, and results.json");
  folder->check(place_validator())->excludes(json);
  add_force_flag(command);
  command
      .add_option(
          "--cues", arguments.cues,
          "Read all traces for ideal observers; auto: with --out, if there are at most 2,500")
      ->check(CLI::IsMember({"auto", "yes", "no"}))
      ->capture_default_str();
  CLI::Option* is_public = command.add_flag("--public", arguments.is_public,
                                            "Leave out participants' ids, serial numbers, times "
                                            "of day, and every reason, note and remark");
  command
      .add_option("--trial", arguments.trial,
                  "Trial whose exploration is drawn over its texture, for instance P01:3 (default: "
                  "if traces "
                  "are read, the first counted trial of each method)")
      ->type_name("PARTICIPANT:N")
      ->excludes(is_public)
      ->needs(folder);
  command
      .add_flag(
          "--paper-values", arguments.paper_values,
          "Show the source paper's accuracies (other images, another device) in the figure by "
          "class")
      ->needs(folder);
}

}  // namespace touchtrial::app
