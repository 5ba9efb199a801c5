#include "protocols/rating/analysis/methods.hpp"

#include "analysis/statistics/paired_tests.hpp"
#include "core/text.hpp"
#include "protocols/rating/study/rating.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

std::string scale_words(const study::Scale& scale) {
  const std::string ends = fmt::format("from “{}” to “{}”", scale.low, scale.high);
  const std::string kind = scale.points == 0 ? "a line of 0 to 1 " + ends
                                             : fmt::format("{} points {}", scale.points, ends);
  return fmt::format("“{}” ({})", scale.text, kind);
}

std::string trial_sentence(const study::Study& study) {
  const std::vector<study::Scale> scales = study::rating::scales_of(study);
  return fmt::format(
      "In each trial one plane was felt; then the picture of a texture was shown with {}: {}.",
      scales.size() == 1 ? "a scale" : fmt::format("{} scales", scales.size()),
      listed(scales, " and ", scale_words));
}

std::string order_sentence(const study::Study& study) {
  const int methods = study.presented_methods();
  const bool is_mixed = study.trials.blocks == study::Blocks::mixed;
  const std::string method_words =
      methods > 1 ? fmt::format(" by each of {} methods", methods) : "";
  std::string text = fmt::format(
      "Each of {} textures was presented {} times{} with its own picture, in {} trials in random "
      "order, each once before any was repeated.",
      study.classes.size(), study.trials.repeats, method_words, study.scored_trials());
  if (methods > 1 && !is_mixed) {
    text += " Each method had a separate block, in orders by a Williams design.";
  }
  return text;
}

std::string anchors_sentence(const study::Study& study) {
  if (!study::rating::options_of(study).anchors || study.trials.practice == 0) return {};
  return "Practice began with the ends of the scale: a plane without texture, which fits no "
         "picture, then textures with their own pictures.";
}

std::string catches_sentence(const study::Study& study) {
  const int catches = study.trials.catch_trials;
  if (catches == 0) return {};
  return fmt::format(
      "In {} at random places a plane without texture was felt with the picture of a random "
      "texture; means and differences exclude these trials.",
      counted(catches, "catch trial"));
}

}  // namespace

ProtocolMethods protocol_methods(const RatingReport& report, const Outcomes& outcomes) {
  const study::Study& study = outcomes.design;
  ProtocolMethods methods;
  methods.trial = {{trial_sentence(study)}};
  methods.sequence = {
      {order_sentence(study)}, {catches_sentence(study)}, {anchors_sentence(study)}};
  methods.statistics = {
      {"The unit of analysis was the participant: repeats of a texture with a method were averaged "
       "first, and means over participants have 95% Student's t intervals.",
       {Source::student}}};
  const auto any_scale = [&](auto condition) {
    return std::ranges::any_of(report.scales, condition);
  };
  if (any_scale([](const ScaleReport& scale) { return !scale.differences.empty(); })) {
    const bool are_exact = report.people.size() <= kExactSignFlips;
    methods.statistics.push_back(
        {fmt::format("Two methods were compared by participants' differences, with {}, two-sided, "
                     "adjusted over all pairs of methods by Holm's method.",
                     are_exact ? "exact sign flips" : "sign flips drawn at random"),
         {Source::holm}});
    methods.statistics.push_back(
        {"Effect sizes are d_z, with noncentral t and jackknife intervals.",
         {Source::miller_jackknife}});
  }
  if (any_scale([](const ScaleReport& scale) { return scale.agreement.single.has_value(); })) {
    methods.statistics.push_back(
        {"Agreement between participants is ICC(2,1) and ICC(2,k), agreement within participants "
         "ICC(1,1).",
         {Source::shrout_fleiss}});
  }
  return methods;
}

}  // namespace touchtrial::analysis::rating
