/// \file A model of a disk whose power can be cut: which content of its files, synced or not,
///   remains.
#pragma once

#include "core/bytes.hpp"
#include "core/random.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::testing {

/// Files by their paths; nothing where there is none.
using DiskImage = std::map<std::string, std::optional<Bytes>>;

/// Keeps every file twice: as programs see it, and as the platter has it. A sector (512 bytes) is
/// written as a whole or not at all, and does not affect its neighbours.
class FaultDisk {
 public:
  [[nodiscard]] bool knows(const std::string& path) const { return files_.count(path) > 0; }
  /// Adds a file whose content is already durable.
  void adopt(const std::string& path, Bytes content);
  /// Creates an empty file; it surely exists only after a sync.
  void create(const std::string& path);
  void write(const std::string& path, std::size_t offset, ByteView bytes);
  void truncate(const std::string& path, std::size_t size);
  /// Makes everything that was written to the file durable, and its folder's entries as well.
  void sync(const std::string& path);
  /// A sync that failed: as on Linux, the data that it should have written are lost, although
  /// programs still see them.
  void lose(const std::string& path);
  /// \param durably  whether its absence is certain
  void remove(const std::string& path, bool durably);

  /// The files after a process was killed: everything that programs saw.
  [[nodiscard]] DiskImage as_seen() const;
  /// The files after a power cut: what was synced, and with `random` any part of the rest, sector
  /// by sector.
  /// \param random  may be null
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
    bool is_safe = false;
    Bytes seen;
    Bytes safe;
    std::vector<Change> pending;  ///< seen by programs, but not durable
  };

  static void apply(const Change& change, Bytes& content);
  static void apply_in_part(const Change& change, Bytes& content, RandomStream& random);
  static void record(File& file, Change change);

  std::map<std::string, File> files_;
};

}  // namespace touchtrial::testing
