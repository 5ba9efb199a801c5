#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

std::vector<Cell> accuracy_row(const std::string& name, const ClassAccuracy& one) {
  return {name,
          std::to_string(one.accuracy.n),
          std::to_string(one.accuracy.correct),
          share_figure(one.accuracy.share()),
          one.has_interval_over_participants() ? share_range(one.mean.interval) : kNoFigure,
          share_range(one.wilson),
          share_range(one.clopper_pearson),
          share_range(one.jeffreys)};
}

Table class_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  Table table =
      method_table(report, index, "accuracy-by-class",
                   "right answers by the texture presented; t over participants, the other "
                   "intervals as if all trials were independent",
                   columns_of({"texture", "n", "right", "accuracy", "t 95% (%)", "Wilson 95% (%)",
                               "Clopper-Pearson 95% (%)", "Jeffreys 95% (%)"}));
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    table.rows.push_back(accuracy_row(report.classes[i], method.accuracy[i]));
  }
  table.notes = {{"t: Student's interval of the mean of participants' own accuracies with the "
                  "texture, to quote; – with one participant, or if all have the same.",
                  {Source::student}},
                 {"Wilson: score interval.", {Source::wilson}},
                 {"Clopper-Pearson: exact, never below its level.", {Source::clopper_pearson}},
                 {"Jeffreys: quantiles of a beta distribution, by convention from 0 where no "
                  "answer is right and to 1 where all are. The last three treat trials as "
                  "independent, but those of one participant are not, so they are too narrow.",
                  {Source::brown_cai_dasgupta}}};
  return table;
}

/// The labels that the best matching exchanges, for example "pebbles → brick, brick → pebbles".
std::string exchange_of(const LabelMatching& matching, const std::vector<std::string>& classes) {
  if (matching.answer_of.empty()) return kNoFigure;
  std::string text;
  for (std::size_t i = 0; i < matching.answer_of.size() && i < classes.size(); ++i) {
    const auto answer = static_cast<std::size_t>(matching.answer_of[i]);
    if (answer == i || answer >= classes.size()) continue;
    text += (text.empty() ? "" : ", ") + classes[i] + " → " + classes[answer];
  }
  return text.empty() ? "none" : text;
}

Table participant_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  Table table = method_table(
      report, index, "accuracy-by-participant", "right answers by participant",
      columns_of({"participant", "n", "right", "accuracy", "with the best exchange of labels",
                  "exchange", "p of the exchange", "adjusted", "consistency (bit)"},
                 {"exchange"}));
  for (const ParticipantAccuracy& one : method.per_participant) {
    table.rows.push_back({one.participant, std::to_string(one.accuracy.n),
                          std::to_string(one.accuracy.correct), share_figure(one.accuracy.share()),
                          share_figure(one.matching.accuracy.share()),
                          exchange_of(one.matching, report.classes), p_figure(one.swap_p),
                          p_figure(one.swap_adjusted), plain_figure(one.consistency, 2)});
  }
  table.rows.push_back(
      {"all, pooled", std::to_string(method.overall.n), std::to_string(method.overall.correct),
       share_figure(method.overall.share()), share_figure(method.matching.accuracy.share()),
       exchange_of(method.matching, report.classes), kNoFigure, kNoFigure, kNoFigure});
  table.notes = {
      {"The best exchange of labels is the one-to-one matching of textures and answers with the "
       "most trials: somebody who swaps two labels tells them apart all the same. It is chosen "
       "after the fact, and so biased upward.",
       {Source::kuhn}},
      {"p of the exchange: sign test of the answers that agree with it against those with the own "
       "label, times the number of exchanges of as many labels. Adjusted over all participants and "
       "methods of the study: of the exchanges with 0.05 or less, 5% at most are false on average, "
       "and if nobody exchanges labels, 5% of studies have one.",
       {Source::benjamini_hochberg}},
      {"Consistency is the raw information transfer of one participant's trials, biased upward "
       "and not to be quoted.",
       {Source::tan_reed_durlach}}};
  return table;
}

/// A count and its share of the row.
std::string count_cell(int count, int of) {
  if (count == 0) return "0";
  const auto share = percentage(count, of);
  return fmt::format("{} ({}%)", count, plain_figure(share, 0));
}

std::vector<Column> class_columns(const std::string& first, const StudyReport& report) {
  std::vector<Column> columns{{first, Align::left}};
  for (const std::string& label : report.classes) columns.push_back({label});
  return columns;
}

std::vector<Cell> marginal_row(const ConfusionMatrix& confusion) {
  std::vector<Cell> row{"all answers"};
  const int n = confusion.accuracy().n;
  int missed = 0;
  for (int j = 0; j < confusion.classes(); ++j) {
    missed += confusion.no_response(j);
    row.emplace_back(count_cell(confusion.answered(j), n));
  }
  row.emplace_back(count_cell(missed, n));
  row.emplace_back(std::to_string(n));
  return row;
}

Table confusion_table(const StudyReport& report, std::size_t index) {
  const ConfusionMatrix& confusion = report.methods[index].confusion;
  Table table =
      method_table(report, index, "confusions",
                   "answers (columns) to the textures presented (rows), counts and row percentages",
                   class_columns("presented", report));
  table.columns.push_back({"no response"});
  table.columns.push_back({"n"});
  for (int i = 0; i < confusion.classes(); ++i) {
    const int n = confusion.presented(i);
    std::vector<Cell> row{report.classes[i]};
    for (int j = 0; j < confusion.classes(); ++j) {
      row.emplace_back(count_cell(confusion.count(i, j), n), i == j);
    }
    row.emplace_back(count_cell(confusion.no_response(i), n));
    row.emplace_back(std::to_string(n));
    table.rows.push_back(std::move(row));
  }
  table.rows.push_back(marginal_row(confusion));
  table.notes = {
      {"All participants' trials pooled; right answers are emphasised. The last row counts each "
       "answer, whatever was presented; it shows preferences for answers."}};
  return table;
}

Table unbiased_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  Table table = method_table(report, index, "unbiased-hits",
                             "unbiased hit rates, which answering one texture often does not raise",
                             columns_of({"texture", "mean", "t 95% (%)", "at random"}));
  for (std::size_t i = 0; i < method.unbiased.size(); ++i) {
    const UnbiasedHits& hits = method.unbiased[i];
    const bool all = i >= report.classes.size();
    table.rows.push_back({all ? "mean of all" : report.classes[i],
                          Cell(share_figure(hits.rate.mean), all),
                          share_range(hits.rate.known_interval()), share_figure(hits.by_chance)});
  }
  table.notes = {
      {"The share of a texture's presentations that were answered right, times the share of its "
       "answers that were right: mean over participants with Student's t interval. At random: its "
       "mean if the same answers had nothing to do with the order of presentations.",
       {Source::wagner, Source::student}}};
  return table;
}

/// The groups of classes, for example "{basket, leaf} and {log}".
std::string groups_of(const ChoiceModel& model, const std::vector<std::string>& classes) {
  std::vector<std::string> groups(static_cast<std::size_t>(model.groups));
  for (std::size_t i = 0; i < model.group.size() && i < classes.size(); ++i) {
    std::string& group = groups[static_cast<std::size_t>(model.group[i])];
    group += (group.empty() ? "" : ", ") + classes[i];
  }
  for (std::string& group : groups) group = "{" + group + "}";
  return listed(groups, " and ");
}

/// How well the model fits, in a sentence or two.
std::string fit_of(const ChoiceModel& model) {
  std::string fit = "No degree of freedom is left to test the fit.";
  if (model.degrees_of_freedom > 0) {
    fit = fmt::format("Fit: G² = {} on {}", plain_figure(model.g_squared, 2),
                      counted(model.degrees_of_freedom, "degree") + " of freedom");
    if (model.drawn_p) {
      fit += fmt::format(", {} by {} tables drawn from the model", p_phrase(*model.drawn_p),
                         model.draws);
    }
    fit += ".";
    if (model.drawn_p && *model.drawn_p <= kUsualLevel) {
      fit +=
          " The model does not fit: its similarities and biases describe the answers, but do "
          "not explain them.";
    }
  }
  return model.converged ? fit : fit + " The fit did not converge.";
}

/// Notes on the choice model, and on zeros among the counts.
std::vector<Cited> choice_notes(const ChoiceModel& model, const std::vector<std::string>& classes) {
  std::vector<Cited> notes{
      {fmt::format("Similarity choice model, maximum likelihood over trials with a response: "
                   "similarity 1 means the same, 0 never taken for each other, – no value; biases "
                   "add up to 1{}.",
                   model.groups > 1 ? " within each group" : ""),
       {Source::luce, Source::townsend_landon}},
      {fit_of(model)}};
  if (model.groups > 1) {
    notes.push_back({fmt::format(
        "Only within the {} groups {} were textures taken for each other both ways: between groups "
        "no similarity can be told from a bias, and biases cannot be compared.",
        model.groups, groups_of(model, classes))});
  }
  return notes;
}

Table choice_table(const StudyReport& report, std::size_t index) {
  const ChoiceModel& model = *report.methods[index].choice;
  Table table =
      method_table(report, index, "choice-model", "similarity of textures, and bias of answers",
                   class_columns("similarity", report));
  const auto classes = static_cast<int>(report.classes.size());
  for (int i = 0; i < classes; ++i) {
    std::vector<Cell> row{report.classes[i]};
    for (int j = 0; j < classes; ++j) {
      row.emplace_back(plain_figure(model.similarity.at(i, j), 3));
    }
    table.rows.push_back(std::move(row));
  }
  std::vector<Cell> bias{"bias"};
  for (const double one : model.bias) bias.emplace_back(plain_figure(one, 3));
  table.rows.push_back(std::move(bias));
  table.notes = choice_notes(model, report.classes);
  return table;
}

std::string bound_of(const DPrime& sensitivity) {
  if (!sensitivity.estimate && !sensitivity.low && !sensitivity.high) return kNoFigure;
  if (!sensitivity.low) return "up to " + plain_figure(sensitivity.high, 2);
  if (!sensitivity.high) return "at least " + plain_figure(sensitivity.low, 2);
  return plain_range(Interval{*sensitivity.low, *sensitivity.high}, 2);
}

/// The limits of d' over participants, or else those of independent trials, with a mark.
std::string bound_of(const MethodReport& method) {
  if (method.d_prime_over_participants) return bound_of(*method.d_prime_over_participants);
  return bound_of(method.d_prime) + " *";
}

Table information_table(const StudyReport& report) {
  Table table{"information",
              "Information transfer and nominal sensitivity, all participants' trials pooled",
              columns_of({"method", "n", "raw (bit)", "corrected (bit)", "at random (bit)",
                          "categories", "d′", "d′ 95%"})};
  for (const MethodReport& method : report.methods) {
    const InformationTransfer& information = method.information;
    const auto categories =
        information.corrected ? std::optional(std::exp2(*information.corrected)) : std::nullopt;
    table.rows.push_back({method.method, std::to_string(method.confusion.answered()),
                          plain_figure(information.raw, 2), plain_figure(information.corrected, 2),
                          plain_figure(information.null_mean, 2), plain_figure(categories, 1),
                          plain_figure(method.d_prime.estimate, 2), bound_of(method)});
  }
  table.notes = {
      {"Information transfer over trials with a response: raw (biased upward), minus Miller and "
       "Madow's bias, and the mean of the raw value when each participant's answers are dealt at "
       "random; categories are two to the power of the corrected value.",
       {Source::tan_reed_durlach, Source::miller}},
      {"d′ is what an unbiased observer of as many equally distant textures would need for this "
       "accuracy: nominal; a bound in place of infinity. Its interval follows from the share's "
       "bootstrap interval over participants.",
       {Source::green_swets, Source::hacker_ratcliff, Source::davison_hinkley}}};
  const auto of_trials = [](const MethodReport& one) { return !one.d_prime_over_participants; };
  if (std::ranges::any_of(report.methods, of_trials)) {
    table.notes.push_back(
        {"* From Clopper and Pearson's interval, which treats trials as "
         "independent: there are fewer than six participants, or they do "
         "not differ."});
  }
  return table;
}

}  // namespace

Section accuracy_section(const StudyReport& report) {
  Section section{"accuracy", "Accuracy", {}};
  add_headline(report, section);
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    add_method_heading(report, i, section);
    section.blocks.emplace_back(class_table(report, i));
    section.blocks.emplace_back(participant_table(report, i));
  }
  return section;
}

Section confusions_section(const StudyReport& report) {
  Section section{"confusions", "Confusions", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    add_method_heading(report, i, section);
    section.blocks.emplace_back(confusion_table(report, i));
    if (!report.methods[i].unbiased.empty()) {
      section.blocks.emplace_back(unbiased_table(report, i));
    }
    if (report.methods[i].choice) section.blocks.emplace_back(choice_table(report, i));
  }
  if (report.methods.size() > 1) {
    section.blocks.emplace_back(Subheading{"information-transfer", "Information transfer"});
  }
  section.blocks.emplace_back(information_table(report));
  return section;
}

}  // namespace touchtrial::analysis::identification
