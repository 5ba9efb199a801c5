#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

Table ability_table(const StudyReport& report) {
  Table table{"ability", "Whether at least one participant can, and how many would show it",
              columns_of({"method", "right", "by chance", "p, at least one", "passed alone",
                          "by chance alone", "would pass", "95% (%)"})};
  for (const MethodReport& method : report.methods) {
    std::vector<Cell> row{method.method, kNoFigure, kNoFigure, kNoFigure,
                          kNoFigure,     kNoFigure, kNoFigure, kNoFigure};
    if (method.chance) {
      row[1] = fmt::format("{}/{}", method.chance->correct, method.chance->trials);
      row[2] = plain_figure(method.chance->expected, 1);
      row[3] = p_figure(method.chance->p);
    }
    if (method.prevalence) {
      const Prevalence& found = *method.prevalence;
      row[4] = fmt::format("{}/{}", found.passed, found.participants);
      row[5] = share_figure(found.level);
      row[6] = share_figure(found.estimate);
      row[7] = share_range(found.interval);
    }
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      {"At least one participant: permutation over the orders that the study's design could have "
       "dealt, one-sided; a small p says nothing about the mean.",
       {Source::phipson_smyth}},
      {"Would pass: the share of people who would pass their own test in as many trials, a lower "
       "bound of those who can; posterior mode and 95% highest posterior density. By chance alone: "
       "the mean level that participants' tests attain.",
       {Source::ince}}};
  return table;
}

/// "8.2 (6.1, 11.0)": the time until the answer, from the moment the plane can be felt.
std::string time_figure(const MethodReport& method, std::size_t place) {
  if (place >= method.reaction.size()) return kNoFigure;
  const Quartiles& times = method.reaction[place].from_plane_on;
  if (!times.median) return kNoFigure;
  return fmt::format("{} ({}, {})", plain_figure(times.median, 1), plain_figure(times.lower, 1),
                     plain_figure(times.upper, 1));
}

Table class_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  const bool unbiased = !method.unbiased.empty();
  Table table =
      method_table(report, index, "accuracy-by-class", "right answers by the texture presented",
                   columns_of({"texture", "n", "right", "accuracy", "t 95% (%)"}));
  if (unbiased) {
    for (const char* title : {"unbiased hits", "at random"}) table.columns.push_back({title});
  }
  table.columns.push_back({"time (s)"});
  const auto add = [&](const std::string& name, const Proportion& pooled, const MeanEstimate& mean,
                       std::size_t place) {
    std::vector<Cell>& row = table.rows.emplace_back(
        std::vector<Cell>{name, std::to_string(pooled.n), std::to_string(pooled.correct),
                          share_figure(pooled.share()), share_range(mean.known_interval())});
    if (unbiased) {
      const bool known = place < method.unbiased.size();
      const UnbiasedHits hits = known ? method.unbiased[place] : UnbiasedHits{};
      row.emplace_back(share_figure(hits.rate.mean));
      row.emplace_back(share_figure(hits.by_chance));
    }
    row.emplace_back(time_figure(method, place));
  };
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    add(report.classes[i], method.accuracy[i].accuracy, method.accuracy[i].mean, i);
  }
  add("all", method.overall, method.mean, report.classes.size());
  table.notes = {
      {"Counts pool all participants. t: Student's interval of the mean of participants' own "
       "accuracies; – with one participant, or if all have the same. Time: median and quartiles, "
       "from the moment the plane can be felt to the answer, right or wrong.",
       {Source::student, Source::hyndman_fan}}};
  if (unbiased) {
    table.notes.push_back(
        {"Unbiased hits: the share of a texture's presentations that were answered right, times "
         "the share of its answers that were right, mean over participants, which answering one "
         "texture often does not raise. At random: the same if answers had nothing to do with "
         "what was presented.",
         {Source::wagner}});
  }
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

/// Every participant's accuracies, a column for each method.
Table participant_table(const StudyReport& report) {
  Table table{"accuracy-by-participant", "Right answers by participant",
              columns_of({"participant"})};
  std::map<std::string, std::size_t> row_of;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    table.columns.push_back({report.methods[i].method});
    for (const ParticipantAccuracy& one : report.methods[i].per_participant) {
      const auto [found, is_new] = row_of.emplace(one.participant, table.rows.size());
      if (is_new) {
        table.rows.emplace_back(std::vector<Cell>(report.methods.size() + 1, kNoFigure));
        table.rows.back().front() = one.participant;
      }
      table.rows[found->second][i + 1] = count_and_share(one.accuracy);
    }
  }
  return table;
}

/// Those whose labels may have been swapped.
std::optional<Table> swaps_table(const StudyReport& report) {
  Table table{"label-swaps", "Participants who may have swapped labels",
              columns_of({"participant", "method", "accuracy", "under the exchange", "exchange",
                          "p", "p, adjusted"},
                         {"method", "exchange"})};
  for (const MethodReport& method : report.methods) {
    for (const ParticipantAccuracy& one : method.per_participant) {
      if (one.swap_adjusted > kUsualLevel) continue;
      table.rows.push_back({one.participant, method.method, count_and_share(one.accuracy),
                            share_figure(one.matching.accuracy.share()),
                            exchange_of(one.matching, report.classes), p_figure(one.swap_p),
                            p_figure(one.swap_adjusted)});
    }
  }
  if (table.rows.empty()) return {};
  table.notes = {
      {"The exchange is the one-to-one matching of textures and answers with the most trials, "
       "chosen after the fact. p: sign test of the answers that agree with it against those with "
       "the own label, times the number of exchanges of as many labels; adjusted over all "
       "participants and methods.",
       {Source::kuhn, Source::benjamini_hochberg}}};
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

}  // namespace

Section accuracy_section(const StudyReport& report) {
  Section section{"accuracy",
                  "Accuracy",
                  {table_of("headline", "Right answers, mean over participants", report.methods,
                            headline_measures(report))}};
  const bool is_one = report.methods.size() == 1;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    // Of several methods a table compares them by texture.
    (is_one ? section.blocks : section.more).emplace_back(class_table(report, i));
  }
  if (auto swaps = swaps_table(report)) section.blocks.emplace_back(std::move(*swaps));
  section.more.emplace_back(ability_table(report));
  section.more.emplace_back(participant_table(report));
  return section;
}

Section confusions_section(const StudyReport& report, bool drawn) {
  Section section{"confusions", "Confusions", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    (drawn ? section.more : section.blocks).emplace_back(confusion_table(report, i));
    if (report.methods[i].choice) section.more.emplace_back(choice_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
