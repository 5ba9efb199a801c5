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
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return std::pair<unsigned long, unsigned long>(found.st_dev, found.st_ino);
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
  constexpr std::chrono::milliseconds kNoticed{500};
  const Clock::time_point began = Clock::now();
  for (;;) {
    try {
      store();
      const auto took = Clock::now() - began;
      if (took >= kNoticed) waited_ = std::max(waited_.value_or(took), took);
      return;
    } catch (const record::LockedStore& locked) {
      if (!waiting_ || !waiting_(locked.what())) throw;
    }
  }
}

DatabaseWatch::DatabaseWatch(fs::path database)
    : database_(std::move(database)),
      file_{database_, id_of(database_)},
      log_{log_of(database_), id_of(log_of(database_))} {}

std::string DatabaseWatch::trouble() {
  constexpr std::chrono::seconds kPollInterval{1};
  const Clock::time_point now = Clock::now();
  if (!trouble_.empty() || now - looked_ < kPollInterval) return trouble_;
  looked_ = now;
  for (const File& file : {file_, log_}) {
    const auto id = id_of(file.path);
    if (id == file.id) continue;
    trouble_ = fmt::format("{} was {} while the session ran", one_line(file.path.string()),
                           id ? "replaced by another file" : "removed");
    break;
  }
  return trouble_;
}

bool is_on_disk(const fs::path& database, int session, const record::StudyStore& store) {
  try {
    const record::StudyStore found =
        record::StudyStore::open(database, record::StudyStore::Access::read_only);
    const auto there = found.last_event(session);
    const auto here = store.last_event(session);
    return there && here && there->sequence == here->sequence && there->hash == here->hash;
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
    if (is_there(name)) continue;
    try {
      store.copy_to(name);
      // The copy has its own head file.
      std::error_code ignored;
      fs::copy_file(beside_database(database, ".head"), beside_database(name, ".head"), ignored);
      return fmt::format(
          "the recorded events are in {}; find out which file is the study's before "
          "the next session",
          one_line(name.string()));
    } catch (const Error& error) {
      return fmt::format("the recorded events could not be saved ({})", error.what());
    }
  }
}

}  // namespace touchtrial::app
