#include "core/utc.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

using std::chrono::nanoseconds;
using std::chrono::seconds;

TEST_CASE("times are written in UTC to the whole second below") {
  CHECK(utc_text(seconds(0)) == "1970-01-01T00:00:00Z");
  CHECK(utc_text(seconds(951'782'399)) == "2000-02-28T23:59:59Z");
  CHECK(utc_text(seconds(951'782'400)) == "2000-02-29T00:00:00Z");
  CHECK(utc_text(seconds(253'402'300'799)) == "9999-12-31T23:59:59Z");
  CHECK(utc_text(nanoseconds(1'999'999'999)) == "1970-01-01T00:00:01Z");
  CHECK(utc_text(nanoseconds(-1)) == "1969-12-31T23:59:59Z");
  CHECK(utc_words(seconds(1'769'868'309)) == "2026-01-31 14:05 UTC");
  CHECK(utc_day(seconds(1'769'868'309)) == "2026-01-31");
}

TEST_CASE("any number of nanoseconds is a date") {
  CHECK(utc_text(nanoseconds::max()) == "2262-04-11T23:47:16Z");
  CHECK(utc_text(nanoseconds::min()) == "1677-09-21T00:12:43Z");
}

}  // namespace
}  // namespace touchtrial
