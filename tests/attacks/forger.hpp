/// \file What attackers have: a real study's files to attack, and the means to write any database
/// that they like. A forger has this program's source, so that these tools use its own libraries.
#pragma once

#include "analysis/fake_study.hpp"
#include "core/random.hpp"
#include "record/event.hpp"
#include "record/sealing.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::attacks {

namespace fs = std::filesystem;

/// A study with people at one station. P01 has session 1, and is excluded after an interim look;
/// P02 and P03 have sessions 2 and 3, and P04 the open session 4. All are in `study.db`, whose head
/// is kept beside it and in `elsewhere`.
class AttackedStudy : public FakeStudy {
 public:
  /// \param answered  trials of the open session; 0: there is none
  explicit AttackedStudy(int answered = 3);

  [[nodiscard]] const study::StationKey& station() const noexcept { return station_; }
  [[nodiscard]] fs::path key_file() const { return folder() / "study.key"; }
  [[nodiscard]] fs::path station_file() const { return folder() / "study.station"; }
  [[nodiscard]] fs::path head() const { return folder() / "study.db.head"; }
  [[nodiscard]] fs::path second_head() const { return folder() / "elsewhere" / "study.db.head"; }

  /// As the program at this station leaves the database: without a log.
  void close();
  /// Opens it again as the station, and keeps its heads.
  void open();
  /// Answers further trials of the open session as the program at this station does.
  void answer(int trials);
  [[nodiscard]] static constexpr int open_session() noexcept { return 4; }

  /// What `verify` finds, with the key: "check: detail" of each failed check; empty if nothing.
  [[nodiscard]] std::string found() const;
  /// The same of a database elsewhere, with its own head file alone.
  [[nodiscard]] std::string found(const fs::path& database) const;
  /// The same for somebody who has the database and its head files alone.
  [[nodiscard]] std::string found_without_key() const;
  /// What a head that was once written down finds.
  [[nodiscard]] std::string found_by_head(const Digest& head) const;

 private:
  void begin_open_session();

  study::StationKey station_;
  study::Schedule schedule_;  ///< of the open session
  SecretKey own_{};           ///< its participant's
  std::unique_ptr<record::EventSink> sink_;
  std::optional<record::SessionRecorder> recorder_;
  int answered_ = 0;
};

/// A database in memory, which a forger alters as they like and writes anew, with hashes, triggers,
/// and the tables that follow from the events.
struct Forgery {
  explicit Forgery(const fs::path& database);

  /// Computes all hashes anew, writes them to the file's chain where it names them, and signs that
  /// chain.
  /// \param signer  null: signatures stay as they are
  void relink(const Signer* signer = nullptr);
  void write() const;

  [[nodiscard]] std::vector<record::Event>& file() { return chains.at(0); }
  /// The first event of a kind on a chain.
  [[nodiscard]] record::Event& first(int session, record::EventKind kind);
  /// Removes a session, with its lines on the file's chain.
  void drop(int session);

  fs::path path;
  std::map<int, std::vector<record::Event>> chains;  ///< by session; 0: the file's
  std::map<int, record::WrappedKeys> keys;           ///< participants'
  std::map<int, Bytes> kept;                         ///< the station's copies
  std::vector<record::SealedTrace> traces;
};

/// Sets a member of an event's body to a value, as JSON.
void set(record::Event& event, const std::string& member, const std::string& json);

/// Runs SQL while the triggers of a database are gone.
void with_sql(const fs::path& database, const std::string& sql);

/// All rows of all tables, read by SQLite without an index; what SQLite says if it cannot read.
[[nodiscard]] std::string rows_of(const fs::path& database);

/// Flips one bit of a file's byte.
void flip(const fs::path& file, std::uintmax_t at, unsigned bit);

/// What became of an attack.
enum class Outcome {
  refused,    ///< the program does not read the file
  named,      ///< `verify` or a head file names it
  unchanged,  ///< no row of any table differs
  possible    ///< this person can do that: docs/evidence.md says so
};

/// Notes outcomes for scripts/attack, which names a file in TOUCHTRIAL_ATTACKS.
void note(const std::string& attack, Outcome outcome, int count = 1);

/// How many places a test attacks: of CTest, or TOUCHTRIAL_ATTACK_PLACES.
[[nodiscard]] int places(int of_ctest);
/// The stream that decides where; TOUCHTRIAL_ATTACK_SEED, or 1.
[[nodiscard]] RandomStream places_of(const std::string& attack);

}  // namespace touchtrial::attacks
