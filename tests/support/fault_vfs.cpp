#include "support/fault_vfs.hpp"

#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include <sqlite3.h>

namespace touchtrial::testing {

namespace {

using Kind = Fault::Kind;
constexpr const char* kName = "touchtrial-faults";
constexpr std::size_t kIndexBytes = 32768;

/// What happens to an operation.
enum class Verdict { done, half, failed, dead };

bool stops_process(Kind kind) {
  return kind == Kind::kill || kind == Kind::torn_kill || kind == Kind::power_cut ||
         kind == Kind::torn_power_cut;
}

}  // namespace

struct FaultVfs::State {
  sqlite3_vfs* real = nullptr;
  sqlite3_vfs ours{};
  FaultDisk disk;
  Fault fault;
  std::array<std::int64_t, kDiskOperations> counts{};
  bool has_occurred = false;
  bool repaired = false;
  bool shares_memory = true;
  std::optional<DiskImage> left;  ///< the disk after a kill or a power cut

  [[nodiscard]] bool is_dead() const { return left.has_value(); }
  Verdict before(DiskOperation operation);
  Verdict inject(DiskOperation operation);
  void record_end();
  [[nodiscard]] int code(int error) const { return fault.kind == Kind::full ? SQLITE_FULL : error; }
};

Verdict FaultVfs::State::before(DiskOperation operation) {
  if (is_dead()) return Verdict::dead;
  ++counts[static_cast<std::size_t>(operation)];
  if (fault.kind == Kind::none || repaired) return Verdict::done;
  if (fault.only && *fault.only != operation) return Verdict::done;
  const std::int64_t number = fault.only
                                  ? counts[static_cast<std::size_t>(operation)]
                                  : std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  const bool now = number == fault.at || (has_occurred && fault.is_persistent);
  return now ? inject(operation) : Verdict::done;
}

Verdict FaultVfs::State::inject(DiskOperation operation) {
  has_occurred = true;
  const bool writes = operation == DiskOperation::write;
  switch (fault.kind) {
    case Kind::short_write:
      return writes ? Verdict::half : Verdict::failed;
    case Kind::full:
      // A full disk still syncs and removes.
      return writes || operation == DiskOperation::create ? Verdict::failed : Verdict::done;
    case Kind::error:
      return Verdict::failed;
    case Kind::torn_kill:
      if (writes) return Verdict::half;
      [[fallthrough]];
    default:
      record_end();
      return Verdict::dead;
  }
}

void FaultVfs::State::record_end() {
  RandomStream random(fault.seed, "power cut", static_cast<std::uint64_t>(fault.at));
  if (fault.kind == Kind::kill || fault.kind == Kind::torn_kill) {
    left = disk.as_seen();
  } else {
    left = disk.after_power_cut(fault.kind == Kind::power_cut ? nullptr : &random);
  }
}

namespace {

FaultVfs::State* active = nullptr;

/// SQLite's view of an open file, followed by the real file.
struct FaultFile {
  sqlite3_file base;
  bool tracked;
  char* path;
  sqlite3_file* real;
};

FaultFile* ours(sqlite3_file* file) {
  return reinterpret_cast<FaultFile*>(file);
}
sqlite3_file* real(sqlite3_file* file) {
  return ours(file)->real;
}

int close_file(sqlite3_file* file) {
  FaultFile* const mine = ours(file);
  const int code =
      mine->real->pMethods == nullptr ? SQLITE_OK : mine->real->pMethods->xClose(mine->real);
  sqlite3_free(mine->path);
  return code;
}

int read_file(sqlite3_file* file, void* buffer, int bytes, sqlite3_int64 offset) {
  return real(file)->pMethods->xRead(real(file), buffer, bytes, offset);
}

int write_part(sqlite3_file* file, const void* buffer, int bytes, sqlite3_int64 offset) {
  const int code = real(file)->pMethods->xWrite(real(file), buffer, bytes, offset);
  if (code == SQLITE_OK && ours(file)->tracked) {
    active->disk.write(
        ours(file)->path, static_cast<std::size_t>(offset),
        ByteView(static_cast<const std::uint8_t*>(buffer), static_cast<std::size_t>(bytes)));
  }
  return code;
}

int write_file(sqlite3_file* file, const void* buffer, int bytes, sqlite3_int64 offset) {
  if (!ours(file)->tracked) return write_part(file, buffer, bytes, offset);
  switch (active->before(DiskOperation::write)) {
    case Verdict::done:
      return write_part(file, buffer, bytes, offset);
    case Verdict::half:
      static_cast<void>(write_part(file, buffer, bytes / 2, offset));
      if (stops_process(active->fault.kind)) active->record_end();
      return SQLITE_IOERR_WRITE;
    default:
      return active->code(SQLITE_IOERR_WRITE);
  }
}

int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
  if (ours(file)->tracked) {
    if (active->before(DiskOperation::truncate) != Verdict::done) {
      return active->code(SQLITE_IOERR_TRUNCATE);
    }
    active->disk.truncate(ours(file)->path, static_cast<std::size_t>(size));
  }
  return real(file)->pMethods->xTruncate(real(file), size);
}

int sync_file(sqlite3_file* file, int /*flags*/) {
  if (!ours(file)->tracked) return SQLITE_OK;
  const Verdict verdict = active->before(DiskOperation::sync);
  if (verdict == Verdict::done) {
    active->disk.sync(ours(file)->path);
    return SQLITE_OK;
  }
  if (verdict == Verdict::failed) active->disk.drop_unsynced(ours(file)->path);
  return SQLITE_IOERR_FSYNC;
}

int file_size(sqlite3_file* file, sqlite3_int64* size) {
  return real(file)->pMethods->xFileSize(real(file), size);
}
int lock_file(sqlite3_file* file, int level) {
  return real(file)->pMethods->xLock(real(file), level);
}
int unlock_file(sqlite3_file* file, int level) {
  return real(file)->pMethods->xUnlock(real(file), level);
}
int check_lock(sqlite3_file* file, int* held) {
  return real(file)->pMethods->xCheckReservedLock(real(file), held);
}
int control_file(sqlite3_file* file, int operation, void* argument) {
  return real(file)->pMethods->xFileControl(real(file), operation, argument);
}
int sector_size(sqlite3_file* file) {
  return real(file)->pMethods->xSectorSize(real(file));
}
int characteristics(sqlite3_file* file) {
  return real(file)->pMethods->xDeviceCharacteristics(real(file));
}
int map_index(sqlite3_file* file, int page, int bytes, int extend, void volatile** memory) {
  return real(file)->pMethods->xShmMap(real(file), page, bytes, extend, memory);
}
int lock_index(sqlite3_file* file, int offset, int count, int flags) {
  return real(file)->pMethods->xShmLock(real(file), offset, count, flags);
}
void index_barrier(sqlite3_file* file) {
  real(file)->pMethods->xShmBarrier(real(file));
}
int unmap_index(sqlite3_file* file, int remove) {
  return real(file)->pMethods->xShmUnmap(real(file), remove);
}

// Version 2 does not map files, so every write passes through here.
constexpr sqlite3_io_methods kMethods = {
    2,          close_file,    read_file,   write_file,   truncate_file, sync_file,       file_size,
    lock_file,  unlock_file,   check_lock,  control_file, sector_size,   characteristics, map_index,
    lock_index, index_barrier, unmap_index, nullptr,      nullptr};

constexpr sqlite3_io_methods without_shared_memory() {
  sqlite3_io_methods methods = kMethods;
  methods.iVersion = 1;
  return methods;
}
constexpr sqlite3_io_methods kMethodsWithoutSharedMemory = without_shared_memory();

Bytes content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool is_tracked(const char* path, int flags) {
  constexpr int kKinds =
      SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_WAL | SQLITE_OPEN_SUPER_JOURNAL;
  return path != nullptr && (flags & kKinds) != 0;
}

/// Adds a file to the disk before it is opened.
/// \return false if it must not be opened
bool add_to_disk(const char* path, int flags) {
  const bool exists = std::filesystem::exists(path);
  if (exists && !active->disk.contains(path)) active->disk.adopt(path, content_of(path));
  if (exists || (flags & SQLITE_OPEN_CREATE) == 0) return true;
  if (active->before(DiskOperation::create) != Verdict::done) return false;
  active->disk.create(path);
  return true;
}

int open_file(sqlite3_vfs* /*vfs*/, const char* path, sqlite3_file* file, int flags, int* granted) {
  FaultFile* const mine = ours(file);
  mine->base.pMethods = nullptr;
  mine->tracked = is_tracked(path, flags);
  mine->path = nullptr;
  mine->real = reinterpret_cast<sqlite3_file*>(mine + 1);
  mine->real->pMethods = nullptr;
  if (mine->tracked && !add_to_disk(path, flags)) return active->code(SQLITE_CANTOPEN);
  const int code = active->real->xOpen(active->real, path, mine->real, flags, granted);
  if (code != SQLITE_OK) return code;
  if (mine->tracked) mine->path = sqlite3_mprintf("%s", path);
  mine->base.pMethods = active->shares_memory ? &kMethods : &kMethodsWithoutSharedMemory;
  return SQLITE_OK;
}

int delete_file(sqlite3_vfs* /*vfs*/, const char* path, int sync_folder) {
  if (active->disk.contains(path) && std::filesystem::exists(path)) {
    if (active->before(DiskOperation::remove) != Verdict::done) return SQLITE_IOERR_DELETE;
    active->disk.remove(path, sync_folder != 0);
  }
  return active->real->xDelete(active->real, path, 0);
}

void overwrite(const std::string& path, const Bytes& content) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(content.data()),
             static_cast<std::streamsize>(content.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace

FaultVfs::FaultVfs() : state_(std::make_unique<State>()) {
  if (active != nullptr) throw std::logic_error("there is a FaultVfs already");
  state_->real = sqlite3_vfs_find(nullptr);
  state_->ours = *state_->real;
  state_->ours.pNext = nullptr;
  state_->ours.zName = kName;
  state_->ours.szOsFile = static_cast<int>(sizeof(FaultFile)) + state_->real->szOsFile;
  state_->ours.xOpen = open_file;
  state_->ours.xDelete = delete_file;
  if (sqlite3_vfs_register(&state_->ours, 1) != SQLITE_OK) {
    throw std::runtime_error("SQLite refuses another file system");
  }
  active = state_.get();
}

FaultVfs::~FaultVfs() {
  sqlite3_vfs_unregister(&state_->ours);
  active = nullptr;
}

void FaultVfs::plan(const Fault& fault) {
  state_->fault = fault;
  state_->counts = {};
  state_->has_occurred = false;
  state_->repaired = false;
}

void FaultVfs::forbid_shared_memory() {
  state_->shares_memory = false;
}

void FaultVfs::repair() {
  state_->repaired = true;
}

std::int64_t FaultVfs::operations() const noexcept {
  return std::accumulate(state_->counts.begin(), state_->counts.end(), std::int64_t{0});
}

std::int64_t FaultVfs::count(DiskOperation operation) const noexcept {
  return state_->counts[static_cast<std::size_t>(operation)];
}

bool FaultVfs::has_occurred() const noexcept {
  return state_->has_occurred;
}

void FaultVfs::restore_disk() {
  if (!state_->left) throw std::logic_error("there was neither a kill nor a power cut");
  const DiskImage left = *std::exchange(state_->left, std::nullopt);
  state_->disk = {};
  for (const auto& [path, content] : left) {
    if (!std::filesystem::exists(std::filesystem::path(path).parent_path())) continue;
    std::filesystem::remove(path + "-shm");
    if (!content) {
      std::filesystem::remove(path);
      continue;
    }
    overwrite(path, *content);
    if (left.count(path + "-wal") > 0) overwrite(path + "-shm", Bytes(kIndexBytes, 0xa5));
  }
  plan({});
}

}  // namespace touchtrial::testing
