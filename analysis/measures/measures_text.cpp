#include "analysis/measures/picture_set.hpp"
#include "analysis/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// The file's name; its folders would take the place of figures.
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
         fmt::format("{:.1f} %", 100.0 * p.renderable_share)});
  }
  constexpr std::size_t kOneBlock = 140;
  return table.text(kOneBlock);
}

std::string pair_mean(const PairMean& mean) {
  return mean.pairs == 0 ? "-" : fmt::format("{:.4f} ({})", mean.mean, mean.pairs);
}

std::string likeness_text(const MeasuredPictures& measured) {
  TextTable table(
      {"MS-SSIM, mean (pairs)", "original within", "between", "texture within", "between"});
  for (const SetMeasures& set : measured.sets) {
    if (!set.likeness) {
      table.add({set.set, "too small", "", "", ""});
      continue;
    }
    table.add({set.set, pair_mean(set.likeness->original_within),
               pair_mean(set.likeness->original_between), pair_mean(set.likeness->texture_within),
               pair_mean(set.likeness->texture_between)});
  }
  return table.text();
}

std::string rms_alone_text(const MeasuredPictures& measured) {
  TextTable table(
      {"told by rms force alone", "classes", "sets", "chance", "unseen patch", "unseen picture"});
  for (const SetMeasures& set : measured.sets) {
    for (const RmsAlone& score : set.rms_alone) {
      table.add({set.set, std::to_string(score.classes), std::to_string(score.sets),
                 fmt::format("{:.1f} %", 100.0 / score.classes),
                 fmt::format("{:.1f} %", 100.0 * score.unseen_patch),
                 score.unseen_picture < 0.0
                     ? "-"
                     : fmt::format("{:.1f} %", 100.0 * score.unseen_picture)});
    }
  }
  return table.text();
}

}  // namespace

std::string measures_text(const MeasuredPictures& measured) {
  return pictures_text(measured) + "\n" + likeness_text(measured) + "\n" +
         rms_alone_text(measured) + "\n" +
         wrapped("  ",
                 fmt::format(
                     "Forces are those of a tangential gain of {:.4g} N per grey level and pixel. "
                     "Co-occurrence figures are means over four directions; T: of the texture. "
                     "Slope: of log power over log frequency. MS-SSIM with exponents 1.",
                     measured.tangential_gain_n));
}

}  // namespace touchtrial::analysis
