#include "app/run/database_watch.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/damage.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <sys/stat.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

std::optional<std::pair<unsigned long, unsigned long>> id_of(const fs::path& path) {
  struct stat file_status {};
  if (::stat(path.c_str(), &file_status) != 0) return std::nullopt;
  return std::pair<unsigned long, unsigned long>(file_status.st_dev, file_status.st_ino);
}

fs::path log_of(const fs::path& database) {
  fs::path log = database;
  return log += "-wal";
}

}  // namespace

void PatientSink::accept(const record::Event& event,
                         const std::optional<record::SealedTrace>& trace) {
  retry_while_locked([&] { inner_->accept(event, trace); });
}

void PatientSink::accept_together(std::span<const record::RecordedEvent> events) {
  retry_while_locked([&] { inner_->accept_together(events); });
}

void PatientSink::retry_while_locked(const std::function<void()>& store) {
  // Longer than any usable disk takes.
  constexpr std::chrono::milliseconds kNoticeable{500};
  const Clock::time_point start = Clock::now();
  for (;;) {
    try {
      store();
      const auto duration = Clock::now() - start;
      if (duration >= kNoticeable)
        longest_wait_ = std::max(longest_wait_.value_or(duration), duration);
      return;
    } catch (const record::LockedStore& error) {
      if (!wait_callback_ || !wait_callback_(error.what())) throw;
    }
  }
}

DatabaseWatch::DatabaseWatch(fs::path database)
    : database_(std::move(database)),
      file_{database_, id_of(database_)},
      log_{log_of(database_), id_of(log_of(database_))} {}

std::string DatabaseWatch::problem() {
  constexpr std::chrono::seconds kPollInterval{1};
  const Clock::time_point now = Clock::now();
  if (!problem_.empty() || now - checked_at_ < kPollInterval) return problem_;
  checked_at_ = now;
  for (const File& file : {file_, log_}) {
    const auto id = id_of(file.path);
    if (id == file.id) continue;
    problem_ = fmt::format("{} was {} while the session ran", one_line(file.path.string()),
                           id ? "replaced by another file" : "removed");
    break;
  }
  return problem_;
}

bool is_on_disk(const fs::path& database, int session, const record::StudyStore& store) {
  try {
    const record::StudyStore reopened =
        record::StudyStore::open(database, record::StudyStore::Access::read_only);
    const auto on_disk = reopened.last_event(session);
    const auto recorded = store.last_event(session);
    return on_disk && recorded && on_disk->sequence == recorded->sequence &&
           on_disk->hash == recorded->hash;
  } catch (const record::LockedStore&) {
    return true;  // locked by a reader, who cannot have changed it
  } catch (const StoreError&) {
    return false;
  }
}

std::string save_copy(const fs::path& database, const record::StudyStore& store) {
  for (int i = 1;; ++i) {
    fs::path name = database;
    name.replace_extension();
    name += fmt::format("-rescued-{}.db", i);
    if (path_exists(name)) continue;
    try {
      store.copy_to(name);
      // The copy needs its own head file.
      std::error_code ignored;
      fs::copy_file(database_companion(database, ".head"), database_companion(name, ".head"),
                    ignored);
      return fmt::format(
          "the recorded events are saved in {}; find out which file belongs to the study before "
          "the next session",
          one_line(name.string()));
    } catch (const Error& error) {
      return fmt::format("the recorded events could not be saved ({})", error.what());
    }
  }
}

}  // namespace touchtrial::app
