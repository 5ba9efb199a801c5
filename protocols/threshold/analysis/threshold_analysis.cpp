#include "protocols/threshold/analysis/threshold_analysis.hpp"

#include "protocols/threshold/analysis/exports.hpp"
#include "protocols/threshold/analysis/figures.hpp"
#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/methods.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <utility>

namespace touchtrial::analysis::threshold {
namespace {

class ThresholdResults final : public Results {
 public:
  explicit ThresholdResults(ThresholdReport report) : report_(std::move(report)) {}

  const StudyHead& head() const override { return report_; }
  std::string json() const override { return report_json(report_); }
  std::vector<Figure> figures(const std::string& stamp) const override {
    return report_figures(report_, stamp);
  }
  Document document(const Provenance& provenance, const Pictures& pictures) const override {
    return threshold_document(report_, provenance, pictures);
  }

 private:
  ThresholdReport report_;
};

class ThresholdAnalysis final : public ProtocolAnalysis {
 public:
  std::unique_ptr<const Results> results(const Outcomes& outcomes,
                                         const ReportOptions& options) const override {
    refuse_exploration_options(
        options, "trials of thresholds have several planes, so explorations are not drawn");
    ThresholdReport report = make_report(outcomes);
    const ProtocolMethods methods = protocol_methods(report);
    return with_methods(std::make_unique<ThresholdResults>(std::move(report)), outcomes, options,
                        methods);
  }
  std::vector<ResultTable> tables(const Outcomes& outcomes) const override {
    const ThresholdReport report = make_report(outcomes);
    return {{"thresholds.csv", data_table_of(report.tracks, track_measures(report))},
            {"tracks.csv", track_trials_table(outcomes)}};
  }
  std::vector<TrialColumn> trial_columns(const Outcomes&) const override {
    return threshold_trial_columns();
  }
  std::optional<RModel> r_model(const Outcomes& outcomes) const override {
    return threshold_model(outcomes);
  }
};

}  // namespace

const ProtocolAnalysis& threshold_analysis() {
  static const ThresholdAnalysis analysis;
  return analysis;
}

}  // namespace touchtrial::analysis::threshold
