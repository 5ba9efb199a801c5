#include "protocols/session/whole_session.hpp"

#include "analysis/outcomes/sealed_sessions.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/instruments.hpp"
#include "record/payload_json.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace touchtrial {
namespace {

constexpr std::chrono::nanoseconds kUtc = std::chrono::seconds(1'700'000'000);

/// A lab's instruments that are a serial line alone.
class MarkedLine final : public session::Instruments {
 public:
  explicit MarkedLine(const device::MarkerLineSettings& settings) : line_(settings) {}

  /// The servo's time, by which a contact is dated, may run ahead of the line's in a test.
  void mark(Mark mark, int trial, TimePoint at) noexcept override {
    line_.send(static_cast<int>(mark), trial, std::min(at, TimePoint::clock::now()));
  }
  void feel(const device::ServoSample&, TimePoint) noexcept override {}
  [[nodiscard]] Report take() override {
    Report report;
    for (const device::SentMarker& sent : line_.take()) report.latencies.push_back(sent.latency);
    return report;
  }

 private:
  device::MarkerLine line_;
};

simulation::SubjectModel quick_subject(double explore_s) {
  return {.explore_s = explore_s, .training_passes = 4};
}

}  // namespace

WholeSession::WholeSession(int repeats, double explore_s)
    : study{{.side_px = 200,
             .trials = R"({"explore_limit_s": 20, "repeats": )" + std::to_string(repeats) + "}"}},
      store(record::StudyStore::create(
          study.next_database(), session::commitment_of(study.key(), study.pack(), false, false),
          kUtc, study.key().signer())),
      subject(quick_subject(explore_s)),
      knowledge(simulation::learn_by_feeling(simulation::LabelledFields(study.key(), source),
                                             subject, 3.3, 5, 1)) {
  instrument.settings.format = device::MarkerFormat::text;
}

session::SessionTally WholeSession::run(session::DeviceStation& station,
                                        session::Participant& person,
                                        session::RealTimeExplorer& explorer,
                                        session::Experimenter& experimenter) {
  while (station.make_ready() != session::SupplyState::ready) {
  }
  const std::unique_ptr<record::EventSink> sink = store.begin_session(
      1, record::wrap_participant_key(study.key().investigator_box, 1, participant_key),
      [] { return kUtc; });
  auto order =
      study::make_order(study.key().study, study.key().draw_of(1, study::Draws::rehearsal));
  const std::string schedule = study::schedule_to_json(order->schedule(), study.key());
  session::Session session(std::move(order), study.key().study.trials,
                           record::SessionRecorder(1, participant_key, *sink));
  record::SessionOpening opening{.participant = "P001",
                                 .enrolment = 1,
                                 .study_id = study.key().study_id,
                                 .seal = study::study_seal(study.key())};
  session::describe_station(opening, station.info(), explorer.scheduling(), device::kServoRateHz,
                            "");
  session.open({}, opening, schedule);
  session::VirtualSessionClock clock;
  MarkedLine line(instrument.settings);
  return session::run_session(session, {.key = study.key(),
                                        .source = source,
                                        .participant = person,
                                        .clock = clock,
                                        .explorer = explorer,
                                        .devices = station,
                                        .experimenter = experimenter,
                                        .instruments = &line});
}

std::vector<record::Event> WholeSession::all(record::EventKind kind) const {
  std::vector<record::Event> found;
  store.for_each(kind, [&](const record::Event& event) { found.push_back(event); });
  return found;
}

record::InterruptionDetail WholeSession::check(const std::vector<int>& named, int unlucky) {
  std::vector<int> stored;
  for (const record::Event& event : all(record::EventKind::answered)) {
    const record::Event answer = as_recorded(event, participant_key);
    stored.push_back(
        position_of(record::from_json<record::AnswerBody>(answer.body).answer).value());
  }
  CHECK(stored == named);

  const std::vector<record::Event> interrupted = all(record::EventKind::interrupted);
  REQUIRE(interrupted.size() == 1);
  const auto body = record::from_json<record::InterruptedBody>(interrupted[0].body);
  CHECK(body.trial == unlucky);
  CHECK(body.reason == "device lost");
  CHECK(record::from_json<record::TrialBody>(all(record::EventKind::presented).back().body).trial ==
        unlucky);
  CHECK(all(record::EventKind::paused).size() == 1);
  check_codes(unlucky);

  record::InterruptionDetail detail = record::from_json<record::InterruptionDetail>(
      analysis::open_event(interrupted[0], participant_key).secret);
  CHECK(detail.device_fault == "link_lost");
  return detail;
}

/// The codes are those of docs/running-sessions.md.
void WholeSession::check_codes(int unlucky) {
  std::string expected = "E1 T0\n";
  bool is_lost = false;
  for (const record::Event& event : all(record::EventKind::presented)) {
    const int trial = record::from_json<record::TrialBody>(event.body).trial;
    const std::string of_trial = " T" + std::to_string(trial) + "\n";
    expected += "E10" + of_trial + "E11" + of_trial;
    const bool is_answered = trial != unlucky || std::exchange(is_lost, true);
    expected +=
        is_answered ? "E12" + of_trial + "E20" + of_trial : "E30" + of_trial + "E40 T0\nE41 T0\n";
  }
  expected += "E2 T0\n";
  CHECK(codes_recorded() == expected);
  CHECK(instrument.read(expected.size()) == expected);
}

std::string WholeSession::codes_recorded() const {
  std::string codes;
  for (const record::Event& event : all(record::EventKind::marked)) {
    const record::MarksBody marks =
        record::from_json<record::MarksBody>(record::unsealed(event, participant_key).value());
    for (std::size_t i = 0; i < marks.codes.size(); ++i) {
      codes += "E" + std::to_string(marks.codes[i]) + " T" + std::to_string(marks.trials[i]) + "\n";
      CHECK(marks.latency_ns.at(i) > 0);
    }
  }
  return codes;
}

analysis::identification::StudyReport WholeSession::report() {
  CHECK_FALSE(store.first_fault());
  store.close_study(kUtc);
  store.unblind(kUtc, "planned", false);
  return analysis::identification::make_report(analysis::load_outcomes(store, study.key()));
}

}  // namespace touchtrial
