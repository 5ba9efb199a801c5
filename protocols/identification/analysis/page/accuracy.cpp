#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

Table class_table(const StudyReport& report, std::size_t index) {
  const MethodReport& method = report.methods[index];
  std::vector<std::size_t> rows(method.accuracy.size() + 1);
  std::iota(rows.begin(), rows.end(), 0U);
  return method_table(report, index, "accuracy-by-class", "right answers by the texture presented",
                      rows, accuracy_measures(report, method));
}

/// Accuracies by participant and method.
Table participant_table(const StudyReport& report) {
  Table table{"accuracy-by-participant", "Right answers by participant",
              columns_of({"participant"})};
  std::map<std::string, std::size_t> row_of;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    table.columns.push_back({report.methods[i].method});
    for (const ParticipantAccuracy& participant : report.methods[i].per_participant) {
      const auto [entry, is_new] = row_of.emplace(participant.participant, table.rows.size());
      if (is_new) {
        table.rows.emplace_back(std::vector<Cell>(report.methods.size() + 1, kNoFigure));
        table.rows.back().front() = participant.participant;
      }
      table.rows[entry->second][i + 1] = count_and_share(participant.accuracy);
    }
  }
  return table;
}

/// Possibly swapped labels of a participant with a method.
struct Swap {
  const MethodReport* method;
  const ParticipantAccuracy* participant;
};

std::optional<Table> swaps_table(const StudyReport& report) {
  std::vector<Swap> swaps;
  for (const MethodReport& method : report.methods) {
    for (const ParticipantAccuracy& participant : method.per_participant) {
      if (participant.swap_p_adjusted <= kUsualLevel) swaps.push_back({&method, &participant});
    }
  }
  if (swaps.empty()) return {};
  MeasureList<Swap> measures = measures_in<Swap>(&Swap::participant, participant_measures(report));
  measures.insert(measures.begin() + 1, label_of<Swap>("", "method", [](const Swap& swap) {
                    return swap.method->method;
                  }));
  return table_of("label-swaps", "Participants who may have swapped labels", swaps, measures);
}

/// How often each answer was given, over all textures.
std::vector<Cell> marginal_row(const ConfusionMatrix& confusion) {
  std::vector<Cell> row{"all answers"};
  const int n = confusion.accuracy().n;
  int missed = 0;
  for (int j = 0; j < confusion.classes(); ++j) {
    missed += confusion.no_response(j);
    row.emplace_back(count_and_percentage(confusion.answered(j), n));
  }
  row.emplace_back(count_and_percentage(missed, n));
  row.emplace_back(std::to_string(n));
  return row;
}

Table confusion_table(const StudyReport& report, std::size_t index) {
  const ConfusionMatrix& confusion = report.methods[index].confusion;
  Table table =
      method_table(report, index, "confusions",
                   "answers (columns) to the textures presented (rows), counts and row percentages",
                   class_indices(confusion), confusion_measures(report.classes, confusion));
  table.rows.push_back(marginal_row(confusion));
  return table;
}

}  // namespace

Section accuracy_section(const StudyReport& report) {
  Section section{"accuracy",
                  "Accuracy",
                  {table_of("headline", "Right answers, mean over participants", report.methods,
                            headline_measures(report))}};
  const bool has_one_method = report.methods.size() == 1;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    // Another table compares several methods by texture.
    (has_one_method ? section.blocks : section.folded_blocks).emplace_back(class_table(report, i));
  }
  if (auto swaps = swaps_table(report)) section.blocks.emplace_back(std::move(*swaps));
  section.folded_blocks.emplace_back(table_of(
      "ability", "Participants above chance: whether there is one, and how many would pass a test",
      report.methods, ability_measures()));
  section.folded_blocks.emplace_back(participant_table(report));
  return section;
}

Section confusions_section(const StudyReport& report, bool has_figure) {
  Section section{"confusions", "Confusions", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    (has_figure ? section.folded_blocks : section.blocks).emplace_back(confusion_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
