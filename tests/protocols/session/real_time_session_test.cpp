// Sessions with the servo on its own thread, on a device that is lost and comes back. Servo time
// passes as fast as the processor allows, unless a test says otherwise.
#include "core/cipher.hpp"
#include "protocols/identification/simulation/identifying_participant.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/fake_station.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/still_time.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "record/payload_json.hpp"
#include "record/study_store.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"
#include "support/realtime_watch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace touchtrial {
namespace {

using std::chrono::seconds;

/// A participant at a station, who names a picture by what was felt and remembers the answer.
class PersonAtStation : public simulation::PromptParticipant {
 public:
  PersonAtStation(session::DeviceStation& station, FakeDevice*& device)
      : station_(station), device_(device) {}

  void see_pictures(const std::vector<std::string>& labels) override { pictures_ = labels.size(); }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry&) override {
    device_->lift();
    felt_n_ = 0.0;
    samples_ = 0;
    return station_.device();
  }
  void feel(const device::ServoSample& sample) noexcept override {
    felt_n_ += std::abs(sample.force_n.x);
    ++samples_;
  }
  [[nodiscard]] simulation::ParticipantAnswer answer() override {
    const auto tenths = static_cast<std::size_t>(felt_n_ * 10.0);
    const int position = static_cast<int>((tenths + named.size()) % pictures_);
    named.push_back(position);
    return {position, seconds(1)};
  }

  std::vector<int> named;
  [[nodiscard]] int samples() const noexcept { return samples_; }

 private:
  session::DeviceStation& station_;
  FakeDevice*& device_;
  std::size_t pictures_ = 0;
  double felt_n_ = 0.0;
  int samples_ = 0;
};

/// A session of 5 trials of 0.4 s at the fake station.
struct Laboratory {
  explicit Laboratory(const session::RealTimeOptions& options = as_fast_as_it_goes())
      : explorer(options),
        session(
            study::make_order(study.key().study, study.key().draw_of(1, study::Draws::rehearsal)),
            study.key().study.trials, record::SessionRecorder(1, participant_key, events)) {}

  session::SessionTally run(session::Participant& participant,
                            session::Experimenter& experimenter = session::no_experimenter()) {
    REQUIRE(station.make_ready() == session::SupplyState::ready);
    record::SessionOpening opening{.participant = "P001", .enrolment = 1};
    session::describe_station(opening, station.info(), explorer.scheduling(), device::kServoRateHz,
                              "");
    session.open({}, opening, "{}");
    return session::run_session(session, {study.key(), source, participant, clock, explorer,
                                          station, device::kServoRateHz, experimenter});
  }
  session::SessionTally run() { return run(person); }

  [[nodiscard]] std::vector<record::Event> all(record::EventKind kind) const {
    std::vector<record::Event> found;
    for (const record::Event& event : events.events) {
      if (event.kind == kind) found.push_back(event);
    }
    return found;
  }

  TinyStudy study{{.trials = R"({"repeats": 1, "explore_limit_s": 0.4})"}};
  session::StimulusSource source{study.pack(), study.key().study.rendering};
  SecretKey participant_key = sha256(bytes_of("somebody"));
  record::BufferedEvents events;
  Cable cable;
  FakeDevice* device = nullptr;
  Helper helper{cable};
  session::DeviceStation station{opener(cable, device), std::nullopt, helper};
  PersonAtStation person{station, device};
  session::VirtualSessionClock clock;
  session::RealTimeExplorer explorer;
  session::Session session;
};

TEST_CASE("a real-time session stores every answer, every sample and the servo's health") {
  Laboratory lab;
  static_cast<void>(take_realtime_offences());
  const session::SessionTally tally = lab.run();
  CHECK(take_realtime_offences() == RealtimeOffences{});
  CHECK(lab.session.phase() == session::SessionPhase::closed);
  CHECK(tally.presentations == 5);
  const std::vector<record::Event> answers = lab.all(record::EventKind::answered);
  REQUIRE(answers.size() == 5);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const record::Event answer = as_recorded(answers[i], lab.participant_key);
    CHECK(position_of(record::from_json<record::AnswerBody>(answer.body).answer) ==
          lab.person.named[i]);
  }
  REQUIRE(lab.events.traces.size() == 5);
  for (const record::Event& stored : lab.all(record::EventKind::trace_stored)) {
    const record::TraceBody body =
        record::from_json<record::TraceBody>(as_recorded(stored, lab.participant_key).body);
    CHECK(body.samples == 500);
    REQUIRE(body.servo);
    CHECK(body.servo->lost == 0);
    CHECK(body.servo->held == 0);
    const record::TrialMeasures measures =
        record::measures_from_json(record::unsealed(stored, lab.participant_key).value());
    CHECK(measures.contact_s > 0.3);
    CHECK(measures.limited_ticks);
  }
  CHECK(lab.person.samples() == 500);
  CHECK(lab.cable.last_was_zero);
  CHECK(lab.cable.strong_writes > 5 * 300);
  const record::SessionOpening opening =
      record::from_json<record::SessionOpening>(lab.events.events.front().body);
  REQUIRE(opening.station);
  CHECK(opening.station->model == "Fake One");
  CHECK(opening.station->scheduling == "other, memory not locked");
}

TEST_CASE("unplugging the cable interrupts a trial, which is repeated at the end") {
  Laboratory lab;
  lab.cable.pull_at_tick = 200;
  const session::SessionTally tally = lab.run();
  CHECK(tally.presentations == 6);
  CHECK(lab.cable.opened == 2);
  CHECK(lab.helper.consents == 2);
  CHECK(lab.cable.writes_unarmed == 0);
  CHECK(lab.cable.last_was_zero);
  CHECK(lab.all(record::EventKind::answered).size() == 5);
  CHECK(lab.all(record::EventKind::paused).size() == 1);
  const std::vector<record::Event> interrupted = lab.all(record::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const auto body = record::from_json<record::InterruptedBody>(interrupted.front().body);
  CHECK(body.reason == "device lost");
  CHECK(record::from_json<record::TrialBody>(lab.all(record::EventKind::presented).back().body)
            .trial == body.trial);
}

TEST_CASE("the flight record of an interruption is sealed and holds the ticks before it") {
  Laboratory lab;
  lab.cable.pull_at_tick = 200;
  lab.run();
  const record::Event event = lab.all(record::EventKind::interrupted).front();
  CHECK(event.body.find("link") != std::string::npos);
  CHECK(event.body.find("flight") == std::string::npos);
  CHECK_FALSE(record::unsealed(event, SecretKey{}));
  const record::InterruptionDetail detail = record::from_json<record::InterruptionDetail>(
      record::unsealed(event, lab.participant_key).value());
  CHECK(detail.safety_fault == "device");
  CHECK(detail.device_fault == "link_lost");
  CHECK(detail.ticks == 201);
  CHECK(std::ranges::count(detail.flight, '\n') == 202);
  CHECK(detail.flight.substr(0, 12) == "tick,time_s,");
}

TEST_CASE("a session ends when the attendant gives up on the device") {
  Laboratory lab;
  lab.cable.pull_at_tick = 200;
  lab.helper.gives_up = true;
  lab.run();
  CHECK(lab.session.phase() == session::SessionPhase::closed);
  CHECK(lab.all(record::EventKind::stopped).size() == 1);
  CHECK(lab.all(record::EventKind::answered).empty());
  CHECK_FALSE(record::from_json<record::ClosedBody>(lab.events.events.back().body).complete);
}

/// Servo time that stands still from one tick on until it is told to go on.
class GateClock final : public device::ServoClock {
 public:
  GateClock(std::atomic<bool>& open, Time gate) : open_(open), gate_(gate) {}
  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    while (time >= gate_ && !open_.load()) std::this_thread::yield();
    now_ = std::max(now_, time);
  }

 private:
  std::atomic<bool>& open_;
  Time gate_;
  Time now_{};
};

session::RealTimeOptions gated(std::atomic<bool>& gate) {
  session::RealTimeOptions options = as_fast_as_it_goes();
  options.clock = [&gate] {
    return std::make_unique<GateClock>(gate, std::chrono::milliseconds(100));
  };
  return options;
}

/// A participant who acts on the servo while its time stands still, in every exploration or only in
/// the first.
class Acting final : public PersonAtStation {
 public:
  using Act = std::function<void(device::ServoControl&)>;
  Acting(Laboratory& lab, std::atomic<bool>& gate, bool once, Act act)
      : PersonAtStation(lab.station, lab.device), gate_(gate), once_(once), act_(std::move(act)) {}

  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    gate_ = false;
    return PersonAtStation::begin_exploring(plane);
  }
  void while_exploring(device::ServoControl& servo) override {
    if (!once_ || !acted_) act_(servo);
    acted_ = true;
    gate_ = true;
  }

 private:
  std::atomic<bool>& gate_;
  bool once_;
  bool acted_ = false;
  Act act_;
};

TEST_CASE("a participant who is done ends the exploration before its time is up") {
  std::atomic<bool> gate{false};
  Laboratory lab(gated(gate));
  Acting person(lab, gate, false, [](device::ServoControl& servo) { servo.finish(); });
  lab.run(person);
  CHECK(lab.all(record::EventKind::answered).size() == 5);
  CHECK(lab.all(record::EventKind::timed_out).empty());
  for (const record::Event& stored : lab.all(record::EventKind::trace_stored)) {
    const record::Event recorded = as_recorded(stored, lab.participant_key);
    CHECK(record::from_json<record::TraceBody>(recorded.body).samples <= 201);
  }
}

TEST_CASE("a comfort stop interrupts the trial, and force requires new consent") {
  std::atomic<bool> gate{false};
  Laboratory lab(gated(gate));
  Acting person(lab, gate, true, [](device::ServoControl& servo) { servo.comfort_stop(); });
  lab.run(person);
  const std::vector<record::Event> interrupted = lab.all(record::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  CHECK(record::from_json<record::InterruptedBody>(interrupted.front().body).reason ==
        "comfort stop");
  CHECK(lab.cable.opened == 1);
  CHECK(lab.helper.consents == 2);
  CHECK(lab.cable.writes_unarmed == 0);
  CHECK(lab.all(record::EventKind::answered).size() == 5);
}

/// A participant whose servo stands still in each exploration until the experimenter opens the
/// gate.
class Waiting final : public PersonAtStation {
 public:
  Waiting(Laboratory& lab, std::atomic<bool>& gate)
      : PersonAtStation(lab.station, lab.device), gate_(gate) {}
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    gate_ = false;
    return PersonAtStation::begin_exploring(plane);
  }

 private:
  std::atomic<bool>& gate_;
};

/// Pauses the first exploration, and goes on at once.
class Pausing final : public session::Experimenter {
 public:
  explicit Pausing(std::atomic<bool>& gate) : gate_(gate) {}
  void show(const session::SessionStatus& status) override { stage_ = status.stage; }
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override {
    using Kind = session::ExperimenterRequest::Kind;
    if (stage_ == "exploring" && !std::exchange(has_paused_, true)) {
      return session::ExperimenterRequest{Kind::pause, "", ""};
    }
    gate_ = true;
    if (stage_ != "paused") return std::nullopt;
    return session::ExperimenterRequest{Kind::resume, "", ""};
  }

 private:
  std::atomic<bool>& gate_;
  std::string stage_;
  bool has_paused_ = false;
};

TEST_CASE("a pause while a plane is on repeats the trial, and is not counted as an interruption") {
  std::atomic<bool> gate{false};
  Laboratory lab(gated(gate));
  Waiting person(lab, gate);
  Pausing experimenter(gate);
  const session::SessionTally tally = lab.run(person, experimenter);
  CHECK(tally.presentations == 6);
  CHECK(lab.helper.consents == 1);
  const std::vector<record::Event> interrupted = lab.all(record::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const auto body = record::from_json<record::InterruptedBody>(interrupted.front().body);
  CHECK(body.reason == record::kPauseReason);
  const std::vector<record::Event> presented = lab.all(record::EventKind::presented);
  CHECK(record::from_json<record::TrialBody>(presented[0].body).trial == body.trial);
  CHECK(record::from_json<record::TrialBody>(presented[1].body).trial == body.trial);
  CHECK(lab.all(record::EventKind::answered).size() == 5);
  CHECK(lab.events.traces.size() == 5);
}

TEST_CASE("an emergency stop between two explorations applies to the next") {
  Laboratory lab;
  lab.explorer.control().emergency_stop();
  lab.run();
  const std::vector<record::Event> interrupted = lab.all(record::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const auto body = record::from_json<record::InterruptedBody>(interrupted.front().body);
  CHECK(body.trial == 1);
  CHECK(body.reason == "emergency stop");
  CHECK(lab.helper.consents == 2);
  CHECK(lab.all(record::EventKind::answered).size() == 5);
}

TEST_CASE("an error on the session's thread leaves the hand without force") {
  std::atomic<bool> gate{false};
  Laboratory lab(gated(gate));
  Acting person(lab, gate, true, [&](device::ServoControl&) {
    gate = true;
    throw std::runtime_error("the screen is gone");
  });
  CHECK_THROWS_WITH(lab.run(person), "the screen is gone");
  CHECK(lab.cable.last_was_zero);
}

TEST_CASE("a real-time session on the machine's own clock records how late its ticks were") {
  const TinyStudy study({.trials = R"({"repeats": 1})"});
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  simulation::SubjectModel subject{.explore_s = 0.2, .training_passes = 1};
  const simulation::FeltKnowledge knowledge = simulation::learn_by_feeling(
      simulation::LabelledFields(study.key(), source), subject, 3.3, 1, 1);
  simulation::identification::IdentifyingParticipant participant(subject, knowledge, 1, 1);
  session::RealTimeOptions patient;  // a paced clock, and the best scheduling available
  patient.watchdog_time = &still_time();
  session::RealTimeExplorer explorer(patient);
  session::SteadySessionClock clock;
  session::AlwaysReady devices;
  record::BufferedEvents events;
  session::Session session(
      study::make_order(study.key().study, study.key().draw_of(1, study::Draws::rehearsal)),
      study.key().study.trials, record::SessionRecorder(1, SecretKey{}, events));
  record::SessionOpening opening{.participant = "P001", .enrolment = 1};
  session.open(clock.now(), opening, "{}");
  const session::SessionTally tally =
      session::run_session(session, {study.key(), source, participant, clock, explorer, devices});
  CHECK(session.phase() == session::SessionPhase::closed);
  // Ticks that were not left out take 1 ms each: no clock runs faster.
  CHECK(tally.duration >= std::chrono::milliseconds(tally.ticks - 5));
  int traces = 0;
  for (const record::Event& event : events.events) {
    if (event.kind != record::EventKind::trace_stored) continue;
    const record::TraceBody body =
        record::from_json<record::TraceBody>(as_recorded(event, SecretKey{}).body);
    ++traces;
    REQUIRE(body.servo);
    CHECK(body.servo->rate_hz > 0.0);
    CHECK(body.servo->lateness_worst_us >= body.servo->lateness_p50_us);
    CHECK(body.servo->lateness_worst_us > 0.0);
    CHECK(body.servo->lost == 0);
    CHECK(body.samples >= 200);
  }
  CHECK(traces == 5);
}

/// Before each exploration, a hand that presses as told and strokes too slowly, until somebody has
/// seen it.
class SeenExplorer final : public session::Explorer {
 public:
  SeenExplorer(session::Explorer& inner, std::function<bool()> is_seen)
      : inner_(inner), is_seen_(std::move(is_seen)) {}

  [[nodiscard]] bool in_real_time() const noexcept override { return true; }
  [[nodiscard]] session::Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                             session::Participant& participant,
                                             const device::ServoOptions& options,
                                             record::Trace& trace) override {
    constexpr double kMmATick = 0.02;
    for (std::int64_t tick = 0; tick < 1000; ++tick) {
      participant.feel({{kMmATick * static_cast<double>(tick), 4.0, -1.5}, {0.0, 0.0, 0.6}, tick});
    }
    device::ServoControl control;
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!is_seen_() && std::chrono::steady_clock::now() < give_up) {
      participant.while_exploring(control);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return inner_.explore(force, plane, participant, options, trace);
  }

 private:
  session::Explorer& inner_;
  std::function<bool()> is_seen_;
};

class HandWatcher final : public session::Experimenter {
 public:
  void show(const session::SessionStatus& status) override {
    if (status.hand) {
      seen = status.hand;
      stage = status.stage;
    }
    shown_last = status.hand;
  }

  std::optional<session::HandLevels> seen;
  std::string stage;
  std::optional<session::HandLevels> shown_last;
};

TEST_CASE("the experimenter sees force and speed of the hand while a plane is on, and only then") {
  Laboratory lab;
  HandWatcher watcher;
  SeenExplorer explorer(lab.explorer, [&] { return watcher.seen.has_value(); });
  REQUIRE(lab.station.make_ready() == session::SupplyState::ready);
  record::SessionOpening opening{.participant = "P001", .enrolment = 1};
  lab.session.open({}, opening, "{}");
  (void)session::run_session(lab.session, {.key = lab.study.key(),
                                           .source = lab.source,
                                           .participant = lab.person,
                                           .clock = lab.clock,
                                           .explorer = explorer,
                                           .devices = lab.station,
                                           .experimenter = watcher});
  REQUIRE(watcher.seen);
  CHECK(watcher.seen == session::HandLevels{session::HandLevel::right, session::HandLevel::low});
  CHECK(watcher.stage == "exploring");
  CHECK_FALSE(watcher.shown_last);
}

}  // namespace
}  // namespace touchtrial
