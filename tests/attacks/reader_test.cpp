// Attacks by whoever wants to learn: what will be presented, or what somebody answered who has
// withdrawn since.
#include "analysis/outcomes/sealed_sessions.hpp"
#include "app/study_folder.hpp"
#include "attacks/forger.hpp"
#include "core/files.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;

namespace {

constexpr int kParticipants = 6;

/// The schedules of the study's first participants.
std::vector<study::Schedule> schedules_of(const study::Study& study, const study::Station& station,
                                          study::Draws draws) {
  std::vector<study::Schedule> schedules;
  for (int number = 1; number <= kParticipants; ++number) {
    schedules.push_back(
        study::make_schedule(study, study::draw_for(study, station, number, draws)));
  }
  return schedules;
}

/// Secrets that a small number gives: the number itself, its hash, and what a seeded generator
/// makes of it.
std::vector<SecretKey> secrets_of(std::uint64_t small) {
  SecretKey number{};
  for (std::size_t i = 0; i < 8; ++i) number[i] = static_cast<std::uint8_t>(small >> (8 * i));
  SeededEntropy entropy(small);
  return {number, sha256(bytes_of(std::to_string(small))), entropy.secret("station"),
          entropy.secret("touchtrial study key master")};
}

/// Keys that somebody has who took everything but copies from before a withdrawal.
std::vector<SecretKey> keys_in_reach(const AttackedStudy& study, const record::StudyStore& store) {
  const study::StudyKey& key = study.key();
  std::vector<SecretKey> keys = {key.master, key.box().secret_half, study.station().station.secret};
  for (const record::SessionRow& row : store.sessions()) {
    if (const auto own = analysis::participant_key(store, key, row)) keys.push_back(*own);
    keys.push_back(key.draw_of(row.enrolment, study::Draws::people).secret);
  }
  return keys;
}

bool holds(const Bytes& file, const Bytes& part) {
  return std::search(file.begin(), file.end(), part.begin(), part.end()) != file.end();
}

/// Whether any of the study's files still has a part of these bytes.
bool is_in_any_file(const AttackedStudy& study, const Bytes& bytes) {
  constexpr std::ptrdiff_t kPart = 16;
  const Bytes part(bytes.end() - kPart, bytes.end());
  for (const auto& entry : fs::recursive_directory_iterator(study.folder())) {
    if (entry.is_regular_file() && holds(read_file(entry.path()), part)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("no seed, no rehearsal and no small secret gives the schedules of a prepared study") {
  const StudyFolder folder;
  REQUIRE(folder.run({"prepare", folder.in("cloths.json")}).exit_code == 0);
  const study::StudyKey key = study::load_study_key(folder.in("cloths.key"));
  const auto real = schedules_of(key.study, key.stations.front(), study::Draws::people);
  REQUIRE(real == schedules_of(key.study,
                               study::load_station_key(folder.in("cloths.station")).station,
                               study::Draws::people));
  CHECK_FALSE(real == schedules_of(key.study, key.stations.front(), study::Draws::rehearsal));

  const study::StudyKey simulated = study::simulated_study_key(key.study);
  std::vector<study::Station> guesses = simulated.stations;
  std::vector<std::uint64_t> seeds = {key.study.seed};
  for (int seed = 0; seed < places(200); ++seed) seeds.push_back(static_cast<std::uint64_t>(seed));
  for (const std::uint64_t seed : seeds) {
    SeededEntropy entropy(seed);
    guesses.push_back(study::make_study_key(key.study, entropy, false).stations.front());
    for (const SecretKey& secret : secrets_of(seed)) {
      guesses.push_back(simulated.stations.front());
      guesses.back().secret = secret;
    }
  }
  for (const study::Station& guess : guesses) {
    for (const study::Draws draws : {study::Draws::people, study::Draws::rehearsal}) {
      CHECK_FALSE(schedules_of(key.study, guess, draws) == real);
    }
  }
  note("schedules from a seed or a small secret", Outcome::refused,
       static_cast<int>(guesses.size()) * 2);
}

TEST_CASE("nothing opens what a person answered who was erased, but a copy from before does") {
  AttackedStudy study;
  const fs::path copy = study.folder() / "copy.db";
  const Bytes wrapped = study.store().wrapped_key(2).value();
  const Bytes kept = study.store().kept_key(AttackedStudy::open_session()).value();
  record::copy_database(study.database(), copy);
  // A session that has ended, and one that is open.
  const std::array erased = {2, AttackedStudy::open_session()};
  study.store().withdraw(erased, std::chrono::seconds(9), "asked to");
  study.close();
  CHECK(study.found().empty());

  const record::StudyStore store =
      record::StudyStore::open(study.database(), record::StudyStore::Access::read_only);
  const std::vector<SecretKey> keys = keys_in_reach(study, store);
  for (const int session : erased) {
    CHECK_FALSE(store.wrapped_key(session));
    CHECK_FALSE(store.kept_key(session));
    for (const record::Event& event : store.events(session)) {
      for (const SecretKey& key : keys) CHECK_FALSE(record::opened_event(event, key));
    }
    for (const SecretKey& key : keys) {
      CHECK_FALSE(record::unsealed_trace(store.sealed_trace(session, 1).value(), key));
    }
  }
  CHECK(std::ranges::any_of(keys, [&](const SecretKey& key) {
    return record::opened_event(store.events(1).front(), key).has_value();
  }));
  note("an erased person's answers", Outcome::refused, static_cast<int>(erased.size()));

  const record::StudyStore before =
      record::StudyStore::open(copy, record::StudyStore::Access::read_only);
  const auto own = analysis::participant_key(before, study.key(), before.sessions().at(1));
  REQUIRE(own);
  CHECK(record::opened_event(store.events(2).back(), *own));
  note("an erased person's answers, with an older copy and the key", Outcome::possible);
  fs::remove(copy);
  CHECK_FALSE(is_in_any_file(study, wrapped));
  CHECK_FALSE(is_in_any_file(study, kept));
}
