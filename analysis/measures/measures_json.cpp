#include "analysis/json_figures.hpp"
#include "analysis/measures/picture_set.hpp"

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json pair_json(const PairMean& mean) {
  return {{"pairs", mean.pairs}, {"mean", mean.pairs == 0 ? Json() : Json(mean.mean)}};
}

Json picture_json(const PictureMeasures& picture) {
  return {{"set", picture.set},
          {"class", picture.label},
          {"picture", picture.name},
          {"mean", picture.mean},
          {"deviation", picture.deviation},
          {"spectrum_slope", picture.slope},
          {"original", statistics_json(picture.original)},
          {"texture", statistics_json(picture.texture)},
          {"force_rms_n", picture.force_rms_n},
          {"renderable_share", picture.renderable_share}};
}

Json likeness_json(const Likeness& likeness) {
  return {{"original",
           {{"within", pair_json(likeness.original_within)},
            {"between", pair_json(likeness.original_between)}}},
          {"texture",
           {{"within", pair_json(likeness.texture_within)},
            {"between", pair_json(likeness.texture_between)}}}};
}

Json score_json(const RmsAlone& score) {
  return {{"classes", score.classes},
          {"sets", score.sets},
          {"chance", 1.0 / score.classes},
          {"unseen_patch", score.unseen_patch},
          {"unseen_picture", score.unseen_picture < 0.0 ? Json() : Json(score.unseen_picture)}};
}

Json set_json(const SetMeasures& set) {
  Json scores = Json::array();
  for (const RmsAlone& score : set.rms_alone) scores.push_back(score_json(score));
  return {{"set", set.set},
          {"classes", set.classes},
          {"pictures", set.pictures},
          {"ms_ssim", set.likeness ? likeness_json(*set.likeness) : Json()},
          {"rms_alone", scores}};
}

}  // namespace

std::string measures_json(const MeasuredPictures& measured) {
  Json pictures = Json::array();
  for (const PictureMeasures& picture : measured.pictures)
    pictures.push_back(picture_json(picture));
  Json sets = Json::array();
  for (const SetMeasures& set : measured.sets) sets.push_back(set_json(set));
  return json_text(
      {{"tangential_gain_n", measured.tangential_gain_n}, {"pictures", pictures}, {"sets", sets}});
}

}  // namespace touchtrial::analysis
