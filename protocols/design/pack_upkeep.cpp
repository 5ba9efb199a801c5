#include "protocols/design/pack_upkeep.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace touchtrial::design {
namespace {

constexpr std::string_view kManifestName = "pack.json";
constexpr std::string_view kFieldEnding = ".field";
constexpr std::string_view kDraftMark = ".tmp";

bool is_number(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// \return the code in the file name of a field, or nothing for any other file name
std::optional<std::string> code_of_file(std::string_view name) {
  if (!name.ends_with(kFieldEnding)) return std::nullopt;
  name.remove_suffix(kFieldEnding.size());
  if (!engine::is_pack_code(name)) return std::nullopt;
  return std::string(name);
}

/// Whether `name` is the name of a pack's file while it is being written.
bool is_draft(std::string_view name) {
  const std::size_t mark = name.rfind(kDraftMark);
  if (mark == std::string_view::npos || !is_number(name.substr(mark + kDraftMark.size()))) {
    return false;
  }
  const std::string_view target = name.substr(0, mark);
  return target == kManifestName || code_of_file(target).has_value();
}

bool names_code(const engine::PackManifest& manifest, const std::string& code) {
  return std::ranges::find(manifest.entries, code, &engine::PackEntry::code) !=
         manifest.entries.end();
}

}  // namespace

PackLock::PackLock(const std::filesystem::path& folder, bool wait)
    : descriptor_(::open((folder / "prepare.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ >= 0 && ::flock(descriptor_, wait ? LOCK_EX : LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  if (descriptor_ >= 0) ::close(descriptor_);
  const std::string place = one_line(folder.string());
  if (reason == EWOULDBLOCK) {
    throw FileError(place + ": the pack is being prepared by another process; wait for it to end");
  }
  throw FileError(place + ": the pack cannot be locked (" +
                  std::generic_category().message(reason) +
                  "); check the folder's permissions and the free space");
}

PackLock::~PackLock() {
  ::close(descriptor_);
}

std::filesystem::path field_path(const std::filesystem::path& folder, const std::string& code) {
  return folder / (code + std::string(kFieldEnding));
}

std::string unfinished_id(const StudyKey& key) {
  return to_hex(ByteView(derive_key(key.master, "identity of an unfinished pack")).first(16));
}

std::optional<engine::PackEntry> EarlierPack::reusable(const std::string& code,
                                                       const Digest& tag) const {
  if (!pack || !names_code(pack->manifest(), code)) return std::nullopt;
  const engine::PackEntry& entry = pack->entry(code);
  try {
    if (entry.input_tag == tag && pack->is_intact(code)) return entry;
  } catch (const FileError&) {
    // Missing or unreadable, so it is written again.
  }
  return std::nullopt;
}

EarlierPack earlier_pack(const std::filesystem::path& folder, const StudyKey& key) {
  EarlierPack earlier;
  if (!std::filesystem::exists(folder / kManifestName)) return earlier;
  try {
    earlier.pack.emplace(folder);
  } catch (const FileError& error) {
    earlier.damage = error.what();
    return earlier;
  }
  const std::string& id = earlier.pack->manifest().study_id;
  if (id == key.study_id || id == unfinished_id(key)) return earlier;
  if (!key.simulated) {
    throw FileError(one_line(folder.string()) +
                    ": holds the pack of another key; prepare into another folder with --pack, or "
                    "remove this one if its key is lost");
  }
  earlier.pack.reset();
  return earlier;
}

void remove_leftovers(const std::filesystem::path& folder, const engine::PackManifest& manifest) {
  std::vector<std::filesystem::path> leftovers;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    const auto code = code_of_file(name);
    const bool stale = code && !names_code(manifest, *code);
    if (stale || is_draft(name)) leftovers.push_back(file.path());
  }
  for (const auto& path : leftovers) {
    std::error_code ignored;  // a leftover that stays does no harm
    std::filesystem::remove(path, ignored);
  }
}

}  // namespace touchtrial::design
