#include "analysis/paper/paper_claims.hpp"
#include "analysis/paper/paper_document.hpp"
#include "analysis/report/json_figures.hpp"
#include "core/version.hpp"

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using PaperJson = nlohmann::ordered_json;

PaperJson strength_json(const TextureStrength& strength) {
  return {{"rms_grey", strength.rms_grey}, {"fine_share", strength.fine_share}};
}

PaperJson swept_json(const engine::Evaluation& evaluation) {
  PaperJson orders = PaperJson::array();
  for (const engine::OrderEvaluation& one : evaluation.orders) {
    orders.push_back({{"order", one.order}, {"entropy", one.entropy}, {"ms_ssim", one.ms_ssim}});
  }
  return orders;
}

PaperJson picture_measures_json(const MeasuredPicture& one) {
  PaperJson fixed = PaperJson::object();
  for (std::size_t i = 0; i < kPaperOrders.size(); ++i) {
    fixed[fmt::format("{:g}", kPaperOrders[i])] = strength_json(one.fixed[i]);
  }
  PaperJson readings = PaperJson::object();
  for (std::size_t i = 0; i < kTableReadings.size(); ++i) {
    readings[kTableReadings[i].words] = glcm_json(one.readings[i]);
  }
  return {{"picture", one.name},
          {"height", one.evaluation.height},
          {"width", one.evaluation.width},
          {"entropy_original", one.evaluation.original.entropy},
          {"entropy_adaptive", one.evaluation.adaptive.entropy},
          {"glcm_original", glcm_json(one.evaluation.original.glcm)},
          {"glcm_adaptive", glcm_json(one.evaluation.adaptive.glcm)},
          {"fixed", fixed},
          {"adaptive", strength_json(one.adaptive)},
          {"orders", swept_json(one.evaluation)},
          {"readings", readings}};
}

}  // namespace

std::string paper_json(const PaperMeasures& measures) {
  PaperJson object = {{"command", "paper"},
                      {"program", program_version()},
                      {"claims", PaperJson::array()},
                      {"pictures", PaperJson::array()},
                      {"compared", PaperJson::array()}};
  for (const PaperClaim& claim : paper_claims(measures)) {
    object["claims"].push_back({{"id", claim.id},
                                {"where", claim.where},
                                {"says", claim.statement},
                                {"found", claim.measured},
                                {"agreeing", claim.agreeing},
                                {"of", claim.total},
                                {"verdict", verdict_of(claim)}});
  }
  for (const MeasuredPicture& one : measures.pictures) {
    object["pictures"].push_back(picture_measures_json(one));
  }
  for (const MethodMeasures& one : measures.compared) {
    object["compared"].push_back({{"picture", one.name},
                                  {"adaptive", strength_json(one.adaptive)},
                                  {"tv_gabor", strength_json(one.tv_gabor)},
                                  {"ms_ssim", one.ms_ssim}});
  }
  return json_text(object);
}

}  // namespace touchtrial::analysis
