#include "protocols/rating/analysis/rating_analysis.hpp"

#include "core/errors.hpp"
#include "protocols/rating/analysis/figures.hpp"
#include "protocols/rating/analysis/page.hpp"
#include "protocols/rating/analysis/rating_model.hpp"
#include "protocols/rating/analysis/report.hpp"
#include "protocols/rating/analysis/tables.hpp"

#include <utility>

namespace touchtrial::analysis::rating {
namespace {

class RatingResults final : public Results {
 public:
  explicit RatingResults(RatingReport report) : report_(std::move(report)) {}

  const StudyHead& head() const override { return report_; }
  std::string json() const override { return report_json(report_); }
  std::vector<Figure> figures(const std::string& stamp) const override {
    return report_figures(report_, stamp);
  }
  Document document(const Provenance& provenance, const Pictures& pictures) const override {
    return rating_document(report_, provenance, pictures);
  }

 private:
  RatingReport report_;
};

void require_possible_wishes(const ReportWishes& wishes) {
  if (!wishes.trial.empty()) {
    throw UsageError("--trial: explorations of ratings are not drawn; leave the option out");
  }
  if (wishes.traces == ReportWishes::Traces::yes) {
    throw UsageError(
        "--cues yes: ideal observers are of studies whose participants choose between textures; "
        "leave the option out");
  }
}

class RatingAnalysis final : public ProtocolAnalysis {
 public:
  std::unique_ptr<const Results> results(const Outcomes& outcomes,
                                         const ReportWishes& wishes) const override {
    require_possible_wishes(wishes);
    return std::make_unique<RatingResults>(make_report(outcomes));
  }
  std::vector<ResultTable> tables(const Outcomes& outcomes) const override {
    return {{"ratings.csv", ratings_table(outcomes)}};
  }
  std::vector<TrialColumn> trial_columns(const Outcomes& outcomes) const override {
    return rating_columns(outcomes);
  }
  std::vector<std::filesystem::path> export_model(
      const record::StudyStore& store, const Outcomes& outcomes,
      const std::filesystem::path& folder) const override {
    return export_rating_model(store, outcomes, folder);
  }
};

}  // namespace

const ProtocolAnalysis& rating_analysis() {
  static const RatingAnalysis analysis;
  return analysis;
}

}  // namespace touchtrial::analysis::rating
