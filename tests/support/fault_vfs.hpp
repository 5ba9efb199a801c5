/// \file A file system under SQLite that fails, is killed or loses power when a test requests it.
/// Source: "The SQLite OS Interface or VFS", https://www.sqlite.org/vfs.html
#pragma once

#include "support/fault_disk.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::testing {

/// SQLite's operations on a disk. Reading changes nothing and is not counted.
enum class DiskOperation { create, write, truncate, sync, remove };
inline constexpr std::size_t kDiskOperations = 5;

/// The fault, and when it occurs.
struct Fault {
  enum class Kind {
    none,
    error,           ///< the operation fails with SQLITE_IOERR
    full,            ///< it fails with SQLITE_FULL
    short_write,     ///< half of a write is done, then SQLITE_IOERR
    kill,            ///< the process ends before it: all that was written stays
    torn_kill,       ///< the process ends in the middle of it
    power_cut,       ///< the machine ends before it: what was not synced is lost
    torn_power_cut,  ///< the same, but any part of what was not synced is on the disk
  };
  Kind kind = Kind::none;
  std::int64_t at = 0;                  ///< which operation, from 1, counted from FaultVfs::plan on
  std::optional<DiskOperation> only{};  ///< counts only these operations
  bool lasts = false;                   ///< errors: every later operation fails too, until `repair`
  std::uint64_t seed = 1;               ///< decides which unsynced writes happen to be on the disk
};

/// While it lives, every connection of this process goes through it. It passes operations on to
/// SQLite's own file system (except syncs, which take long), and knows which of them are durable.
/// One at a time; not thread-safe.
class FaultVfs {
 public:
  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// Plans a fault; operations are counted from this call on.
  void plan(const Fault& fault);
  /// From now on, files are opened as on a file system without shared memory.
  void forbid_shared_memory();
  /// Ends lasting errors.
  void repair();
  /// Operations since `plan`.
  [[nodiscard]] std::int64_t operations() const noexcept;
  [[nodiscard]] std::int64_t count(DiskOperation operation) const noexcept;
  /// Whether the planned fault has occurred.
  [[nodiscard]] bool struck() const noexcept;
  /// Call this after a kill or a power cut, when every connection is closed. Restores the disk to
  /// the state at that moment, whatever destructors have written since. Index files (-shm) then
  /// contain garbage.
  void start_anew();

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::testing
