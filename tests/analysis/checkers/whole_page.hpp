/// \file What every protocol's page must be.
#pragma once

#include "analysis/checkers/checkers.hpp"
#include "analysis/report/results.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

namespace touchtrial {

/// Checks a page of simulated results: figures are described in words and all shown but those for
/// papers, the page keeps its rules, and a stamp says that nobody was measured.
inline void check_whole_page(const analysis::Results& results) {
  analysis::Pictures pictures;
  for (const analysis::Figure& figure : results.figures("PILOT")) {
    CHECK(figure.alt.starts_with("PILOT. "));
    CHECK(figure.alt.size() > 40);
    CHECK_FALSE(figure.caption.empty());
    pictures.push_back({figure.id, figure.caption, figure.alt, {}, figure.section});
  }
  REQUIRE_FALSE(pictures.empty());
  const analysis::Document document = results.document({}, pictures);
  CHECK(faults_of_page(analysis::page_html(document)).empty());
  CHECK(document.stamp.find("SIMULATED") != std::string::npos);
  CHECK_THAT(analysis::document_text(document), holds_text("SIMULATED"));
  std::size_t shown = 0;
  for (const analysis::Section& section : document.sections) {
    shown += static_cast<std::size_t>(
        std::ranges::count_if(all_blocks(section), [](const analysis::Block* block) {
          return std::holds_alternative<analysis::Picture>(*block);
        }));
  }
  // The participants' flow is for papers.
  CHECK(std::cmp_equal(shown, std::ranges::count_if(pictures, [](const analysis::Picture& one) {
                         return !one.section.empty();
                       })));
}

}  // namespace touchtrial
