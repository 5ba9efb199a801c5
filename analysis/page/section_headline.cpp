#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

double chance_share(const StudyReport& report) {
  return report.classes.empty() ? 0.0 : 1.0 / static_cast<double>(report.classes.size());
}

std::string spread_phrase(const MeanEstimate& mean) {
  if (!mean.sd) return "";
  return fmt::format("; standard deviation between participants {} points",
                     plain_figure(100.0 * *mean.sd, 1));
}

std::string chance_phrase(const MethodReport& method) {
  if (!method.chance) return "";
  const ChanceTest& test = *method.chance;
  return fmt::format(
      " Answers that have nothing to do with what was presented would give {} "
      "right of {} on average; {} were right ({} permutation over the design, "
      "one-sided {}).",
      plain_figure(test.expected, 1), test.trials, test.correct,
      test.exact ? "exact" : "Monte Carlo", p_phrase(test.p));
}

/// The sentence to quote.
std::string headline_of(const StudyReport& report, const MethodReport& method) {
  if (!method.mean.mean) return method.method + ": no participant's trials count yet.";
  const std::string who = counted(method.mean.participants, "participant");
  if (method.mean.participants < 2) {
    return fmt::format(
               "{}: {} was right in {} of trials ({} of {}). Of one participant there is "
               "no interval over participants.",
               method.method, who, share_figure(method.mean.mean), method.overall.correct,
               method.overall.n) +
           chance_phrase(method);
  }
  const std::string bootstrap =
      method.bootstrap ? ", cluster bootstrap interval " + share_range(method.bootstrap) : "";
  return fmt::format(
             "{}: participants were right in {} of their trials on average "
             "({}, {}; 95% t interval {}{}{}). Chance is {}.",
             method.method, share_figure(method.mean.mean), who, counted(method.overall.n, "trial"),
             share_range(method.mean.interval), bootstrap, spread_phrase(method.mean),
             share_figure(chance_share(report))) +
         chance_phrase(method);
}

std::vector<Cell> headline_row(const MethodReport& method) {
  const MeanEstimate& mean = method.mean;
  const bool interval = mean.participants > 1;
  const auto p = method.chance ? std::optional(method.chance->p) : std::nullopt;
  return {method.method,
          std::to_string(mean.participants),
          std::to_string(method.overall.n),
          Cell(share_figure(mean.mean), true),
          interval ? share_range(mean.interval) : kNoFigure,
          share_range(method.bootstrap),
          mean.sd ? plain_figure(100.0 * *mean.sd, 1) : kNoFigure,
          p_figure(p)};
}

Table headline_table(const StudyReport& report) {
  Table table{"headline",
              "Proportion of right answers, mean over participants",
              {{"method", Align::left},
               {"participants"},
               {"trials"},
               {"mean"},
               {"t 95% (%)"},
               {"bootstrap 95% (%)"},
               {"SD (points)"},
               {"p, above chance"}}};
  for (const MethodReport& method : report.methods) table.rows.push_back(headline_row(method));
  table.notes = {
      {"Mean of participants' own proportions, with Student's t interval.", {Source::student}},
      {"Bootstrap: expanded percentiles over draws of whole participants with all their trials.",
       {Source::davison_hinkley, Source::hesterberg}},
      {"Above chance: permutation over the orders that the study's design could have dealt, "
       "one-sided.",
       {Source::phipson_smyth}},
      {fmt::format("A trial without a response counts as wrong. Chance is {}.",
                   share_figure(chance_share(report)))}};
  return table;
}

}  // namespace

Section headline_section(const StudyReport& report) {
  Section section{"result", "Result", {}};
  for (const MethodReport& method : report.methods) {
    section.blocks.emplace_back(
        Cited{headline_of(report, method), {Source::student, Source::phipson_smyth}});
  }
  section.blocks.emplace_back(headline_table(report));
  return section;
}

Section warnings_section(const StudyReport& report) {
  Section section{"to-bear-in-mind", "What to bear in mind", {}};
  if (!report.warnings.empty()) section.blocks.emplace_back(Warnings{report.warnings});
  return section;
}

}  // namespace touchtrial::analysis
