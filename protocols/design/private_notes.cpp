#include "protocols/design/private_notes.hpp"

#include "core/errors.hpp"
#include "core/file_stamp.hpp"
#include "core/files.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

namespace touchtrial::design {
namespace {

/// Coarse, so that the size of a file of notes says little.
constexpr std::size_t kPaddedSize = 4096;
constexpr std::uintmax_t kLargestNotes = std::uintmax_t{1} << 28;

/// Distinguishes builds of the program, whose numbers may differ; empty if the system does not say.
std::string this_build() {
  const auto program = stamp_of("/proc/self/exe");
  if (!program) return "";
  return std::to_string(program->bytes) + " " + std::to_string(program->modified_ns) + " " +
         std::to_string(program->changed_ns);
}

/// Removes the notes, and what was left of drafts, that nobody has written for kKeptNotes. Whose
/// they are cannot be told without their keys.
void remove_old_notes(const std::filesystem::path& folder) {
  std::error_code error;
  const auto oldest = std::filesystem::file_time_type::clock::now() - kKeptNotes;
  for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    std::error_code unknown;
    const bool is_notes = file->path().filename().string().find(".notes") != std::string::npos;
    if (!is_notes || !file->is_regular_file(unknown)) continue;
    const auto written = file->last_write_time(unknown);
    if (!unknown && written < oldest) std::filesystem::remove(file->path(), unknown);
  }
}

}  // namespace

PrivateNotes::PrivateNotes(const std::filesystem::path& folder, const SecretKey& master,
                           std::string_view subject)
    : key_(derive_key(master, "private notes")) {
  const std::string build = this_build();
  if (folder.empty() || build.empty()) return;
  context_ = std::string(subject) + " by " + build;
  const Digest name = keyed_hash(key_, bytes_of(subject));
  file_ = folder / (to_hex(ByteView(name).first(16)) + ".notes");
}

std::optional<std::string> PrivateNotes::read() const {
  if (file_.empty() || !is_there(file_)) return std::nullopt;
  try {
    const auto text = unseal(key_, context_, read_file(file_, kLargestNotes), kPaddedSize);
    if (text) return std::string(text_of(*text));
  } catch (const FileError&) {
    // As if there were none.
  }
  return std::nullopt;
}

/// Not synced: notes that a power cut damages do not open.
void PrivateNotes::keep(std::string_view text) const {
  if (file_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(file_.parent_path(), error);
  std::filesystem::path draft = file_;
  draft += ".tmp" + std::to_string(::getpid());
  const Bytes box = seal(key_, context_, bytes_of(text), kPaddedSize);
  std::ofstream file(draft, std::ios::binary);
  file.write(reinterpret_cast<const char*>(box.data()), static_cast<std::streamsize>(box.size()));
  file.close();
  if (file) std::filesystem::rename(draft, file_, error);
  if (!file || error) std::filesystem::remove(draft, error);
  remove_old_notes(file_.parent_path());
}

}  // namespace touchtrial::design
