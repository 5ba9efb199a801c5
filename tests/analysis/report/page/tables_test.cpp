// A report's tables for papers: no part of a label may act as mark-up.
#include "analysis/report/escaping.hpp"
#include "analysis/report/page/document.hpp"
#include "protocols/identification/analysis/hand_made_report.hpp"
#include "support/catch.hpp"

#include <algorithm>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::analysis::identification;

namespace {

Table small_table(const std::string& label) {
  Table table{"small", "What was answered", {{"texture", Align::left}, {"n"}}};
  table.rows = {{label, "3"}, {"cloth", Cell("4", true)}};
  table.notes = {{"Wilson's.", {Source::wilson}}};
  return table;
}

}  // namespace

TEST_CASE("tables: Markdown has one line per row, with emphasis and a numbered reference") {
  const std::string text = table_markdown(small_table("bark"), "");
  CHECK_THAT(text, holds_text("**What was answered**\n\n| texture | n |\n| :--- | ---: |\n"
                              "| bark | 3 |\n| cloth | **4** |\n\nWilson's. \\[1\\]\n\n1. "
                              "Wilson EB (1927)."));
}

TEST_CASE("tables: Markdown shows a hostile label as it is") {
  const std::string text = table_markdown(small_table("a|b <i>*x*</i>\nc [d](e) `f`"), "");
  CHECK_THAT(text, holds_text("| a\\|b \\<i\\>\\*x\\*\\</i\\> c \\[d\\](e) \\`f\\` | 3 |\n"));
}

TEST_CASE("tables: LaTeX is a booktabs float with a stamp, a label and notes") {
  const std::string text = table_latex(small_table("bark"), "SIMULATED");
  CHECK_THAT(text, holds_text("\\caption{What was answered {[}SIMULATED{]}}\n\\label{tab:small}"));
  CHECK_THAT(text, holds_text("\\toprule\ntexture & n \\\\\n\\midrule\nbark & 3 \\\\\n"
                              "cloth & \\textbf{4} \\\\\n\\bottomrule"));
  CHECK_THAT(text, holds_text("% [1] Wilson EB (1927)."));
}

TEST_CASE("tables: LaTeX prints would-be commands as text, and the codes of signs that it lacks") {
  CHECK(latex_escaped("50% & a_b #1 $x$ {y}") == "50\\% \\& a\\_b \\#1 \\$x\\$ \\{y\\}");
  CHECK(latex_escaped("\\input{x}") == "\\textbackslash{}input\\{x\\}");
  CHECK(latex_escaped("−1 – é") == "$-$1 -- é");
  CHECK(latex_escaped("木") == "{[}U+6728{]}");
  CHECK(latex_escaped("a\nb\xff") == "a b{[}U+FFFD{]}");
}

TEST_CASE("tables: a LaTeX table alone prints its references, all together print them once") {
  CHECK_THAT(table_latex(small_table("bark"), ""),
             holds_text(". {[}1{]}\n\\par\\noindent {[}1{]} Wilson EB (1927)."));
  const Document document = study_document(hand_made_report(), hand_made_provenance());
  const std::string latex = tables_latex(document);
  const std::size_t at = latex.find("Student (1908).");
  REQUIRE(at != std::string::npos);
  CHECK(latex.find("Student (1908).", at + 1) == std::string::npos);
}

TEST_CASE("tables: all together hold the report's warnings") {
  const Document document = study_document(hand_made_report(), hand_made_provenance());
  CHECK_THAT(document_markdown(tables_only(document), ""),
             holds_text("- Intervals of a class pool all trials.\n"));
  CHECK_THAT(tables_latex(document), holds_text("\\item Intervals of a class pool all trials.\n"));
}

TEST_CASE("tables: Markdown typesets no formula from a label") {
  CHECK_THAT(table_markdown(small_table("$x^2$"), ""), holds_text("| \\$x\\^2\\$ | 3 |"));
}

TEST_CASE("tables: a long table may break across pages") {
  Table table = small_table("bark");
  table.rows.insert(table.rows.end(), 50, {"again", "1"});
  CHECK_THAT(table_latex(table, ""), holds_text("\\begin{longtable}{@{}lr@{}}"));
}

TEST_CASE("tables: all together hold every table, once") {
  const Document document = study_document(hand_made_report(kHostile), hand_made_provenance());
  const std::string latex = tables_latex(document);
  const std::string markdown = document_markdown(tables_only(document), "");
  for (const Table* table : tables_of(document)) {
    const std::string label = "\\label{tab:" + table->id + "}";
    const std::size_t at = latex.find(label);
    INFO(table->id);
    REQUIRE(at != std::string::npos);
    CHECK(latex.find(label, at + 1) == std::string::npos);
  }
  CHECK(markdown.find("<script>") == std::string::npos);
  const auto tables = tables_of(document).size();
  CHECK(static_cast<std::size_t>(std::count(markdown.begin(), markdown.end(), '\n')) > 8 * tables);
}
