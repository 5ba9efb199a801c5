// A complete simulated study.
#include "app/commands/study_inputs.hpp"
#include "bench/rows.hpp"
#include "core/random.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/registration/registration.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/simulation.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "record/study_store.hpp"
#include "study/prepare.hpp"
#include "tests/support/temp_folder.hpp"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

namespace touchtrial::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kParticipants = 20;

/// \return the key of the shipped classification study: 25 trials of 10 s
study::StudyKey study_key(const fs::path& folder) {
  registration::register_protocols();
  study::StudyKey key = study::simulated_study_key(
      study::load_study(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/classification.json"));
  key.pack_folder = folder / "pack";
  study::prepare_pack(key, key.pack_folder, {});
  return key;
}

struct PreparedStudy {
  TempFolder folder{};
  study::StudyKey key = study_key(folder.path());
  engine::Pack pack{key.pack_folder};
};

const PreparedStudy& prepared_study() {
  static const PreparedStudy study;
  return study;
}

/// Simulates the study, with one transaction per session.
/// \return the database's bytes per trial
double simulate(int threads) {
  const PreparedStudy& study = prepared_study();
  const simulation::SubjectModel subject = app::subject_for({}, study.key.study, {});
  simulation::SimulationOptions options;
  options.participants = kParticipants;
  options.jobs = threads;
  const fs::path database = study.folder.path() / "study.db";
  fs::remove(database);
  int trials = 0;
  {
    record::StudyStore store = record::StudyStore::create(
        database, session::commitment_of(study.key, study.pack, true, false),
        std::chrono::nanoseconds(0), study.key.signer());
    trials =
        simulation::simulate_study(study.key, study.pack, subject, options, store).presentations;
  }
  return std::round(static_cast<double>(fs::file_size(database)) / trials);
}

/// Explores all trials of the study tick by tick with only the hand and the stimulus force: no
/// servo, limits, senses, traces, answers or training.
void explore_without_servo() {
  const study::StudyKey& key = prepared_study().key;
  const simulation::SubjectModel subject = app::subject_for({}, key.study, {});
  const session::StimulusSource source(prepared_study().pack, key);
  const simulation::SimulationOptions options;
  Vec3 sum_mm;
  for (int number = 1; number <= kParticipants; ++number) {
    const device::HandFactors factors =
        simulation::hand_of_participant(subject, options.seed, static_cast<std::uint64_t>(number));
    for (int trial = 1; trial <= key.study.scored_trials(); ++trial) {
      RandomStream random = simulation::stream_of_trial(
          options.seed, simulation::kExplorationPurpose, number, static_cast<std::uint64_t>(trial));
      device::SimulatedHand hand =
          simulation::make_exploring_hand(subject, source.plane(), random, factors);
      const auto stimulus = static_cast<std::size_t>(trial) % key.stimuli.size();
      session::ModelForce force(source.model(key.stimuli[stimulus].code));
      device::DeviceSample sample;
      while (hand.read(sample) == device::DeviceStatus::ok) {
        static_cast<void>(hand.write(force.force_n(sample)));
      }
      sum_mm = sum_mm + sample.position_mm;
    }
  }
  benchmark::DoNotOptimize(sum_mm);
}

/// Wall-clock time, because it includes the disk.
template <class Work>
Case study_case(const std::string& name, Work work, int threads = 1) {
  Case result = timed(
      name, [] { return &prepared_study(); }, [=](const PreparedStudy*) { work(); });
  result.clock = Clock::wall;
  result.threads = threads;
  result.is_slow = true;
  return result;
}

Case simulated_study(const std::string& name, int threads) {
  return study_case(
      name, [=] { simulate(threads); }, threads);
}

}  // namespace

Rows study_rows() {
  return {{.title = "study of 20 x 25 trials of 10 s, one thread",
           .ours = simulated_study("touchtrial", 1),
           .goal = {"us", 1e6}},
          {.title = "the same study against its 5 million ticks",
           .ours = simulated_study("touchtrial", 1),
           .peers = {study_case("hand and force only", explore_without_servo)},
           .goal = {"ratio", 2}},
          {.title = "the same study, two threads",
           .ours = simulated_study("touchtrial", 2),
           .peers = {simulated_study("one thread", 1)},
           .goal = {"ratio", 1.0 / 1.8}},
          {.title = "database, a trial of 10 s",
           .ours = counted("touchtrial", [] { return simulate(1); }),
           .goal = {"count", 100e3},
           .count_unit = "bytes"}};
}

}  // namespace touchtrial::bench
