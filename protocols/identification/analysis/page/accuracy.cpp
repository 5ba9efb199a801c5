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
  std::vector<std::size_t> places(method.accuracy.size() + 1);
  std::iota(places.begin(), places.end(), 0U);
  return method_table(report, index, "accuracy-by-class", "right answers by the texture presented",
                      places, accuracy_measures(report, method));
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

/// A participant with a method.
struct Swap {
  const MethodReport* method;
  const ParticipantAccuracy* participant;
};

/// Those whose labels may have been swapped.
std::optional<Table> swaps_table(const StudyReport& report) {
  std::vector<Swap> swaps;
  for (const MethodReport& method : report.methods) {
    for (const ParticipantAccuracy& one : method.per_participant) {
      if (one.swap_adjusted <= kUsualLevel) swaps.push_back({&method, &one});
    }
  }
  if (swaps.empty()) return {};
  MeasureList<Swap> measures = measures_in<Swap>(&Swap::participant, participant_measures(report));
  measures.insert(measures.begin() + 1,
                  label_of<Swap>("", "method", [](const Swap& one) { return one.method->method; }));
  return table_of("label-swaps", "Participants who may have swapped labels", swaps, measures);
}

/// How often each answer was given, whatever was presented.
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
  const bool is_one = report.methods.size() == 1;
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    // Of several methods a table compares them by texture.
    (is_one ? section.blocks : section.more).emplace_back(class_table(report, i));
  }
  if (auto swaps = swaps_table(report)) section.blocks.emplace_back(std::move(*swaps));
  section.more.emplace_back(table_of(
      "ability", "Whether at least one participant performs above chance, and how many would",
      report.methods, ability_measures()));
  section.more.emplace_back(participant_table(report));
  return section;
}

Section confusions_section(const StudyReport& report, bool drawn) {
  Section section{"confusions", "Confusions", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    (drawn ? section.more : section.blocks).emplace_back(confusion_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
