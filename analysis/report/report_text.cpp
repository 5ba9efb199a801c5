#include "analysis/report/report.hpp"
#include "analysis/report/report_text_parts.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// A count and its share of the row, or a dot where nobody gave that answer.
std::string cell(int count, int row_total) {
  if (count == 0) return ".";
  return fmt::format("{} {:>6}", count, '(' + percent(percentage(count, row_total), 0) + ')');
}

/// How often each answer was given: beside how often it was there, what is preferred.
std::vector<std::string> answered_row(const ConfusionMatrix& confusion) {
  std::vector<std::string> row{"all"};
  int missing = 0;
  int all = 0;
  for (int j = 0; j < confusion.classes(); ++j) {
    int answered = 0;
    for (int i = 0; i < confusion.classes(); ++i) answered += confusion.count(i, j);
    row.push_back(std::to_string(answered));
    missing += confusion.no_response(j);
    all += confusion.presented(j);
  }
  row.push_back(std::to_string(missing));
  row.push_back(std::to_string(all));
  return row;
}

std::string confusion_text(const MethodReport& method, const std::vector<std::string>& classes) {
  std::vector<std::string> header{"presented"};
  header.insert(header.end(), classes.begin(), classes.end());
  header.insert(header.end(), {"no response", "n"});
  TextTable table(header);
  const ConfusionMatrix& confusion = method.confusion;
  for (int i = 0; i < confusion.classes(); ++i) {
    const int n = confusion.presented(i);
    std::vector<std::string> row{classes[i]};
    for (int j = 0; j < confusion.classes(); ++j) row.push_back(cell(confusion.count(i, j), n));
    row.push_back(cell(confusion.no_response(i), n));
    row.push_back(std::to_string(n));
    table.add(row);
  }
  table.add(answered_row(confusion));
  return table.text();
}

std::string accuracy_text(const MethodReport& method, const std::vector<std::string>& classes) {
  TextTable table({"class", "n", "correct", "accuracy", "Wilson 95 %", "Clopper-Pearson 95 %"});
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const ClassAccuracy& one = method.accuracy[i];
    table.add({classes[i], std::to_string(one.accuracy.n), std::to_string(one.accuracy.correct),
               percent_of(one.accuracy), one.accuracy.n > 0 ? percent_range(one.wilson) : "-",
               one.accuracy.n > 0 ? percent_range(one.clopper_pearson) : "-"});
  }
  return table.text();
}

/// Several participants a line.
std::string participants_text(const MethodReport& method) {
  std::size_t name_width = 0;
  for (const ParticipantAccuracy& one : method.per_participant) {
    name_width = std::max(name_width, display_width(one.participant));
  }
  const std::size_t per_line = std::max<std::size_t>(1, (kTextWidth - 2) / (name_width + 18));
  std::string text;
  for (std::size_t i = 0; i < method.per_participant.size(); ++i) {
    const ParticipantAccuracy& one = method.per_participant[i];
    const bool last = (i + 1) % per_line == 0 || i + 1 == method.per_participant.size();
    text += fmt::format("{}{:<{}} {:>7} {:>6}{}", i % per_line == 0 ? "  " : "   ", one.participant,
                        name_width, fmt::format("{}/{}", one.accuracy.correct, one.accuracy.n),
                        percent_of(one.accuracy), last ? "\n" : "");
  }
  return text;
}

std::string method_text(const StudyReport& report, const MethodReport& method) {
  const auto titled = [&](const std::string& what) {
    return heading(method.method + ": " + what, report.simulated);
  };
  return titled("confusions (rows: presented, columns: answered; count and row %)") +
         confusion_text(method, report.classes) + titled("accuracy of each class") +
         accuracy_text(method, report.classes) + titled("accuracy of each participant") +
         participants_text(method) + titled("overall") + overall_text(method);
}

std::string side_by_side_text(const StudyReport& report) {
  const MethodReport& first = report.methods[0];
  const MethodReport& second = report.methods[1];
  TextTable table({"class", first.method, second.method, "difference", "dB"});
  for (std::size_t i = 0; i < report.classes.size(); ++i) {
    const double a = first.accuracy[i].accuracy.share().value_or(0.0);
    const double b = second.accuracy[i].accuracy.share().value_or(0.0);
    const bool both = first.accuracy[i].accuracy.n > 0 && second.accuracy[i].accuracy.n > 0;
    table.add({report.classes[i], percent_of(first.accuracy[i].accuracy),
               percent_of(second.accuracy[i].accuracy), both ? points(a - b) : "-",
               signed_figure(decibels(a, b), 2)});
  }
  return table.text();
}

std::string comparison_text(const StudyReport& report) {
  const MethodComparison& comparison = *report.comparison;
  std::string text = heading(fmt::format("{} beside {} (differences: first minus second)",
                                         report.methods[0].method, report.methods[1].method),
                             report.simulated) +
                     side_by_side_text(report);
  if (!comparison.difference) return text;
  return text + fmt::format(
                    "  mean difference over {} {} points, 95 % interval "
                    "{}\n  sign-flip p = {}; {} dB (10 log10 of the ratio of means)\n",
                    counted(comparison.participants, "participant"), points(*comparison.difference),
                    points_range(comparison.known_interval()), p_value(comparison.p.value_or(1.0)),
                    signed_figure(comparison.db, 2));
}

std::string warnings_text(const StudyReport& report) {
  if (report.warnings.empty()) return "";
  std::string text = heading("to bear in mind", report.simulated);
  for (const std::string& warning : report.warnings) text += wrapped("  - ", warning);
  return text;
}

}  // namespace

std::string report_text(const StudyReport& report) {
  std::string text = simulated_line(report.simulated);
  text += fmt::format("{} ({}): {}, {}; chance is {}\n", report.study, report.protocol,
                      counted(report.participants, "participant"), counted(report.trials, "trial"),
                      percent(100.0 / static_cast<double>(report.classes.size()), 1));
  text += flow_text(report.collection.flow);
  for (const MethodReport& method : report.methods) text += method_text(report, method);
  if (report.comparison) text += comparison_text(report);
  text += pairs_text(report);
  text += warnings_text(report);
  if (report.cues) text += cues_text(*report.cues);
  if (report.simulated) text += '\n' + simulated_line(report.simulated);
  return text;
}

}  // namespace touchtrial::analysis
