/// \file Several stations of one study, each with a database of its own, to be collected.
#pragma once

#include "core/files.hpp"
#include "record/merging/collect.hpp"
#include "record/store_fixture.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::fixture {

namespace fs = std::filesystem;
using std::chrono::minutes;

using Access = record::StudyStore::Access;

/// A study with people, so that times of day matter.
inline record::StudyCommitment lab_commitment() {
  record::StudyCommitment commitment = fixture::commitment();
  commitment.simulated = false;
  return commitment;
}

struct Visitor {
  std::string participant;
  int enrolment = 0;
  nanoseconds at{};  ///< since kUtc
};

inline record::SessionOpening opening_of(const Visitor& visitor,
                                         const record::StudyCommitment& commitment) {
  record::SessionOpening opening = fixture::opening(1);
  opening.participant = visitor.participant;
  opening.enrolment = visitor.enrolment;
  opening.study_id = commitment.study_id;
  opening.seal = commitment.seal;
  opening.simulated = commitment.simulated;
  opening.pilot = commitment.pilot;
  return opening;
}

/// Records the visitors' finished sessions.
inline void visit(record::StudyStore& store, const std::vector<Visitor>& visitors) {
  for (const Visitor& visitor : visitors) {
    const int session = store.next_session();
    store.add_session(
        session_of(session, 3, stroking(20, 0.05), opening_of(visitor, store.commitment())),
        wrapped_key_of(session), kUtc + visitor.at);
  }
}

/// Opens a session and leaves it open.
inline void begin(record::StudyStore& store, const Visitor& visitor) {
  const int session = store.next_session();
  const auto sink =
      store.begin_session(session, wrapped_key_of(session), [&] { return kUtc + visitor.at; });
  record::SessionRecorder recorder(session, participant_key(session), *sink);
  recorder.opened(nanoseconds(0), opening_of(visitor, store.commitment()), R"({"schedule":"x"})");
}

/// A folder with stations' databases, which are closed between calls.
class Lab {
 public:
  /// Makes a station's database.
  /// \return its path
  fs::path station(const std::string& name, const std::vector<Visitor>& visitors,
                   const record::StudyCommitment& commitment = lab_commitment()) {
    const fs::path path = file(name);
    record::StudyStore store = record::StudyStore::create(path, commitment, kUtc, investigator());
    visit(store, visitors);
    return path;
  }
  /// Calls `work` with a station's open database.
  template <typename Work>
  static void at(const fs::path& path, Work&& work) {
    record::StudyStore store = writable(path);
    work(store);
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }

 private:
  TempFolder folder_;
};

/// Two stations with sessions in turn: P1 and P3 at A, P2 and P4 at B.
struct TwoStations : Lab {
  const fs::path a = station("A.db", {{"P1", 1, minutes(10)}, {"P3", 3, minutes(30)}});
  const fs::path b = station("B.db", {{"P2", 2, minutes(20)}, {"P4", 4, minutes(40)}});
};

inline merging::Stations stations_in(const std::vector<fs::path>& files) {
  merging::Stations stations;
  for (const fs::path& file : files) {
    for (auto& station : merging::stations_of_file(file)) stations.push_back(std::move(station));
  }
  return stations;
}

inline merging::CollectReport merge(const std::vector<fs::path>& files, const fs::path& target) {
  return merging::collect_into_file(stations_in(files), target);
}

/// The message with which a merge is refused; empty if it is not. Also checks that a refused merge
/// left nothing behind.
inline std::string merge_refusal(const Lab& lab, const std::vector<fs::path>& files) {
  const fs::path target = lab.file("refused.db");
  std::string line = refusal_of([&] { merge(files, target); });
  int left = 0;
  for (const auto& entry : fs::directory_iterator(lab.file(""))) {
    if (entry.path().filename().string().starts_with("refused.db")) ++left;
  }
  return left == 0 ? line : line + " [LEFT A FILE]";
}

inline std::vector<std::string> participants_in(const record::StudyStore& store) {
  std::vector<std::string> participants;
  for (const record::SessionRow& row : store.sessions()) participants.push_back(row.participant);
  return participants;
}

/// Runs SQL on a closed file behind the back of its triggers.
inline void tamper_file(const fs::path& path, const std::string& sql) {
  SQLite::Database raw(path.string(), SQLite::OPEN_READWRITE);
  raw.exec("PRAGMA foreign_keys = OFF; PRAGMA synchronous = OFF");
  without_triggers(raw, [&] { raw.exec(sql); });
}

}  // namespace touchtrial::fixture
