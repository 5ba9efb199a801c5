#include "support/fault_disk.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::testing {
namespace {

constexpr std::size_t kSectorBytes = 512;

void put(Bytes& content, std::size_t offset, ByteView bytes) {
  content.resize(std::max(content.size(), offset + bytes.size()));
  std::copy(bytes.begin(), bytes.end(), content.begin() + static_cast<std::ptrdiff_t>(offset));
}

bool flip_coin(RandomStream& random) {
  return random.below(2) == 1;
}

}  // namespace

void FaultDisk::adopt(const std::string& path, Bytes content) {
  files_[path] = {
      .is_seen = true, .is_durable = true, .seen = content, .durable = content, .pending = {}};
}

void FaultDisk::create(const std::string& path) {
  File& file = files_[path];
  file.is_seen = true;
  file.seen.clear();
  // If the removal was not synced, the old content may remain.
  file.pending = {{.offset = 0, .bytes = {}, .truncates = true}};
}

void FaultDisk::record(File& file, Change change) {
  apply(change, file.seen);
  file.pending.push_back(std::move(change));
}

void FaultDisk::write(const std::string& path, std::size_t offset, ByteView bytes) {
  record(files_[path],
         {.offset = offset, .bytes = Bytes(bytes.begin(), bytes.end()), .truncates = false});
}

void FaultDisk::truncate(const std::string& path, std::size_t size) {
  record(files_[path], {.offset = size, .bytes = {}, .truncates = true});
}

void FaultDisk::sync(const std::string& path) {
  File& file = files_[path];
  for (const Change& change : file.pending) apply(change, file.durable);
  file.pending.clear();
  file.is_durable = true;
  for (auto& [other, removed] : files_) {
    if (!removed.is_seen) removed.is_durable = false;
  }
}

void FaultDisk::drop_unsynced(const std::string& path) {
  files_[path].pending.clear();
}

void FaultDisk::remove(const std::string& path, bool durably) {
  File& file = files_[path];
  file.is_seen = false;
  file.pending.clear();
  if (durably) file.is_durable = false;
}

void FaultDisk::apply(const Change& change, Bytes& content) {
  if (change.truncates) {
    content.resize(change.offset);
  } else {
    put(content, change.offset, change.bytes);
  }
}

void FaultDisk::apply_in_part(const Change& change, Bytes& content, RandomStream& random) {
  if (change.truncates) {
    if (flip_coin(random)) apply(change, content);
    return;
  }
  std::size_t done = 0;
  while (done < change.bytes.size()) {
    const std::size_t at = change.offset + done;
    const std::size_t part = std::min(kSectorBytes - at % kSectorBytes, change.bytes.size() - done);
    if (flip_coin(random)) put(content, at, ByteView(change.bytes).subspan(done, part));
    done += part;
  }
}

DiskImage FaultDisk::as_seen() const {
  DiskImage image;
  for (const auto& [path, file] : files_) {
    image[path] = file.is_seen ? std::optional(file.seen) : std::nullopt;
  }
  return image;
}

DiskImage FaultDisk::after_power_cut(RandomStream* random) const {
  DiskImage image;
  for (const auto& [path, file] : files_) {
    bool remains = file.is_durable;
    if (random != nullptr && file.is_seen != file.is_durable) remains = flip_coin(*random);
    Bytes content = file.durable;
    if (random != nullptr) {
      for (const Change& change : file.pending) apply_in_part(change, content, *random);
    }
    image[path] = remains ? std::optional(std::move(content)) : std::nullopt;
  }
  return image;
}

}  // namespace touchtrial::testing
