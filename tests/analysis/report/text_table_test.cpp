#include "analysis/report/text_table.hpp"

#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "support/catch.hpp"

#include <sstream>
#include <stdexcept>

namespace touchtrial {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("display_width counts characters, not bytes, and wide ones twice") {
  CHECK(analysis::display_width("") == 0);
  CHECK(analysis::display_width("bark") == 4);
  CHECK(analysis::display_width("écorce") == 6);
  CHECK(analysis::display_width("木") == 2);
}

TEST_CASE("A table pads labels in any language to the same column") {
  analysis::TextTable table({"class", "n"});
  table.add({"écorce", "5"});
  table.add({"木目", "12"});
  CHECK(table.text() == "  class    n\n  écorce   5\n  木目    12\n");
}

TEST_CASE("A table that is too wide continues below with its first column repeated") {
  analysis::TextTable table({"row", "aaaaaaaa", "bbbbbbbb", "cccccccc"});
  table.add({"one", "1", "2", "3"});
  const auto lines = lines_of(table.text(26));
  REQUIRE(lines.size() == 4);
  CHECK(lines[0] == "  row  aaaaaaaa  bbbbbbbb");
  CHECK(lines[1] == "  one         1         2");
  CHECK(lines[2] == "  row  cccccccc");
  CHECK(lines[3] == "  one         3");
}

TEST_CASE("A cell that is too long is cut at a character") {
  CHECK(analysis::fitted("short", 10) == "short");
  CHECK(analysis::fitted("abcdef", 4) == "abc…");
  CHECK(analysis::fitted("ééé", 2) == "é…");
  CHECK(analysis::display_width(analysis::fitted("木木木木", 5)) == 5);
}

TEST_CASE("A table refuses rows of another length") {
  analysis::TextTable table({"a", "b"});
  CHECK_THROWS_AS(table.add({"1"}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::TextTable({}), std::invalid_argument);
}

TEST_CASE("wrapped breaks paragraphs at spaces and indents what follows") {
  std::string words;
  for (int i = 0; i < 40; ++i) words += "word ";
  const auto lines = lines_of(analysis::wrapped("  - ", words));
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].starts_with("  - word"));
  CHECK(lines[1].starts_with("    word"));
  for (const std::string& line : lines)
    CHECK(analysis::display_width(line) <= analysis::kTextWidth);
}

TEST_CASE("Numbers in text have signs where they differ and dashes where they do not exist") {
  CHECK(analysis::share_figure(0.8) == "80.0%");
  CHECK(analysis::share_figure(std::nullopt) == analysis::kNoFigure);
  CHECK(analysis::share_range(analysis::Interval{0.0, 1.0}) == "[0.0, 100.0]");
  CHECK(analysis::points_figure(0.075) == "+7.5");
  CHECK(analysis::points_figure(-0.0001) == "0.0");
  CHECK(analysis::signed_plain_figure(std::nullopt, 2) == analysis::kNoFigure);
  CHECK(analysis::signed_plain_figure(0.4, 2) == "+0.40");
  CHECK(analysis::p_value(0.000244140625) == "0.000244");
}

}  // namespace touchtrial
