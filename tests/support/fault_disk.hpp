/// \file Models which file content a disk keeps after a power cut.
#pragma once

#include "core/bytes.hpp"
#include "core/random.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::testing {

/// File content by path; nullopt: the file does not exist.
using DiskImage = std::map<std::string, std::optional<Bytes>>;

/// Stores each file twice: as programs see it, and as it is on the disk. A sector (512 bytes) is
/// written completely or not at all, and does not affect its neighbours.
class FaultDisk {
 public:
  [[nodiscard]] bool contains(const std::string& path) const { return files_.count(path) > 0; }
  /// Adds a file whose content is already durable.
  void adopt(const std::string& path, Bytes content);
  /// Creates an empty file, which is durable only after a sync.
  void create(const std::string& path);
  void write(const std::string& path, std::size_t offset, ByteView bytes);
  void truncate(const std::string& path, std::size_t size);
  /// Makes the file's content and its folder's entries durable.
  void sync(const std::string& path);
  /// Models a failed sync: as on Linux, the unsynced data are lost, although programs still see
  /// them.
  void drop_unsynced(const std::string& path);
  /// \param durably  whether the removal is synced
  void remove(const std::string& path, bool durably);

  /// The files after a kill of the process: everything that programs saw.
  [[nodiscard]] DiskImage as_seen() const;
  /// The files after a power cut.
  /// \param random  draws which unsynced sectors are on the disk; null: none
  [[nodiscard]] DiskImage after_power_cut(RandomStream* random) const;

 private:
  /// A write, or a change of length.
  struct Change {
    std::size_t offset = 0;
    Bytes bytes;
    bool truncates = false;
  };
  struct File {
    bool is_seen = false;
    bool is_durable = false;
    Bytes seen;
    Bytes durable;
    std::vector<Change> pending;  ///< seen by programs, but not durable
  };

  static void apply(const Change& change, Bytes& content);
  static void apply_in_part(const Change& change, Bytes& content, RandomStream& random);
  static void record(File& file, Change change);

  std::map<std::string, File> files_;
};

}  // namespace touchtrial::testing
