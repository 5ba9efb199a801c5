/// \file What a disk holds of the files written through it, synced or not: a model whose power can
/// be cut.
#pragma once

#include "core/bytes.hpp"
#include "core/random.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::testing {

/// Files by their paths; nothing where there is none.
using DiskImage = std::map<std::string, std::optional<Bytes>>;

/// Keeps every file twice: as programs see it, and as the platter has it. A sector (512 bytes) is
/// written whole or not at all, and without harm to its neighbours.
class FaultDisk {
 public:
  [[nodiscard]] bool knows(const std::string& path) const { return files_.count(path) > 0; }
  /// A file that lies there safely.
  void adopt(const std::string& path, Bytes content);
  /// A new, empty file; it is there for certain only after a sync.
  void create(const std::string& path);
  void write(const std::string& path, std::size_t offset, ByteView bytes);
  void truncate(const std::string& path, std::size_t size);
  /// All that was written to the file is safe now, and so are its folder's entries.
  void sync(const std::string& path);
  /// A sync that failed: as Linux does, what it should have written is forgotten, though programs
  /// go on seeing it.
  void lose(const std::string& path);
  /// \param durably  whether its absence is certain
  void remove(const std::string& path, bool durably);

  /// What a process that was killed leaves: everything that programs saw.
  [[nodiscard]] DiskImage as_seen() const;
  /// What a power cut leaves: what was synced, and with `random` any part of the rest, sector by
  /// sector. \param random  may be null
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
    std::vector<Change> pending;  ///< seen, but not safe
  };

  static void apply(const Change& change, Bytes& content);
  static void apply_in_part(const Change& change, Bytes& content, RandomStream& random);
  static void record(File& file, Change change);

  std::map<std::string, File> files_;
};

}  // namespace touchtrial::testing
