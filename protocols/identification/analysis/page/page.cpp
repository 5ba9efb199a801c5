#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// Capitalises the captions of tables. With several methods a caption begins with a method's name,
/// which must stay as it is.
void capitalise_captions(Document& document) {
  for (Section& section : document.sections) {
    for (Block& block : section.blocks) {
      auto* table = std::get_if<Table>(&block);
      if (table == nullptr || table->caption.empty()) continue;
      char& first = table->caption.front();
      if (first >= 'a' && first <= 'z') first = static_cast<char>(first - 'a' + 'A');
    }
  }
}

bool explores(const Pictures& pictures) {
  return std::ranges::find(pictures, kExplorations, &Picture::section) != pictures.end();
}

/// Tells whether an earlier method has the same slug.
bool is_taken(const StudyReport& report, std::size_t method, const std::string& slug) {
  for (std::size_t i = 0; i < method; ++i) {
    if (slug_of(report.methods[i].method) == slug) return true;
  }
  return false;
}

double chance_share(const StudyReport& report) {
  return report.classes.empty() ? 0.0 : 1.0 / static_cast<double>(report.classes.size());
}

std::string spread_figure(const std::optional<Spread>& spread) {
  if (!spread) return kNoFigure;
  return plain_figure(100.0 * spread->estimate, 1) + " " + share_range(spread->interval);
}

std::string spread_phrase(const MethodReport& method) {
  if (!method.spread) return "";
  return fmt::format(
      "; standard deviation between participants {} points, without what a limited number of "
      "trials "
      "adds by chance",
      spread_figure(method.spread));
}

std::string chance_phrase(const MethodReport& method) {
  if (!method.chance) return "";
  const ChanceTest& test = *method.chance;
  return fmt::format(
      " Whether at least one participant can: answers that have nothing to do with what was "
      "presented would give {} right of {} on average; {} were right ({} permutation over the "
      "design, one-sided {}).",
      plain_figure(test.expected, 1), test.trials, test.correct,
      test.exact ? "exact" : "Monte Carlo", p_phrase(test.p));
}

std::string prevalence_phrase(const MethodReport& method) {
  if (!method.prevalence || method.prevalence->participants < 2) return "";
  const Prevalence& found = *method.prevalence;
  return fmt::format(
      " {} of {} passed this test on their own trials; somebody who guesses passes with a "
      "probability of {}. Estimated share of people who would pass in as many trials: {} {}, a "
      "lower bound of those who can.",
      found.passed, counted(found.participants, "participant"), share_figure(found.level),
      share_figure(found.estimate), share_range(found.interval));
}

/// The t interval, with what a reader of it might miss.
std::string interval_phrase(const MeanEstimate& mean) {
  const std::optional<Interval> interval = mean.known_interval();
  if (!interval) return "no t interval, because they do not differ";
  return "95% t interval " + share_range(interval) +
         (*interval == Interval{0.0, 1.0} ? ", which is every possible value" : "");
}

/// The sentence for readers to quote.
std::string headline_of(const StudyReport& report, const MethodReport& method) {
  if (!method.mean.mean) return method.method + ": no participant's trials count yet.";
  const std::string who = counted(method.mean.participants, "participant");
  if (method.mean.participants < 2) {
    return fmt::format(
               "{}: {} was right in {} of trials ({} of {}). With one participant there is no "
               "interval over participants.",
               method.method, who, share_figure(method.mean.mean), method.overall.correct,
               method.overall.n) +
           chance_phrase(method);
  }
  const std::string bootstrap =
      method.bootstrap ? ", bootstrap interval " + share_range(method.bootstrap) : "";
  return fmt::format(
             "{}: participants were right in {} of their trials on average "
             "({}, {}; {}{}{}). Chance is {}.",
             method.method, share_figure(method.mean.mean), who, counted(method.overall.n, "trial"),
             interval_phrase(method.mean), bootstrap, spread_phrase(method),
             share_figure(chance_share(report))) +
         chance_phrase(method) + prevalence_phrase(method);
}

std::vector<Cell> headline_row(const MethodReport& method) {
  const MeanEstimate& mean = method.mean;
  return {method.method,
          std::to_string(mean.participants),
          std::to_string(method.overall.n),
          Cell(share_figure(mean.mean), true),
          share_range(mean.known_interval()),
          share_range(method.bootstrap),
          spread_figure(method.spread)};
}

Table headline_table(const StudyReport& report) {
  Table table{"headline", "Proportion of right answers, mean over participants",
              columns_of({"method", "participants", "trials", "mean", "t 95% (%)",
                          "bootstrap 95% (%)", "SD between (points)"})};
  for (const MethodReport& method : report.methods) table.rows.push_back(headline_row(method));
  table.notes = {
      {"Mean of participants' own proportions, with Student's t interval, cut where possible "
       "values "
       "end.",
       {Source::student}},
      {"Bootstrap: expanded percentiles of the same mean over draws of whole participants.",
       {Source::davison_hinkley, Source::hesterberg}},
      {"SD between: the standard deviation of participants' own probabilities of a right answer, "
       "without what a limited number of trials adds by chance, with its 95% interval.",
       {Source::paule_mandel, Source::viechtbauer}},
      {fmt::format(
          "Each participant weighs the same, however many trials it has. A trial without a "
          "response counts as wrong. Chance is {}.",
          share_figure(chance_share(report)))}};
  return table;
}

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

/// The end of the ids of a method's tables; unique in the report.
std::string method_slug(const StudyReport& report, std::size_t method) {
  const std::string slug = slug_of(report.methods[method].method);
  if (!slug.empty() && !is_taken(report, method, slug)) return slug;
  // No slug contains two hyphens in a row.
  return slug + "--" + std::to_string(method + 1);
}

}  // namespace

void add_method_heading(const StudyReport& report, std::size_t method, Section& section) {
  if (report.methods.size() < 2) return;
  section.blocks.emplace_back(
      Subheading{section.id + "-of-" + method_slug(report, method), report.methods[method].method});
}

Table method_table(const StudyReport& report, std::size_t method, const std::string& id,
                   const std::string& caption, std::vector<Column> columns) {
  return {id + "-" + method_slug(report, method), method_prefix(report, method) + caption,
          std::move(columns)};
}

std::vector<Cell> pooled_and_mean_row(const std::string& name, const Proportion& pooled,
                                      const MeanEstimate& mean) {
  return {name,
          std::to_string(pooled.n),
          std::to_string(pooled.correct),
          share_figure(pooled.share()),
          std::to_string(mean.participants),
          share_figure(mean.mean),
          share_range(mean.known_interval())};
}

std::string method_prefix(const StudyReport& report, std::size_t method) {
  return report.methods.size() > 1 ? report.methods[method].method + ": " : "";
}

Document study_document(const StudyReport& report, const Provenance& provenance,
                        const Pictures& pictures) {
  Document document = framed_document(
      report, {"result", "Result", {}},
      {accuracy_section(report), confusions_section(report), places_section(report),
       comparison_section(report), visits_section(report), order_section(report),
       confidence_section(report), times_section(report), cues_section(report, explores(pictures)),
       robustness_section(report), methods_section(report)},
      provenance, pictures);
  if (report.methods.size() < 2) capitalise_captions(document);
  return document;
}

void add_headline(const StudyReport& report, Section& section) {
  const bool differs =
      report.primary && report.primary->registered().participants != report.participants;
  if (differs) {
    section.blocks.emplace_back(Cited{fmt::format(
        "From here on the numbers are of the {} who are left after all exclusions; the "
        "result above is about {}.",
        counted(report.participants, "participant"), report.primary->registered().participants)});
  }
  for (const MethodReport& method : report.methods) {
    section.blocks.emplace_back(
        Cited{headline_of(report, method), {Source::student, Source::phipson_smyth}});
  }
  section.blocks.emplace_back(headline_table(report));
  section.blocks.emplace_back(ability_table(report));
}

}  // namespace touchtrial::analysis::identification
