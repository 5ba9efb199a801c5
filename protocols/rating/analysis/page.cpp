#include "protocols/rating/analysis/page.hpp"

#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/rating/analysis/measures.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

std::string question_sentence(const RatingReport& report, const ScaleReport& scale) {
  const std::string kind = scale.scale.points == 0
                               ? "a line from 0 to 1"
                               : fmt::format("points from 1 to {}", scale.scale.points);
  return caption_of(report, scale,
                    fmt::format("Participants rated: {} (from \"{}\" to \"{}\", {})",
                                scale.scale.text, scale.scale.low, scale.scale.high, kind)) +
         ".";
}

std::string mean_words(const MeanEstimate& mean) {
  if (mean.participants == 1) return " (one participant)";
  return fmt::format(", 95% t interval {} ({})",
                     plain_range(mean.known_interval(), kRatingDecimals),
                     counted(mean.participants, "participant"));
}

/// The mean difference between the first two methods, or the mean of the only one.
std::string result_sentence(const RatingReport& report, const ScaleReport& scale) {
  const auto label = [&](int method) { return report.methods[static_cast<std::size_t>(method)]; };
  if (scale.differences.empty()) {
    if (scale.means.methods.empty()) return "";
    const GroupMean& only = scale.means.methods.front();
    if (!only.mean.mean) return "Nobody rated every texture, so there is no mean.";
    return fmt::format("Mean rating, {}: {}{}.", label(only.group),
                       plain_figure(only.mean.mean, kRatingDecimals), mean_words(only.mean));
  }
  const MethodDifference& pair = scale.differences.front();
  const std::string names = "Mean rating, " + label(pair.first) + " minus " + label(pair.second);
  if (!pair.difference.mean) {
    return names + ": nobody rated every texture with both, so there is no difference.";
  }
  std::string text =
      fmt::format("{}: {}{}", names, signed_plain_figure(pair.difference.mean, kRatingDecimals),
                  mean_words(pair.difference));
  if (const auto statistic = statistic_of(pair)) {
    text += fmt::format("; {}, d_z = {}", t_phrase(*statistic), effect_figure(statistic));
  }
  if (pair.sign_flip) {
    text += fmt::format("; {} by sign flips", p_phrase(pair.sign_flip->p));
    if (scale.differences.size() > 1) {
      text += fmt::format(", {} after Holm over {} pairs", p_figure(pair.sign_flip->holm),
                          scale.differences.size());
    }
  }
  return text + ".";
}

Section result_section(const RatingReport& report) {
  Section section{"result", "Result", {}};
  const auto add = [&](std::string text) {
    if (!text.empty()) section.blocks.emplace_back(CitedText{std::move(text)});
  };
  for (const ScaleReport& scale : report.scales) {
    if (report.trials > 0) add(result_sentence(report, scale));
    add(question_sentence(report, scale));
  }
  if (report.trials == 0) add("No trial counts, so there is no result.");
  if (report.without_answer > 0) {
    add(fmt::format("Left out: {} without an answer.", counted(report.without_answer, "trial")));
  }
  return section;
}

}  // namespace

std::string caption_of(const RatingReport& report, const ScaleReport& scale,
                       const std::string& caption) {
  if (report.scales.size() < 2) return caption;
  return fmt::format("{} (scale {})", caption, scale.scale.id);
}

std::string id_of(const RatingReport& report, const ScaleReport& scale, const std::string& name) {
  if (report.scales.size() < 2) return name;
  return fmt::format("{}-{}", name, &scale - report.scales.data() + 1);
}

Document rating_document(const RatingReport& report, const Provenance& provenance,
                         const Pictures& pictures) {
  const bool has_figure = std::ranges::any_of(pictures, [](const Picture& picture) {
    return picture.id.starts_with("ratings") && !picture.svg.empty();
  });
  return framed_document(
      report, result_section(report),
      {differences_section(report), means_section(report, has_figure), reliability_section(report),
       catches_section(report), use_section(report)},
      provenance, pictures);
}

}  // namespace touchtrial::analysis::rating
