#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// Capitalises the captions of tables. With several methods a caption begins with a method's name,
/// which must stay as it is.
void capitalise_captions(Document& document) {
  for (Section& section : document.sections) {
    for (auto* blocks : {&section.blocks, &section.more}) {
      for (Block& block : *blocks) {
        auto* table = std::get_if<Table>(&block);
        if (table == nullptr || table->caption.empty()) continue;
        char& first = table->caption.front();
        if (first >= 'a' && first <= 'z') first = static_cast<char>(first - 'a' + 'A');
      }
    }
  }
}

bool explores(const Pictures& pictures) {
  return std::ranges::find(pictures, kExplorations, &Picture::section) != pictures.end();
}

/// Whether an earlier method has the same slug.
bool is_taken(const StudyReport& report, std::size_t method, const std::string& slug) {
  for (std::size_t i = 0; i < method; ++i) {
    if (slug_of(report.methods[i].method) == slug) return true;
  }
  return false;
}

/// What a study without a question that decides found, for readers to quote.
std::string mean_sentence(const StudyReport& report, const MethodReport& method) {
  if (!method.mean.mean) return method.method + ": no participant's trials count yet.";
  const std::optional<Interval> interval = method.mean.known_interval();
  return fmt::format(
      "{}: participants were right in {} of their trials on average{}; chance is {}.",
      method.method, share_figure(method.mean.mean),
      interval ? ", 95% t interval " + share_range(interval) : "",
      share_figure(1.0 / static_cast<double>(report.classes.size())));
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

TableName method_table_name(const StudyReport& report, std::size_t method, const std::string& id,
                            const std::string& caption) {
  return {id + "-" + method_slug(report, method), method_prefix(report, method) + caption};
}

Section result_section(const StudyReport& report) {
  Section section{"result", "Result", {}};
  const bool differs =
      report.primary && report.primary->registered().participants != report.participants;
  if (differs) {
    section.blocks.emplace_back(Cited{fmt::format(
        "From here on the numbers are of the {} who are left after all exclusions; the "
        "result above is about {}.",
        counted(report.participants, "participant"), report.primary->registered().participants)});
  }
  if (report.primary) return section;
  for (const MethodReport& method : report.methods) {
    section.blocks.emplace_back(Cited{mean_sentence(report, method), {Source::student}});
  }
  return section;
}

std::string method_prefix(const StudyReport& report, std::size_t method) {
  return report.methods.size() > 1 ? report.methods[method].method + ": " : "";
}

Document study_document(const StudyReport& report, const Provenance& provenance,
                        const Pictures& pictures) {
  const auto drawn = [&](std::string_view id) {
    return std::ranges::any_of(
        pictures, [&](const Picture& one) { return one.id.starts_with(id) && !one.svg.empty(); });
  };
  Document document = framed_document(
      report, result_section(report),
      {comparison_section(report), accuracy_section(report),
       confusions_section(report, drawn("confusion")), visits_section(report),
       confidence_section(report), places_section(report), order_section(report),
       times_section(report), cues_section(report, explores(pictures)), robustness_section(report)},
      provenance, pictures);
  if (report.methods.size() < 2) capitalise_captions(document);
  return document;
}

}  // namespace touchtrial::analysis::identification
