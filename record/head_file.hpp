/// \file The head file of a database: outside of the database, it records the ends of its chains
///   and the number of acknowledged answers. A database that was rolled back, lost its write-ahead
///   log, or had sessions removed from its end, lacks something that its head file records.
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

/// How many open sessions a head file holds; of more, those with the highest numbers.
inline constexpr std::size_t kMaxHeadSessions = 64;

/// The content of a head file.
struct HeadRecord {
  std::string study_id;
  std::string station;                ///< its name
  Digest database{};                  ///< hash of the first event of the file's chain
  std::int64_t count = 0;             ///< number of writes of the file; 0: no file yet
  ChainHead file;                     ///< the end of the file's chain
  std::map<int, ChainHead> sessions;  ///< the ends of open sessions, by number, from 1
  std::int64_t acknowledged = 0;      ///< answers in the whole database
  std::string also;                   ///< folder of the second head file; empty: there is none

  /// Advance the end of a chain, or the number of answers; never back, because of two programs that
  /// write to the database the slower one may call this last.
  void advance_file(const ChainHead& end);
  void advance_session(int session, const ChainHead& end);
  void advance_answers(std::int64_t answers);

  friend bool operator==(const HeadRecord&, const HeadRecord&) = default;
};

/// The record that matches the current database: for the first record, and after a loss was
/// accepted. `count` and `also` are not set.
[[nodiscard]] HeadRecord record_of(const StudyStore& store);

/// `<database>.head`.
[[nodiscard]] std::filesystem::path head_path_for(const std::filesystem::path& database);

/// The valid signers of a head file.
[[nodiscard]] std::vector<PublicKey> head_signers(const StudyCommitment& commitment);

/// Changes a record. It may be called several times, each with another record. `update` itself sets
/// `count`.
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

/// One head file: two signed copies of its record, which are written alternately. Several programs
/// and threads may use one file at a time; a lock serialises their changes.
class HeadFile {
 public:
  /// \param timeout  for another program that holds the lock
  explicit HeadFile(std::filesystem::path path,
                    std::chrono::milliseconds timeout = std::chrono::seconds(30));

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// The newest complete copy. Read it before the database, which others may write to meanwhile.
  /// \param signers  public keys of valid signers: the station, the investigator
  /// \return nothing if there is no file
  /// \throws FileError if no copy is complete and signed by one of `signers`, or the file cannot be
  ///   read
  [[nodiscard]] std::optional<HeadRecord> read(std::span<const PublicKey> signers) const;
  /// The same, with the fault of the other copy.
  [[nodiscard]] std::optional<HeadReading> reading(std::span<const PublicKey> signers) const;

  /// Changes the record, and returns when it is on the disk. If there is no file, `change` gets an
  /// empty record, whose `count` is 0, and the file is created. An exception of `change` is passed
  /// on and leaves the file unchanged.
  /// \param others  valid signers in addition to `signer`
  /// \throws StoreError if the file cannot be read, locked, written or synced; its last record then
  ///   remains
  void update(const Signer& signer, const HeadChange& change,
              std::span<const PublicKey> others = {}) const;

 private:
  [[nodiscard]] bool overwrite(const Signer& signer, const HeadChange& change,
                               std::span<const PublicKey> signers) const;
  [[nodiscard]] bool create(const Signer& signer, const HeadChange& change) const;

  std::filesystem::path path_;
  std::chrono::milliseconds timeout_;
};

/// The head files of one database: `<database>.head` beside it and, if there is a second folder, a
/// file of the same name there. Each has its own content, so that the other one reveals a file that
/// was rolled back with the database.
class HeadFiles {
 public:
  /// \param signers  as HeadFile::read
  /// \param also  the second folder, preferably on another disk; empty: none; nothing: the one that
  ///   `<database>.head` names
  /// \throws FileError if the second folder is missing, cannot be written, or is the database's
  ///   own; as HeadFile::read if `also` is nothing
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
  /// As HeadFile::update, for each file in turn. A missing second file is created with the record
  /// of the first.
  /// \throws StoreError the same; also if the second file belongs to another database
  void update(const Signer& signer, const HeadChange& change) const;

 private:
  std::vector<HeadFile> files_;
  std::vector<PublicKey> signers_;
  std::string also_;
};

/// A head file that a database has, or had.
struct KnownHead {
  std::filesystem::path file;
  std::optional<HeadReading> reading;  ///< nothing: the file does not exist
};

/// The head files beside a database or on record: first the one beside it, then those in the
/// folders that the database and that file name. Empty if there are none.
/// \throws FileError as HeadFile::read
[[nodiscard]] std::vector<KnownHead> known_heads(const StudyStore& store,
                                                 const std::filesystem::path& database);

/// Something that a head file records and the database lacks.
struct Loss {
  int session = 0;           ///< 0: the file's chain, or the database as a whole
  std::string what;          ///< a sentence for messages, without the database's name
  std::int64_t answers = 0;  ///< missing acknowledged answers, if `what` is about them

  friend bool operator==(const Loss&, const Loss&) = default;
};

/// Compares a database with a head file: the file's chain, every session that was open, and the
/// number of answers. It compares stored hashes; StudyStore::first_fault computes them.
/// \return the file's chain first, then sessions by number; empty: nothing is missing
/// \throws StoreError if the database cannot be read
[[nodiscard]] std::vector<Loss> losses(const HeadRecord& known, const StudyStore& store);

/// The first 16 digits of the file chain's hash in groups of four, to write down and compare: "0f3a
/// 91c2 77de 4b08". `verify --head` takes them.
[[nodiscard]] std::string head_digits(const HeadRecord& record);

}  // namespace touchtrial::record
