// Databases of earlier builds verify only while the bytes of every body stay as they are.
#include "core/files.hpp"
#include "record/body_parts.hpp"
#include "record/event_kinds.hpp"
#include "record/payload_json.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <string>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// The events of one kind after the other: the body in clear, and what is sealed.
class EventBytes {
 public:
  void about_file(EventKind kind, const std::string& body) {
    const BodyParts parts = split_body(kind, body);
    text += std::string(name_of(kind)) + "\n  " + parts.clear + "\n";
    if (!parts.hidden.empty()) text += "  sealed " + parts.hidden + "\n";
  }
  void of_session(const Event& stored) {
    const OpenedEvent opened = opened_event(stored, participant_key(1)).value();
    const BodyParts parts = split_body(stored.kind, opened.event.body);
    REQUIRE(parts.clear == stored.body);
    about_file(stored.kind, opened.event.body);
    if (!opened.secret.empty()) text += "  secret " + opened.secret + "\n";
    text += "  size " + std::to_string(stored.sealed.size()) +
            (is_safety_record(stored.kind) ? ", under the safety key\n" : "\n");
  }

  std::string text;
};

std::string file_events() {
  EventBytes bytes;
  StudyCommitment study = commitment();
  bytes.about_file(EventKind::study_committed, to_json(study));
  study.station.reset();
  bytes.about_file(EventKind::study_committed, to_json(study));
  SessionOpenedBody opened{.session = 3,
                           .participant = "P3",
                           .enrolment = 7,
                           .visit = 1,
                           .first = digest_of("first"),
                           .key = digest_of("key"),
                           .safety_key = digest_of("safety"),
                           .kept = {},
                           .remarks = digest_of("remarks"),
                           .reasons = digest_of("reasons"),
                           .station = 0,
                           .own_session = 0};
  bytes.about_file(EventKind::session_opened, to_json(opened));
  opened.visit = 2;
  opened.kept = digest_of("kept");
  opened.station = 2;
  opened.own_session = 1;
  bytes.about_file(EventKind::session_opened, to_json(opened));
  bytes.about_file(EventKind::session_closed,
                   to_json(SessionClosedBody{
                       .session = 3, .length = 90, .head = digest_of("head"), .complete = true}));
  bytes.about_file(EventKind::participant_excluded,
                   to_json(ParticipantBody{.session = 3, .reason = "ill", .after_outcomes = true}));
  bytes.about_file(
      EventKind::participant_excluded,
      to_json(ParticipantBody{.session = 3, .reason = "ill", .after_outcomes = false}));
  bytes.about_file(EventKind::participant_withdrawn,
                   to_json(WithdrawalBody{.session = 3,
                                          .kept = Retention::safety_record,
                                          .reason = "no time",
                                          .not_erased = "backups"}));
  bytes.about_file(
      EventKind::participant_withdrawn,
      to_json(WithdrawalBody{.session = 3, .kept = Retention::data, .reason = "no time"}));
  bytes.about_file(EventKind::participant_withdrawn,
                   to_json(WithdrawalBody{.session = 3, .kept = Retention::nothing, .reason = ""}));
  bytes.about_file(EventKind::study_closed, "{}");
  bytes.about_file(EventKind::study_unblinded,
                   to_json(UnblindingBody{.reason = "the end \"now\"\n", .interim = false}));
  bytes.about_file(EventKind::study_unblinded,
                   to_json(UnblindingBody{.reason = "halfway",
                                          .interim = true,
                                          .question_alone = true,
                                          .sessions = std::vector<int>{1, 2, 9},
                                          .participant = "P3"}));
  bytes.about_file(EventKind::participant_replaced,
                   to_json(ReplacementBody{.session = 3, .by = "P4", .reason = "moved"}));
  bytes.about_file(EventKind::participant_noted,
                   to_json(NoteBody{.session = 3, .code = "", .text = "left-handed"}));
  bytes.about_file(EventKind::participant_noted,
                   to_json(NoteBody{.session = 3, .code = "no-consent", .text = "\u00e9t\u00e9"}));
  bytes.about_file(EventKind::heads_kept, to_json(HeadsBody{.also = "/mnt/heads"}));
  bytes.about_file(EventKind::loss_accepted,
                   to_json(LossBody{.reason = "disk", .missing = "two sessions", .answers = 12}));
  return bytes.text;
}

std::string session_events() {
  BufferedEvents sink;
  SessionRecorder recorder(1, participant_key(1), sink);
  const auto at = [&] { return nanoseconds(1'000'000'007) * (recorder.length() + 1); };
  recorder.opened(at(), opening(1), R"({"schedule":"1"})");
  SessionOpening whole = opening(1);
  whole.visit = 2;
  whole.group = "left";
  whole.device_serial = "17";
  whole.opened_utc = "2026-01-31T12:00:00Z";
  whole.station = StationRecord{.model = "Novint Falcon",
                                .firmware = "v3",
                                .max_force_n = 8.5,
                                .visual = true,
                                .rate_hz = 1000.0,
                                .scheduling = "fifo 80",
                                .calibration = std::string(64, 'a'),
                                .screen = {},
                                .force_scale = {1.0, 1.25, 0.8},
                                .length_scale = {1.0, 1.0, 1.5}};
  recorder.opened(at(), whole, "{}");
  whole.station->screen = ScreenRecord{.mm_per_px = 0.2768, .source = "measured"};
  recorder.opened(at(), whole, "{}");
  recorder.add(at(), EventKind::calibrated, TextBody{.text = "moved to every corner"});
  recorder.add(at(), EventKind::instructed, TextBody{.text = ""});
  recorder.add(
      at(), EventKind::practised,
      PracticeBody{.round = 2, .presentation = 3, .answer = ChoiceAnswer{1, 0}, .correct = true});
  recorder.add(
      at(), EventKind::practised,
      PracticeBody{.round = 1, .presentation = 1, .answer = RatingAnswer{{0.5, 7}}, .correct = {}});
  recorder.presented(at(), 7, 2);
  recorder.first_contact(at(), 7);
  const Trace trace = stroking(5, 0.0);
  const TraceBody plain{
      .trial = 7, .samples = 0, .rate_hz = 999.9871, .overruns = 0, .valid = true, .trace = {}};
  recorder.answered(at(), {.trial = 7, .answer = ChoiceAnswer{4}, .confidence = {}});
  recorder.answered(at(), {.trial = 7,
                           .answer = ChoiceAnswer{4, 0},
                           .confidence = 5,
                           .kind = "scored",
                           .track = 2,
                           .level = 11,
                           .target = 0});
  recorder.answered(at(),
                    {.trial = 8, .answer = RatingAnswer{{0.25, 1.0 / 3.0}}, .confidence = {}});
  recorder.answered(at(), {.trial = 8, .answer = {}, .confidence = {}});
  recorder.interrupted(at(), 9, "comfort stop");
  recorder.interrupted(at(), 9, "device fault",
                       InterruptionDetail{.safety_fault = "overspeed",
                                          .device_fault = "none",
                                          .ticks = 1,
                                          .flight = "a,b\r\n1,2\r\n",
                                          .largest_force_n = 3.25});
  recorder.timed_out(at(), 9);
  // A trace's box has random bytes, which its hash shows.
  TrialEvidence evidence = recorder.pack_evidence(plain, {}, trace);
  evidence.body.trace = digest_of("box");
  recorder.timed_out(at(), 7, evidence);
  evidence.body.servo = ServoHealth{.rate_hz = 999.5,
                                    .lateness_p50_us = 3.0,
                                    .lateness_p99_us = 63.0,
                                    .lateness_p999_us = 210.0,
                                    .lateness_worst_us = 1700.0,
                                    .lost = 1,
                                    .held = 3};
  evidence.body.overruns = 2;
  evidence.body.valid = false;
  evidence.body.hand = {.contact = true, .path = false, .force = true, .speed = false};
  evidence.body.saturated = true;
  evidence.body.largest_force_n = 4.125;
  evidence.body.explorations = {3, 2};
  evidence.body.began_ns = {1'250'000, 8'000'000'000};
  evidence.measures = {.contact_s = 8.5,
                       .path_mm = 612.25,
                       .force_rms_n = 0.1,
                       .saturated_share = 1.0 / 3.0,
                       .within_limits = false,
                       .limited_ticks = 17};
  recorder.timed_out(at(), 7, evidence);
  recorder.add(at(), EventKind::break_taken, TextBody{.text = ""});
  recorder.add(at(), EventKind::paused, PauseBody{.text = "phone", .trial = 3});
  recorder.add(at(), EventKind::paused, PauseBody{.text = "", .trial = {}});
  recorder.add(at(), EventKind::stopped, StopBody{.text = "ill"});
  recorder.add(at(), EventKind::stopped, StopBody{.code = "too many faults", .text = ""});
  recorder.add(at(), EventKind::noted, RemarkBody{.text = "sneezed"});
  recorder.add(at(), EventKind::ticked, TextBody{.text = "warm-up"});
  recorder.add(at(), EventKind::deviated, DeviationBody{"late", "ten minutes"});
  recorder.add(at(), EventKind::questioned, TextBody{"after"}, R"({"age":30})");
  recorder.add(at(), EventKind::explored_again, TrialBody{7});
  recorder.block_restarted(at(), 2, 41, "[]");
  recorder.add(at(), EventKind::resumed,
               ResumedBody{.after = "pause", .away_s = 12.5, .program_version = "1", .trial = 3});
  recorder.add(
      at(), EventKind::resumed,
      ResumedBody{.after = "program-ended", .away_s = 3600.0, .program_version = "1", .trial = {}});
  recorder.add(at(), EventKind::marked, EmptyBody{},
               to_json(MarksBody{.codes = {1, 10},
                                 .trials = {0, 1},
                                 .at_ns = {5, 1'000'000'000},
                                 .latency_ns = {0, 12'000},
                                 .lsl_zero_s = {},
                                 .lsl_uncertainty_s = {}}));
  recorder.add(at(), EventKind::marked, EmptyBody{},
               to_json(MarksBody{.codes = {},
                                 .trials = {},
                                 .at_ns = {},
                                 .latency_ns = {},
                                 .lsl_zero_s = 12.5,
                                 .lsl_uncertainty_s = 1e-5}));
  // The end's secret has the head, and with it random bytes.
  Event last;
  last.session = 1;
  last.sequence = 98;
  last.hash = digest_of("head");
  recorder.continue_after(last);
  recorder.closed(at(), true);
  recorder.continue_after(last);
  recorder.closed(at(), false, 120, true, 3.14159);
  EventBytes bytes;
  for (const Event& event : sink.events) bytes.of_session(event);
  return bytes.text;
}

}  // namespace

TEST_CASE("the bytes of one event of every kind are as they were") {
  const std::string bytes = file_events() + session_events();
  for (const EventKindRow& row : event_kinds()) {
    INFO(row.name);
    CHECK(bytes.find(std::string(row.name) + "\n") != std::string::npos);
  }
  CHECK(bytes == text_of(read_file(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) /
                                   "tests/record/event_bytes.txt")));
}
