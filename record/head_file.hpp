/// \file The head file of a database. It is a separate file that records the ends of the database's
///   chains and the number of acknowledged answers. A database that was rolled back, lost its
///   write-ahead log, or had sessions removed from its end lacks something that its head file
///   records.
///
/// Order of writing: commit in the database, then `update`, then the acknowledgement. A database
/// that is ahead of its head file is therefore normal. Format: docs/data-dictionary.md, "Head
/// file".
#pragma once

#include "core/public_keys.hpp"
#include "record/event.hpp"
#include "record/file_bodies.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::record {

class StudyStore;

/// The most open sessions in a head file; if there are more, those with the highest numbers.
inline constexpr std::size_t kMaxHeadSessions = 64;

/// The content of a head file.
struct HeadRecord {
  std::string study_id;
  std::string station;                ///< name of the station
  Digest database{};                  ///< hash of the first event of the file's chain
  std::int64_t count = 0;             ///< number of writes of the file; 0: no file yet
  ChainHead file;                     ///< the end of the file's chain
  std::map<int, ChainHead> sessions;  ///< the ends of open sessions, by number, from 1
  std::int64_t acknowledged = 0;      ///< answers in the whole database
  std::string also;                   ///< folder of the second head file; empty: there is none

  /// These functions advance the end of a chain, or the number of answers. They never move it back,
  /// because the slower of two programs that write to the database may call them last.
  void advance_file(const ChainHead& end);
  void advance_session(int session, const ChainHead& end);
  void advance_answers(std::int64_t answers);

  friend bool operator==(const HeadRecord&, const HeadRecord&) = default;
};

/// The record of the current database, for a new head file or after a loss was accepted. `count`
/// and `also` are not set.
[[nodiscard]] HeadRecord record_of(const StudyStore& store);

/// `<database>.head`.
[[nodiscard]] std::filesystem::path head_path_for(const std::filesystem::path& database);

/// The valid signers of a head file.
[[nodiscard]] std::vector<PublicKey> head_signers(const StudyCommitment& commitment);

/// Changes a record. It may be called several times, with different records. `update` sets `count`.
using HeadChange = std::function<void(HeadRecord&)>;

/// Writes a change to all head files of a database, as `update` does.
using HeadWriter = std::function<void(const HeadChange&)>;

/// A head file, and its content.
struct HeadReading {
  std::filesystem::path file;
  HeadRecord record;
  /// The fault of the file's other copy, or of its size; empty: none. A power cut during `update`
  /// may leave one copy torn.
  std::string damage;
};

/// One head file: two signed copies of its record, which are written alternately. A lock serialises
/// changes by several programs and threads.
class HeadFile {
 public:
  /// \param timeout  how long to wait for the lock
  explicit HeadFile(std::filesystem::path path,
                    std::chrono::milliseconds timeout = std::chrono::seconds(30));

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// The newest complete copy. Read it before the database, which others may write to meanwhile.
  /// \param signers  public keys of valid signers: the station, the investigator
  /// \return nothing if there is no file
  /// \throws FileError if no copy is complete and signed by one of `signers`, or the file cannot be
  ///   read
  [[nodiscard]] std::optional<HeadRecord> read(std::span<const PublicKey> signers) const;
  /// Reads the newest complete copy, as `read`, and reports the fault of the other copy.
  [[nodiscard]] std::optional<HeadReading> reading(std::span<const PublicKey> signers) const;

  /// Changes the record, and returns when it is on the disk. If there is no file, `change` gets an
  /// empty record, whose `count` is 0, and the file is created. An exception of `change` leaves
  /// the file unchanged and is rethrown.
  /// \param signers  valid signers besides `signer`
  /// \throws StoreError if the file cannot be read, locked, written or synced; its last record then
  ///   remains
  void update(const Signer& signer, const HeadChange& change,
              std::span<const PublicKey> signers = {}) const;

 private:
  [[nodiscard]] bool overwrite(const Signer& signer, const HeadChange& change,
                               std::span<const PublicKey> signers) const;
  [[nodiscard]] bool create(const Signer& signer, const HeadChange& change) const;

  std::filesystem::path path_;
  std::chrono::milliseconds timeout_;
};

/// The head files of one database: `<database>.head` beside it and, if there is a second folder, a
/// file of the same name there. If one is rolled back with the database, the other reveals it.
class HeadFiles {
 public:
  /// \param signers  as HeadFile::read
  /// \param also  the second folder, preferably on another disk; an empty path: none; nullopt: the
  ///   one that `<database>.head` names
  /// \throws FileError if the second folder is missing, cannot be written, or is the database's
  ///   own; as HeadFile::read if `also` is nullopt
  HeadFiles(const std::filesystem::path& database, std::vector<PublicKey> signers,
            std::optional<std::filesystem::path> also = {});

  /// One path or two, the one beside the database first.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
  /// The recorded second folder; empty: none.
  [[nodiscard]] const std::string& also() const noexcept { return also_; }
  /// The existing files, in the order of `paths`. A database that has sessions has all of its head
  /// files, unless they were removed.
  /// \throws FileError as HeadFile::read
  [[nodiscard]] std::vector<HeadReading> read() const;
  /// Updates each file in turn, as HeadFile::update. A missing second file is created with the
  /// record of the first.
  /// \throws StoreError as HeadFile::update, and if the second file belongs to another database
  void update(const Signer& signer, const HeadChange& change) const;

 private:
  std::vector<HeadFile> files_;
  std::vector<PublicKey> signers_;
  std::string also_;
};

/// A head file that a database has, or had.
struct ExpectedHead {
  std::filesystem::path file;
  std::optional<HeadReading> reading;  ///< empty: the file does not exist
};

/// The head files that a database has or should have: first the one beside it, then one in each
/// folder that the database or that file names.
/// \throws FileError as HeadFile::read
[[nodiscard]] std::vector<ExpectedHead> expected_heads(const StudyStore& store,
                                                       const std::filesystem::path& database);

/// Data that a head file records but the database lacks.
struct Loss {
  int session = 0;           ///< 0: the file's chain, or the database as a whole
  std::string what;          ///< for messages, without the database's name
  std::int64_t answers = 0;  ///< missing acknowledged answers, if `what` is about them

  friend bool operator==(const Loss&, const Loss&) = default;
};

/// Compares a database with a head file: the file's chain, every session that was open, and the
/// number of answers. It compares stored hashes; StudyStore::first_fault computes them.
/// \return the file's chain first, then sessions by number; empty: nothing is missing
/// \throws StoreError if the database cannot be read
[[nodiscard]] std::vector<Loss> losses(const HeadRecord& head, const StudyStore& store);

/// The first 16 digits of the file chain's hash, to write down and pass to `verify --head`:
/// "0f3a 91c2 77de 4b08".
[[nodiscard]] std::string head_digits(const HeadRecord& record);

}  // namespace touchtrial::record
