#include "protocols/identification/analysis/identification_analysis.hpp"

#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/identification/analysis/cues/exploration_path.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/identification/analysis/methods.hpp"
#include "protocols/identification/analysis/mixed_model.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <utility>

namespace touchtrial::analysis::identification {
namespace {

/// The maximum number of traces that a report reads by default; more take seconds.
constexpr int kMaxDefaultTraces = 2500;

DataTable confusion_table(const Outcomes& outcomes, int method) {
  const ConfusionMatrix confusion = confusion_of(outcomes, method);
  MeasureList<int> measures = confusion_measures(outcomes.classes, confusion);
  measures.push_back(
      member_of<int>("", [&outcomes](int) { return outcomes.simulated; }).in_csv({"simulated"}));
  return data_table_of(class_indices(confusion), measures);
}

class IdentificationResults final : public Results {
 public:
  IdentificationResults(StudyReport report, std::vector<ExplorationPath> paths, bool paper_values)
      : report_(std::move(report)), paths_(std::move(paths)), paper_values_(paper_values) {}

  const StudyHead& head() const override { return report_; }
  std::string json() const override { return report_json(report_); }
  std::vector<Figure> figures(const std::string& stamp) const override {
    return report_figures(report_, {.paper_values = paper_values_,
                                    .cues = report_.cues ? &*report_.cues : nullptr,
                                    .explorations = paths_,
                                    .stamp = stamp});
  }
  Document document(const Provenance& provenance, const Pictures& pictures) const override {
    return study_document(report_, provenance, pictures);
  }

 private:
  StudyReport report_;
  std::vector<ExplorationPath> paths_;
  bool paper_values_;
};

bool should_read_traces(const ReportOptions& options, const Outcomes& outcomes) {
  if (options.source == nullptr) return false;
  if (options.traces != ReportOptions::Traces::if_few) {
    return options.traces == ReportOptions::Traces::yes;
  }
  return options.page && traces_to_read(outcomes) <= kMaxDefaultTraces;
}

std::vector<ExplorationPath> explorations(const Outcomes& outcomes, const ReportOptions& options) {
  if (options.source == nullptr) return {};
  const auto& [store, key] = *options.source;
  if (!options.trial.empty()) {
    return {find_exploration(store, key, outcomes, trial_name(options.trial))};
  }
  if (!options.page || !should_read_traces(options, outcomes)) return {};
  return first_explorations(store, key, outcomes);
}

class IdentificationAnalysis final : public ProtocolAnalysis {
 public:
  std::unique_ptr<const Results> results(const Outcomes& outcomes,
                                         const ReportOptions& options) const override {
    // Paths are made first, because the name of the trial may be invalid.
    std::vector<ExplorationPath> paths = explorations(outcomes, options);
    StudyReport report = make_report(outcomes);
    if (should_read_traces(options, outcomes)) {
      report.cues = make_cues(options.source->store, options.source->key, outcomes,
                              {.progress = options.progress});
    }
    const ProtocolMethods methods = protocol_methods(report, outcomes);
    return with_methods(std::make_unique<IdentificationResults>(std::move(report), std::move(paths),
                                                                options.published_values),
                        outcomes, options, methods);
  }
  std::vector<ResultTable> tables(const Outcomes& outcomes) const override {
    std::vector<ResultTable> tables;
    for (const std::string& method : outcomes.methods) {
      tables.push_back({"confusion_" + method + ".csv",
                        confusion_table(outcomes, static_cast<int>(tables.size()))});
    }
    return tables;
  }
  std::optional<RModel> r_model(const Outcomes& outcomes) const override {
    return mixed_model(outcomes);
  }
};

}  // namespace

const ProtocolAnalysis& identification_analysis() {
  static const IdentificationAnalysis analysis;
  return analysis;
}

}  // namespace touchtrial::analysis::identification
