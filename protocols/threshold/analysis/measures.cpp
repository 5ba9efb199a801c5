#include "protocols/threshold/analysis/measures.hpp"

#include "core/named.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <array>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using Json = nlohmann::ordered_json;
using procedures::Censored;

MeasureList<procedures::Threshold> estimate_measures() {
  using Row = procedures::Threshold;
  return {number_member<Row>("threshold", &Row::level), number_member<Row>("low", &Row::low),
          number_member<Row>("high", &Row::high), member_of<Row>("censored", [](const Row& one) {
            const std::string_view censored = word_of(one.censored);
            return censored.empty() ? Json(nullptr) : Json(censored);
          })};
}

MeasureList<Quantity> quantity_measures() {
  return {number_member<Quantity>("fraction", &Quantity::value),
          number_member<Quantity>("low", &Quantity::low),
          number_member<Quantity>("high", &Quantity::high)};
}

MeasureList<procedures::GoodnessOfFit> fit_measures() {
  using Row = procedures::GoodnessOfFit;
  return {number_member<Row>("deviance", &Row::deviance), number_member<Row>("p", &Row::p),
          member_of<Row>("draws", [](const Row& one) { return one.thresholds.size(); })};
}

MeasureList<Proportion> count_measures(const std::string& of_them) {
  return {member_of<Proportion>("n", &Proportion::n),
          member_of<Proportion>(of_them, &Proportion::correct)};
}

/// "6 of 6"
std::string counts_text(const Proportion& of) {
  return of.n == 0 ? kNoFigure : fmt::format("{} of {}", of.correct, of.n);
}

/// A threshold in the quantity that readers know; nothing if there is none.
std::optional<Quantity> known_quantity(const Quantity& quantity) {
  return quantity.value ? std::optional(quantity) : std::nullopt;
}

Json class_name(const ThresholdReport& report, const StandardReport& standard) {
  const auto label = static_cast<std::size_t>(standard.of.class_index);
  return label < report.classes.size() ? Json(report.classes[label]) : Json(nullptr);
}

/// "−12.5", "above 0.0" or "between −5.0 and −2.5"; a dash if nothing is known of it.
std::string median_figure(const CensoredMean& mean) {
  const std::string text = median_text(mean);
  return text.empty() ? kNoFigure : text;
}

/// "2 below, 1 above"
std::string beyond_text(const StandardReport& standard) {
  const int below = standard.number_of(Censored::below);
  const int above = standard.number_of(Censored::above);
  if (below == 0 && above == 0) return "0";
  if (above == 0) return fmt::format("{} below", below);
  if (below == 0) return fmt::format("{} above", above);
  return fmt::format("{} below, {} above", below, above);
}

auto number_of_censored(Censored censored) {
  return [censored](const StandardReport& one) { return one.number_of(censored); };
}

std::string reversals_note(const ThresholdReport& report) {
  return fmt::format(
      "Reversals: mean of the last turns of the staircase. It estimates the level with {} right, "
      "not the threshold's {}, so do not compare the two. It has no interval; above or below means "
      "that a turn was at an end of the levels.",
      share_figure(procedures::convergence_of(report.options().track.up_down)),
      share_figure(report.criterion));
}

}  // namespace

MeasureList<CensoredMean> censored_measures(const std::string& name) {
  using Row = CensoredMean;
  using enum Lack;
  static constexpr auto kLacks = std::to_array<Named<Lack>>(
      {{"few known", values}, {"most censored", most}, {"all alike", spread}});
  return {number_of<Row>(name, "", signed_decimals(1), &Row::mean),
          interval_of<Row>("interval", "", range_decimals(1), &Row::interval),
          member_of<Row>("lack",
                         [](const Row& one) {
                           return one.lack == nothing ? Json(nullptr)
                                                      : Json(name_in(kLacks, one.lack));
                         }),
          number_of<Row>("sd", "", decimals(1), &Row::sd),
          number_member<Row>("median", &Row::median).shown("", median_figure),
          member_of<Row>("median_within", [](const Row& one) {
            return interval_json(Interval{one.median_within.low, one.median_within.high});
          })};
}

MeasureList<TrackReport> track_measures(const ThresholdReport& report) {
  using Row = TrackReport;
  const auto standard = [&report](const Row& track) -> const StandardReport& {
    return report.standards[track.standard];
  };
  const auto estimate = [](const Row& track) -> const procedures::Threshold* {
    return track.estimate ? &track.estimate->threshold : nullptr;
  };
  const auto quantity = [=, &report](const Row& track) {
    return track.estimate ? quantity_of(report.options(), standard(track).of, *estimate(track))
                          : Quantity{};
  };
  const auto threshold_cell = [standard](const procedures::Threshold* one, const Row& track) {
    return one == nullptr ? kNoFigure : threshold_text(*one, standard(track).levels);
  };
  return {
      label_of<Row>("participant", "participant", &Row::participant).in_csv({"participant"}),
      count_of<Row>("track", "track", &Row::track).in_csv({"track"}),
      label_of<Row>("standard", "standard", [=](const Row& one) { return standard(one).words; }),
      member_of<Row>("", [=, &report](const Row& one) { return class_name(report, standard(one)); })
          .in_csv({"class"}),
      member_of<Row>("", [=](const Row& one) { return standard(one).of.value; })
          .in_csv({"standard_value"}),
      count_of<Row>("trials", "n", [](const Row& one) { return one.answers.n; }).in_csv({"trials"}),
      member_of<Row>("right", [](const Row& one) { return one.answers.correct; })
          .shown("right", [](const Row& one) { return share_figure(one.answers.share()); })
          .in_csv({"right"}),
      object_in<Row>("catch", &Row::catches, count_measures("right"))
          .shown("catch trials right", [](const Row& one) { return counts_text(one.catches); })
          .in_csv({"catch_trials", "catch_right"}),
      object_in<Row>("estimate", estimate, estimate_measures())
          .shown("threshold and 95% (dB)",
                 [=](const Row& one) { return threshold_cell(estimate(one), one); })
          .in_csv({"threshold_db", "low_db", "high_db", "censored"})
          .with("Threshold: with its 95% interval, as under Methods. Above, below: with usual "
                "lapse rates the whole interval lies beyond the highest or the lowest level. Not "
                "determined: the answers determine neither a threshold within the levels nor a "
                "side; a known end of the interval is given. n and right: trials chosen by the "
                "procedure; catch trials are at the highest level and also enter the threshold."),
      member_of<Row>("in_mean",
                     [=](const Row& one) -> Json {
                       if (!one.estimate) return nullptr;
                       const Bounds bounds = bounds_of(*one.estimate, standard(one).levels);
                       return interval_json(Interval{bounds.low, bounds.high});
                     })
          .in_csv({"at_least_db", "at_most_db"}),
      object_in<Row>("reversals", &Row::reversals, estimate_measures())
          .shown("reversals",
                 [=](const Row& one) {
                   return threshold_cell(one.reversals ? &*one.reversals : nullptr, one);
                 })
          .in_csv({"reversals_db", "", "", "reversals_censored"})
          .with(reversals_note(report))
          .if_known(),
      object_in<Row>(
          "weber", [=](const Row& one) { return known_quantity(quantity(one)); },
          quantity_measures())
          .shown(quantity_name(report.options()),
                 [=, &report](const Row& one) {
                   return quantity_text(quantity(one), report.options());
                 })
          .in_csv({"weber", "weber_low", "weber_high"}),
      object_in<Row>("goodness_of_fit", &Row::fit, fit_measures())
          .shown("p of the fit",
                 [](const Row& one) { return one.fit ? p_figure(one.fit->p) : kNoFigure; })
          .in_csv({"", "fit_p", ""})
          .with("p of the fit: the share of 399 data sets simulated from the fit whose deviance is "
                "at least as large (Wichmann and Hill 2001). With few trials per level it detects "
                "only large deviations.")
          .if_known(),
      number_member<Row>("learning_db", &Row::learning_db).in_csv({"learning_db"}),
      number_member<Row>("", [&report](const Row&) { return report.criterion; })
          .in_csv({"criterion"}),
      member_of<Row>("", [&report](const Row&) { return report.simulated; }).in_csv({"simulated"})};
}

MeasureList<StandardReport> standard_measures(const ThresholdReport& report) {
  using Row = StandardReport;
  const auto quantity = [&report](const Row& one) {
    return quantity_of(report.options(), one.of, mean_threshold(one.mean));
  };
  const std::string title = quantity_name(report.options());
  return joined_measures<Row>(
      {{label_of<Row>("standard", "standard", &Row::words),
        member_of<Row>("class", [&report](const Row& one) { return class_name(report, one); }),
        number_member<Row>("value", [](const Row& one) { return one.of.value; }),
        number_member<Row>("highest_level",
                           [](const Row& one) {
                             return one.levels.empty() ? std::nullopt
                                                       : std::optional(one.levels.back());
                           }),
        member_of<Row>("tracks", &Row::tracks),
        count_of<Row>("n", "n", [](const Row& one) { return one.mean.participants; })
            .with("n: participants with a share in the mean; each counts with the mean of their "
                  "tracks. Known: every track has a number. Beyond: the whole interval lies below "
                  "the lowest or above the highest level; counted as censored. Not determined: "
                  "neither, or the tracks disagree; the likeliest threshold enters the mean, or "
                  "its side if it lies beyond the levels, and nothing if both ends are open. If "
                  "more than half are not determined or have no value, there is no mean."),
        member_of<Row>("no_share", [](const Row& one) { return one.mean.open; }),
        column_of<Row>(
            "mean and 95% (dB)",
            [](const Row& one) { return threshold_text(mean_threshold(one.mean), one.levels); }),
        count_of<Row>("known", "known", number_of_censored(Censored::no)),
        member_of<Row>("below", number_of_censored(Censored::below)).shown("beyond", beyond_text),
        member_of<Row>("above", number_of_censored(Censored::above)),
        count_of<Row>("undetermined", "not determined",
                      number_of_censored(Censored::undetermined))},
       measures_in<Row>(&Row::mean, titled(censored_measures("mean"),
                                           {{"sd", "SD (dB)"}, {"median", "median (dB)"}})),
       {object_in<Row>(
            "weber", [=](const Row& one) { return known_quantity(quantity(one)); },
            quantity_measures())
            .shown(title.empty() ? "" : title + " and 95%", [=, &report](const Row& one) {
              return quantity_text(quantity(one), report.options());
            })}});
}

MeasureList<DifferenceReport> difference_measures(const ThresholdReport& report) {
  using Row = DifferenceReport;
  const auto words = [&report](std::size_t Row::*which) {
    return [&report, which](const Row& one) { return report.standards[one.*which].words; };
  };
  return joined_measures<Row>(
      {{label_of<Row>("first", "first", words(&Row::first)),
        label_of<Row>("second", "second", words(&Row::second))},
       measures_in<Row>(&Row::difference,
                        titled(censored_measures("difference"),
                               {{"difference", "difference (dB)"}, {"interval", "95% (dB)"}})),
       {count_of<Row>("participants", "n",
                      [](const Row& one) { return one.difference.participants; }),
        count_of<Row>("known", "known", &Row::known), number_of<Row>("p", "p", p_figure, &Row::p),
        number_of<Row>("p_holm", "p by Holm", p_figure, &Row::p_holm),
        column_of<Row>(
            "t",
            [](const Row& one) { return one.statistic ? t_phrase(*one.statistic) : kNoFigure; }),
        member_of<Row>("statistic", [](const Row& one) { return statistic_json(one.statistic); })
            .shown("d_z, 95%", [](const Row& one) { return effect_figure(one.statistic); })
            .with("Mean, interval and p, two-sided, as for thresholds; a difference is known if "
                  "both thresholds are, and has a bound if one of them enters by a side. By "
                  "Holm: adjusted over all pairs. t and d_z, the mean over its standard deviation "
                  "between participants, if every difference is known.",
                  {Source::student, Source::tobin, Source::holm, Source::cumming_finch})}});
}

MeasureList<RightAnswers> right_measures(bool of_participants) {
  using Row = RightAnswers;
  const MeasureList<Row> right{
      count_of<Row>("n", "n", [](const Row& one) { return one.answers.n; }),
      count_of<Row>("right", "right", [](const Row& one) { return one.answers.correct; }),
      number_of<Row>("share", "share", share_figure,
                     [](const Row& one) { return one.answers.share(); }),
      interval_of<Row>("interval", "", share_range,
                       [](const Row& one) { return known(one.interval, one.answers); }),
      number_of<Row>("p", "p", p_figure, &Row::p)};
  if (!of_participants) return right;
  return joined_measures<Row>(
      {{member_of<Row>("participant", &Row::participant)
            .shown("participant",
                   [](const Row& one) {
                     return one.participant.empty() ? "all, pooled" : one.participant;
                   })},
       right,
       {number_of<Row>("p_holm", "p by Holm", p_figure, &Row::p_holm)
            .with("p: exact binomial probability of as many right answers or more by guessing; by "
                  "Holm: adjusted over participants. Targets are drawn independently, so trials "
                  "are independent under guessing.",
                  {Source::holm})}});
}

MeasureList<GroupTest> test_measures(const std::string& name) {
  using Row = GroupTest;
  return {number_of<Row>(name, "difference (points)", points_figure,
                         [](const Row& one) { return one.mean.mean; }),
          interval_of<Row>("interval", "t 95%", share_range,
                           [](const Row& one) { return one.mean.known_interval(); }),
          member_of<Row>("participants", [](const Row& one) { return one.mean.participants; }),
          number_of<Row>("p", "p", p_figure, &Row::p), member_of<Row>("test", [](const Row& one) {
            return !one.p ? Json(nullptr) : Json(one.alike ? "sign flips" : "t");
          })};
}

MeasureList<ChoiceUse> choice_measures() {
  using Row = ChoiceUse;
  return joined_measures<Row>({{label_of<Row>("choice", "answer", &Row::choice),
                                count_of<Row>("named", "given", &Row::named),
                                count_of<Row>("targets", "right answer", &Row::targets)},
                               measures_in<Row>(&Row::excess, test_measures("difference"))});
}

MeasureList<Repetition> repetition_measures() {
  using Row = Repetition;
  return joined_measures<Row>(
      {{count_of<Row>("n", "n", [](const Row& one) { return one.repeats.n; }),
        member_of<Row>("repeats", [](const Row& one) { return one.repeats.correct; }),
        number_member<Row>("share", [](const Row& one) { return one.repeats.share(); }),
        number_member<Row>("expected", &Row::expected)},
       measures_in<Row>(&Row::excess, test_measures("difference"))});
}

MeasureList<SameDifferentLevel> level_measures(const ThresholdReport& report) {
  using Row = SameDifferentLevel;
  const MeasureList<Proportion> counts = count_measures("said_different");
  return {
      member_of<Row>("participant",
                     [](const Row& one) {
                       return one.participant.empty() ? Json(nullptr) : Json(one.participant);
                     }),
      member_of<Row>("standard",
                     [&report](const Row& one) { return report.standards[one.standard].words; }),
      number_member<Row>("level", &Row::level),
      object_in<Row>("different", &Row::different, counts),
      object_in<Row>("same", &Row::same, counts),
      object_in<Row>("same_at_all_levels", &Row::same_at_all, counts),
      number_member<Row>("d_prime_differencing", &Row::d_differencing),
      number_member<Row>("d_prime_independent", &Row::d_independent)};
}

MeasureList<SameDifferentGroup> group_measures(const ThresholdReport& report) {
  using Row = SameDifferentGroup;
  const auto pooled = [](const char* member, PooledDPrime Row::*of) {
    const MeasureList<PooledDPrime> both{
        number_of<PooledDPrime>("d_prime", "", decimals(2), &PooledDPrime::d_prime),
        interval_of<PooledDPrime>("interval", "", range_decimals(2), &PooledDPrime::interval)};
    return MeasureList<Row>{
        object_in<Row>(member, of, both)
            .shown(std::string("d' ") + member,
                   [of](const Row& one) { return plain_figure((one.*of).d_prime, 2); }),
        column_of<Row>("bootstrap 95%",
                       [of](const Row& one) { return plain_range((one.*of).interval, 2); })};
  };
  return joined_measures<Row>(
      {{label_of<Row>("standard", "standard",
                      [&report](const Row& one) { return report.standards[one.standard].words; }),
        number_of<Row>("level", "level (dB)", decimals(1), &Row::level),
        count_of<Row>("participants", "participants", &Row::participants)},
       pooled("differencing", &Row::differencing),
       pooled("independent", &Row::independent)});
}

}  // namespace touchtrial::analysis::threshold
