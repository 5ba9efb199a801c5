#include "record/payload_json.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::record;

TEST_CASE("every body reads back as it was written") {
  REQUIRE(from_json<StudyCommitment>(to_json(fixture::commitment())) == fixture::commitment());

  const SessionOpening opening = fixture::opening(3);
  const SessionOpening read = from_json<SessionOpening>(to_json(opening));
  REQUIRE(to_json(read) == to_json(opening));
  REQUIRE(read.seal == opening.seal);
  REQUIRE(read.enrolment == 3);

  const TraceBody trace{.trial = 9,
                        .samples = 10'000,
                        .rate_hz = 999.9871,
                        .overruns = 3,
                        .valid = false,
                        .hand = {.path = false, .speed = false},
                        .saturated = true,
                        .trace = fixture::digest_of("t")};
  const TraceBody read_trace = from_json<TraceBody>(to_json(trace));
  REQUIRE(read_trace.rate_hz == trace.rate_hz);
  REQUIRE(read_trace.trace == trace.trace);
  REQUIRE_FALSE(read_trace.valid);
  REQUIRE(read_trace.samples == 10'000);
  REQUIRE(read_trace.hand == trace.hand);
  REQUIRE(read_trace.saturated);

  const AnswerBody answer = from_json<AnswerBody>(
      to_json(AnswerBody{.trial = 1, .answer = ChoiceAnswer{4, 0}, .confidence = {}}));
  REQUIRE(first_position_of(answer.answer) == 0);
  REQUIRE_FALSE(answer.confidence);

  ClosedBody closed{.complete = true};
  REQUIRE(to_json(closed) == R"({"complete":true})");
  REQUIRE(from_json<ClosedBody>(to_json(closed)).complete);
  closed = {.complete = true, .answers = 9, .one_key = true, .largest_force_n = 3.1};
  REQUIRE(from_json<ClosedBody>(to_json(closed)).answers == 9);
  REQUIRE(from_json<ClosedBody>(to_json(closed)).one_key);
  REQUIRE(from_json<ClosedBody>(to_json(closed)).largest_force_n == 3.1);
}

TEST_CASE("what is in clear of a body reads without the rest") {
  REQUIRE_FALSE(position_of(from_json<AnswerBody>(R"({"trial":1})").answer));
  REQUIRE_FALSE(from_json<PracticeBody>(R"({"presentation":1,"round":1})").correct);
  REQUIRE(from_json<DeviationBody>(R"({"code":"late"})").code == "late");
  REQUIRE(from_json<ResumedBody>(R"({"after":"pause","program_version":""})").after == "pause");
}

TEST_CASE("members for sessions in real time are written for those alone, and read back") {
  SessionOpening opening = fixture::opening(3);
  REQUIRE_FALSE(from_json<SessionOpening>(to_json(opening)).station);
  REQUIRE(to_json(opening).find("station") == std::string::npos);
  opening.station = StationRecord{.model = "Novint Falcon",
                                  .firmware = "v3",
                                  .max_force_n = 8.5,
                                  .visual = true,
                                  .rate_hz = 1000.0,
                                  .scheduling = "fifo 80",
                                  .calibration = std::string(64, 'a'),
                                  .force_scale = {1.0, 1.25, 0.8},
                                  .length_scale = {1.0, 1.0, 1.5}};
  REQUIRE(from_json<SessionOpening>(to_json(opening)).station == opening.station);
  REQUIRE(to_json(opening).find("screen") == std::string::npos);
  opening.station->screen = ScreenRecord{.mm_per_px = 0.2768, .source = "measured"};
  REQUIRE(from_json<SessionOpening>(to_json(opening)).station == opening.station);

  TraceBody trace{
      .trial = 1, .samples = 5, .rate_hz = 1000.0, .overruns = 2, .valid = true, .trace = {}};
  REQUIRE_FALSE(from_json<TraceBody>(to_json(trace)).servo);
  REQUIRE(to_json(trace).find("servo") == std::string::npos);
  trace.servo = ServoHealth{.rate_hz = 999.5,
                            .lateness_p50_us = 3.0,
                            .lateness_p99_us = 63.0,
                            .lateness_p999_us = 210.0,
                            .lateness_worst_us = 1700.0,
                            .lost = 1,
                            .held = 3};
  REQUIRE(from_json<TraceBody>(to_json(trace)).servo == trace.servo);
  REQUIRE(to_json(trace).find("began_ns") == std::string::npos);
  trace.began_ns = {1'250'000, 8'000'000'000};
  REQUIRE(from_json<TraceBody>(to_json(trace)).began_ns == trace.began_ns);

  TrialMeasures measures;
  REQUIRE_FALSE(measures_from_json(to_json(measures)).limited_ticks);
  measures.limited_ticks = 17;
  REQUIRE(measures_from_json(to_json(measures)) == measures);

  const InterruptionDetail detail{
      .safety_fault = "overspeed", .device_fault = "none", .ticks = 1, .flight = "a,b\r\n1,2\r\n"};
  REQUIRE(from_json<InterruptionDetail>(to_json(detail)) == detail);
}

TEST_CASE("a refusal within an object names both keys") {
  TraceBody trace{.trial = 1, .servo = ServoHealth{}};
  std::string text = to_json(trace);
  text.replace(text.find("\"lost\""), 6, "\"lust\"");
  REQUIRE_THROWS_WITH(static_cast<void>(from_json<TraceBody>(text)), holds_text("/servo/lost"));
}

TEST_CASE("doubles in bodies survive to the last bit") {
  RandomStream random(5, "doubles");
  for (int i = 0; i < 2000; ++i) {
    const double value =
        std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.below(400)) - 200);
    const TrialMeasures measures{
        .contact_s = value, .path_mm = 0.1, .force_rms_n = 1.0 / 3.0, .saturated_share = -0.0};
    const TrialMeasures read = measures_from_json(to_json(measures));
    REQUIRE(std::bit_cast<std::uint64_t>(read.contact_s) == std::bit_cast<std::uint64_t>(value));
    REQUIRE(read == measures);
  }
}

TEST_CASE("hostile bodies are refused with one line and never crash") {
  const std::vector<std::string> hostile = {"",
                                            "null",
                                            "[]",
                                            "42",
                                            "{",
                                            "{\"trial\":",
                                            "\xff\xfe",
                                            std::string("{}\0", 3),
                                            R"({"trial":0})",
                                            R"({"trial":-1})",
                                            R"({"trial":1.5})",
                                            R"({"trial":"1"})",
                                            R"({"trial":2147483648})",
                                            R"({"trial":18446744073709551615})",
                                            R"({"trial":1e400})",
                                            R"({"trial":null})",
                                            R"({"trial":{"trial":1}})",
                                            std::string(100'000, '['),
                                            std::string(100'000, '{'),
                                            R"({"position":1})"};
  using Parse = std::function<void(const std::string&)>;
  const std::vector<Parse> parsers = {
      [](const auto& t) { static_cast<void>(from_json<StudyCommitment>(t)); },
      [](const auto& t) { static_cast<void>(from_json<SessionOpening>(t)); },
      [](const auto& t) { static_cast<void>(from_json<AnswerBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<TraceBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<SessionOpenedBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<SessionClosedBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<ParticipantBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<UnblindingBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<TrialBody>(t)); },
      [](const auto& t) { static_cast<void>(from_json<ClosedBody>(t)); },
      [](const auto& t) { static_cast<void>(measures_from_json(t)); },
      [](const auto& t) { static_cast<void>(from_json<InterruptionDetail>(t)); },
  };
  for (const Parse& parse : parsers) {
    for (const std::string& text : hostile) REQUIRE_THROWS_AS(parse(text), StoreError);
  }
}

TEST_CASE("a refused body names the key") {
  REQUIRE_THROWS_WITH(from_json<TrialBody>(R"({"trial":"x"})"), holds_text("/trial"));
  REQUIRE_THROWS_WITH(from_json<AnswerBody>(R"({"position":1})"), holds_text("/trial"));
  REQUIRE_THROWS_WITH(
      static_cast<void>(from_json<SessionClosedBody>(R"({"session":1,"length":3,"head":"zz"})")),
      holds_text("/head"));
}

TEST_CASE("values that JSON cannot represent are refused before writing") {
  const double infinite = std::numeric_limits<double>::infinity();
  REQUIRE_THROWS_AS(
      to_json(TrialMeasures{
          .contact_s = infinite, .path_mm = 0.0, .force_rms_n = 0.0, .saturated_share = 0.0}),
      StoreError);
  REQUIRE_THROWS_AS(to_json(TextBody{"\xc3\x28"}), StoreError);
  REQUIRE(to_json(TextBody{"Würfel"}) == "{\"text\":\"Würfel\"}");
}
