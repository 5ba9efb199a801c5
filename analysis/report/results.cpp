#include "analysis/report/results.hpp"

#include "analysis/exports/export_folder.hpp"
#include "analysis/report/page/frame_sections.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "study/protocol.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::map<std::string_view, const ProtocolAnalysis*>& registered_analyses() {
  static std::map<std::string_view, const ProtocolAnalysis*> all;
  return all;
}

/// Keeps only the registered estimate, its interval and test, and public data.
void keep_registered_answer(StudyHead& head, Collection public_data) {
  head.collection = std::move(public_data);
  head.warnings.clear();
  head.explorations.clear();
  head.prevalence.reset();
  if (!head.primary) return;
  head.primary->choices.resize(1);
  head.primary->permutation.reset();
  head.primary->stations.reset();
  if (head.primary->crossover) {
    head.primary->crossover->period.reset();
    head.primary->crossover->period_interval.reset();
  }
}

class RegisteredAnswer final : public Results {
 public:
  RegisteredAnswer(StudyHead head, const record::StudyStore& store)
      : head_(std::move(head)), quality_(make_quality(store)) {
    keep_registered_answer(head_, load_collection(store));
  }

  const StudyHead& head() const override { return head_; }
  std::string json() const override { return framed_json(head_, "{}"); }
  Document document(const Provenance& provenance, const Pictures&) const override {
    std::vector<Section> quality = quality_sections(quality_);
    std::erase_if(quality, [](const Section& section) { return section.id == "participants"; });
    return framed_document(head_, {"result", "Result", {}}, std::move(quality), provenance);
  }

 private:
  StudyHead head_;
  QualityReport quality_;
};

class ResultsWithMethods final : public Results {
 public:
  ResultsWithMethods(std::unique_ptr<const Results> results, Section methods)
      : results_(std::move(results)), methods_(std::move(methods)) {}

  const StudyHead& head() const override { return results_->head(); }
  std::string json() const override { return results_->json(); }
  std::vector<Figure> figures(const std::string& stamp) const override {
    return results_->figures(stamp);
  }
  Document document(const Provenance& provenance, const Pictures& pictures) const override {
    Document document = results_->document(provenance, pictures);
    document.sections.push_back(methods_);
    return document;
  }

 private:
  std::unique_ptr<const Results> results_;
  Section methods_;
};

}  // namespace

std::unique_ptr<const Results> registered_answer_only(const Results& results,
                                                      const record::StudyStore& store) {
  return std::make_unique<RegisteredAnswer>(results.head(), store);
}

std::unique_ptr<const Results> with_methods(std::unique_ptr<const Results> results,
                                            const Outcomes& outcomes, const ReportOptions& options,
                                            const ProtocolMethods& protocol) {
  if (!options.page || options.source == nullptr) return results;
  const RecordedStudy recorded = recorded_study(options.source->store, options.source->key);
  Section methods = methods_section(results->head(), outcomes, recorded, protocol);
  return std::make_unique<ResultsWithMethods>(std::move(results), std::move(methods));
}

void refuse_exploration_options(const ReportOptions& options, const std::string& reason) {
  if (!options.trial.empty()) throw UsageError("--trial: " + reason + "; omit the option");
  if (options.traces == ReportOptions::Traces::yes) {
    throw UsageError(
        "--cues yes: ideal observers exist only for studies in which participants choose between "
        "textures; omit the option");
  }
}

std::vector<Figure> Results::figures(const std::string&) const {
  return {};
}

std::vector<ResultTable> ProtocolAnalysis::tables(const Outcomes&) const {
  return {};
}

std::vector<TrialColumn> ProtocolAnalysis::trial_columns(const Outcomes&) const {
  return {};
}

std::optional<RModel> ProtocolAnalysis::r_model(const Outcomes&) const {
  return std::nullopt;
}

std::string r_script_of(const RModel& model, const Outcomes& outcomes) {
  return fmt::format(
      "# {1} of the study {2}{3}. Run: Rscript {0}.R\n"
      "# Needs lme4; reads {0}.csv in the same folder. Meaning: {0}.md.\n{4}",
      model.name, model.title, one_line(outcomes.study), outcomes.simulated ? " (SIMULATED)" : "",
      model.script);
}

std::vector<std::filesystem::path> export_r_model(const record::StudyStore& store,
                                                  const Outcomes& outcomes,
                                                  const std::filesystem::path& folder) {
  const std::optional<RModel> model = analysis_of(outcomes.design).r_model(outcomes);
  if (!model) {
    throw UsageError("--format r: the protocol " + outcomes.design.protocol_name() +
                     " has no model for R; choose csv, json, bids or psych-ds");
  }
  const std::string notes = fmt::format(
      "# {} of {}\n\n{}{}", model->title, one_line(outcomes.study),
      outcomes.simulated ? "SIMULATED: every participant is a program.\n\n" : "", model->notes);
  const record::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "r"},
                      {text_file(model->name + ".csv", csv_text(model->table)),
                       text_file(model->name + ".R", r_script_of(*model, outcomes)),
                       text_file(model->name + ".md", notes)});
}

void add_analysis(std::string_view protocol, const ProtocolAnalysis& analysis) {
  registered_analyses()[protocol] = &analysis;
}

const ProtocolAnalysis& analysis_of(const study::Study& study) {
  const auto found = registered_analyses().find(study.protocol->name);
  if (found != registered_analyses().end()) return *found->second;
  throw StudyError(one_line("study " + study.name + ": the protocol " + study.protocol_name() +
                            " has no report; export the trials instead"));
}

}  // namespace touchtrial::analysis
