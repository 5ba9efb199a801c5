// The content of a report's document, and the names of its parts.
#include "analysis/report/page/document.hpp"
#include "analysis/report/page/wording.hpp"
#include "protocols/identification/analysis/hand_made_report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::analysis::identification;

namespace {

Table table_named(const Document& document, const std::string& id) {
  for (const Table* table : tables_of(document)) {
    if (table->id == id) return *table;
  }
  FAIL("no table " << id);
  return {};
}

std::string texts_of(const std::vector<Cell>& row) {
  std::string texts;
  for (const Cell& cell : row) texts += (texts.empty() ? "" : " | ") + cell.text;
  return texts;
}

Document hand_made() {
  return study_document(hand_made_report(), hand_made_provenance());
}

}  // namespace

TEST_CASE("document: the result comes first, then people, and what specialists read is folded") {
  std::string shown;
  std::string folded;
  for (const Section& section : hand_made().sections) {
    (section.is_folded() ? folded : shown) += section.id + ' ';
  }
  CHECK(shown == "result methods-compared accuracy confusions confidence places participants ");
  CHECK(folded == "order reaction-times cues servo-and-validity ");
}

TEST_CASE("document: every table has a unique name and as many cells as columns") {
  std::set<std::string> ids;
  StudyReport report = hand_made_report();
  report.methods[1].method = "Adaptive!";  // the same name as a file's
  const Document document = study_document(report, hand_made_provenance());
  for (const Table* table : tables_of(document)) {
    INFO(table->id);
    CHECK(ids.insert(table->id).second);
    CHECK(table->id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") ==
          std::string::npos);
    for (const std::vector<Cell>& row : table->rows) CHECK(row.size() == table->columns.size());
  }
}

TEST_CASE("document: answers by place") {
  const Table places = table_named(hand_made(), "answers-by-place");
  CHECK(places.rows.size() == 3);
  CHECK(texts_of(places.rows[0]) == "1 | 60 | +8.3 | [−10.0, 20.0] | 0.040");
}

TEST_CASE("document: confusions hold counts, row percentages, marginals and missing responses") {
  const Table table = table_named(hand_made(), "confusions-adaptive");
  CHECK(texts_of(table.rows.front()) == "bark | 20 (80%) | 3 (12%) | 1 (4%) | 1 (4%) | 25");
  CHECK(texts_of(table.rows.back()) ==
        "all answers | 24 (32%) | 26 (35%) | 22 (29%) | 3 (4%) | 75");
  CHECK(table.rows[1][2].strong);
  CHECK_FALSE(table.rows[1][1].strong);
}

TEST_CASE("document: order, confidence and unbiased hit rates stand in tables of their own") {
  const Document document = hand_made();
  const Table order = table_named(document, "order-adaptive");
  CHECK_THAT(texts_of(order.rows[0]), holds_text(" | +12.3 | [−2.0, 26.6] | 0.0 | 0.082"));
  CHECK_THAT(texts_of(order.rows[1]), names("9 18 – 6.2 0.310"));
  const Table confidence = table_named(document, "confidence-adaptive");
  CHECK(texts_of(confidence.rows[1]) ==
        "2 (certain) | 42 | 39 | 92.9% | 5 | 93.0% | [80.0, 100.0]");
  CHECK_THAT(document_text(document), names("0.71 95% 0.60 0.82"));
  const Table by_class = table_named(document, "accuracy-by-class-adaptive");
  const std::vector<Cell>& all = by_class.rows.back();
  REQUIRE(all.size() == 8);
  CHECK(all[5].text == "62.0%");
  CHECK(all[6].text == "13.1%");
}

TEST_CASE("document: the headline is the mean over participants, with its interval and spread") {
  const Table table = table_named(hand_made(), "headline");
  CHECK_THAT(texts_of(table.rows.front()),
             holds_text("adaptive | 6 | 75 | 79.0% | [63.0, 95.0] | 12.1 [5.0, 30.0] | "));
  const Table ability = table_named(hand_made(), "ability");
  CHECK(texts_of(ability.rows.front()) ==
        "adaptive | 57/75 | 25.0 | < 0.001 | 82.6% | [50.0, 97.0] | 5/6 | 4.0%");
}

TEST_CASE("document: the result is the verdict, the departures and one table of all choices") {
  const Document document = hand_made();
  const Section& result = document.sections.front();
  CHECK(result.id == "result");
  CHECK_THAT(std::get<CitedText>(result.blocks.at(0)).text,
             names("−8.3 95% −20.0 3.4 6 20 7 0.125 0.05"));
  const auto departures = std::ranges::find_if(
      result.blocks, [](const Block& block) { return std::holds_alternative<Warnings>(block); });
  REQUIRE(departures != result.blocks.end());
  CHECK(std::get<Warnings>(*departures).sentences.front() == "7 of 20 participants.");
  const Table table = table_named(document, "primary");
  CHECK(texts_of(table.rows[0]).ends_with(" | 6 | 150 | −8.3 | [−20.0, 3.4] | 0.125"));
  CHECK(table.rows[1].back().text == "–");
  CHECK(table_named(document, "looks").rows[0][0].text == "2026-01-31 12:00 UTC");
}

TEST_CASE("document: after an unregistered look no p stands without saying so") {
  StudyReport report = hand_made_report();
  report.looks.push_back({std::chrono::seconds(0), 3, "curious", LookKind::unregistered});
  const Document document = study_document(report, hand_made_provenance());
  const std::string words = table_named(document, "primary").notes.back().text;
  CHECK_THAT(words, names("p 1"));
  for (const char* id : {"primary", "ability", "methods", "methods-by-class-1"}) {
    INFO(id);
    CHECK(table_named(document, id).notes.back().text == words);
  }
  CHECK(table_named(document, "headline").notes.back().text != words);
  for (const Section& section : document.sections) {
    for (const Block& block : section.blocks) {
      const auto* sentence = std::get_if<CitedText>(&block);
      if (sentence == nullptr || sentence->text.find("p = ") == std::string::npos) continue;
      CHECK_THAT(sentence->text, holds_text(words));
    }
  }
}

TEST_CASE("document: methods are compared with differences, t, effect sizes and odds") {
  const Table table = table_named(hand_made(), "methods");
  CHECK_THAT(texts_of(table.rows.front()),
             names("adaptive tv-gabor") &&
                 holds_text(" | 6 | −8.3 | [−20.0, 3.4] | t(5) = −1.82 | 0.125 | −0.74 [−1.63, "
                            "0.20] | 0.66 [0.25, 1.70]"));
}

TEST_CASE("document: participants' flow is drawn once, explorations come last among the cues") {
  const Document document = study_document(
      hand_made_report(), hand_made_provenance(),
      {hand_made_picture("participant-flow"), hand_made_picture("ideal-observers", "cues"),
       hand_made_picture("exploration-1-2", kExplorations)});
  CHECK_THAT(page_html(document), !holds_text("figure-participant-flow"));
  for (const Section& section : document.sections) {
    if (section.id != "cues") continue;
    const auto first_table = std::ranges::find_if(section.folded_blocks, [](const Block& block) {
      return std::holds_alternative<Table>(block);
    });
    REQUIRE(first_table != section.folded_blocks.begin());
    REQUIRE(std::holds_alternative<Picture>(*std::prev(first_table)));
    CHECK(std::get<Picture>(*std::prev(first_table)).id == "ideal-observers");
    REQUIRE(std::holds_alternative<Picture>(section.folded_blocks.back()));
    CHECK(std::get<Picture>(section.folded_blocks.back()).id == "exploration-1-2");
  }
}

TEST_CASE("document: few participants give no verdict on which observer confuses alike") {
  StudyReport report = hand_made_report();
  const auto page = [&] { return page_html(study_document(report, hand_made_provenance())); };
  const std::string of_two = page();
  report.cues->methods[0].participants.assign(6, "P");
  CHECK_THAT(page(), names("0.020 −0.010 0.050"));
  CHECK(page() != of_two);
  report.cues->methods[0].match->difference.interval.reset();
  CHECK_THAT(page(), !holds_text("[−0.010, 0.050]"));
}

TEST_CASE("document: an observer that cannot reach participants is never as uncertain as they") {
  StudyReport report = hand_made_report();
  MethodCues& cues = report.cues->methods[0];
  const auto page = [&] { return page_html(study_document(report, hand_made_provenance())); };
  const std::string reached = page();
  // Strength, which is not the nearest, is right less often.
  cues.observers[0].matched_accuracy = 0.58;
  cues.observers[0].target_accuracy = 0.77;
  const std::string unreached = page();
  CHECK(unreached != reached);
  cues.match->best = Cue::rms;
  CHECK(page().size() > unreached.size());
}

TEST_CASE("document: intervals over participants come first, those of trials are marked") {
  StudyReport report = hand_made_report();
  const auto markdown = [&](const std::string& id) {
    return table_markdown(table_named(study_document(report, hand_made_provenance()), id), "");
  };
  CHECK_THAT(markdown("accuracy-by-class-adaptive"), holds_text("55.0, 97.0"));
  CHECK_THAT(markdown("methods"), holds_text("0.66 \\[0.25, 1.70\\]"));
  CHECK_THAT(markdown("headline"), holds_text("1.20, 2.30"));
  report.pairs[0].odds_ratio->bootstrap.reset();
  for (MethodReport& method : report.methods) {
    method.d_prime_over_participants.reset();
    for (ClassAccuracy& one : method.accuracy) one.mean.interval = {0.76, 0.76};
  }
  CHECK_THAT(markdown("methods"), holds_text("0.66 \\[0.31, 1.40\\] †"));
  CHECK_THAT(markdown("headline"), !holds_text("1.20, 2.30") && holds_text(" \\*"));
  CHECK_THAT(markdown("accuracy-by-class-adaptive"), !holds_text("76.0, 76.0"));
}

TEST_CASE("document: every table of an interim look or a pilot is marked") {
  StudyReport report = hand_made_report();
  Provenance provenance = hand_made_provenance();
  CHECK(study_document(report, provenance).stamp == "SIMULATED");
  report.pilot = true;
  provenance.state.closed = false;
  const Document document = study_document(report, provenance);
  for (const Table* table : tables_of(document)) {
    CHECK_THAT(table_markdown(*table, document.stamp),
               holds_text("SIMULATED, PILOT, INTERIM LOOK"));
    CHECK_THAT(table_latex(*table, document.stamp), holds_text("SIMULATED, PILOT, INTERIM LOOK"));
  }
  CHECK(stamped("SIMULATED: x", document.stamp) == "SIMULATED: x [PILOT, INTERIM LOOK]");
}

TEST_CASE("document: figures that were not drawn are described, without their captions") {
  Picture picture = hand_made_picture("methods", "methods-compared");
  const auto page = [&] {
    return page_html(study_document(hand_made_report(), hand_made_provenance(), {picture}));
  };
  CHECK_THAT(page(), holds_text("A picture."));
  picture.svg.clear();
  CHECK_THAT(page(), holds_text("</b> Three bars: 80, 76 and 72%."));
  CHECK_THAT(page(), !holds_text("A picture."));
}

TEST_CASE("document: where all differences are equal, that there is no interval is marked") {
  StudyReport report = hand_made_report();
  report.pairs[0].classes[1].comparison.interval = {-0.08, -0.08};
  const Document document = study_document(report, hand_made_provenance());
  const Table table = table_named(document, "methods-by-class-1");
  CHECK(table.rows[1][5].text == "– *");
  CHECK(table_named(hand_made(), "methods-by-class-1").rows[1][5].text != "– *");
}

TEST_CASE("document: every cited source is in the list of references, once") {
  const std::vector<Source> references = references_of(hand_made());
  CHECK(references.size() > 10);
  CHECK(std::set<Source>(references.begin(), references.end()).size() == references.size());
  CHECK(reference_number(references[2], references) == 3);
  for (const Source source : references) CHECK_FALSE(citation_of(source).empty());
}

TEST_CASE("document: parts that were not requested tell how to request them") {
  StudyReport report = hand_made_report();
  report.cues.reset();
  CHECK_THAT(page_html(study_document(report, hand_made_provenance())), holds_text("--cues yes"));
}

TEST_CASE(
    "document: numbers that do not exist are dashes, and those that round to 0 have no sign") {
  CHECK(share_figure({}) == "–");
  CHECK(points_figure(-0.0001) == "0.0");
  CHECK(points_figure(-0.083) == "−8.3");
  CHECK(plain_figure(-0.001, 2) == "0.00");
  CHECK(p_figure(0.0004) == "< 0.001");
  CHECK(p_phrase(0.0312) == "p = 0.031");
  CHECK(slug_of("TV-Gabor (2)") == "tv-gabor-2");
  CHECK(slug_of("木").empty());
}
