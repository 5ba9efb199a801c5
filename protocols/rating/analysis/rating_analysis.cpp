#include "protocols/rating/analysis/rating_analysis.hpp"

#include "core/errors.hpp"
#include "engine/image_file.hpp"
#include "engine/pictures/colour_image.hpp"
#include "protocols/rating/analysis/figures.hpp"
#include "protocols/rating/analysis/methods.hpp"
#include "protocols/rating/analysis/page.hpp"
#include "protocols/rating/analysis/rating_model.hpp"
#include "protocols/rating/analysis/report.hpp"
#include "protocols/rating/analysis/tables.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace touchtrial::analysis::rating {
namespace {

class RatingResults final : public Results {
 public:
  RatingResults(RatingReport report, ItemPictures pictures)
      : report_(std::move(report)), pictures_(std::move(pictures)) {}

  const StudyHead& head() const override { return report_; }
  std::string json() const override { return report_json(report_); }
  std::vector<Figure> figures(const std::string& stamp) const override {
    return report_figures(report_, pictures_, stamp);
  }
  Document document(const Provenance& provenance, const Pictures& pictures) const override {
    return rating_document(report_, provenance, pictures);
  }

 private:
  RatingReport report_;
  ItemPictures pictures_;
};

/// A thumbnail; empty if the file cannot be read.
GreyImage picture_of(const std::filesystem::path& file) {
  try {
    const GreyImage grey = engine::read_grey_image(file);
    const int longer = std::max(grey.height(), grey.width());
    if (longer <= kPictureSide_px) return grey;
    const auto side = [&](int length) { return std::max(1, length * kPictureSide_px / longer); };
    return engine::resized(grey, side(grey.height()), side(grey.width()));
  } catch (const Error&) {
    return {};
  }
}

/// Thumbnails for a report with a page, if the study's pictures are available.
ItemPictures item_pictures(const ReportOptions& options) {
  ItemPictures pictures;
  if (options.source == nullptr || !options.page) return pictures;
  const study::Study& study = options.source->key.study;
  for (const study::StudyClass& texture : study.classes) {
    pictures.push_back(texture.images.empty() ? GreyImage()
                                              : picture_of(study.folder / texture.images.front()));
  }
  return pictures;
}

class RatingAnalysis final : public ProtocolAnalysis {
 public:
  std::unique_ptr<const Results> results(const Outcomes& outcomes,
                                         const ReportOptions& options) const override {
    refuse_exploration_options(options, "explorations of ratings are not drawn");
    RatingReport report = make_report(outcomes);
    const ProtocolMethods methods = protocol_methods(report, outcomes);
    return with_methods(std::make_unique<RatingResults>(std::move(report), item_pictures(options)),
                        outcomes, options, methods);
  }
  std::vector<ResultTable> tables(const Outcomes& outcomes) const override {
    return {{"ratings.csv", ratings_table(outcomes)}};
  }
  std::vector<TrialColumn> trial_columns(const Outcomes& outcomes) const override {
    return rating_columns(outcomes);
  }
  std::optional<RModel> r_model(const Outcomes& outcomes) const override {
    return rating_model(outcomes);
  }
};

}  // namespace

const ProtocolAnalysis& rating_analysis() {
  static const RatingAnalysis analysis;
  return analysis;
}

}  // namespace touchtrial::analysis::rating
