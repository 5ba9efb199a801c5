// Whole sessions, each interrupted at one commit by a kill or a power cut, then resumed and
// finished.
#include "core/random.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/resting_stylus.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "record/noting_sink.hpp"
#include "record/study_store.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"
#include "support/fault_vfs.hpp"

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace touchtrial {
namespace {

using testing::DiskOperation;
using testing::Fault;
using testing::FaultVfs;
using Access = record::StudyStore::Access;
using Kind = Fault::Kind;

constexpr int kTrials = 25;

/// Names one picture after the other.
class Restless final : public simulation::PromptParticipant {
 public:
  explicit Restless(int first) : next_(first) {}

  void see_pictures(const std::vector<std::string>&) override {}
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry&) override {
    stylus_ = RestingStylus(40);
    return stylus_;
  }
  void feel(const device::ServoSample&) noexcept override {}
  [[nodiscard]] simulation::ParticipantAnswer answer() override {
    return {next_++ % 5, std::chrono::seconds(1)};
  }

 private:
  int next_;
  RestingStylus stylus_{40};
};

/// The study, and a database of it without sessions; made once.
struct Laboratory {
  Laboratory() {
    static_cast<void>(record::StudyStore::create(
        empty, session::commitment_of(study.key(), study.pack(), true, false),
        std::chrono::seconds(1), study.key().signer()));
  }
  TinyStudy study{{.side_px = 120, .trials = R"({"repeats": 5, "rove_db": 20})"}};
  session::StimulusSource source{study.pack(), study.key().study.rendering};
  SecretKey participant_key = sha256(bytes_of("participant"));
  std::filesystem::path empty = study.next_database();
};

Laboratory& laboratory() {
  static Laboratory laboratory;
  return laboratory;
}

/// One session in its own database, over several starts of the program.
struct KilledSession {
  KilledSession() : path(laboratory().study.next_database()) {
    std::filesystem::copy_file(laboratory().empty, path);
  }
  ~KilledSession() { std::filesystem::remove(path); }
  KilledSession(const KilledSession&) = delete;
  KilledSession& operator=(const KilledSession&) = delete;

  /// Starts the program, which runs a new session, or the open one, to its end.
  /// \return whether it reached its end
  bool start() try {
    ++starts;
    record::StudyStore store = record::StudyStore::open(path, Access::read_write);
    store.sign_with(laboratory().study.key().signer());
    const std::optional<record::SessionRow> row = store.session_of("P001");
    if (row && row->state != record::SessionState::open) return true;  // ended, but not reported
    run(store, row.has_value());
    return true;
  } catch (const StoreError&) {
    return false;
  }

  std::filesystem::path path;
  std::vector<record::Event> acknowledged;
  int starts = 0;

 private:
  void run(record::StudyStore& store, bool again) {
    Laboratory& lab = laboratory();
    const study::StudyKey& key = lab.study.key();
    const record::NewKeys wrapped =
        record::wrap_participant_key(key.investigator_box, 1, lab.participant_key);
    NotingSink sink(again ? store.continue_session(1) : store.begin_session(1, wrapped),
                    acknowledged);
    auto order = study::make_order(key.study, key.draw_of(1, study::Draws::rehearsal));
    const std::string schedule = study::schedule_to_json(order->schedule(), key);
    session::Session session(std::move(order), key.study.trials,
                             record::SessionRecorder(1, lab.participant_key, sink));
    session::VirtualSessionClock clock;
    if (again) {
      session.restore(as_recorded(store.events(1), lab.participant_key));
      clock = session::VirtualSessionClock(session.last() + std::chrono::seconds(30));
      session.resume_after_exit(clock.now(), {.after = "program-ended", .away_s = 30.0});
    } else {
      session.open({}, opening(), schedule);
    }
    Restless participant(starts);
    session::VirtualExplorer explorer;
    session::AlwaysReady devices;
    session::run_session(session, {key, lab.source, participant, clock, explorer, devices});
  }

  static record::SessionOpening opening() {
    const study::StudyKey& key = laboratory().study.key();
    record::SessionOpening opening{.participant = "P001",
                                   .enrolment = 1,
                                   .study_id = key.study_id,
                                   .seal = study::study_seal(key),
                                   .device = "simulated",
                                   .simulated = true};
    return opening;
  }
};

/// Requires that every acknowledged event is stored once, as it was acknowledged.
void require_kept(const std::vector<record::Event>& stored,
                  const std::vector<record::Event>& acknowledged) {
  for (const record::Event& event : acknowledged) {
    REQUIRE(event.sequence < static_cast<std::int64_t>(stored.size()));
    REQUIRE(stored[static_cast<std::size_t>(event.sequence)].hash == event.hash);
  }
}

/// Requires that the stylus felt the plane at its own roved gain. The servo's ramp at the beginning
/// scales the whole force, which keeps its direction.
void require_felt(const record::StudyStore& store, const study::Trial& shown) {
  const Laboratory& lab = laboratory();
  const auto box = store.sealed_trace(1, shown.place.trial);
  REQUIRE(box);
  const record::Trace trace = record::unsealed_trace(*box, lab.participant_key).value();
  const auto strongest = std::ranges::max_element(
      trace.samples, {}, [](const record::TraceSample& sample) { return norm(sample.force_n); });
  const Vec3 felt_n = strongest->force_n;
  engine::Bristle touch;
  const Vec3 wanted_n =
      lab.source.model(lab.study.key().code_of(shown.field()), shown.planes.front().gain_db)
          .force_n(strongest->position_mm, {}, touch);
  REQUIRE(std::hypot(wanted_n.x, wanted_n.y) > 0.0);
  REQUIRE(norm((1.0 / norm(felt_n)) * felt_n - (1.0 / norm(wanted_n)) * wanted_n) < 0.01);
}

/// Requires 25 answers, five for each class, and an intact chain.
void require_complete(const KilledSession& session) {
  const record::StudyStore store = record::StudyStore::open(session.path, Access::read_only);
  REQUIRE_FALSE(store.first_fault());
  REQUIRE(store.sessions().size() == 1);
  REQUIRE(store.sessions().at(0).state == record::SessionState::completed);
  require_kept(store.events(1), session.acknowledged);
  std::map<int, int> class_of_trial;
  for (const study::Trial& one :
       study::make_schedule(laboratory().study.key().study,
                            laboratory().study.key().draw_of(1, study::Draws::rehearsal))
           .trials) {
    class_of_trial[one.place.trial] = one.field().class_index;
    require_felt(store, one);
  }
  std::map<int, int> answered;
  for (const record::TrialRow& trial : store.trials()) {
    REQUIRE(trial.state == record::TrialState::answered);
    ++answered[class_of_trial.at(trial.trial)];
  }
  REQUIRE(store.trials().size() == kTrials);
  for (int class_index = 0; class_index < 5; ++class_index) REQUIRE(answered[class_index] == 5);
  int answers = 0;
  store.for_each(record::EventKind::answered, [&](const record::Event&) { ++answers; });
  REQUIRE(answers == kTrials);
}

/// Interrupts a session once, resumes it, and finishes it.
/// \return whether the fault occurred
bool is_finished_after(FaultVfs& vfs, const Fault& fault) {
  INFO("kind " << static_cast<int>(fault.kind) << " at " << fault.at);
  KilledSession session;
  vfs.plan(fault);
  const bool ended = session.start();
  if (!vfs.has_occurred()) return false;
  vfs.restore_disk();
  {
    const record::StudyStore store = record::StudyStore::open(session.path, Access::read_only);
    REQUIRE_FALSE(store.first_fault());
    require_kept(store.events(1), session.acknowledged);
  }
  // A fault while the file is closed comes when everything is done.
  REQUIRE((ended || session.start()));
  require_complete(session);
  return true;
}

/// \return how many commits there are
std::int64_t end_at_every_commit(Kind kind) {
  FaultVfs vfs;
  Fault fault{
      .kind = kind, .at = 1, .only = DiskOperation::sync, .is_persistent = false, .seed = 3};
  while (is_finished_after(vfs, fault)) ++fault.at;
  return fault.at - 1;
}

TEST_CASE("a session killed at any of its commits is resumed, complete and balanced") {
  // Four events a trial, two of them together, and those before and after.
  REQUIRE(end_at_every_commit(Kind::kill) > 3 * kTrials);
}

TEST_CASE(
    "a session whose power is cut at any of its commits is complete and balanced in the end") {
  REQUIRE(end_at_every_commit(Kind::power_cut) > 3 * kTrials);
  REQUIRE(end_at_every_commit(Kind::torn_power_cut) > 3 * kTrials);
}

TEST_CASE("a session that is ended over and over loses and doubles nothing") {
  FaultVfs vfs;
  constexpr std::array kKinds = {Kind::kill, Kind::torn_kill, Kind::power_cut,
                                 Kind::torn_power_cut};
  RandomStream random(5, "ended over and over");
  int ends = 0;
  for (int i = 0; i < 12; ++i) {
    KilledSession session;
    for (bool ended = false; !ended;) {
      const auto at = static_cast<std::int64_t>(1 + random.below(400));
      vfs.plan({.kind = kKinds[random.below(kKinds.size())],
                .at = at,
                .only = {},
                .is_persistent = false,
                .seed = random.bits()});
      ended = session.start();
      if (!vfs.has_occurred()) continue;
      ++ends;
      vfs.restore_disk();
    }
    require_complete(session);
  }
  REQUIRE(ends > 24);
}

}  // namespace
}  // namespace touchtrial
