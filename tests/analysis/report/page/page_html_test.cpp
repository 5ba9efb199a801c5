// The page of a report: complete, harmless, and readable by a screen reader.
#include "analysis/checkers/checkers.hpp"
#include "analysis/report/page/document.hpp"
#include "protocols/identification/analysis/hand_made_report.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::analysis::identification;

namespace {

std::string page_of(const StudyReport& report, const Pictures& pictures = {}) {
  return page_html(study_document(report, hand_made_provenance(), pictures));
}

std::string with_body(const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\"><body><h1>x</h1>" + body + "</body></html>\n";
}

}  // namespace

TEST_CASE("page: the checker finds the faults that it looks for") {
  CHECK(faults_of_page(with_body("<p>fine</p>")).empty());
  const auto fault = [](const std::string& body) {
    const std::vector<std::string> faults = faults_of_page(with_body(body));
    return faults.empty() ? std::string() : faults.front();
  };
  CHECK(fault("<p>") == "</body> closes p");
  CHECK(fault("<b id=\"a\"></b><b id=\"a\"></b>") == "twice: id a");
  CHECK(fault("<a href=\"#nowhere\">x</a>") == "leads nowhere: #nowhere");
  CHECK(fault("<a href=\"https://example.org/\">x</a>") ==
        "an address outside the page: https://example.org/");
  CHECK(fault("<script></script>") == "element script");
  CHECK(fault("<p onclick=\"x\"></p>") == "a handler: onclick");
  CHECK(fault("<h3>x</h3>") == "a heading skips a level");
  CHECK(fault("<table><tr><th scope=\"row\">x</th></tr></table>") == "a table without a caption");
  CHECK(fault("<table><caption>c</caption><tr><td>x</td></tr></table>") ==
        "a table without headers");
  CHECK(fault("<table><caption>c</caption><tr><th>x</th></tr></table>") ==
        "a header cell without a scope");
  CHECK(fault("<figure></figure>") == "a figure without a caption");
  CHECK(fault("<div role=\"img\"></div>") == "a picture without words");
  CHECK(fault("<div role=\"region\"></div>") == "out of reach by keyboard");
  CHECK(fault("a > b") == "a bare > in text");
}

TEST_CASE("page: a full report has no fault") {
  const std::vector<std::string> faults = faults_of_page(
      page_of(hand_made_report(), {hand_made_picture("accuracy-by-class", "accuracy"),
                                   hand_made_picture("confusions-adaptive", "confusions"),
                                   hand_made_picture("methods", "methods-compared"),
                                   hand_made_picture("of-no-section", "no-section")}));
  CHECK(faults == std::vector<std::string>());
}

TEST_CASE("page: no label, reason or name becomes mark-up") {
  StudyReport report = hand_made_report(kHostile);
  report.study = kHostile;
  report.methods[0].method = kHostile;
  report.registration.hypothesis = kHostile;
  const std::string page = page_of(report);
  CHECK(faults_of_page(page) == std::vector<std::string>());
  CHECK(page.find("<script") == std::string::npos);
  CHECK_THAT(page, holds_text("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; "));
}

TEST_CASE("page: no line ends within a p") {
  Document document;
  document.sections = {{"s",
                        "S",
                        {CitedText{"Test: p < 0.001, n = 20; a=b."},
                         Table{"t", "T", {{"x"}, {"p"}}, {{"row", "< 0.001"}}}}}};
  const std::string page = page_html(document);
  CHECK(faults_of_page(page) == std::vector<std::string>());
  CHECK_THAT(page, holds_text("p\u00a0&lt;\u00a00.001, n\u00a0=\u00a020; a=b."));
  CHECK_THAT(page, holds_text("<td>&lt;\u00a00.001</td>"));
}

TEST_CASE("page: an empty report is still a page") {
  StudyReport report;
  report.classes = {"bark", "cloth"};
  report.methods.resize(1);
  report.methods[0].confusion = ConfusionMatrix(2);
  CHECK(faults_of_page(page_of(report)) == std::vector<std::string>());
}

TEST_CASE("page: a simulated study says so on every table, and at both ends") {
  const Document document = study_document(hand_made_report(), hand_made_provenance());
  const std::string page = page_html(document);
  std::size_t stamps = 0;
  for (std::size_t at = page.find("[SIMULATED]"); at != std::string::npos;
       at = page.find("[SIMULATED]", at + 1)) {
    ++stamps;
  }
  CHECK(stamps >= tables_of(document).size() + 1);
  CHECK(page.rfind("SIMULATED") > page.find("<footer>"));
  StudyReport real = hand_made_report();
  real.simulated = false;
  CHECK(page_of(real).find("SIMULATED") == std::string::npos);
}

TEST_CASE("page: a picture's ids are unique, and a picture with a script is left out") {
  Picture bad = hand_made_picture("reaction-times", "reaction-times");
  bad.svg.insert(bad.svg.find("<path"), "<script>1</script>");
  const std::string page =
      page_of(hand_made_report(), {hand_made_picture("accuracy-by-class", "accuracy"),
                                   hand_made_picture("confusions-adaptive", "confusions"), bad});
  CHECK(faults_of_page(page) == std::vector<std::string>());
  CHECK_THAT(page, holds_text("id=\"figure-accuracy-by-class-t\""));
  CHECK_THAT(page, holds_text("url(#figure-confusions-adaptive-p)"));
  CHECK_THAT(
      page,
      holds_text("aria-labelledby=\"figure-confusions-adaptive-t figure-confusions-adaptive-d\""));
  CHECK_THAT(page, holds_text("Three bars: 80, 76 and 72%."));
}

TEST_CASE("page: a table of a thousand participants is folded away") {
  StudyReport report = hand_made_report();
  std::vector<ParticipantAccuracy>& all = report.methods[0].per_participant;
  all.assign(1000, all.front());
  report.methods[1].per_participant.clear();
  for (std::size_t i = 0; i < all.size(); ++i) all[i].participant = "P" + std::to_string(i);
  const std::string page = page_of(report);
  CHECK_THAT(page, holds_text(", 1000 rows</summary>"));
  CHECK(faults_of_page(page) == std::vector<std::string>());
}

TEST_CASE("page: what is folded has numbers of its own, follows, and is left out of the text") {
  const auto table = [](const std::string& id, Source source) {
    Table made{id, "Table " + id, {{"x"}, {"y"}}, {{"row", "1"}}};
    made.notes = {{"Note.", {source}}};
    return made;
  };
  Document document;
  document.sections = {
      {"all", "All", {}, false, {table("c", Source::wilson)}},
      {"part", "Part", {table("a", Source::student)}, false, {table("b", Source::wagner)}},
      {"last", "Last", {table("d", Source::holm)}}};
  const std::string page = page_html(document);
  CHECK(faults_of_page(page) == std::vector<std::string>());
  for (const char* caption : {"<b>Table 1.</b> Table a", "<b>Table S1.</b> Table b",
                              "<b>Table 2.</b> Table d", "<b>Table S2.</b> Table c"}) {
    CHECK_THAT(page, holds_text(caption));
  }
  CHECK(page.find("Table d") < page.find("Table c"));
  CHECK(references_of(document) ==
        std::vector{Source::student, Source::holm, Source::wilson, Source::wagner});
  CHECK(printed_reference_count(document) == 2);
  CHECK(tables_of(document).size() == 4);
  const std::string text = document_text(document);
  CHECK_THAT(text, holds_text("Table a") && holds_text("Table d") && !holds_text("Table b") &&
                       !holds_text("Table c"));
}

TEST_CASE("page: the report before unblinding tells nothing about outcomes") {
  QualityReport quality;
  quality.study = "hand-made";
  quality.quality.answered = 12;
  quality.collection = hand_made_report().collection;
  Provenance provenance = hand_made_provenance();
  provenance.state = {};
  const std::string page = page_html(quality_document(quality, provenance));
  CHECK(faults_of_page(page) == std::vector<std::string>());
  CHECK_THAT(page, holds_text("BLIND"));
  for (const char* word : {"accuracy", "Accuracy", "correct", "confusion", "d′", "adaptive"}) {
    INFO(word);
    CHECK(page.find(word) == std::string::npos);
  }
}
