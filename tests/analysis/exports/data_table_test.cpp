#include "analysis/exports/data_table.hpp"

#include "analysis/report/escaping.hpp"
#include "support/catch.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial {

using std::chrono::nanoseconds;

TEST_CASE("seconds_text is exact to the nanosecond and has no needless digit") {
  CHECK(analysis::seconds_text(nanoseconds(0)) == "0");
  CHECK(analysis::seconds_text(nanoseconds(1)) == "0.000000001");
  CHECK(analysis::seconds_text(nanoseconds(4'250'000'000)) == "4.25");
  CHECK(analysis::seconds_text(nanoseconds(10'000'000'000)) == "10");
  CHECK(analysis::seconds_text(nanoseconds(-1'500'000'000)) == "-1.5");
  CHECK(analysis::seconds_text(nanoseconds(std::numeric_limits<std::int64_t>::min())) ==
        "-9223372036.854775808");
}

TEST_CASE("csv_text writes numbers with a decimal dot and nothing for a missing value") {
  const analysis::DataTable table{
      {"a", "b", "c", "d", "e"},
      {{std::string("x"), std::int64_t{-3}, 0.1, nanoseconds(1'500'000'000), std::monostate{}}}};
  CHECK(analysis::csv_text(table) == "a,b,c,d,e\nx,-3,0.1,1.5,\n");
}

TEST_CASE("csv_text quotes what would break a row") {
  const analysis::DataTable table{{"a,b", "c"},
                                  {{std::string("say \"hi\""), std::string("two\nlines")}}};
  CHECK(analysis::csv_text(table) == "\"a,b\",c\n\"say \"\"hi\"\"\",\"two\nlines\"\n");
}

TEST_CASE("no text becomes a formula of a spreadsheet, and no number changes") {
  const std::vector<std::string> formulas = {"=1+1", "+x", "-x", "@SUM(A1)", "=\"a\"", "-1+1"};
  for (const std::string& formula : formulas) {
    INFO(formula);
    CHECK(analysis::harmless_cell(formula) == "'" + formula);
  }
  CHECK(analysis::harmless_cell("\t=1") == "'\t=1");
  CHECK(analysis::harmless_cell("\r=1") == "'\\u000d=1");
  for (const char* const plain : {"", "a=b", "P-1", "-1.5", "-3", "-1e-05", "1"}) {
    CHECK(analysis::harmless_cell(plain) == plain);
  }
  const analysis::DataTable table{
      {"=a", "b", "c", "d"},
      {{std::string("=1,2"), std::int64_t{-3}, -0.5, nanoseconds(-1'500'000'000)}}};
  CHECK(analysis::csv_text(table) == "'=a,b,c,d\n\"'=1,2\",-3,-0.5,-1.5\n");
  CHECK(analysis::tsv_text(table) == "'=a\tb\tc\td\n'=1,2\t-3\t-0.5\t-1.5\n");
}

TEST_CASE("no control of a terminal or of the direction of text is left in tables and pages") {
  const std::string hostile =
      "a\x1b[2J\xe2\x80\xae"
      "b\xc2\x9b";
  const analysis::DataTable table{{"a"}, {{hostile}}};
  CHECK(analysis::csv_text(table) == "a\na\\u001b[2J\\u202eb\\u009b\n");
  CHECK(analysis::tsv_text(table) == "a\na\\u001b[2J\\u202eb\\u009b\n");
  CHECK(analysis::xml_escaped(hostile) == "a [2J\\u202eb\\u009b");
  CHECK(analysis::markdown_escaped("\xe2\x81\xa6") == "\\\\u2066");
}

TEST_CASE("csv_text refuses a row that does not fit its header") {
  CHECK_THROWS_AS(analysis::csv_text({{"a", "b"}, {{std::string("x")}}}), std::invalid_argument);
}

}  // namespace touchtrial
