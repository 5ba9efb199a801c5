#include "analysis/outcomes/departures.hpp"
#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis {
namespace {

/// A mean has a sign only if it is negative, a difference always.
std::string decibels(const PrimaryResult& primary, std::optional<double> value) {
  return primary.is_estimate() ? plain_figure(value, 1) : signed_plain_figure(value, 1);
}

/// A value of the estimand without a unit, except the % of a share.
std::string bare_figure(const PrimaryResult& primary, std::optional<double> value) {
  if (primary.has_thresholds()) return decibels(primary, value);
  return primary.is_difference() ? points_figure(value) : share_figure(value);
}

std::string range_figure(const PrimaryResult& primary, const std::optional<Interval>& interval) {
  return primary.has_thresholds() ? plain_range(interval, 1) : share_range(interval);
}

/// A value of the estimand: "77.0%", "+3.2 points", or "−18.3 dB".
std::string estimand_figure(const PrimaryResult& primary, std::optional<double> value) {
  if (!value) return kNoFigure;
  if (primary.has_thresholds()) return decibels(primary, value) + " dB";
  return primary.is_difference() ? points_figure(value) + " points" : share_figure(value);
}

/// "95%", and never "100%".
std::string level_words(double level) {
  const std::string text = fmt::format("{:.4g}%", 100.0 * level);
  return text == "100%" ? fmt::format("{:.10g}%", 100.0 * level) : text;
}

std::string capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

/// "11 participants analysed; 20 planned, 14 completed"
std::string people_of(const PrimaryResult& primary, const StudyCourse& course) {
  const std::string planned = course.planned > 0 ? std::to_string(course.planned) : "no number";
  return fmt::format("{} analysed; {} planned, {} completed",
                     counted(primary.registered().participants, "participant"), planned,
                     course.completed);
}

std::string lead_of(Verdict verdict) {
  const bool is_decided = verdict == Verdict::supported || verdict == Verdict::not_supported;
  if (verdict == Verdict::estimated) return "Estimated as registered.";
  return capitalized(name_of(verdict)) + (is_decided ? " by the registered test." : ".");
}

/// "; t(19) = 2.41, d = 0.54 [0.06, 1.00]"; empty without a t.
std::string statistic_phrase(const PrimaryResult& primary) {
  if (!primary.statistic) return "";
  return fmt::format("; {}, {} = {} {}", t_phrase(*primary.statistic),
                     primary.is_difference() || primary.has_thresholds() ? "d_z" : "d",
                     plain_figure(primary.statistic->d, 2),
                     plain_range(primary.statistic->interval, 2));
}

/// The verdict, the estimate with interval and test, and the reason for the verdict.
CitedText verdict_sentence(const StudyHead& head) {
  const PrimaryResult& primary = *head.primary;
  const PrimaryChoice& choice = primary.registered();
  std::string text =
      fmt::format("{}: {}", capitalized(primary.words), estimand_figure(primary, choice.estimate));
  if (!choice.pair.empty()) text += " (" + choice.pair + ")";
  if (choice.interval) {
    text += fmt::format(", {} {} {}", level_words(primary.interval_level),
                        primary.has_thresholds() ? "interval" : "t interval",
                        range_figure(primary, choice.interval));
  }
  text += " (" + people_of(primary, head.course) + ")";
  if (primary.is_estimate()) {
    return {
        text + ". " + primary.reason, {Source::student, Source::tobin}, lead_of(primary.verdict)};
  }
  text += ". " + capitalized(primary.test);
  if (primary.p) text += ": " + p_phrase(*primary.p);
  text += statistic_phrase(primary);
  text += fmt::format(", alpha {:.3g}", primary.alpha);
  if (primary.level != primary.alpha) {
    text += fmt::format(", nominal level at this look {:.3g}", primary.level);
  }
  if (primary.bound && !primary.margin) {
    text += fmt::format(", lower {} limit {}", level_words(1.0 - primary.level),
                        estimand_figure(primary, primary.bound));
  }
  std::vector<Source> sources{Source::student};
  if (primary.crossover) sources = {Source::hills_armitage, Source::senn};
  if (primary.has_thresholds()) sources.push_back(Source::tobin);
  if (primary.statistic) sources.push_back(Source::cumming_finch);
  return {text + ". " + primary.reason, std::move(sources), lead_of(primary.verdict)};
}

bool have_same_numbers(const PrimaryChoice& a, const PrimaryChoice& b) {
  const auto ends = [](const PrimaryChoice& choice) {
    return choice.interval ? std::optional(std::pair(choice.interval->low, choice.interval->high))
                           : std::nullopt;
  };
  return a.participants == b.participants && a.trials == b.trials && a.estimate == b.estimate &&
         ends(a) == ends(b);
}

/// Choices with distinct numbers, each with the words of later choices that have the same numbers.
std::vector<std::pair<PrimaryChoice, std::vector<std::string>>> distinct_choices(
    const std::vector<PrimaryChoice>& choices) {
  std::vector<std::pair<PrimaryChoice, std::vector<std::string>>> all;
  for (const PrimaryChoice& choice : choices) {
    const auto match = std::ranges::find_if(
        all, [&](const auto& entry) { return have_same_numbers(entry.first, choice); });
    if (match == all.end()) {
      all.emplace_back(choice, std::vector<std::string>{});
    } else {
      match->second.push_back(choice.words);
    }
  }
  return all;
}

/// Period effect and permutation check of a crossover comparison.
CitedText crossover_sentence(const PrimaryResult& primary, const CrossoverEstimate& crossover) {
  std::string text =
      fmt::format("{} participants had the first method first, {} had the second first",
                  crossover.first_first, crossover.second_first);
  if (crossover.period) {
    text += fmt::format(". Period effect (second minus first period): {} points",
                        points_figure(crossover.period));
    if (crossover.period_interval) text += " " + share_range(crossover.period_interval);
  }
  if (primary.permutation) {
    text += fmt::format(
        ". Permutation check (orders reassigned within their randomisation blocks): {}; smallest "
        "attainable p {:.3g}",
        p_phrase(primary.permutation->p), primary.permutation->least);
  }
  return {text +
              ". Carry-over is confounded with order; it is not tested and does not influence the "
              "choice of analysis.",
          {Source::senn, Source::phipson_smyth}};
}

/// Adds rows for the first choice with stations as strata, if the study has several stations.
void add_stations(const PrimaryResult& primary, Table& table) {
  if (!primary.stations) return;
  const StratifiedMean& stations = *primary.stations;
  const PrimaryChoice& choice = primary.registered();
  const auto add = [&](const std::string& title, double mean,
                       const std::optional<Interval>& interval) {
    table.rows.push_back({title, std::to_string(choice.participants), std::to_string(choice.trials),
                          primary.is_difference() ? points_figure(mean) : share_figure(mean),
                          share_range(interval), kNoFigure});
  };
  add(fmt::format("first row, {} stations as fixed strata", stations.strata), stations.mean,
      stations.interval);
  if (stations.random) {
    add(fmt::format("first row, {} stations as a random sample", stations.strata),
        stations.random->mean, stations.random->interval);
  }
}

CitedText note_of(const StratifiedMean& stations) {
  std::string text =
      "Fixed strata: for these stations, from the spread of participants within stations.";
  if (!stations.random) {
    return {
        text + fmt::format(" With fewer than {} stations there is no inference to other stations.",
                           kMinRandomStrata),
        {Source::student}};
  }
  text += fmt::format(
      " Random sample: the standard deviation between stations is {} points; "
      "Hartung-Knapp-Sidik-Jonkman interval.",
      plain_figure(100.0 * stations.random->spread, 1));
  return {text, {Source::student, Source::paule_mandel, Source::inthout}};
}

/// Column titles of the estimate and its interval.
std::pair<std::string, std::string> estimate_titles(const PrimaryResult& primary) {
  const std::string level = level_words(primary.interval_level);
  if (primary.has_thresholds()) {
    return {primary.is_estimate() ? "mean (dB)" : "difference (dB)", level + " (dB)"};
  }
  return primary.is_difference() ? std::pair("difference (points)", "t " + level + " (points)")
                                 : std::pair("mean", "t " + level + " (%)");
}

/// All pairwise differences of an equivalence test.
Table pairs_table(const PrimaryResult& primary) {
  const auto [estimate, interval] = estimate_titles(primary);
  Table table{"primary-pairs",
              fmt::format("All pairwise differences, registered selection; margin {} dB",
                          plain_figure(primary.margin, 1)),
              {{"difference", Align::left}, {"participants"}, {estimate}, {interval}, {"p"}}};
  for (const PrimaryPair& pair : primary.pairs) {
    table.rows.push_back({pair.words, std::to_string(pair.participants),
                          bare_figure(primary, pair.estimate), range_figure(primary, pair.interval),
                          p_figure(pair.p)});
  }
  table.notes = {
      {"p: the larger p of two one-sided t tests, against differences of plus and minus the "
       "margin. Equality is shown only if every p is at most the level, so p values are not "
       "adjusted.",
       {Source::student, Source::tobin}}};
  return table;
}

Table choices_table(const StudyHead& head) {
  const PrimaryResult& primary = *head.primary;
  const auto [estimate_title, interval_title] = estimate_titles(primary);
  Table table{"primary",
              "The primary result under every selection of sessions and trials",
              {{"choice", Align::left},
               {"participants"},
               {"trials"},
               {estimate_title},
               {interval_title},
               {"p"}}};
  std::vector<CitedText> repeat_notes;
  for (const auto& [choice, same_words] : distinct_choices(primary.choices)) {
    const bool is_first = table.rows.empty();
    if (!same_words.empty()) {
      repeat_notes.push_back(
          {same_words.size() + 1 == primary.choices.size()
               ? std::string("All other selections give the same numbers: with excluded sessions, "
                             "valid trials only") +
                     (primary.has_thresholds() ? "." : ", only trials with a response.")
               : fmt::format("The same numbers as \"{}\": {}.", choice.words,
                             fmt::join(same_words, "; "))});
    }
    table.rows.push_back(
        {choice.words, std::to_string(choice.participants), std::to_string(choice.trials),
         Cell(bare_figure(primary, choice.estimate), is_first),
         range_figure(primary, choice.interval), is_first ? p_figure(primary.p) : kNoFigure});
  }
  add_stations(primary, table);
  table.notes = {
      {std::string(
           "p applies to the first row only; the other rows show how much the result depends on "
           "the selection.") +
       (primary.has_thresholds()
            ? ""
            : " All participants have the same weight, regardless of their "
              "number of trials. Intervals are truncated to the possible range.")}};
  table.notes.insert(table.notes.end(), repeat_notes.begin(), repeat_notes.end());
  if (head.course.excluded_afterwards > 0) {
    table.notes.push_back({counted(head.course.excluded_afterwards, "session") +
                           " excluded after outcomes were seen."});
  }
  if (primary.stations) table.notes.push_back(note_of(*primary.stations));
  if (primary.estimand == study::Estimand::mean_accuracy && primary.p) {
    table.notes.push_back({*primary.p <= primary.level
                               ? "A mean above chance shows that some people perform above chance, "
                                 "not that everybody does."
                               : "A mean that is not shown to be above chance does not show that "
                                 "nobody performs above chance; \"Accuracy\" tests that."});
  }
  return table;
}

/// Whether a column has p values: "p", "sign-flip p", "p, Holm", "McNemar mid-p", "p of the
/// exchange".
bool has_p_values(const Column& column) {
  const std::string_view title = column.title;
  return title == "p" || title.starts_with("p, ") || title.starts_with("p of ") ||
         title.ends_with(" p") || title.ends_with("-p");
}

bool mentions_p(const std::string& text) {
  return text.find("p = ") != std::string::npos || text.find("p < ") != std::string::npos;
}

}  // namespace

void add_verdict(const StudyHead& head, Section& section) {
  if (!head.primary) return;
  const PrimaryResult& primary = *head.primary;
  section.blocks.emplace_back(verdict_sentence(head));
  if (primary.crossover) {
    section.blocks.emplace_back(crossover_sentence(primary, *primary.crossover));
  }
  const bool is_same = distinct_choices(primary.choices).size() == 1 && !primary.stations &&
                       head.course.excluded_afterwards == 0;
  (is_same ? section.folded_blocks : section.blocks).emplace_back(choices_table(head));
  if (primary.pairs.size() > 1) section.blocks.emplace_back(pairs_table(primary));
}

void add_unadjusted_notes(const std::vector<Look>& looks, std::vector<Section>& sections) {
  const std::string words = unadjusted_words(looks);
  if (words.empty()) return;
  const auto add_words = [&](Block& block) {
    if (auto* table = std::get_if<Table>(&block)) {
      const bool has_p = std::ranges::any_of(table->columns, has_p_values) ||
                         std::ranges::any_of(table->notes, mentions_p, &CitedText::text);
      if (has_p) table->notes.push_back({words});
    } else if (auto* sentence = std::get_if<CitedText>(&block)) {
      if (mentions_p(sentence->text)) sentence->text += " The " + words;
    }
  };
  for (Section& section : sections) {
    std::ranges::for_each(section.blocks, add_words);
    std::ranges::for_each(section.folded_blocks, add_words);
  }
}

}  // namespace touchtrial::analysis
