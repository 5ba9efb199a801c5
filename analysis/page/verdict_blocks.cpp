#include "analysis/page/frame_sections.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

bool is_difference(const PrimaryResult& primary) {
  return primary.estimand == design::Estimand::difference;
}

/// A value of the estimand: "77.0%", or "+3.2 points".
std::string estimand_figure(const PrimaryResult& primary, std::optional<double> value) {
  if (!value) return kNoFigure;
  return is_difference(primary) ? points_figure(value) + " points" : share_figure(value);
}

std::string level_of(double alpha) {
  return fmt::format("{:.4g}%", 100.0 * (1.0 - alpha));
}

std::string first_letter_raised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

/// "11 participants analysed; 20 planned, 14 completed"
std::string people_of(const PrimaryResult& primary, const StudyCourse& course) {
  const std::string planned = course.planned > 0 ? std::to_string(course.planned) : "no number";
  return fmt::format("{} analysed; {} planned, {} completed",
                     counted(primary.registered().participants, "participant"), planned,
                     course.completed);
}

Cited verdict_sentence(const PrimaryResult& primary) {
  return {fmt::format("{}. {}", first_letter_raised(name_of(primary.verdict)), primary.because)};
}

Cited estimate_sentence(const StudyHead& head) {
  const PrimaryResult& primary = *head.primary;
  const PrimaryChoice& choice = primary.registered();
  std::string text = fmt::format("{}: {}", first_letter_raised(primary.words),
                                 estimand_figure(primary, choice.estimate));
  if (choice.interval) {
    text +=
        fmt::format(", {} t interval {}", level_of(primary.alpha), share_range(choice.interval));
  }
  text += " (" + people_of(primary, head.course) + ")";
  text += ". " + first_letter_raised(primary.test);
  if (primary.p) text += ": " + p_phrase(*primary.p);
  text += fmt::format(", alpha {:.3g}", primary.alpha);
  if (primary.level != primary.alpha) {
    text += fmt::format(", nominal level at this look {:.3g}", primary.level);
  }
  if (primary.bound) {
    text += fmt::format(", lower {} limit {}", level_of(primary.alpha),
                        estimand_figure(primary, primary.bound));
  }
  return {text + ".", {Source::student}};
}

Table choices_table(const StudyHead& head) {
  const PrimaryResult& primary = *head.primary;
  Table table{"primary",
              "The deciding question under every choice of sessions and trials",
              {{"choice", Align::left},
               {"participants"},
               {"trials"},
               {is_difference(primary) ? "difference (points)" : "mean"},
               {"t " + level_of(primary.alpha) + (is_difference(primary) ? " (points)" : " (%)")},
               {"p"}}};
  for (const PrimaryChoice& choice : primary.choices) {
    const bool first = &choice == &primary.choices.front();
    const std::string estimate =
        is_difference(primary) ? points_figure(choice.estimate) : share_figure(choice.estimate);
    table.rows.push_back({choice.words, std::to_string(choice.participants),
                          std::to_string(choice.trials), Cell(estimate, first),
                          share_range(choice.interval), first ? p_figure(primary.p) : kNoFigure});
  }
  table.notes = {
      {"p belongs to the first row alone; the others show what a choice changes. Each "
       "participant weighs the same, however many trials it has."}};
  if (head.course.excluded_afterwards > 0) {
    table.notes.push_back({counted(head.course.excluded_afterwards, "session") +
                           " excluded after outcomes were seen."});
  }
  if (!is_difference(primary)) {
    table.notes.push_back(
        {"A mean above chance says that some people can, not that everybody can."});
  }
  return table;
}

}  // namespace

std::vector<Block> verdict_blocks(const StudyHead& head) {
  std::vector<Block> blocks;
  if (head.primary) {
    blocks.emplace_back(verdict_sentence(*head.primary));
    blocks.emplace_back(estimate_sentence(head));
  }
  if (!head.departures.empty()) {
    blocks.emplace_back(Cited{head.registration.analysis ? "Departures from what was registered:"
                                                         : "Departures from the plan:"});
    blocks.emplace_back(Warnings{head.departures});
  } else if (head.registration.analysis) {
    blocks.emplace_back(Cited{"No departure from what was registered is recorded."});
  }
  if (head.primary) blocks.emplace_back(choices_table(head));
  return blocks;
}

namespace {

/// Whether a column's title announces p values: "p", "sign-flip p", "p, Holm", "McNemar mid-p".
bool is_of_p(const Column& column) {
  const std::string_view title = column.title;
  return title == "p" || title.starts_with("p, ") || title.ends_with(" p") || title.ends_with("-p");
}

bool tells_p(const std::string& text) {
  return text.find("p = ") != std::string::npos || text.find("p < ") != std::string::npos;
}

}  // namespace

void say_unadjusted(const std::vector<Look>& looks, std::vector<Section>& sections) {
  const std::string words = unadjusted_words(looks);
  if (words.empty()) return;
  for (Section& section : sections) {
    for (Block& block : section.blocks) {
      if (auto* table = std::get_if<Table>(&block)) {
        const bool has_p = std::ranges::any_of(table->columns, is_of_p) ||
                           std::ranges::any_of(table->notes, tells_p, &Cited::text);
        if (has_p) table->notes.push_back({words});
      } else if (auto* sentence = std::get_if<Cited>(&block)) {
        if (tells_p(sentence->text)) sentence->text += " The " + words;
      }
    }
  }
}

}  // namespace touchtrial::analysis
