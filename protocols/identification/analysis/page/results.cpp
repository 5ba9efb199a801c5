#include "analysis/page/frame_sections.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"
#include "core/named.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

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

/// What a reader of the interval might miss.
const char* remark_on(const Interval& interval) {
  if (interval == Interval{0.0, 1.0}) return ", which is every possible value";
  return interval.low < interval.high ? "" : ", which has no width because they do not differ";
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
             "({}, {}; 95% t interval {}{}{}{}). Chance is {}.",
             method.method, share_figure(method.mean.mean), who, counted(method.overall.n, "trial"),
             share_range(method.mean.interval), remark_on(method.mean.interval), bootstrap,
             spread_phrase(method), share_figure(chance_share(report))) +
         chance_phrase(method) + prevalence_phrase(method);
}

std::vector<Cell> headline_row(const MethodReport& method) {
  const MeanEstimate& mean = method.mean;
  const bool interval = mean.participants > 1;
  return {method.method,
          std::to_string(mean.participants),
          std::to_string(method.overall.n),
          Cell(share_figure(mean.mean), true),
          interval ? share_range(mean.interval) : kNoFigure,
          share_range(method.bootstrap),
          spread_figure(method.spread)};
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
               {"SD between (points)"}}};
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
  Table table{"ability",
              "Whether at least one participant can, and how many would show it",
              {{"method", Align::left},
               {"right"},
               {"by chance"},
               {"p, at least one"},
               {"passed alone"},
               {"by chance alone"},
               {"would pass"},
               {"95% (%)"}}};
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

}  // namespace

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

namespace {

struct KindWords {
  const char* id;
  const char* caption;
  const char* column;
};

KindWords words_of(BreakdownKind kind) {
  switch (kind) {
    case BreakdownKind::exemplar:
      return {"exemplar", "by exemplar: which picture of a texture", "exemplar"};
    case BreakdownKind::trial:
      break;
    case BreakdownKind::order_group:
      return {"order-group", "by order group: in which order methods came", "order group"};
    case BreakdownKind::visit:
      return {"visit", "by visit", "visit"};
    case BreakdownKind::group:
      return {"group", "by group", "group"};
  }
  return {"", "", ""};
}

bool is_about_people(BreakdownKind kind) {
  return kind == BreakdownKind::visit || kind == BreakdownKind::group;
}

/// Over participants: what visits and groups differ in is about people.
Table people_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const KindWords words = words_of(breakdown.kind);
  Table table{std::string("accuracy-by-") + words.id + "-" + method_slug(report, index),
              method_prefix(report, index) + "right answers " + words.caption,
              {{words.column, Align::left},
               {"participants"},
               {"n"},
               {"right"},
               {"mean (%)"},
               {"t 95% (%)"}}};
  for (const GroupAccuracy& group : breakdown.groups) {
    const MeanEstimate mean = group.mean.value_or(MeanEstimate{});
    const auto interval = mean.known_interval();
    table.rows.push_back({group.group, std::to_string(mean.participants),
                          std::to_string(group.accuracy.n), std::to_string(group.accuracy.correct),
                          share_figure(mean.mean), interval ? share_range(*interval) : kNoFigure});
  }
  table.notes = {
      {"Mean of participants' own accuracies with Student's t interval: to look at. The registered "
       "test decides, over the visits that were registered and all groups.",
       {Source::student}}};
  return table;
}

Table breakdown_table(const StudyReport& report, std::size_t index, const Breakdown& breakdown) {
  const KindWords words = words_of(breakdown.kind);
  Table table{std::string("accuracy-by-") + words.id + "-" + method_slug(report, index),
              method_prefix(report, index) + "right answers " + words.caption,
              {{words.column, Align::left}, {"n"}, {"right"}, {"accuracy"}, {"Wilson 95% (%)"}}};
  for (const GroupAccuracy& group : breakdown.groups) {
    table.rows.push_back({group.group, std::to_string(group.accuracy.n),
                          std::to_string(group.accuracy.correct),
                          share_figure(group.accuracy.share()), share_range(group.wilson)});
  }
  table.notes = {
      {"All participants' trials pooled as if independent: to look at, not to test "
       "with. Of many such rows some stand out by chance.",
       {Source::wilson}}};
  return table;
}

}  // namespace

namespace {

std::vector<Cell> dependence_row(const char* what, const SerialDependence& found) {
  return {what, fmt::format("{} of {}", found.same, found.wrong), kNoFigure,
          plain_figure(found.expected, 1), p_figure(found.p)};
}

/// A slope in percentage points per ten trials.
std::string slope_figure(std::optional<double> slope) {
  return slope ? points_figure(10.0 * *slope) : kNoFigure;
}

Table order_table(const StudyReport& report, std::size_t index, const OrderEffects& order) {
  Table table{"order-" + method_slug(report, index),
              method_prefix(report, index) +
                  "whether answers depend on when a texture came, and on what came just before",
              {{"question", Align::left}, {"found"}, {"t 95%"}, {"at random"}, {"p"}}};
  const auto interval = order.slope.known_interval();
  table.rows = {
      {"learning: change of accuracy over ten trials (points)", slope_figure(order.slope.mean),
       interval ? share_range(Interval{10.0 * interval->low, 10.0 * interval->high}) : kNoFigure,
       "0.0", p_figure(order.slope_p)},
      dependence_row("wrong answers that name the texture presented before", order.class_before),
      dependence_row("wrong answers that repeat the answer before", order.answer_before)};
  table.notes = {
      {fmt::format("p two-sided, of {} orders that the design could have produced, in which each "
                   "answer stays with its presentation. More than at random: drawn to what came "
                   "before; less: driven from it. Three tests, not adjusted for each other.",
                   order.draws),
       {Source::phipson_smyth, Source::fischer_whitney}},
      {"Learning: least squares within blocks, mean of participants' own slopes with Student's t "
       "interval.",
       {Source::student}}};
  return table;
}

}  // namespace

Section order_section(const StudyReport& report) {
  Section section{"order", "Order and carry-over", {}, true};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    if (method.breakdowns.empty() && !method.order) continue;
    add_method_heading(report, i, section);
    if (method.order) section.blocks.emplace_back(order_table(report, i, *method.order));
    for (const Breakdown& one : method.breakdowns) {
      // A figure shows accuracy by trial; the table above tests it.
      if (one.kind == BreakdownKind::trial || is_about_people(one.kind)) continue;
      section.blocks.emplace_back(breakdown_table(report, i, one));
    }
  }
  return section;
}

Section visits_section(const StudyReport& report) {
  Section section{"visits-and-groups", "Visits and groups", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    bool first = true;
    for (const Breakdown& one : report.methods[i].breakdowns) {
      if (!is_about_people(one.kind)) continue;
      if (first) add_method_heading(report, i, section);
      first = false;
      section.blocks.emplace_back(people_table(report, i, one));
    }
  }
  return section;
}

namespace {

std::vector<Cell> time_row(const std::string& name, const ReactionTimes& times) {
  return {name,
          std::to_string(times.from_plane_on.n),
          plain_figure(times.from_plane_on.lower, 2),
          plain_figure(times.from_plane_on.median, 2),
          plain_figure(times.from_plane_on.upper, 2),
          plain_figure(times.from_contact.lower, 2),
          plain_figure(times.from_contact.median, 2),
          plain_figure(times.from_contact.upper, 2)};
}

Table times_table(const StudyReport& report, std::size_t index) {
  Table table{"reaction-times-" + method_slug(report, index),
              method_prefix(report, index) +
                  "reaction times in seconds by the texture presented: quartiles and medians",
              {{"texture", Align::left},
               {"n"},
               {"plane on, 25%"},
               {"plane on, median"},
               {"plane on, 75%"},
               {"contact, 25%"},
               {"contact, median"},
               {"contact, 75%"}}};
  const std::vector<ReactionTimes>& times = report.methods[index].reaction;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool all = i >= report.classes.size();
    table.rows.push_back(time_row(all ? "all" : report.classes[i], times[i]));
  }
  table.notes = {
      {"Trials with a response, right or wrong. From the moment the plane can be felt, "
       "and from first contact, to the answer; one monotonic clock, the servo's. "
       "Quantiles by interpolation (definition 7).",
       {Source::hyndman_fan}}};
  if (const int paused = times.empty() ? 0 : times.back().paused; paused > 0) {
    table.notes.push_back({fmt::format("{} waited for the end of a pause and {} left out.",
                                       counted(paused, "response"), paused == 1 ? "is" : "are")});
  }
  return table;
}

}  // namespace

Section times_section(const StudyReport& report) {
  Section section{"reaction-times", "Reaction times", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].reaction.empty()) continue;
    section.blocks.emplace_back(times_table(report, i));
  }
  return section;
}

namespace {

const char* words_of(TrialSubset subset) {
  using enum TrialSubset;
  static constexpr auto kNames = std::to_array<Named<TrialSubset>>(
      {{"as counted (a missing response is wrong)", counted},
       {"trials without a response left out", answered},
       {"trials that break the validity rule left out", valid},
       {"excluded participants' sessions put back", with_excluded_sessions}});
  return name_in(kNames, subset).data();
}

Table robustness_table(const StudyReport& report, std::size_t index) {
  Table table{"with-and-without-" + method_slug(report, index),
              method_prefix(report, index) + "the mean accuracy with other choices of trials",
              {{"trials", Align::left},
               {"n"},
               {"right"},
               {"pooled"},
               {"participants"},
               {"mean"},
               {"t 95% (%)"}}};
  for (const SubsetAccuracy& one : report.methods[index].robustness) {
    table.rows.push_back({words_of(one.subset), std::to_string(one.pooled.n),
                          std::to_string(one.pooled.correct), share_figure(one.pooled.share()),
                          std::to_string(one.mean.participants), share_figure(one.mean.mean),
                          one.mean.participants > 1 ? share_range(one.mean.interval) : kNoFigure});
  }
  table.notes = {
      {"Mean over participants with Student's t interval. If a row's conclusion differs "
       "from the first's, say so beside the result.",
       {Source::student}}};
  return table;
}

}  // namespace

Section robustness_section(const StudyReport& report) {
  Section section{"servo-and-validity", "Servo and validity", {}};
  if (const auto servo = servo_table(report.collection)) {
    section.blocks.emplace_back(*servo);
  } else {
    section.blocks.emplace_back(
        Cited{"There is no table and no figure of the servo: no trial ran in real time. In "
              "virtual time every tick is on time by construction, and says nothing about a "
              "device.",
              {}});
  }
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].robustness.empty()) continue;
    section.blocks.emplace_back(robustness_table(report, i));
  }
  return section;
}

Section methods_section(const StudyReport& /*report*/) {
  Section section{"methods", "How these numbers were computed", {}, true};
  section.blocks.emplace_back(Cited{
      "Every number is computed by the program named above from the database named above; "
      "results.json, beside this page, holds the same numbers with all their digits. A note under "
      "each table says what its numbers are and where the method comes from. Intervals hold 95% "
      "nominally. Resampling draws from a random stream of fixed seed, so that the same database "
      "gives the same numbers on every machine.",
      {}});
  section.blocks.emplace_back(Definitions{
      {{"unit of analysis",
        "The participant. Trials pooled over participants are shown for information; intervals "
        "and tests that treat them as independent are marked."},
       {"missing responses",
        "Wrong in every accuracy; left out of information transfer and of the choice model. The "
        "tables with and without them show what depends on this."},
       {"right or wrong",
        "An answer is right if its picture belongs to the class that was presented, whatever the "
        "exemplar."},
       {"blinding",
        "What was presented was sealed before trial 1 and opened by a recorded event; touchtrial "
        "verify DB checks every event, the seal and the schedules against each other, and the "
        "head of the file's chain named above shows whether this report is of the same file."}}});
  return section;
}

}  // namespace touchtrial::analysis::identification
