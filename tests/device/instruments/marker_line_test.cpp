// Event codes on a pseudo terminal, whose other side reads what an instrument would.
#include "device/instruments/marker_line.hpp"

#include "core/errors.hpp"
#include "device/instruments/instrument_side.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <string>

namespace touchtrial {
namespace {

using device::MarkerFormat;
using Clock = std::chrono::steady_clock;

}  // namespace

TEST_CASE("markers as bytes are the code and the trial's number, most significant byte first") {
  device::MarkerLineSettings line;
  CHECK(device::marker_bytes(line, 10, 7) == "\x0a");
  line.width = 1;
  CHECK(device::marker_bytes(line, 255, 7) == "\xff\x07");
  line.width = 2;
  CHECK(device::marker_bytes(line, 10, 0x1234) == "\x0a\x12\x34");
  CHECK(device::marker_bytes(line, 10, 0) == std::string("\x0a\0\0", 3));
  line.width = 4;
  CHECK(device::marker_bytes(line, 1, 1) == std::string("\x01\0\0\0\x01", 5));
}

TEST_CASE("markers as text are a line each") {
  device::MarkerLineSettings line;
  line.format = MarkerFormat::text;
  CHECK(device::marker_bytes(line, 10, 7) == "E10 T7\n");
  line.width = 3;
  CHECK(device::marker_bytes(line, 10, 7) == "E10 T007\n");
  CHECK(device::marker_bytes(line, 1, 12345) == "E1 T12345\n");
}

TEST_CASE("a marker line writes markers byte by byte, and reports their latency") {
  Instrument instrument;
  instrument.settings.width = 1;
  device::MarkerLine line(instrument.settings);
  // Control characters of a terminal go through as they are.
  for (const int code : {1, 3, 10, 13, 17, 19, 26, 255}) line.send(code, code, Clock::now());
  const std::vector<device::SentMarker> sent = line.take();
  REQUIRE(sent.size() == 8);
  for (const device::SentMarker& one : sent) {
    REQUIRE(one.latency);
    CHECK(one.latency->count() > 0);
  }
  CHECK(instrument.read(16) == "\x01\x01\x03\x03\x0a\x0a\x0d\x0d\x11\x11\x13\x13\x1a\x1a\xff\xff");
  CHECK(line.take().empty());
}

TEST_CASE("a marker line sets trigger lines back with a zero") {
  Instrument instrument;
  instrument.settings.reset_ms = 1.0;
  {
    device::MarkerLine line(instrument.settings);
    line.send(10, 0, Clock::now());
    CHECK(instrument.read(2) == std::string("\x0a\0", 2));
    line.send(11, 0, Clock::now());
  }
  CHECK(instrument.read(2) == std::string("\x0b\0", 2));
}

TEST_CASE("a marker that an unplugged line did not take has no latency, and nothing else happens") {
  Instrument instrument;
  device::MarkerLine line(instrument.settings);
  instrument.unplug();
  line.send(10, 1, Clock::now());
  const std::vector<device::SentMarker> sent = line.take();
  REQUIRE(sent.size() == 1);
  CHECK_FALSE(sent.front().latency);
}

TEST_CASE("a line that cannot be used is refused with its name and the remedy") {
  const TempFolder folder;
  device::MarkerLineSettings none{.port = folder.path() / "ttyNONE"};
  CHECK_THROWS_WITH(device::MarkerLine(none), holds_text("ttyNONE"));
  device::MarkerLineSettings file{.port = "/dev/null"};
  CHECK_THROWS_AS(device::MarkerLine(file), Error);
  Instrument instrument;
  instrument.settings.baud = 12'345;
  CHECK_THROWS_WITH(device::MarkerLine(instrument.settings), holds_text("115200"));
}

}  // namespace touchtrial
