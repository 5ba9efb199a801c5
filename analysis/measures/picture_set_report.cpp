#include "analysis/measures/picture_set.hpp"
#include "analysis/report/json_figures.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// The file's name without its folders, to leave room for the numbers.
std::string file_of(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::string pictures_text(const MeasuredPictures& measured) {
  TextTable table({"picture", "mean", "deviation", "slope", "ASM", "entropy", "contrast",
                   "correlation", "contrast T", "correlation T", "rms mN", "over 1 mm"});
  for (const PictureMeasures& p : measured.pictures) {
    table.add(
        {file_of(p.name), fmt::format("{:.1f}", p.mean), fmt::format("{:.1f}", p.deviation),
         fmt::format("{:.2f}", p.slope), fmt::format("{:.6f}", p.original.angular_second_moment),
         fmt::format("{:.2f}", p.original.entropy), fmt::format("{:.0f}", p.original.contrast),
         fmt::format("{:.3f}", p.original.correlation), fmt::format("{:.0f}", p.texture.contrast),
         fmt::format("{:.3f}", p.texture.correlation), fmt::format("{:.1f}", 1e3 * p.force_rms_n),
         share_figure(p.renderable_share)});
  }
  constexpr std::size_t kTableWidth = 140;
  return table.text(kTableWidth);
}

std::string pair_mean(const PairMean& mean) {
  return mean.pairs == 0 ? "-" : fmt::format("{:.4f} ({})", mean.mean, mean.pairs);
}

std::string similarity_text(const MeasuredPictures& measured) {
  TextTable table(
      {"MS-SSIM, mean (pairs)", "original within", "between", "texture within", "between"});
  for (const SetMeasures& set : measured.sets) {
    if (!set.similarity) {
      table.add({set.set, "too small", "", "", ""});
      continue;
    }
    table.add({set.set, pair_mean(set.similarity->original_within),
               pair_mean(set.similarity->original_between),
               pair_mean(set.similarity->texture_within),
               pair_mean(set.similarity->texture_between)});
  }
  return table.text();
}

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

Json similarity_json(const Similarity& similarity) {
  return {{"original",
           {{"within", pair_json(similarity.original_within)},
            {"between", pair_json(similarity.original_between)}}},
          {"texture",
           {{"within", pair_json(similarity.texture_within)},
            {"between", pair_json(similarity.texture_between)}}}};
}

Json set_json(const SetMeasures& set) {
  return {{"set", set.set},
          {"classes", set.classes},
          {"pictures", set.pictures},
          {"ms_ssim", set.similarity ? similarity_json(*set.similarity) : Json()}};
}

}  // namespace

std::string measures_text(const MeasuredPictures& measured) {
  return pictures_text(measured) + "\n" + similarity_text(measured) + "\n" +
         wrapped("  ",
                 fmt::format(
                     "Forces assume a tangential gain of {:.4g} N per grey level and pixel. "
                     "Co-occurrence numbers are means over four directions; T is the texture. "
                     "Slope is that of log power over log frequency. MS-SSIM uses exponents of 1.",
                     measured.tangential_gain_n));
}

std::string measures_json(const MeasuredPictures& measured) {
  Json pictures = Json::array();
  for (const PictureMeasures& picture : measured.pictures)
    pictures.push_back(picture_json(picture));
  Json sets = Json::array();
  for (const SetMeasures& set : measured.sets) sets.push_back(set_json(set));
  return json_text(Json{
      {"tangential_gain_n", measured.tangential_gain_n}, {"pictures", pictures}, {"sets", sets}});
}

}  // namespace touchtrial::analysis
