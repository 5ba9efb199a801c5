#include "record/head_file.hpp"

#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "record/head_copy.hpp"
#include "record/study_store.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace touchtrial::record {
namespace {

/// \param error  an errno of the system
[[noreturn]] void refuse_with_reason(const std::filesystem::path& path, const std::string& what,
                                     int error, const std::string& remedy) {
  refuse_head(path, what + " (" + std::generic_category().message(error) + "); " + remedy);
}

/// An open head file, locked if the file system supports locks.
class LockedHead {
 public:
  /// \param access  O_RDONLY or O_RDWR
  /// \throws FileError if the file cannot be opened, or another program holds the lock for too long
  LockedHead(const std::filesystem::path& path, int access, std::chrono::milliseconds timeout)
      : path_(path) {
    const bool writes = access == O_RDWR;
    if (writes) refuse_link(path);
    file_ = ::open(path.c_str(), access | (writes ? O_NOFOLLOW : 0) | O_CLOEXEC | O_NONBLOCK);
    if (file_ < 0 && errno == ENOENT) return;
    if (file_ < 0) refuse_with_reason(path, "cannot be opened", errno, "check its permissions");
    try {
      lock_and_measure(access == O_RDWR ? LOCK_EX : LOCK_SH, timeout);
    } catch (...) {
      ::close(file_);
      throw;
    }
  }
  ~LockedHead() {
    if (file_ >= 0) ::close(file_);
  }
  LockedHead(const LockedHead&) = delete;
  LockedHead& operator=(const LockedHead&) = delete;

  [[nodiscard]] bool file_exists() const noexcept { return file_ >= 0; }
  [[nodiscard]] bool has_expected_size() const noexcept {
    return size_ == off_t{2 * kHeadCopyBytes};
  }

  /// The existing bytes of one slot.
  [[nodiscard]] std::string slot(std::size_t index) const {
    std::string bytes(kHeadCopyBytes, '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::pread(file_, bytes.data() + done, bytes.size() - done,
                                    static_cast<off_t>(index * kHeadCopyBytes + done));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) refuse_with_reason(path_, "cannot be read", errno, "check the disk");
      if (count == 0) break;
      done += static_cast<std::size_t>(count);
    }
    bytes.resize(done);
    return bytes;
  }

  /// Writes and syncs a slot. If that fails, it restores the old bytes as far as possible, so that
  /// no program reads bytes that a power cut may still lose.
  /// \throws FileError
  void write(std::size_t index, const std::string& bytes, const std::string& old) const {
    const bool has_no_tail =
        size_ <= off_t{2 * kHeadCopyBytes} || ::ftruncate(file_, 2 * kHeadCopyBytes) == 0;
    if (has_no_tail && write_at(index, bytes) && ::fdatasync(file_) == 0) return;
    const int error = errno;
    if (write_at(index, old)) static_cast<void>(::fdatasync(file_));
    refuse_with_reason(path_, "cannot be written", error,
                       "check its disk, and the free space there");
  }

 private:
  void lock_and_measure(int lock, std::chrono::milliseconds timeout) {
    struct stat status {};
    if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
      refuse_head(path_, "is not a file; move it away");
    }
    wait_for_lock(lock, timeout);
    // Checked under the lock: the program that held it may have changed the size.
    if (::fstat(file_, &status) == 0) size_ = status.st_size;
  }

  /// Waits for at most `timeout`, because a suspended program that holds the lock must not block
  /// this one forever.
  void wait_for_lock(int lock, std::chrono::milliseconds timeout) const {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (::flock(file_, lock | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno != EWOULDBLOCK) {
        if (lock == LOCK_SH) return;  // the file system has no locks
        refuse_with_reason(path_, "cannot be locked", errno, "move it to a local disk");
      }
      if (std::chrono::steady_clock::now() >= end) {
        refuse_head(path_, "another program keeps it locked; end that program");
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  [[nodiscard]] bool write_at(std::size_t index, std::string_view bytes) const {
    auto place = static_cast<off_t>(index * kHeadCopyBytes);
    while (!bytes.empty()) {
      const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), place);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
      place += written;
    }
    return true;
  }

  const std::filesystem::path& path_;
  int file_ = -1;
  off_t size_ = 0;
};

/// Both slots of a file.
struct HeadSlots {
  std::array<HeadCopy, 2> slots;
  std::size_t latest = 0;  ///< index of the current slot

  [[nodiscard]] const HeadCopy& newest() const { return slots.at(latest); }
  [[nodiscard]] const HeadCopy& other() const { return slots.at(1 - latest); }
};

[[noreturn]] void refuse_both(const std::filesystem::path& path, const HeadCopy& first,
                              const HeadCopy& second) {
  const std::string& claim = first.claim.empty() ? second.claim : first.claim;
  const std::string owner_clause =
      claim.empty() ? "; "
                    : "; it names " + claim +
                          " as its owner: if this database belongs to another study or station, "
                          "give it another name, or a folder of its own with `run --heads`; else ";
  refuse_head(path, "of its two copies, the first " + first.fault + ", the second " + second.fault +
                        owner_clause +
                        "if there is another head file, copy it over this one, or compare the "
                        "database with the last day sheet and move this file away");
}

/// \throws FileError if neither slot can be read
HeadSlots read_slots(const LockedHead& file, std::span<const PublicKey> signers,
                     const std::filesystem::path& path) {
  HeadSlots result{
      .slots = {read_head_copy(file.slot(0), signers), read_head_copy(file.slot(1), signers)}};
  const auto& [first, second] = result.slots;
  if (!first.record && !second.record) refuse_both(path, first, second);
  const bool second_is_newer =
      second.record && (!first.record || second.record->count >= first.record->count);
  result.latest = second_is_newer ? 1 : 0;
  return result;
}

void drop_oldest(std::map<int, ChainHead>& sessions) {
  while (sessions.size() > kMaxHeadSessions) sessions.erase(sessions.begin());
}

void require_second_folder(const std::filesystem::path& folder,
                           const std::filesystem::path& database) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    refuse_head(folder,
                "the folder of the second head file is not available; connect its disk, or name "
                "another folder once, with `run --heads`");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse_with_reason(folder, "the folder of the second head file cannot be written", errno,
                       "change its permissions, or name another folder");
  }
  const std::filesystem::path own_folder = std::filesystem::absolute(database).parent_path();
  if (std::filesystem::equivalent(folder, own_folder, error)) {
    refuse_head(folder,
                "is the database's own folder, which already has a head file; name a folder on "
                "another disk");
  }
}

bool describe_same_database(const HeadRecord& a, const HeadRecord& b) {
  return a.study_id == b.study_id && a.station == b.station && a.database == b.database;
}

std::string missing_answers(std::int64_t answers) {
  return counted(answers, "acknowledged answer") + (answers == 1 ? " is" : " are") + " missing";
}

/// \param name  of the chain, for people
std::optional<Loss> loss_of_chain(const StudyStore& store, int session, const std::string& name,
                                  const ChainHead& recorded) {
  if (recorded.length == 0) return std::nullopt;
  const std::optional<Event> same_place = store.event_at(session, recorded.length - 1);
  if (same_place && same_place->hash == recorded.hash) return std::nullopt;
  if (same_place) {
    return Loss{.session = session,
                .what = "event " + std::to_string(recorded.length - 1) + " of " + name +
                        " is not the one in the head file: it was altered, or the database was "
                        "rolled back and rewritten"};
  }
  const std::optional<Event> last = store.last_event(session);
  if (!last) {
    return Loss{.session = session,
                .what = name + " is missing; the head file records its " +
                        counted(recorded.length, "event")};
  }
  return Loss{.session = session,
              .what = name + " has " + counted(last->sequence + 1, "event") +
                      "; the head file records " + std::to_string(recorded.length)};
}

std::map<int, std::string> names_of_sessions(const StudyStore& store) {
  std::map<int, std::string> names;
  for (const SessionRow& row : store.sessions()) {
    names[row.session] =
        "session " + std::to_string(row.session) + " of participant " + row.participant;
  }
  return names;
}

/// Attributes missing answers to the session that lost them, if only one is possible.
void add_answers(std::vector<Loss>& results, std::int64_t recorded, std::int64_t stored) {
  const std::int64_t missing = recorded - stored;
  if (missing <= 0) return;
  const auto is_of_session = [](const Loss& loss) { return loss.session != 0; };
  if (std::ranges::count_if(results, is_of_session) == 1) {
    Loss& loss = *std::ranges::find_if(results, is_of_session);
    loss.what += ": " + missing_answers(missing);
    loss.answers = missing;
    return;
  }
  results.push_back({.session = 0,
                     .what = missing_answers(missing) + ": the database has " +
                             std::to_string(stored) + ", the head file records " +
                             std::to_string(recorded),
                     .answers = missing});
}

}  // namespace

void HeadRecord::advance_file(const ChainHead& end) {
  if (end.length > file.length) file = end;
}

void HeadRecord::advance_session(int session, const ChainHead& end) {
  ChainHead& recorded = sessions[session];
  if (end.length > recorded.length) recorded = end;
}

void HeadRecord::advance_answers(std::int64_t answers) {
  acknowledged = std::max(acknowledged, answers);
}

std::filesystem::path head_path_for(const std::filesystem::path& database) {
  return database_companion(database, ".head");
}

std::vector<PublicKey> head_signers(const StudyCommitment& commitment) {
  std::vector<PublicKey> signers = {commitment.investigator};
  if (commitment.station) signers.push_back(commitment.station->key);
  return signers;
}

HeadRecord record_of(const StudyStore& store) {
  const auto& station = store.commitment().station;
  const std::optional<Event> first = store.event_at(0, 0);
  HeadRecord record{.study_id = store.commitment().study_id,
                    .station = station ? station->name : "",
                    .database = first ? first->hash : Digest{},
                    .count = 0,
                    .file = store.file_head(),
                    .sessions = {},
                    .acknowledged = store.answers(),
                    .also = {}};
  for (const SessionRow& row : store.sessions()) {
    const std::optional<Event> last = store.last_event(row.session);
    if (row.state != SessionState::open || !last) continue;
    record.sessions[row.session] = {.length = last->sequence + 1, .hash = last->hash};
  }
  drop_oldest(record.sessions);
  return record;
}

HeadFile::HeadFile(std::filesystem::path path, std::chrono::milliseconds timeout)
    : path_(std::move(path)), timeout_(timeout) {}

std::optional<HeadRecord> HeadFile::read(std::span<const PublicKey> signers) const {
  std::optional<HeadReading> found = reading(signers);
  if (!found) return std::nullopt;
  return std::move(found->record);
}

std::optional<HeadReading> HeadFile::reading(std::span<const PublicKey> signers) const {
  const LockedHead file(path_, O_RDONLY, timeout_);
  if (!file.file_exists()) return std::nullopt;
  const HeadSlots slots = read_slots(file, signers, path_);
  HeadReading reading{.file = path_, .record = *slots.newest().record, .damage = {}};
  if (!slots.other().record) {
    reading.damage = one_line("one of its two copies " + slots.other().fault);
  } else if (!file.has_expected_size()) {
    reading.damage = "bytes were added to its end";
  }
  return reading;
}

void HeadFile::update(const Signer& signer, const HeadChange& change,
                      std::span<const PublicKey> signers) const {
  std::vector<PublicKey> valid_signers(signers.begin(), signers.end());
  valid_signers.push_back(signer.public_half());
  try {
    // Another program may create the file between the two attempts.
    constexpr int kTries = 3;
    for (int i = 0; i < kTries; ++i) {
      if (overwrite(signer, change, valid_signers) || create(signer, change)) return;
    }
    refuse_head(path_,
                "can be neither opened nor created, because another program keeps removing it");
  } catch (const FileError& error) {
    throw StoreError(error.what());
  }
}

bool HeadFile::overwrite(const Signer& signer, const HeadChange& change,
                         std::span<const PublicKey> signers) const {
  const LockedHead file(path_, O_RDWR, timeout_);
  if (!file.file_exists()) return false;
  const HeadSlots slots = read_slots(file, signers, path_);
  HeadRecord record = *slots.newest().record;
  const std::int64_t count = record.count;
  change(record);
  record.count = count + 1;
  drop_oldest(record.sessions);
  file.write(1 - slots.latest, head_copy_of(record, signer, path_), slots.other().bytes);
  return true;
}

/// \return false if the file exists already
bool HeadFile::create(const Signer& signer, const HeadChange& change) const {
  HeadRecord record;
  change(record);
  record.count = 1;
  drop_oldest(record.sessions);
  const std::string slot = head_copy_of(record, signer, path_);
  Draft draft(path_, Draft::Kind::file);
  draft.write(bytes_of(slot + slot));
  return draft.rename_if_free();
}

HeadFiles::HeadFiles(const std::filesystem::path& database, std::vector<PublicKey> signers,
                     std::optional<std::filesystem::path> also)
    : signers_(std::move(signers)) {
  files_.emplace_back(head_path_for(database));
  if (!also) {
    const std::optional<HeadRecord> first_record = files_.front().read(signers_);
    also = first_record ? first_record->also : std::string();
  }
  if (also->empty()) return;
  require_second_folder(*also, database);
  also_ = std::filesystem::weakly_canonical(*also).string();
  files_.emplace_back(std::filesystem::path(also_) / files_.front().path().filename());
}

std::vector<std::filesystem::path> HeadFiles::paths() const {
  std::vector<std::filesystem::path> paths;
  for (const HeadFile& file : files_) paths.push_back(file.path());
  return paths;
}

std::vector<HeadReading> HeadFiles::read() const {
  std::vector<HeadReading> readings;
  for (const HeadFile& file : files_) {
    if (auto reading = file.reading(signers_)) readings.push_back(std::move(*reading));
  }
  return readings;
}

void HeadFiles::update(const Signer& signer, const HeadChange& change) const {
  HeadRecord first_record;
  const auto change_first = [&](HeadRecord& record) {
    change(record);
    record.also = also_;
    first_record = record;
  };
  files_.front().update(signer, change_first, signers_);
  if (files_.size() < 2) return;
  const HeadFile& second = files_.back();
  const auto change_second = [&](HeadRecord& record) {
    if (record.count == 0) {
      record = first_record;
      return;
    }
    change(record);
    record.also = also_;
    if (describe_same_database(record, first_record)) return;
    refuse_head(second.path(),
                "belongs to another database; use a separate folder for each database");
  };
  second.update(signer, change_second, signers_);
}

std::vector<ExpectedHead> expected_heads(const StudyStore& store,
                                         const std::filesystem::path& database) {
  const std::vector<PublicKey> signers = head_signers(store.commitment());
  const std::filesystem::path first = head_path_for(database);
  std::optional<HeadReading> reading = HeadFile(first).reading(signers);
  const std::optional<std::string> recorded_folder = store.heads_on_record();
  if (!recorded_folder && !reading) return {};
  std::set<std::string> folders = {recorded_folder.value_or(""),
                                   reading ? reading->record.also : ""};
  folders.erase("");
  std::vector<ExpectedHead> heads = {{first, std::move(reading)}};
  for (const std::filesystem::path folder : folders) {
    std::filesystem::path second = folder / first.filename();
    reading = HeadFile(second).reading(signers);
    heads.push_back({std::move(second), std::move(reading)});
  }
  return heads;
}

std::vector<Loss> losses(const HeadRecord& head, const StudyStore& store) {
  const HeadRecord current = record_of(store);
  if (!describe_same_database(head, current)) {
    return {{.session = 0,
             .what = "the database is not the one in the head file: it was recreated, its "
                     "first event was altered, or the head file belongs to another database; " +
                     missing_answers(head.acknowledged),
             .answers = head.acknowledged}};
  }
  std::vector<Loss> found;
  if (auto loss = loss_of_chain(store, 0, "the file's chain", head.file)) {
    found.push_back(std::move(*loss));
  }
  std::map<int, std::string> names = names_of_sessions(store);
  for (const auto& [session, end] : head.sessions) {
    const std::string& name =
        names.try_emplace(session, "session " + std::to_string(session)).first->second;
    if (auto loss = loss_of_chain(store, session, name, end)) found.push_back(std::move(*loss));
  }
  add_answers(found, head.acknowledged, current.acknowledged);
  return found;
}

std::string head_digits(const HeadRecord& record) {
  return in_groups_of_four(to_hex(record.file.hash).substr(0, 16));
}

}  // namespace touchtrial::record
