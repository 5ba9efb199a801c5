/// \file A file system under SQLite that fails, is killed or loses power when a test says so.
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

/// What SQLite does to a disk. Reading changes nothing and is not counted.
enum class DiskOperation { create, write, truncate, sync, remove };
inline constexpr std::size_t kDiskOperations = 5;

/// What goes wrong, and when.
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
  std::optional<DiskOperation> only{};  ///< counts these alone
  bool lasts = false;                   ///< errors: so does every one after it, until `repair`
  std::uint64_t seed = 1;               ///< of what is on the disk by chance
};

/// While it lives every connection of this process goes through it: it passes operations on to
/// SQLite's own file system (but syncs nothing, which takes long), and knows what of them is safe.
/// One at a time; not thread-safe.
class FaultVfs {
 public:
  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// Counts from here.
  void plan(const Fault& fault);
  /// From here on files are opened as on a file system without shared memory.
  void forbid_shared_memory();
  /// Errors that last end.
  void repair();
  /// Operations since `plan`.
  [[nodiscard]] std::int64_t operations() const noexcept;
  [[nodiscard]] std::int64_t count(DiskOperation operation) const noexcept;
  /// Whether the planned fault has come.
  [[nodiscard]] bool struck() const noexcept;
  /// After a kill or a power cut, when every connection is gone: puts on the disk what it left at
  /// that moment, whatever the program's ways out did since. Index files (-shm) hold garbage then.
  void start_anew();

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::testing
