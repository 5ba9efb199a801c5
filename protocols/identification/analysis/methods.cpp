#include "protocols/identification/analysis/methods.hpp"

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

std::string trial_sentence(const study::Study& study) {
  const bool is_spoken = study.session.sight == study::Sight::blindfold;
  const std::string choice = is_spoken ? "name" : "picture";
  const std::string question = study.presented_methods() > 1
                                   ? "which " + choice + " best fitted what they had felt"
                                   : "the " + choice + " whose texture they had felt";
  return fmt::format("In each trial participants felt one plane and {} {}, among {}{}.",
                     is_spoken ? "said" : "chose", question, study.classes.size(),
                     is_spoken ? "; the experimenter entered the answer"
                               : " in fixed places that were drawn for each participant");
}

std::string order_words(const study::TrialOptions& trials) {
  using enum study::TrialOrder;
  const std::string runs =
      trials.max_run > 0 ? fmt::format(", with at most {} of one texture in a row", trials.max_run)
                         : std::string();
  switch (trials.order) {
    case shuffled:
      return "in random order, all orders being equally likely" + runs;
    case de_bruijn:
      return "in a random de Bruijn sequence, in which each texture followed every texture, "
             "including itself, once";
    case uniform:
      return "each drawn independently, so that textures were not balanced" + runs;
    case williams:
      return "in rows of a Williams design, in which each texture occurred at each place and "
             "followed each other texture equally often" +
             runs;
  }
  return {};
}

std::string number_words(const study::Study& study) {
  const int methods = study.presented_methods();
  const std::string method_words =
      methods > 1 ? fmt::format(" by each of {} methods", methods) : "";
  return fmt::format("Each of {} textures was presented {} times{}, in {} scored trials, {}.",
                     study.classes.size(), study.trials.repeats, method_words,
                     study.scored_trials(), order_words(study.trials));
}

std::string blocks_words(const study::Study& study) {
  if (study.presented_methods() < 2) return {};
  if (study.trials.blocks == study::Blocks::mixed) return "Methods were mixed in one block.";
  return "Each method had a separate block; the order of blocks was a row of a Williams design. "
         "Rows were assigned to participants at random, each once before any was repeated.";
}

std::string images_words(const study::Study& study) {
  const bool has_several = std::ranges::any_of(
      study.classes, [](const study::StudyClass& texture) { return texture.images.size() > 1; });
  if (!has_several) return {};
  std::string text =
      "The image of a presentation was drawn at random from those of its texture, without "
      "repetition until all had been presented";
  if (study.session.sight != study::Sight::blindfold) {
    text += "; the picture on the answer screen was always the first image";
  }
  return text + ".";
}

std::string unscored_words(const study::TrialOptions& trials) {
  std::vector<std::string> parts;
  if (trials.lead_in > 0) {
    parts.push_back(
        fmt::format("{} at the start of each block", counted(trials.lead_in, "presentation")));
  }
  if (trials.catch_trials > 0) {
    parts.push_back(fmt::format("{} of a plane without texture, at random places",
                                counted(trials.catch_trials, "catch trial")));
  }
  return parts.empty() ? "" : "Not scored were " + listed(parts, " and ") + ".";
}

/// The orders that the tests against chance use.
std::string orders_words(const StudyReport& report) {
  int deals = 0;
  for (const MethodReport& method : report.methods) {
    if (method.chance && !method.chance->exact) deals = std::max(deals, method.chance->deals);
  }
  return deals == 0 ? "all of them" : fmt::format("{} of them, drawn at random", deals);
}

/// The patterns of signs that the tests of pairs use.
std::string patterns_words(const StudyReport& report) {
  const bool are_exact = std::ranges::all_of(report.pairs, [](const MethodPair& pair) {
    return pair.overall.participants <= kExactSignFlips;
  });
  return are_exact ? "all patterns of their signs" : "patterns of their signs drawn at random";
}

void add_accuracy(const StudyReport& report, Sentences& all) {
  const auto any = [&](auto condition) { return std::ranges::any_of(report.methods, condition); };
  all.push_back(
      {"The unit of analysis was the participant: means are over participants' accuracies, with "
       "95% Student's t intervals; trials without an answer counted as wrong.",
       {Source::student}});
  if (any([](const MethodReport& method) { return method.bootstrap.has_value(); })) {
    all.push_back({fmt::format("Bootstrap intervals are expanded percentiles over {} samples of "
                               "participants.",
                               kBootstrapDraws),
                   {Source::davison_hinkley, Source::hesterberg}});
  }
  if (any([](const MethodReport& method) { return method.spread.has_value(); })) {
    all.push_back({"The standard deviation between participants excludes sampling error.",
                   {Source::paule_mandel, Source::viechtbauer}});
  }
  if (any([](const MethodReport& method) { return method.chance.has_value(); })) {
    all.push_back({fmt::format("Whether anybody did better than chance was tested by one-sided "
                               "permutation over the orders that could have been drawn ({}).",
                               orders_words(report)),
                   {Source::phipson_smyth}});
  }
  if (any([](const MethodReport& method) { return method.prevalence.has_value(); })) {
    all.push_back(
        {"The prevalence of people who would pass this test individually is a posterior mode with "
         "its highest-density interval.",
         {Source::ince}});
  }
}

void add_comparison(const StudyReport& report, Sentences& all) {
  if (report.pairs.empty()) return;
  all.push_back({fmt::format("Two methods were compared by the mean of participants' differences, "
                             "with its t interval and a two-sided permutation test over {}.",
                             patterns_words(report)),
                 {Source::student, Source::phipson_smyth}});
  const auto any = [&](auto condition) { return std::ranges::any_of(report.pairs, condition); };
  if (any([](const MethodPair& pair) { return pair.p_holm.has_value(); })) {
    all.push_back({"p was adjusted over all pairs of methods by Holm's method.", {Source::holm}});
  }
  if (any([](const MethodPair& pair) { return pair.odds_ratio.has_value(); })) {
    all.push_back({"Odds ratios were stratified by participant.",
                   {Source::mantel_haenszel, Source::robins_breslow_greenland}});
  }
  if (report.all_methods) {
    all.push_back(
        {"All methods together were compared by Cochran's Q and by permuting methods within "
         "participants.",
         {Source::cochran, Source::phipson_smyth}});
  }
}

void add_confusions(const StudyReport& report, Sentences& all) {
  const auto any = [&](auto condition) { return std::ranges::any_of(report.methods, condition); };
  if (any([](const MethodReport& method) { return method.choice.has_value(); })) {
    all.push_back(
        {"Confusions were described by the similarity choice model, by information "
         "transfer with a correction for its bias, and by unbiased hit rates.",
         {Source::luce, Source::townsend_landon, Source::miller, Source::wagner}});
  }
  if (any([](const MethodReport& method) { return method.d_prime.estimate.has_value(); })) {
    all.push_back(
        {"d′ was computed from pooled trials, for an unbiased observer with as many "
         "alternatives as there are textures.",
         {Source::green_swets, Source::hacker_ratcliff}});
  }
  if (any([](const MethodReport& method) { return method.confidence.has_value(); })) {
    all.push_back(
        {"How well confidence distinguishes right from wrong answers is the area under the type 2 "
         "curve.",
         {Source::fleming_lau}});
  }
  if (report.cues) {
    all.push_back(
        {"Ideal observers with single cues from the recorded forces were compared with "
         "participants by the divergence of their confusions.",
         {Source::lin}});
  }
}

}  // namespace

ProtocolMethods protocol_methods(const StudyReport& report, const Outcomes& outcomes) {
  const study::Study& study = outcomes.design;
  ProtocolMethods methods;
  methods.trial = {{trial_sentence(study)}};
  methods.sequence = {{number_words(study)},
                      {images_words(study)},
                      {blocks_words(study)},
                      {unscored_words(study.trials)}};
  add_accuracy(report, methods.statistics);
  add_comparison(report, methods.statistics);
  add_confusions(report, methods.statistics);
  return methods;
}

}  // namespace touchtrial::analysis::identification
