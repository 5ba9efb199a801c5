#include "analysis/quality.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

std::string mean_line(const MethodReport& method) {
  std::string text = fmt::format(
      "mean over {} {}, 95 % interval {}", counted(method.mean.participants, "participant"),
      percent_of_share(method.mean.mean), percent_range(method.mean.known_interval()));
  if (method.bootstrap) text += fmt::format(", bootstrap {}", percent_range(*method.bootstrap));
  return text;
}

std::string pooled_line(const MethodReport& method) {
  std::string text = fmt::format("pooled {} of {}, {}", method.overall.correct, method.overall.n,
                                 percent_of(method.overall));
  if (method.chance) {
    text += fmt::format("; by chance {:.1f}, p = {} ({})", method.chance->expected,
                        p_value(method.chance->p), method.chance->exact ? "exact" : "Monte Carlo");
  }
  return text;
}

std::string matching_line(const MethodReport& method) {
  if (method.overall.n == 0) return "";
  return fmt::format("{} under the best exchange of labels", percent_of(method.matching.accuracy));
}

std::string information_line(const InformationTransfer& information) {
  if (!information.raw) return "";
  return fmt::format(
      "information transfer {:.2f} bit raw, {:.2f} corrected, {:.2f} if answers were dealt at "
      "random",
      *information.raw, information.corrected.value_or(0.0), information.null_mean.value_or(0.0));
}

std::string seconds(const Quartiles& times) {
  return fmt::format("{:.2f} s [{:.2f}, {:.2f}]", *times.median, *times.lower, *times.upper);
}

std::string reaction_line(const MethodReport& method) {
  if (method.reaction.empty() || !method.reaction.back().from_plane_on.median) return "";
  const ReactionTimes& all = method.reaction.back();
  std::string text = "answered after " + seconds(all.from_plane_on) + " (median, quartiles)";
  if (all.from_contact.median) text += ", " + seconds(all.from_contact) + " from contact";
  return text;
}

/// The mean in each subset that differs from the headline's trials.
std::string robustness_line(const MethodReport& method) {
  constexpr std::pair<TrialSubset, const char*> kTold[] = {
      {TrialSubset::answered, "answered trials alone"},
      {TrialSubset::valid, "valid trials alone"},
      {TrialSubset::with_excluded_sessions, "excluded sessions put back"}};
  std::string text;
  for (const SubsetAccuracy& one : method.robustness) {
    if (one.pooled.n == method.overall.n) continue;
    for (const auto& [subset, name] : kTold) {
      if (subset != one.subset) continue;
      text += fmt::format("{}{} {}", text.empty() ? "the mean with other trials: " : ", ", name,
                          percent_of_share(one.mean.mean));
    }
  }
  return text;
}

std::string overall_text(const MethodReport& method) {
  std::string text;
  for (const std::string& line :
       {mean_line(method), pooled_line(method), matching_line(method),
        information_line(method.information), reaction_line(method), robustness_line(method)}) {
    if (!line.empty()) text += wrapped("  ", line);
  }
  return text;
}

std::string p_or_none(const std::optional<double>& p) {
  return p ? p_value(*p) : "-";
}

std::string odds_text(const std::optional<OddsRatio>& ratio) {
  if (!ratio) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", ratio->estimate, ratio->interval.low,
                     ratio->interval.high);
}

std::string together_text(const MethodsTogether& together) {
  return wrapped("  ", fmt::format("all at once: Cochran's Q = {:.2f}, {} degrees of freedom, "
                                   "methods exchanged within participants p = {}",
                                   together.cochran.q, together.cochran.degrees_of_freedom,
                                   p_or_none(together.permuted_p)));
}

std::string pairs_text(const StudyReport& report) {
  if (report.methods.size() < 3) return "";
  TextTable table({"first less second", "points", "95 % interval", "p", "p (Holm)", "odds ratio"});
  for (const MethodPair& pair : report.pairs) {
    const MethodComparison& overall = pair.overall;
    table.add({report.methods[pair.first].method + " - " + report.methods[pair.second].method,
               overall.difference ? points(*overall.difference) : "-",
               points_range(overall.known_interval()), p_or_none(overall.p), p_or_none(pair.p_holm),
               odds_text(pair.odds_ratio)});
  }
  std::string text = heading("every two methods", report.simulated) + table.text();
  if (report.together) text += together_text(*report.together);
  return text;
}

std::string figure_text(const CueFigure& figure, int decimals) {
  if (!figure.value) return "-";
  std::string text = fmt::format("{:.{}f}", *figure.value, decimals);
  if (figure.interval) {
    text += fmt::format(" [{:.{}f}, {:.{}f}]", figure.interval->low, decimals,
                        figure.interval->high, decimals);
  }
  return text;
}

std::string mean_text(const MeanEstimate& mean) {
  const std::string text = percent_of_share(mean.mean);
  return mean.known_interval() ? text + ' ' + percent_range(mean.known_interval()) : text;
}

std::string verdict_text(const CueMatch& match) {
  return wrapped(
      "  ", fmt::format("confusions are most like those of {} ({} bit less divergence than {}): {}",
                        title_of(match.best), figure_text(match.difference, 3),
                        title_of(match.second), match.told_apart ? "told apart" : "no verdict"));
}

std::string observers_text(const MethodCues& cues, bool simulated) {
  TextTable table({"who", "accuracy, 95 %", "efficiency, 95 %", "matched divergence (bit), 95 %"});
  table.add({"participants", mean_text(cues.human_mean), "", ""});
  for (const ObserverFigures& one : cues.observers) {
    table.add({std::string(title_of(one.cue)), mean_text(one.mean), figure_text(one.efficiency, 2),
               figure_text(one.matched_divergence, 3)});
  }
  std::string text = heading(cues.method + ": ideal observers of what was felt", simulated);
  text += table.text();
  if (cues.match) text += verdict_text(*cues.match);
  return text;
}

std::string cues_text(const CueReport& cues) {
  std::string text;
  for (const MethodCues& method : cues.methods) text += observers_text(method, cues.simulated);
  if (cues.warnings.empty()) return text;
  text += heading("to bear in mind of the observers", cues.simulated);
  for (const std::string& warning : cues.warnings) text += wrapped("  - ", warning);
  return text;
}

/// A count and its share of the row, or a dot where nobody gave that answer.
std::string cell(int count, int row_total) {
  if (count == 0) return ".";
  return fmt::format("{} {:>6}", count, '(' + percent(percentage(count, row_total), 0) + ')');
}

/// How often each answer was given; beside how often each class was presented, this shows
/// preferences.
std::vector<std::string> answered_row(const ConfusionMatrix& confusion) {
  std::vector<std::string> row{"all"};
  int missing = 0;
  int all = 0;
  for (int j = 0; j < confusion.classes(); ++j) {
    row.push_back(std::to_string(confusion.answered(j)));
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

/// Participants' accuracies, several to a line.
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

}  // namespace touchtrial::analysis::identification
