/// Whoever has a blind study's database, and no key and no station's file, finds nothing in it by
/// which presentations of one stimulus are more alike than others.
#include "protocols/session/commitment.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/clear_features.hpp"
#include "protocols/simulation/confusion_of.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "record/payload_json.hpp"
#include "study/prepare.hpp"

namespace touchtrial {
namespace {

// The people. Each presentation has one of five textures, the first much rougher than the others
// and often at the force limit, or none.

constexpr int kPeople = 128;
constexpr double kExploreLimitS = 10.0;

int stimulus_of(const study::Trial& trial) {
  const bool is_blank = trial.role == study::Role::catch_trial;
  return is_blank ? kStimuli - 1 : trial.field().class_index;
}

/// Somebody who is mostly right, and differs from texture to texture in how long they explore and
/// think. Or, every second person, somebody at the edges of the hand's windows, who explores hardly
/// long enough and far enough, and in part too lightly and too slowly.
class Person final : public simulation::PromptParticipant {
 public:
  Person(int number, const study::Schedule& schedule)
      : schedule_(schedule), random_(20, "person", static_cast<std::uint64_t>(number)) {
    is_at_the_edge_ = number % 2 == 0;
    const double own = random_.uniform();
    subject_.explore_s = is_at_the_edge_ ? 5.1 + 0.5 * own : 6.8 + 0.6 * own;
    if (!is_at_the_edge_) return;
    if (number % 4 == 0) return;
    subject_.push_n = 0.15 + 0.1 * own;
    subject_.slowest_mm_s = 45.0;
    subject_.fastest_mm_s = 105.0;
  }

  void see_pictures(const std::vector<std::string>&) override {}
  void feel(const device::ServoSample&) noexcept override {}
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    stimulus_ = stimulus_of(schedule_.trials.at(begun_++));
    simulation::SubjectModel subject = subject_;
    if (!is_at_the_edge_) {
      subject.explore_s *= (0.92 + 0.032 * stimulus_) * std::exp(0.04 * random_.normal());
    }
    return hand_.emplace(simulation::make_exploring_hand(subject, plane, random_));
  }
  [[nodiscard]] simulation::ParticipantAnswer answer() override {
    const auto choices = static_cast<int>(schedule_.layout.size());
    const bool knows = stimulus_ < choices && random_.uniform() < 0.75;
    const auto guess = static_cast<int>(random_.below(static_cast<std::uint64_t>(choices)));
    const auto found = std::ranges::find(schedule_.layout, stimulus_);
    const double thought_s = (1.0 + 0.2 * stimulus_) * std::exp(0.3 * random_.normal());
    return {knows ? static_cast<int>(found - schedule_.layout.begin()) : guess,
            std::chrono::nanoseconds(std::llround(1e9 * thought_s))};
  }

 private:
  const study::Schedule& schedule_;
  RandomStream random_;
  simulation::SubjectModel subject_;
  bool is_at_the_edge_ = false;
  std::size_t begun_ = 0;
  int stimulus_ = 0;
  std::optional<device::SimulatedHand> hand_;
};

/// Virtual time, with the health of a servo whose ticks are late by chance, 20 us on average, and
/// one of 20,000 too late.
class LateExplorer final : public session::Explorer {
 public:
  explicit LateExplorer(int number) : random_(21, "servo", static_cast<std::uint64_t>(number)) {}

  [[nodiscard]] session::Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                             session::Participant& participant,
                                             const device::ServoOptions& options,
                                             record::Trace& trace) override {
    session::Exploration done = virtual_.explore(force, plane, participant, options, trace);
    const auto ticks = static_cast<double>(done.servo.ticks);
    const auto quantile_us = [&](double p) {
      const double error = std::sqrt(p / (ticks * (1.0 - p))) * random_.normal();
      return kMeanUs * (error - std::log(1.0 - p));
    };
    for (std::int64_t tick = 0; tick < done.servo.ticks; ++tick) {
      done.servo.overruns += random_.below(20'000) == 0 ? 1 : 0;
    }
    done.health = record::ServoHealth{
        .rate_hz = 1000.0 + kMeanUs * random_.normal() / ticks,
        .lateness_p50_us = quantile_us(0.5),
        .lateness_p99_us = quantile_us(0.99),
        .lateness_p999_us = quantile_us(0.999),
        .lateness_worst_us = -kMeanUs * std::log1p(-std::pow(random_.uniform(), 1.0 / ticks)),
        .lost = 0,
        .held = done.servo.overruns};
    return done;
  }

 private:
  static constexpr double kMeanUs = 20.0;
  session::VirtualExplorer virtual_;
  RandomStream random_;
};

void run_session(const study::StudyKey& study, const session::StimulusSource& source, int number,
                 record::StudyStore& store) {
  record::BufferedEvents events;
  const SecretKey key = SeededEntropy(22).secret("participant " + std::to_string(number));
  auto order = study::make_order(study.study, study.draw_of(number, study::Draws::rehearsal));
  const study::Schedule schedule = order->schedule();
  session::Session session(std::move(order), study.study.trials,
                           record::SessionRecorder(number, key, events));
  record::SessionOpening opening{.participant = "P" + std::to_string(number),
                                 .enrolment = number,
                                 .study_id = study.study_id,
                                 .seal = study.seal,
                                 .device = "simulated",
                                 .simulated = true};
  session.open({}, opening, study::schedule_to_json(schedule, study));
  Person person(number, schedule);
  session::VirtualSessionClock clock;
  LateExplorer explorer(number);
  session::AlwaysReady devices;
  static_cast<void>(
      session::run_session(session, {study, source, person, clock, explorer, devices}));
  store.add_session(events, record::wrap_participant_key(study.investigator_box, number, key), {});
}

/// What the key opens, and what would link presentations if it were in clear.
struct Truth {
  std::vector<int> stimuli;
  Features leaks;
};

Truth opened(const record::StudyStore& store, const study::StudyKey& key) {
  Truth truth;
  constexpr int kMeasuredPeople = 16;
  for (const record::SessionRow& session : store.sessions()) {
    const SecretKey own = key_of_session(store, key, session.session);
    for (const study::Trial& shown : schedule_of_session(store, key, session.session).trials) {
      truth.stimuli.push_back(stimulus_of(shown));
    }
    for (const record::Event& stored : store.events(session.session)) {
      if (stored.kind != record::EventKind::trace_stored) continue;
      const record::OpenedEvent event = record::opened_event(stored, own).value();
      const record::TraceBody body = record::from_json<record::TraceBody>(event.event.body);
      const record::TrialMeasures measures = record::measures_from_json(event.secret);
      truth.leaks["exact length"].push_back(static_cast<double>(body.samples));
      const double length_s = static_cast<double>(body.samples) / 1e3;
      truth.leaks["whole seconds"].push_back(std::ceil(length_s));
      // Of people who take up to three times as long as these.
      const double slowness = 1.0 + 0.125 * (session.session % 16);
      truth.leaks["steps of 5 s"].push_back(std::ceil(slowness * length_s / 5.0));
      truth.leaks["steps of 15 s"].push_back(std::ceil(slowness * length_s / 15.0));
      truth.leaks["saturated"].push_back(body.saturated ? 1.0 : 0.0);
      truth.leaks["rms force"].push_back(measures.force_rms_n);
      truth.leaks["contact by force"].push_back(measures.contact_s);
      double bytes = 0.0;
      if (session.session <= kMeasuredPeople) {
        const auto box = store.sealed_trace(session.session, body.trial).value();
        bytes = static_cast<double>(
            record::encode_trace(record::unsealed_trace(box, own).value()).size());
      }
      truth.leaks["bytes without padding"].push_back(bytes);
    }
  }
  for (const record::TrialRow& row : opened_trials(store, key)) {
    truth.leaks["answer"].push_back(position_of(row.answer).value());
    const std::chrono::duration<double> took = row.answered_at.value() - row.presented_at;
    truth.leaks["time of the answer"].push_back(took.count());
  }
  return truth;
}

struct Findings {
  std::map<std::string, double> in_clear;  ///< probabilities, by feature
  std::set<std::string> sealed_links;
};

/// Runs a study, and looks at its database without and with the key.
Findings findings_of(const study::StudyKey& study, const engine::Pack& pack,
                     const std::filesystem::path& path) {
  REQUIRE(study.study.trials.explore_limit_s == kExploreLimitS);
  const session::StimulusSource source(pack, study.study.rendering);
  Truth truth;
  {
    record::StudyStore store = record::StudyStore::create(
        path, session::commitment_of(study, pack, true, false), {}, study.signer());
    for (int number = 1; number <= kPeople; ++number) run_session(study, source, number, store);
    truth = opened(store, study);
  }
  REQUIRE(truth.stimuli.size() == kPeople * kPresentations);
  Findings findings{probabilities(features_in_clear(path), truth.stimuli), {}};
  const std::map<std::string, double> sealed = probabilities(truth.leaks, truth.stimuli);
  findings.sealed_links = links(sealed);
  for (const auto& [name, p] : findings.in_clear) {
    UNSCOPED_INFO("in clear: " << name << ", p = " << p);
  }
  for (const auto& [name, p] : sealed) UNSCOPED_INFO("sealed: " << name << ", p = " << p);
  CHECK(links(findings.in_clear).empty());
  return findings;
}

TEST_CASE("nothing in clear links presentations of a texture at the force limit, or of none") {
  TinyStudy study({.first_gain = 4.0,
                   .trials = R"({"repeats": 4, "catch": 5, "explore_limit_s": 10})",
                   .rendering = R"({"max_force_n": 1.2})"});
  const std::filesystem::path path = study.next_database();
  const Findings found = findings_of(study.key(), study.pack(), path);
  // The same test finds everything that is sealed because it would tell.
  CHECK(found.sealed_links == std::set<std::string>{"answer", "bytes without padding",
                                                    "contact by force", "exact length", "rms force",
                                                    "saturated", "steps of 15 s", "steps of 5 s",
                                                    "time of the answer", "whole seconds"});
  // People at the edges of the windows are outside in some trials.
  for (const std::string window : {"contact_ok", "path_ok", "force_ok", "speed_ok"}) {
    INFO(window);
    CHECK(found.in_clear.contains("trace-stored/" + window));
  }
  SQLite::Database database(path.string(), SQLite::OPEN_READONLY);
  SQLite::Statement sizes(database,
                          "SELECT kind FROM events WHERE session > 0 GROUP BY kind "
                          "HAVING count(DISTINCT length(sealed)) > 1");
  CHECK_FALSE(sizes.executeStep());  // nor do sizes tell layouts or schedules
}

TEST_CASE("nothing in clear links presentations of the default study") {
  const TempFolder folder;
  study::Study study = study::load_study(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config" /
                                         "classification.json");
  study.trials.explore_limit_s = kExploreLimitS;
  study.trials.practice = 0;
  SeededEntropy entropy(1);
  const study::StudyKey key = study::make_study_key(study, entropy, true);
  study::prepare_pack(key, folder.path() / "default.sim.pack");
  const engine::Pack pack(folder.path() / "default.sim.pack");
  const Findings found = findings_of(key, pack, folder.path() / "default.db");
  CHECK(found.sealed_links == std::set<std::string>{"answer", "bytes without padding",
                                                    "contact by force", "exact length", "rms force",
                                                    "steps of 15 s", "steps of 5 s",
                                                    "time of the answer", "whole seconds"});
}

}  // namespace
}  // namespace touchtrial
