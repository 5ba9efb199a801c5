#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

constexpr const char* kAlike = " *";     ///< refers to a note below the table
constexpr const char* kOfTrials = " †";  ///< refers to a note below the table

std::string pair_name(const StudyReport& report, const MethodPair& pair) {
  return report.methods[pair.first].method + " less " + report.methods[pair.second].method;
}

/// The ratio with its interval over participants, or else that of independent trials, with a mark.
std::string odds_figure(const std::optional<OddsRatio>& odds) {
  if (!odds) return kNoFigure;
  return plain_figure(odds->estimate, 2) + " " +
         (odds->bootstrap ? plain_range(odds->bootstrap, 2)
                          : plain_range(odds->interval, 2) + kOfTrials);
}

/// Whether all participants' differences are equal, which does not mean that they are certain.
bool are_alike(const MethodComparison& paired) {
  return paired.participants > 1 && !paired.known_interval();
}

/// The t interval, with a mark where there is none because all differences are equal.
std::string t_range(const MethodComparison& comparison) {
  return share_range(comparison.known_interval()) + (are_alike(comparison) ? kAlike : "");
}

Cited note_on_alike() {
  return {
      "* Every participant has the same difference, so that there is no t interval: nothing shows "
      "how certain the number is."};
}

std::string sentence_of(const StudyReport& report, const MethodPair& pair) {
  const MethodComparison& overall = pair.overall;
  const std::string& first = report.methods[pair.first].method;
  const std::string& second = report.methods[pair.second].method;
  if (!overall.difference) {
    return fmt::format("{} and {}: no participant felt both.", first, second);
  }
  std::string text = fmt::format(
      "{} less {}: {} percentage points (mean of {}; 95% t interval {}; sign-flip {}", first,
      second, points_figure(overall.difference), counted(overall.participants, "participant"),
      t_range(overall), p_phrase(overall.p.value_or(1.0)));
  if (pair.p_holm) text += ", " + p_phrase(*pair.p_holm) + " after Holm";
  text += ")";
  if (overall.db) {
    text +=
        fmt::format(". As a ratio of the two means that is {} dB (10 log10, the decibel of power)",
                    signed_plain_figure(overall.db, 2));
  }
  if (pair.odds_ratio) text += "; odds ratio " + odds_figure(pair.odds_ratio);
  return text + ".";
}

Table pair_table(const StudyReport& report) {
  const bool mcnemar = std::any_of(report.pairs.begin(), report.pairs.end(),
                                   [](const MethodPair& pair) { return pair.mcnemar_mid_p; });
  const bool holm = std::any_of(report.pairs.begin(), report.pairs.end(),
                                [](const MethodPair& pair) { return pair.p_holm; });
  Table table{"methods", "Methods compared within participants",
              columns_of({"difference", "participants", "points", "t 95%", "bootstrap 95%",
                          "sign-flip p"})};
  if (holm) table.columns.push_back({"p, Holm"});
  if (mcnemar) table.columns.push_back({"McNemar mid-p"});
  table.columns.push_back({"odds ratio, 95%"});
  table.columns.push_back({"dB (10 log10)"});
  for (const MethodPair& pair : report.pairs) {
    const MethodComparison& overall = pair.overall;
    std::vector<Cell> row{pair_name(report, pair),
                          std::to_string(overall.participants),
                          Cell(points_figure(overall.difference), true),
                          t_range(overall),
                          share_range(overall.bootstrap),
                          p_figure(overall.p)};
    if (holm) row.emplace_back(p_figure(pair.p_holm));
    if (mcnemar) row.emplace_back(p_figure(pair.mcnemar_mid_p));
    row.emplace_back(odds_figure(pair.odds_ratio));
    row.emplace_back(signed_plain_figure(overall.db, 2));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      {"Mean of participants' differences, with Student's t interval.", {Source::student}},
      {"Bootstrap: expanded percentiles over draws of whole participants.",
       {Source::davison_hinkley, Source::hesterberg}},
      {"Sign-flip permutation over participants, two-sided.", {Source::phipson_smyth}},
      {"Odds ratio: common to participants, each a stratum; interval by the same bootstrap.",
       {Source::mantel_haenszel}},
      {"dB: 10 log10 of the ratio of the two means; 20 log10 would be twice that."}};
  const auto decides = [&](const MethodPair& pair) { return pair.overall.p == report.primary->p; };
  if (report.primary && std::ranges::none_of(report.pairs, decides)) {
    table.notes.push_back({"The deciding test is another one; it stands under \"Result\"."});
  }
  const auto of_trials = [](const MethodPair& pair) {
    return pair.odds_ratio && !pair.odds_ratio->bootstrap;
  };
  if (std::any_of(report.pairs.begin(), report.pairs.end(), of_trials)) {
    table.notes.push_back(
        {"† Robins, Breslow and Greenland's interval, which treats trials as independent and is "
         "too narrow: there are fewer than six participants, or too few who err, for the "
         "bootstrap.",
         {Source::robins_breslow_greenland}});
  }
  const auto has_none = [](const MethodPair& pair) { return are_alike(pair.overall); };
  if (std::ranges::any_of(report.pairs, has_none)) table.notes.push_back(note_on_alike());
  if (holm) {
    table.notes.push_back({"Holm: adjusted over all pairs of methods.", {Source::holm}});
  }
  if (mcnemar) {
    table.notes.push_back(
        {"McNemar's mid-p test: each participant felt one pair.", {Source::fagerland}});
  }
  return table;
}

std::vector<Cell> class_row(const std::string& label, const ClassComparison& one, bool mcnemar) {
  const auto difference = one.first.share() && one.second.share()
                              ? std::optional(*one.first.share() - *one.second.share())
                              : std::nullopt;
  const auto db = difference ? decibels(*one.first.share(), *one.second.share()) : std::nullopt;
  std::vector<Cell> row{label,
                        fmt::format("{}/{}", one.first.correct, one.first.n),
                        share_figure(one.first.share()),
                        fmt::format("{}/{}", one.second.correct, one.second.n),
                        share_figure(one.second.share()),
                        points_figure(difference),
                        t_range(one.paired),
                        p_figure(one.paired.p)};
  if (mcnemar) row.emplace_back(p_figure(one.mcnemar_mid_p));
  row.emplace_back(signed_plain_figure(db, 2));
  return row;
}

Table class_table(const StudyReport& report, const MethodPair& pair, std::size_t index) {
  const std::string& first = report.methods[pair.first].method;
  const std::string& second = report.methods[pair.second].method;
  const bool mcnemar =
      std::any_of(pair.classes.begin(), pair.classes.end(),
                  [](const ClassComparison& one) { return one.mcnemar_mid_p.has_value(); });
  Table table{"methods-by-class-" + std::to_string(index + 1),
              first + " beside " + second + ", by texture",
              columns_of({"texture", first + ", right", first, second + ", right", second, "points",
                          "t 95%", "sign-flip p"})};
  if (mcnemar) table.columns.push_back({"McNemar mid-p"});
  table.columns.push_back({"dB (10 log10)"});
  for (std::size_t i = 0; i < pair.classes.size(); ++i) {
    table.rows.push_back(class_row(report.classes[i], pair.classes[i], mcnemar));
  }
  table.notes = {
      {"Counts pool all participants; interval and p are of participants' own "
       "differences, two-sided and not adjusted for the number of textures: to look "
       "at, not to test with.",
       {Source::student, Source::phipson_smyth}}};
  if (std::any_of(pair.classes.begin(), pair.classes.end(),
                  [](const ClassComparison& one) { return are_alike(one.paired); })) {
    table.notes.push_back(note_on_alike());
  }
  return table;
}

Cited together_of(const MethodsTogether& together) {
  std::string text = fmt::format(
      "All methods at once: Cochran's Q = {} on {} degrees of freedom, {} under chi-square, which "
      "takes occasions as independent",
      plain_figure(together.cochran.q, 2), together.cochran.degrees_of_freedom,
      p_phrase(together.cochran.p));
  if (together.permuted_p) {
    text += fmt::format("; {} when methods are exchanged within whole participants",
                        p_phrase(*together.permuted_p));
  }
  return {text + ".", {Source::cochran, Source::phipson_smyth}};
}

/// The limits of the design, whatever the numbers are.
Cited limits_of(const StudyReport& report) {
  int fewest = report.participants;
  for (const MethodPair& pair : report.pairs) fewest = std::min(fewest, pair.overall.participants);
  const double floor = std::min(1.0, std::ldexp(2.0, -fewest));
  std::string text = fmt::format(
      "What this design cannot show: it holds {} textures, and the same ones for everybody, so "
      "that a difference may belong to these textures and does not generalise to others, however "
      "small its p. ",
      report.classes.size());
  if (fewest < 1) return {text};
  text += fmt::format("With {} the two-sided sign-flip p cannot fall below {}{}.",
                      counted(fewest, "participant"),
                      floor < 0.001 ? fmt::format("{:.1e}", floor) : fmt::format("{:.3g}", floor),
                      floor > kUsualLevel ? ", and so never below 0.05" : "");
  return {text +
              " Absence of a difference is not shown by a p that is not small; the interval says "
              "which differences remain possible.",
          {Source::phipson_smyth}};
}

}  // namespace

Section comparison_section(const StudyReport& report) {
  Section section{"methods-compared", "Comparison of methods", {}};
  if (report.pairs.empty()) return section;
  for (const MethodPair& pair : report.pairs) {
    section.blocks.emplace_back(Cited{sentence_of(report, pair), {}});
  }
  if (report.together) section.blocks.emplace_back(together_of(*report.together));
  section.blocks.emplace_back(pair_table(report));
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    if (report.pairs[i].classes.empty()) continue;
    section.blocks.emplace_back(class_table(report, report.pairs[i], i));
  }
  section.blocks.emplace_back(limits_of(report));
  return section;
}

}  // namespace touchtrial::analysis::identification
