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
          number_member<Row>("high", &Row::high), member_of<Row>("censored", [](const Row& row) {
            const std::string_view censored = word_of(row.censored);
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
          member_of<Row>("draws", [](const Row& row) { return row.thresholds.size(); })};
}

MeasureList<Proportion> count_measures(const std::string& correct_name) {
  return {member_of<Proportion>("n", &Proportion::n),
          member_of<Proportion>(correct_name, &Proportion::correct)};
}

/// "6 of 6"
std::string counts_text(const Proportion& trials) {
  return trials.n == 0 ? kNoFigure : fmt::format("{} of {}", trials.correct, trials.n);
}

std::optional<Quantity> known_quantity(const Quantity& quantity) {
  return quantity.value ? std::optional(quantity) : std::nullopt;
}

Json class_name(const ThresholdReport& report, const StandardReport& standard) {
  const auto label = static_cast<std::size_t>(standard.definition.class_index);
  return label < report.classes.size() ? Json(report.classes[label]) : Json(nullptr);
}

/// "−12.5", "above 0.0" or "between −5.0 and −2.5"; a dash if unknown
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
  return [censored](const StandardReport& standard) { return standard.number_of(censored); };
}

std::string reversals_note(const ThresholdReport& report) {
  return fmt::format(
      "Reversals: mean of the last reversals of the staircase. It estimates the level with {} "
      "right, not the threshold's {}, so do not compare the two. It has no interval; above or "
      "below means that a reversal was at an end of the levels.",
      share_figure(procedures::convergence_of(report.options().track.up_down)),
      share_figure(report.criterion));
}

}  // namespace

MeasureList<CensoredMean> censored_measures(const std::string& name) {
  using Row = CensoredMean;
  using enum MissingReason;
  static constexpr auto kReasonNames = std::to_array<Named<MissingReason>>(
      {{"few known", values}, {"most censored", most}, {"all alike", spread}});
  return {number_of<Row>(name, "", signed_decimals(1), &Row::mean),
          interval_of<Row>("interval", "", range_decimals(1), &Row::interval),
          member_of<Row>("lack",
                         [](const Row& row) {
                           return row.lack == nothing ? Json(nullptr)
                                                      : Json(name_in(kReasonNames, row.lack));
                         }),
          number_of<Row>("sd", "", decimals(1), &Row::sd),
          number_member<Row>("median", &Row::median).with_cells("", median_figure),
          member_of<Row>("median_within", [](const Row& row) {
            return interval_json(Interval{row.median_within.low, row.median_within.high});
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
    return track.estimate
               ? quantity_of(report.options(), standard(track).definition, *estimate(track))
               : Quantity{};
  };
  const auto threshold_cell = [standard](const procedures::Threshold* threshold, const Row& track) {
    return threshold == nullptr ? kNoFigure : threshold_text(*threshold, standard(track).levels);
  };
  return {
      label_of<Row>("participant", "participant", &Row::participant).in_csv({"participant"}),
      count_of<Row>("track", "track", &Row::track).in_csv({"track"}),
      label_of<Row>("standard", "standard", [=](const Row& row) { return standard(row).words; }),
      member_of<Row>("", [=, &report](const Row& row) { return class_name(report, standard(row)); })
          .in_csv({"class"}),
      member_of<Row>("", [=](const Row& row) { return standard(row).definition.value; })
          .in_csv({"standard_value"}),
      count_of<Row>("trials", "n", [](const Row& row) { return row.answers.n; }).in_csv({"trials"}),
      member_of<Row>("right", [](const Row& row) { return row.answers.correct; })
          .with_cells("right", [](const Row& row) { return share_figure(row.answers.share()); })
          .in_csv({"right"}),
      object_in<Row>("catch", &Row::catches, count_measures("right"))
          .with_cells("catch trials right", [](const Row& row) { return counts_text(row.catches); })
          .in_csv({"catch_trials", "catch_right"}),
      object_in<Row>("estimate", estimate, estimate_measures())
          .with_cells("threshold and 95% (dB)",
                      [=](const Row& row) { return threshold_cell(estimate(row), row); })
          .in_csv({"threshold_db", "low_db", "high_db", "censored"})
          .with_note(
              "Threshold: with its 95% interval, as under Methods. Above, below: with usual lapse "
              "rates the whole interval is beyond the highest or the lowest level. Not determined: "
              "the answers determine neither a threshold within the levels nor a side; a known end "
              "of the interval is given. n and right: trials chosen by the procedure; catch trials "
              "are at the highest level and also enter the threshold."),
      member_of<Row>("in_mean",
                     [=](const Row& row) -> Json {
                       if (!row.estimate) return nullptr;
                       const Bounds bounds = bounds_of(*row.estimate, standard(row).levels);
                       return interval_json(Interval{bounds.low, bounds.high});
                     })
          .in_csv({"at_least_db", "at_most_db"}),
      object_in<Row>("reversals", &Row::reversals, estimate_measures())
          .with_cells("reversals",
                      [=](const Row& track) {
                        return threshold_cell(track.reversals ? &*track.reversals : nullptr, track);
                      })
          .in_csv({"reversals_db", "", "", "reversals_censored"})
          .with_note(reversals_note(report))
          .hidden_if_unknown(),
      object_in<Row>(
          "weber", [=](const Row& track) { return known_quantity(quantity(track)); },
          quantity_measures())
          .with_cells(quantity_name(report.options()),
                      [=, &report](const Row& track) {
                        return quantity_text(quantity(track), report.options());
                      })
          .in_csv({"weber", "weber_low", "weber_high"}),
      object_in<Row>("goodness_of_fit", &Row::fit, fit_measures())
          .with_cells("p of the fit",
                      [](const Row& row) { return row.fit ? p_figure(row.fit->p) : kNoFigure; })
          .in_csv({"", "fit_p", ""})
          .with_note(
              "p of the fit: the share of 399 data sets simulated from the fit whose deviance is "
              "at least as large (Wichmann and Hill 2001). With few trials per level it detects "
              "only large deviations.")
          .hidden_if_unknown(),
      number_member<Row>("learning_db", &Row::learning_db).in_csv({"learning_db"}),
      number_member<Row>("", [&report](const Row&) { return report.criterion; })
          .in_csv({"criterion"}),
      member_of<Row>("", [&report](const Row&) { return report.simulated; }).in_csv({"simulated"})};
}

MeasureList<StandardReport> standard_measures(const ThresholdReport& report) {
  using Row = StandardReport;
  const auto quantity = [&report](const Row& row) {
    return quantity_of(report.options(), row.definition, mean_threshold(row.mean));
  };
  const std::string title = quantity_name(report.options());
  return joined_measures<Row>(
      {{label_of<Row>("standard", "standard", &Row::words),
        member_of<Row>("class", [&report](const Row& row) { return class_name(report, row); }),
        number_member<Row>("value", [](const Row& row) { return row.definition.value; }),
        number_member<Row>("highest_level",
                           [](const Row& row) {
                             return row.levels.empty() ? std::nullopt
                                                       : std::optional(row.levels.back());
                           }),
        member_of<Row>("tracks", &Row::tracks),
        count_of<Row>("n", "n", [](const Row& row) { return row.mean.participants; })
            .with_note(
                "n: participants in the mean, each with the mean of their tracks. Known: every "
                "track has a number. Beyond: the whole interval is below the lowest or above the "
                "highest level; counted as censored. Not determined: neither, or the tracks "
                "disagree; the likeliest threshold enters the mean, or its side if it is beyond "
                "the levels, or nothing if both ends are open. If more than half are not "
                "determined or have no value, there is no mean."),
        member_of<Row>("no_share", [](const Row& row) { return row.mean.open; }),
        column_of<Row>(
            "mean and 95% (dB)",
            [](const Row& row) { return threshold_text(mean_threshold(row.mean), row.levels); }),
        count_of<Row>("known", "known", number_of_censored(Censored::no)),
        member_of<Row>("below", number_of_censored(Censored::below))
            .with_cells("beyond", beyond_text),
        member_of<Row>("above", number_of_censored(Censored::above)),
        count_of<Row>("undetermined", "not determined",
                      number_of_censored(Censored::undetermined))},
       measures_in<Row>(&Row::mean, titled(censored_measures("mean"),
                                           {{"sd", "SD (dB)"}, {"median", "median (dB)"}})),
       {object_in<Row>(
            "weber", [=](const Row& row) { return known_quantity(quantity(row)); },
            quantity_measures())
            .with_cells(title.empty() ? "" : title + " and 95%", [=, &report](const Row& row) {
              return quantity_text(quantity(row), report.options());
            })}});
}

MeasureList<DifferenceReport> difference_measures(const ThresholdReport& report) {
  using Row = DifferenceReport;
  const auto words = [&report](std::size_t Row::*standard) {
    return [&report, standard](const Row& row) { return report.standards[row.*standard].words; };
  };
  return joined_measures<Row>(
      {{label_of<Row>("first", "first", words(&Row::first)),
        label_of<Row>("second", "second", words(&Row::second))},
       measures_in<Row>(&Row::difference,
                        titled(censored_measures("difference"),
                               {{"difference", "difference (dB)"}, {"interval", "95% (dB)"}})),
       {count_of<Row>("participants", "n",
                      [](const Row& row) { return row.difference.participants; }),
        count_of<Row>("known", "known", &Row::known), number_of<Row>("p", "p", p_figure, &Row::p),
        number_of<Row>("p_holm", "p by Holm", p_figure, &Row::p_holm),
        column_of<Row>(
            "t",
            [](const Row& row) { return row.statistic ? t_phrase(*row.statistic) : kNoFigure; }),
        member_of<Row>("statistic", [](const Row& row) { return statistic_json(row.statistic); })
            .with_cells("d_z, 95%", [](const Row& row) { return effect_figure(row.statistic); })
            .with_note(
                "Mean, interval and two-sided p as for thresholds; a difference is known if both "
                "thresholds are, and censored if one of them is. By Holm: adjusted over all pairs. "
                "t and d_z (mean over standard deviation between participants) only if every "
                "difference is known.",
                {Source::student, Source::tobin, Source::holm, Source::cumming_finch})}});
}

MeasureList<RightAnswers> right_measures(bool has_participants) {
  using Row = RightAnswers;
  const MeasureList<Row> right{
      count_of<Row>("n", "n", [](const Row& row) { return row.answers.n; }),
      count_of<Row>("right", "right", [](const Row& row) { return row.answers.correct; }),
      number_of<Row>("share", "share", share_figure,
                     [](const Row& row) { return row.answers.share(); }),
      interval_of<Row>("interval", "", share_range,
                       [](const Row& row) { return known_interval(row.interval, row.answers); }),
      number_of<Row>("p", "p", p_figure, &Row::p)};
  if (!has_participants) return right;
  return joined_measures<Row>(
      {{member_of<Row>("participant", &Row::participant)
            .with_cells("participant",
                        [](const Row& row) {
                          return row.participant.empty() ? "all, pooled" : row.participant;
                        })},
       right,
       {number_of<Row>("p_holm", "p by Holm", p_figure, &Row::p_holm)
            .with_note(
                "p: exact binomial probability of at least as many right answers by guessing; by "
                "Holm: adjusted over participants. Targets are drawn independently, so trials are "
                "independent under guessing.",
                {Source::holm})}});
}

MeasureList<GroupTest> test_measures(const std::string& name) {
  using Row = GroupTest;
  return {number_of<Row>(name, "difference (points)", points_figure,
                         [](const Row& row) { return row.mean.mean; }),
          interval_of<Row>("interval", "t 95%", share_range,
                           [](const Row& row) { return row.mean.known_interval(); }),
          member_of<Row>("participants", [](const Row& row) { return row.mean.participants; }),
          number_of<Row>("p", "p", p_figure, &Row::p), member_of<Row>("test", [](const Row& row) {
            return !row.p ? Json(nullptr) : Json(row.all_equal ? "sign flips" : "t");
          })};
}

MeasureList<ChoiceUse> choice_measures() {
  using Row = ChoiceUse;
  return joined_measures<Row>({{label_of<Row>("choice", "answer", &Row::choice),
                                count_of<Row>("named", "given", &Row::named_count),
                                count_of<Row>("targets", "right answer", &Row::target_count)},
                               measures_in<Row>(&Row::excess, test_measures("difference"))});
}

MeasureList<Repetition> repetition_measures() {
  using Row = Repetition;
  return joined_measures<Row>(
      {{count_of<Row>("n", "n", [](const Row& row) { return row.repeats.n; }),
        member_of<Row>("repeats", [](const Row& row) { return row.repeats.correct; }),
        number_member<Row>("share", [](const Row& row) { return row.repeats.share(); }),
        number_member<Row>("expected", &Row::expected)},
       measures_in<Row>(&Row::excess, test_measures("difference"))});
}

MeasureList<SameDifferentLevel> level_measures(const ThresholdReport& report) {
  using Row = SameDifferentLevel;
  const MeasureList<Proportion> counts = count_measures("said_different");
  return {
      member_of<Row>("participant",
                     [](const Row& row) {
                       return row.participant.empty() ? Json(nullptr) : Json(row.participant);
                     }),
      member_of<Row>("standard",
                     [&report](const Row& row) { return report.standards[row.standard].words; }),
      number_member<Row>("level", &Row::level),
      object_in<Row>("different", &Row::different, counts),
      object_in<Row>("same", &Row::same, counts),
      object_in<Row>("same_at_all_levels", &Row::same_at_all_levels, counts),
      number_member<Row>("d_prime_differencing", &Row::d_differencing),
      number_member<Row>("d_prime_independent", &Row::d_independent)};
}

MeasureList<SameDifferentGroup> group_measures(const ThresholdReport& report) {
  using Row = SameDifferentGroup;
  const auto pooled = [](const char* member, PooledDPrime Row::*model) {
    const MeasureList<PooledDPrime> measures{
        number_of<PooledDPrime>("d_prime", "", decimals(2), &PooledDPrime::d_prime),
        interval_of<PooledDPrime>("interval", "", range_decimals(2), &PooledDPrime::interval)};
    return MeasureList<Row>{
        object_in<Row>(member, model, measures)
            .with_cells(std::string("d' ") + member,
                        [model](const Row& row) { return plain_figure((row.*model).d_prime, 2); }),
        column_of<Row>("bootstrap 95%",
                       [model](const Row& row) { return plain_range((row.*model).interval, 2); })};
  };
  return joined_measures<Row>(
      {{label_of<Row>("standard", "standard",
                      [&report](const Row& row) { return report.standards[row.standard].words; }),
        number_of<Row>("level", "level (dB)", decimals(1), &Row::level),
        count_of<Row>("participants", "participants", &Row::participants)},
       pooled("differencing", &Row::differencing),
       pooled("independent", &Row::independent)});
}

}  // namespace touchtrial::analysis::threshold
