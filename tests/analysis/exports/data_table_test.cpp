#include "analysis/exports/data_table.hpp"

#include "support/catch.hpp"

#include <limits>
#include <stdexcept>

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

TEST_CASE("csv_text refuses a row that does not fit its header") {
  CHECK_THROWS_AS(analysis::csv_text({{"a", "b"}, {{std::string("x")}}}), std::invalid_argument);
}

}  // namespace touchtrial
