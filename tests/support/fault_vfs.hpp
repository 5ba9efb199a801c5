/// \file A file system for SQLite that simulates failures, kills and power cuts.
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

/// A fault and its time.
struct Fault {
  enum class Kind {
    none,
    error,           ///< the operation fails with SQLITE_IOERR
    full,            ///< it fails with SQLITE_FULL
    short_write,     ///< half of the data is written, then SQLITE_IOERR
    kill,            ///< the process ends before it; all written data remain
    torn_kill,       ///< the process ends during it
    power_cut,       ///< power fails before it; unsynced data are lost
    torn_power_cut,  ///< the same, but any part of the unsynced data remains
  };
  Kind kind = Kind::none;
  std::int64_t at = 0;                  ///< number of the operation, from 1 after FaultVfs::plan
  std::optional<DiskOperation> only{};  ///< the only operation that counts
  bool is_persistent = false;           ///< all later operations fail until `repair`
  std::uint64_t seed = 1;               ///< determines which unsynced writes remain
};

/// During its lifetime all SQLite connections of this process use it. It forwards operations to
/// SQLite's own file system (except syncs, which take long), and tracks which are durable. Only one
/// may exist; not thread-safe.
class FaultVfs {
 public:
  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// Sets the fault, and restarts the count of operations.
  void plan(const Fault& fault);
  /// Opens later files as on a file system without shared memory.
  void forbid_shared_memory();
  /// Ends lasting errors.
  void repair();
  /// Number of operations since `plan`.
  [[nodiscard]] std::int64_t operations() const noexcept;
  [[nodiscard]] std::int64_t count(DiskOperation operation) const noexcept;
  /// Whether the planned fault has occurred.
  [[nodiscard]] bool has_occurred() const noexcept;
  /// Restores the disk to its state at the kill or power cut, without later writes of destructors.
  /// Requires that all connections are closed. Fills index files (-shm) with garbage.
  void restore_disk();

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::testing
