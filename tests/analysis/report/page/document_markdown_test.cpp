#include "analysis/report/page/document.hpp"
#include "support/catch.hpp"

#include <string>

using namespace touchtrial;
using namespace touchtrial::analysis;

TEST_CASE("a document in Markdown has every block, escaped, with one list of references") {
  Document document;
  document.title = "A * B";
  document.stamp = "SIMULATED";
  document.banners = {"read this"};
  document.header = {{{"study", "s_1"}}};
  Table table{.id = "t", .caption = "numbers", .columns = {{"name", Align::left}, {"n"}}};
  table.rows = {{"a|b", {"7", true}}};
  table.notes = {{"exact", {Source::clopper_pearson}}};
  document.sections = {{"one",
                        "Section",
                        {CitedText{"as shown", {Source::student}}, Subheading{"sub", "Part"},
                         Warnings{{"take care"}}, Definitions{{{"word", "meaning"}}},
                         Flow{"f", "people", {{"12 came", {"2 left"}}}},
                         Picture{"p", "a picture", "dots", "<svg></svg>"},
                         Picture{"q", "another", "described", ""}, table}}};
  document.colophon = "the end";
  const std::string text = document_markdown(document, "images");
  for (const char* part :
       {"# A \\* B \\[SIMULATED\\]", "**read this**", "- study: s\\_1", "## Section",
        "as shown \\[1\\]", "### Part", "- take care", "- word: meaning", "- 12 came\n  - 2 left",
        "![dots](images/p.svg)\n\na picture", "Not drawn: described", "| a\\|b | **7** |",
        "exact \\[2\\]", "1. Student (1908)", "2. Clopper", "the end\n"}) {
    INFO(part);
    CHECK_THAT(text, holds_text(part));
  }
  CHECK(text.find("q.svg") == std::string::npos);
}
