#include "analysis/report/page/wording.hpp"
#include "protocols/identification/analysis/measures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

Table pair_table(const StudyReport& report) {
  Table table = table_of("methods", "Methods compared within participants", report.pairs,
                         pair_measures(report));
  const auto is_primary = [&](const MethodPair& pair) {
    return pair.overall.p == report.primary->p;
  };
  if (report.primary && std::ranges::none_of(report.pairs, is_primary)) {
    table.notes.push_back({"The primary test is a different one; see \"Result\"."});
  }
  return table;
}

Table class_table(const StudyReport& report, const MethodPair& pair, std::size_t index) {
  std::vector<std::size_t> classes(pair.classes.size());
  std::iota(classes.begin(), classes.end(), 0U);
  return table_of("methods-by-class-" + std::to_string(index + 1),
                  report.methods[pair.first].method + " and " + report.methods[pair.second].method +
                      ", by texture",
                  classes, class_measures(report, pair));
}

CitedText overall_sentence(const AllMethodsTest& test) {
  std::string text = fmt::format(
      "All methods together: Cochran's Q = {} on {} degrees of freedom, {} under chi-square, which "
      "treats trials as independent",
      plain_figure(test.cochran.q, 2), test.cochran.degrees_of_freedom, p_phrase(test.cochran.p));
  if (test.permuted_p) {
    text +=
        fmt::format("; {} with methods permuted within participants", p_phrase(*test.permuted_p));
  }
  return {text + ".", {Source::cochran, Source::phipson_smyth}};
}

}  // namespace

Section comparison_section(const StudyReport& report) {
  Section section{"methods-compared", "Comparison of methods", {}};
  if (report.pairs.empty()) return section;
  if (report.all_methods) section.blocks.emplace_back(overall_sentence(*report.all_methods));
  section.blocks.emplace_back(pair_table(report));
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    if (report.pairs[i].classes.empty()) continue;
    (i == 0 ? section.blocks : section.folded_blocks)
        .emplace_back(class_table(report, report.pairs[i], i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
