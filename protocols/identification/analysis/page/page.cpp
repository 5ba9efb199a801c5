#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// Only for reports with one method; other captions begin with the name of a method, which must not
/// change.
void capitalise_captions(Document& document) {
  for (Section& section : document.sections) {
    for (auto* blocks : {&section.blocks, &section.folded_blocks}) {
      for (Block& block : *blocks) {
        auto* table = std::get_if<Table>(&block);
        if (table == nullptr || table->caption.empty()) continue;
        char& letter = table->caption.front();
        if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
      }
    }
  }
}

bool has_explorations(const Pictures& pictures) {
  return std::ranges::find(pictures, kExplorations, &Picture::section) != pictures.end();
}

/// Whether an earlier method has this slug.
bool is_slug_used(const StudyReport& report, std::size_t method, const std::string& slug) {
  for (std::size_t i = 0; i < method; ++i) {
    if (slug_of(report.methods[i].method) == slug) return true;
  }
  return false;
}

/// The result of a study without a primary question.
std::string mean_sentence(const StudyReport& report, const MethodReport& method) {
  if (!method.mean.mean) return method.method + ": no trials count yet.";
  const std::optional<Interval> interval = method.mean.known_interval();
  return fmt::format(
      "{}: participants were right in {} of their trials on average{}; chance is {}.",
      method.method, share_figure(method.mean.mean),
      interval ? ", 95% t interval " + share_range(interval) : "",
      share_figure(1.0 / static_cast<double>(report.classes.size())));
}

/// The suffix of the ids of a method's tables; unique in the report.
std::string method_slug(const StudyReport& report, std::size_t method) {
  const std::string slug = slug_of(report.methods[method].method);
  if (!slug.empty() && !is_slug_used(report, method, slug)) return slug;
  // No slug contains two hyphens in a row.
  return slug + "--" + std::to_string(method + 1);
}

}  // namespace

void add_method_heading(const StudyReport& report, std::size_t method, Section& section) {
  if (report.methods.size() < 2) return;
  section.blocks.emplace_back(
      Subheading{section.id + "-of-" + method_slug(report, method), report.methods[method].method});
}

TableName method_table_name(const StudyReport& report, std::size_t method, const std::string& id,
                            const std::string& caption) {
  return {id + "-" + method_slug(report, method), method_prefix(report, method) + caption};
}

Section result_section(const StudyReport& report) {
  Section section{"result", "Result", {}};
  const bool has_other_people =
      report.primary && report.primary->registered().participants != report.participants;
  if (has_other_people) {
    section.blocks.emplace_back(CitedText{fmt::format(
        "The following numbers are of the {} who remain after all exclusions; the result above is "
        "of {}.",
        counted(report.participants, "participant"), report.primary->registered().participants)});
  }
  if (report.primary) return section;
  for (const MethodReport& method : report.methods) {
    section.blocks.emplace_back(CitedText{mean_sentence(report, method), {Source::student}});
  }
  return section;
}

std::string method_prefix(const StudyReport& report, std::size_t method) {
  return report.methods.size() > 1 ? report.methods[method].method + ": " : "";
}

Document study_document(const StudyReport& report, const Provenance& provenance,
                        const Pictures& pictures) {
  const auto is_drawn = [&](std::string_view id) {
    return std::ranges::any_of(pictures, [&](const Picture& picture) {
      return picture.id.starts_with(id) && !picture.svg.empty();
    });
  };
  Document document =
      framed_document(report, result_section(report),
                      {comparison_section(report), accuracy_section(report),
                       confusions_section(report, is_drawn("confusion")), visits_section(report),
                       confidence_section(report), places_section(report), order_section(report),
                       times_section(report), cues_section(report, has_explorations(pictures)),
                       robustness_section(report)},
                      provenance, pictures);
  if (report.methods.size() < 2) capitalise_captions(document);
  return document;
}

}  // namespace touchtrial::analysis::identification
