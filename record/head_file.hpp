/// \file The head file of a database: it stands outside of the database, and knows the ends of its
/// chains and how many answers were acknowledged. A database that was rolled back, lost its
/// write-ahead log, or had sessions dropped from its end, lacks something that the head file knows.
///
/// Order of writing: commit in the database, then `update`, then the acknowledgement. A database
/// that is ahead of its head file is therefore normal. Format: docs/data-dictionary.md, "Head
/// file".
#pragma once

#include "core/public_keys.hpp"
#include "record/event.hpp"
#include "record/payload.hpp"

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

/// How many open sessions a head file holds. Of more, it keeps those with the highest numbers.
inline constexpr std::size_t kMaxHeadSessions = 64;

/// What a head file says.
struct HeadRecord {
  std::string study_id;
  std::string station;                ///< its name
  Digest database{};                  ///< hash of the first event of the file's chain
  std::int64_t count = 0;             ///< how often the file was written; 0: there is no file yet
  ChainHead file;                     ///< the end of the file's chain
  std::map<int, ChainHead> sessions;  ///< the ends of open sessions, by number, from 1
  std::int64_t acknowledged = 0;      ///< answers in the whole database
  std::string also;                   ///< folder of the second head file; empty: there is none

  /// Note the end of a chain, or the number of answers, unless more is known already: of two
  /// programs that wrote to the database, the slower one may come here last.
  void know_file(const ChainHead& end);
  void know_session(int session, const ChainHead& end);
  void know_answers(std::int64_t answers);

  friend bool operator==(const HeadRecord&, const HeadRecord&) = default;
};

/// What a head file should know of a database as it is now: for its first record, and after a loss
/// was accepted. `count` and `also` are left out.
[[nodiscard]] HeadRecord record_of(const StudyStore& store);

/// `<database>.head`.
[[nodiscard]] std::filesystem::path head_path_for(const std::filesystem::path& database);

/// Whose signatures count on a head file.
[[nodiscard]] std::vector<PublicKey> head_signers(const StudyCommitment& commitment);

/// Changes a record. It may be called more than once, each time with a record to change. `update`
/// sets `count` by itself.
using HeadChange = std::function<void(HeadRecord&)>;

/// Writes a change to all head files of a database, as `update` does.
using HeadKeeper = std::function<void(const HeadChange&)>;

/// A head file, and its content.
struct HeadReading {
  std::filesystem::path file;
  HeadRecord record;
  /// What is wrong with the other of the file's two copies, or with its size; empty: nothing. A
  /// power cut during `update` may leave one copy torn.
  std::string damage;
};

/// One head file: two signed copies of its record, which are written in turn. Several programs and
/// threads may use one file at a time; a lock on it keeps their changes apart.
class HeadFile {
 public:
  /// \param patience  how long to wait for another program that holds the lock
  explicit HeadFile(std::filesystem::path path,
                    std::chrono::milliseconds patience = std::chrono::seconds(30));

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// The newest whole copy. Read it before the database, which others may write to meanwhile.
  /// \param signers  public halves whose signatures count: the station's, the investigator's
  /// \return nothing if there is no file
  /// \throws FileError if no copy is whole and signed by one of `signers`, or the file cannot be
  ///   read
  [[nodiscard]] std::optional<HeadRecord> read(std::span<const PublicKey> signers) const;
  /// The same, with what is wrong with the other copy.
  [[nodiscard]] std::optional<HeadReading> reading(std::span<const PublicKey> signers) const;

  /// Changes the record, and returns when it is on the disk. If there is no file, `change` gets an
  /// empty record, whose `count` is 0, and the file is made. Whatever `change` throws comes through
  /// and leaves the file as it was.
  /// \param others  whose signatures count beside the signer's own
  /// \throws StoreError if the file cannot be read, locked, written or synced; its last record then
  ///   stands
  void update(const Signer& signer, const HeadChange& change,
              std::span<const PublicKey> others = {}) const;

 private:
  [[nodiscard]] bool overwrite(const Signer& signer, const HeadChange& change,
                               std::span<const PublicKey> signers) const;
  [[nodiscard]] bool create(const Signer& signer, const HeadChange& change) const;

  std::filesystem::path path_;
  std::chrono::milliseconds patience_;
};

/// The head files of one database: `<database>.head` beside it and, if there is a second folder, a
/// file of the same name there. Each keeps what it knows by itself, so that a file that was rolled
/// back with the database is given away by the other.
class HeadFiles {
 public:
  /// \param signers  as HeadFile::read
  /// \param also  the second folder, preferably on another disk; empty: none; nothing: the one that
  ///   `<database>.head` names
  /// \throws FileError if the second folder is not there, cannot be written, or is the database's
  ///   own; as HeadFile::read if `also` is nothing
  HeadFiles(const std::filesystem::path& database, std::vector<PublicKey> signers,
            std::optional<std::filesystem::path> also = {});

  /// One path or two, the one beside the database first.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
  /// The second folder as it is recorded; empty: there is none.
  [[nodiscard]] const std::string& also() const noexcept { return also_; }
  /// The files that there are, in the order of `paths`. A database that has sessions has all of its
  /// head files, unless they were removed.
  /// \throws FileError as HeadFile::read
  [[nodiscard]] std::vector<HeadReading> read() const;
  /// As HeadFile::update, for each file in turn. A second file that is missing is made with the
  /// record of the first.
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
  std::optional<HeadReading> reading;  ///< nothing: it is gone
};

/// The head files that lie beside a database or are on record: the one beside it first, then those
/// in the folders that the database and that file name. Empty if there are none.
/// \throws FileError as HeadFile::read
[[nodiscard]] std::vector<KnownHead> known_heads(const StudyStore& store,
                                                 const std::filesystem::path& database);

/// Something that a head file knows and the database lacks.
struct Loss {
  int session = 0;           ///< 0: the file's chain, or the database as a whole
  std::string what;          ///< a sentence for people, without the database's name
  std::int64_t answers = 0;  ///< acknowledged answers that are missing, if the sentence says so

  friend bool operator==(const Loss&, const Loss&) = default;
};

/// Holds a database against what a head file knows: the file's chain, every session that was open,
/// and the number of answers. It compares stored hashes; StudyStore::first_fault computes them.
/// \return the file's chain first, then sessions by number; empty: nothing is missing
/// \throws StoreError if the database cannot be read
[[nodiscard]] std::vector<Loss> losses(const HeadRecord& known, const StudyStore& store);

/// The first 16 digits of the file chain's hash in groups of four, for people to write down and
/// compare: "0f3a 91c2 77de 4b08". `verify --head` takes them.
[[nodiscard]] std::string spoken_head(const HeadRecord& record);

}  // namespace touchtrial::record
