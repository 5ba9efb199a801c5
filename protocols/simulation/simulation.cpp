#include "protocols/simulation/simulation.hpp"

#include "protocols/session/session_runner.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/trial_course.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

namespace touchtrial::simulation {
namespace {

/// The maximum number of jobs. It may exceed the number of cores, but not by much, because the
/// system may refuse more threads.
int max_jobs() noexcept {
  constexpr unsigned kThreadsPerCore = 4;
  return static_cast<int>(kThreadsPerCore * std::max(1U, std::thread::hardware_concurrency()));
}

/// Read-only data shared by all sessions of a simulation.
struct Setting {
  const study::StudyKey& key;
  const session::StimulusSource& source;
  const Population& population;
  std::string device;  ///< recorded_device
  std::uint64_t seed;
  Digest seal;
};

/// A session, its participant and its visit.
struct Place {
  int session = 0;
  int number = 0;  ///< of the participant; also the enrolment number
  int visit = 1;
};

/// A session that is not stored yet.
struct FinishedSession {
  int visit = 1;
  record::BufferedEvents events;
  record::NewKeys keys;
  session::SessionTally tally;
};

std::string participant_id(int number) {
  constexpr std::size_t kDigits = 3;
  std::string digits = std::to_string(number);
  if (digits.size() < kDigits) digits.insert(0, kDigits - digits.size(), '0');
  return "P" + digits;
}

record::SessionOpening opening_of(const Setting& setting, const Place& place) {
  record::SessionOpening opening;
  opening.participant = participant_id(place.number);
  opening.enrolment = place.number;
  opening.visit = place.visit;
  const study::GroupPlan& groups = setting.key.study.groups;
  const auto group = setting.key.group_of(place.number, study::Draws::rehearsal);
  if (group && groups.open) opening.group = groups.labels[static_cast<std::size_t>(*group)];
  opening.study_id = setting.key.study_id;
  opening.seal = setting.seal;
  opening.device = setting.device;
  opening.simulated = true;
  return opening;
}

/// The key depends on the simulation's seed, so that it is reproducible, and on the study's secret.
SecretKey participant_key(const Setting& setting, const Place& place) {
  SeededEntropy entropy(setting.seed);
  const SecretKey seeded_key =
      entropy.secret("participant key of " + participant_id(place.number) +
                     (place.visit > 1 ? ", visit " + std::to_string(place.visit) : ""));
  return keyed_hash(setting.key.master, ByteView(seeded_key));
}

FinishedSession run_session(const Setting& setting, const Place& place) {
  FinishedSession finished{.visit = place.visit, .events = {}, .keys = {}, .tally = {}};
  const SecretKey key = participant_key(setting, place);
  const study::ScheduleDraw draw =
      setting.key.draw_of(place.number, study::Draws::rehearsal, place.visit);
  const study::Study& study = setting.key.study;
  auto order = study::make_order(study, draw);
  const study::Schedule schedule = order->schedule();
  session::Session session(std::move(order), study.trials,
                           record::SessionRecorder(place.session, key, finished.events),
                           session::block_serialiser(setting.key));
  session.open({}, opening_of(setting, place), study::schedule_to_json(schedule, setting.key));
  const std::unique_ptr<SimulatedParticipant> participant =
      setting.population.participant(place.number);
  participant->start_visit(place.visit, course_of(study, schedule));
  participant->follow(study::make_order(study, draw));
  finished.tally =
      session::run_session_in_virtual_time(session, setting.key, setting.source, *participant);
  finished.keys = record::wrap_participant_key(setting.key.investigator_box, place.session, key);
  return finished;
}

/// Stores sessions in the order of calls, and counts them and their presentations.
class Collector {
 public:
  /// \param sessions  total number of sessions, for progress
  Collector(record::StudyStore& store, const study::Progress& progress,
            const study::VisitPlan& visits, int sessions)
      : store_(store), progress_(progress), visits_(visits), sessions_(sessions) {
    const std::vector<record::Event> file_chain = store.events(0);
    if (!file_chain.empty()) at_ = file_chain.back().at;
  }

  void add(const FinishedSession& session) {
    // Virtual sessions follow each other without a gap, except for the days between visits.
    if (session.visit > visit_) {
      using Days = std::chrono::duration<double, std::ratio<86'400>>;
      at_ += std::chrono::ceil<std::chrono::nanoseconds>(Days(visits_.min_days));
    }
    visit_ = session.visit;
    at_ += session.tally.duration;
    store_.add_session(session.events, session.keys, at_);
    ++report_.sessions;
    report_.presentations += session.tally.presentations;
    report_.invalid_trials += session.tally.invalid_trials;
    report_.ticks += session.tally.ticks;
    if (progress_) progress_(report_.sessions, sessions_);
  }
  [[nodiscard]] const SimulationReport& report() const noexcept { return report_; }

 private:
  record::StudyStore& store_;
  const study::Progress& progress_;
  const study::VisitPlan& visits_;
  int sessions_;
  int visit_ = 1;
  std::chrono::nanoseconds at_{};
  SimulationReport report_;
};

void check(const SimulationOptions& options) {
  if (options.participants < 1 || options.jobs < 1 || options.first_participant < 1) {
    throw std::invalid_argument(
        "simulate_study: participants, jobs and first participant start at 1");
  }
}

/// Runs sessions in parallel and stores them by visit and, within a visit, by participant. No
/// exception leaves a filter, because oneTBB would leak the sessions in flight.
void run_sessions(const Setting& setting, const SimulationOptions& options, int first_session,
                  int sessions, Collector& collector) {
  int started = 0;
  std::exception_ptr fault;
  std::atomic<bool> has_fault = false;
  const auto next = [&](tbb::flow_control& flow) {
    if (has_fault || started == sessions) flow.stop();
    return started++;
  };
  struct Outcome {
    FinishedSession session;
    std::exception_ptr fault;
  };
  using OutcomePointer = std::shared_ptr<Outcome>;
  const auto run = [&](int i) -> OutcomePointer {
    const auto outcome = std::make_shared<Outcome>();
    try {
      const Place place{first_session + i, options.first_participant + i % options.participants,
                        1 + i / options.participants};
      outcome->session = run_session(setting, place);
    } catch (...) {
      outcome->fault = std::current_exception();
    }
    return outcome;
  };
  const auto store = [&](const OutcomePointer& outcome) {
    if (fault) return;
    fault = outcome->fault;
    try {
      if (!fault) collector.add(outcome->session);
    } catch (...) {
      fault = std::current_exception();
    }
    has_fault = fault != nullptr;
  };
  const auto in_order = tbb::filter_mode::serial_in_order;
  const auto pipeline = tbb::make_filter<void, int>(in_order, next) &
                        tbb::make_filter<int, OutcomePointer>(tbb::filter_mode::parallel, run) &
                        tbb::make_filter<OutcomePointer, void>(in_order, store);
  const int jobs = std::min(options.jobs, max_jobs());
  const auto threads = static_cast<std::size_t>(jobs);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(jobs);
  arena.execute([&] { tbb::parallel_pipeline(2 * threads, pipeline); });
  if (fault) std::rethrow_exception(fault);
}

}  // namespace

SimulationReport simulate_study(const study::StudyKey& key, const engine::Pack& pack,
                                const SubjectModel& subject, const SimulationOptions& options,
                                record::StudyStore& store, const study::Progress& progress) {
  check(options);
  const session::StimulusSource source(pack, key);
  const std::unique_ptr<const Population> population =
      population_of({key, source, subject, options.seed, options.jobs});
  const Setting setting{key, source, *population, recorded_device(subject), options.seed, key.seal};
  const int sessions = options.participants * key.study.visits.count;
  Collector collector(store, progress, key.study.visits, sessions);
  run_sessions(setting, options, store.next_session(), sessions, collector);
  SimulationReport report = collector.report();
  report.device = setting.device;
  return report;
}

}  // namespace touchtrial::simulation
