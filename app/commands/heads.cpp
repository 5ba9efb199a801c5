#include "app/commands/heads.hpp"

#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "record/head_file.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// The losses, each session and the file's chain once, by the most complete head file.
std::vector<record::Loss> losses_of(const record::StudyStore& store,
                                    std::vector<record::HeadReading> readings) {
  std::ranges::stable_sort(
      readings, std::ranges::greater{}, [](const record::HeadReading& reading) {
        return std::pair(reading.record.file.length, reading.record.acknowledged);
      });
  std::vector<record::Loss> found;
  std::set<int> named;
  for (const record::HeadReading& reading : readings) {
    if (!reading.damage.empty()) {
      spdlog::warn("{}: {}", one_line(reading.file.string()), reading.damage);
    }
    std::vector<record::Loss> losses = record::losses(reading.record, store);
    std::erase_if(losses, [&](const record::Loss& loss) { return named.contains(loss.session); });
    for (record::Loss& loss : losses) {
      if (found.empty())
        loss.what = "as " + one_line(reading.file.string()) + " knows it, " + loss.what;
      named.insert(loss.session);
      found.push_back(std::move(loss));
    }
  }
  return found;
}

/// The head files to compare a database with: those on record, and the one in a newly named folder.
std::vector<record::KnownHead> heads_of(const record::StudyStore& store, const fs::path& database,
                                        const HeadOptions& options) {
  std::vector<record::KnownHead> heads = record::known_heads(store, database);
  if (!options.folder || options.folder->empty()) return heads;
  const fs::path named =
      fs::weakly_canonical(*options.folder) / record::head_path_for(database).filename();
  if (std::ranges::count(heads, named, &record::KnownHead::file) > 0) return heads;
  auto reading = record::HeadFile(named).reading(record::head_signers(store.commitment()));
  if (reading) heads.push_back({named, std::move(reading)});
  return heads;
}

std::vector<record::HeadReading> readings_of(const std::vector<record::KnownHead>& heads) {
  std::vector<record::HeadReading> readings;
  for (const record::KnownHead& head : heads) {
    if (head.reading) readings.push_back(*head.reading);
  }
  return readings;
}

/// Adds missing head files. The one beside the database is recreated from another one whose folder
/// is named.
void add_gone(std::vector<record::Loss>& missing, const std::vector<record::KnownHead>& heads,
              const fs::path& own, const HeadOptions& options) {
  const bool is_restored = options.folder && !readings_of(heads).empty();
  for (const record::KnownHead& head : heads) {
    if (head.reading || (head.file == own && is_restored)) continue;
    const std::string name = one_line(head.file.string());
    missing.push_back(
        {.session = 0,
         .what = head.file == own
                     ? "its head file " + name +
                           " is gone, so further losses cannot be detected (if there is a "
                           "second head file, name its folder with run --heads)"
                     : "its second head file " + name +
                           " is gone, so it is unknown whether the first is the newest (restore "
                           "it, or connect its disk)"});
  }
}

/// Records which head files there are. A head file that is no longer used is updated too, so that
/// it reveals an older copy of the database.
void record_heads(record::StudyStore& store, const std::vector<record::KnownHead>& before,
                  const record::HeadFiles& files, const Signer& signer) {
  if (store.heads_on_record() == files.also()) return;
  store.record_heads(files.also(), utc_now());
  const std::vector<fs::path> now = files.paths();
  for (const record::KnownHead& head : before) {
    if (!head.reading || std::ranges::count(now, head.file) > 0) continue;
    if (head.reading->record.database != record::record_of(store).database) continue;
    try {
      record::HeadFile(head.file).update(
          signer,
          [&](record::HeadRecord& record) {
            record.advance_file(store.file_head());
            record.also = files.also();
          },
          record::head_signers(store.commitment()));
    } catch (const StoreError& error) {
      spdlog::warn("{}", error.what());
    }
  }
}

std::string words_on(const std::vector<record::Loss>& losses) {
  return listed(losses, "; ", &record::Loss::what);
}

void accept(record::StudyStore& store, const std::vector<record::Loss>& losses,
            const std::string& reason) {
  std::map<int, std::string> sessions;
  std::int64_t answers = 0;
  for (const record::Loss& loss : losses) {
    if (loss.session > 0 && store.last_event(loss.session)) sessions[loss.session] = loss.what;
    answers = std::max(answers, loss.answers);
  }
  store.accept_loss({.reason = reason, .missing = words_on(losses), .answers = answers}, sessions,
                    utc_now());
}

void warn_of_no_loss() {
  spdlog::warn("--accept-loss: no head file shows a loss, and none was recorded");
}

bool is_on_disk_of(const fs::path& file, const fs::path& database) {
  struct stat one {};
  struct stat other {};
  return ::stat(file.parent_path().c_str(), &one) == 0 && ::stat(database.c_str(), &other) == 0 &&
         one.st_dev == other.st_dev;
}

void warn_if_on_one_disk(const record::HeadFiles& files, const record::StudyStore& store,
                         const fs::path& database) {
  const std::vector<fs::path> paths = files.paths();
  const bool is_alone = paths.size() < 2 || is_on_disk_of(fs::absolute(paths.back()), database);
  if (!is_alone || store.commitment().simulated) return;
  spdlog::warn(
      "{}: the head of the study is stored only on the database's disk, and would be lost with it; "
      "name a folder on another disk with --heads",
      one_line(database.string()));
}

}  // namespace

void refuse_lost_database(const std::filesystem::path& database,
                          const record::StudyCommitment& commitment, const HeadOptions& options) {
  if (!options.accept_loss.empty()) return;
  const record::HeadFiles files(database, record::head_signers(commitment), options.folder);
  const std::vector<record::HeadReading> readings = files.read();
  if (readings.empty()) return;
  throw StoreError(fmt::format(
      "{}: is missing, but its head file {} records it, with {} acknowledged; restore the database "
      "and its -wal from a complete copy, or begin a new one with --accept-loss REASON, which "
      "is recorded",
      one_line(database.string()), one_line(readings.front().file.string()),
      counted(readings.front().record.acknowledged, "answer")));
}

void set_head_writer(record::StudyStore& store, const fs::path& database, const Signer& signer,
                     const HeadOptions& options, HeadUse use) {
  const fs::path own = record::head_path_for(database);
  std::vector<record::KnownHead> known = heads_of(store, database, options);
  const std::vector<record::HeadReading> readings = readings_of(known);
  if (use == HeadUse::if_there && readings.empty()) {
    if (!options.accept_loss.empty()) warn_of_no_loss();
    if (!store.commitment().simulated && store.stations() == 0) {
      spdlog::warn("{}: has no head file beside it, so losses cannot be detected",
                   one_line(database.string()));
    }
    return;
  }
  if (known.empty() && !store.sessions().empty()) known.push_back({own, std::nullopt});
  std::vector<record::Loss> missing = losses_of(store, readings);
  add_gone(missing, known, own, options);
  if (!missing.empty() && options.accept_loss.empty()) {
    throw StoreError(one_line(database.string()) +
                     ": lacks events that its head file records: " + words_on(missing) +
                     "; restore the database and its -wal from a complete copy, or continue with "
                     "--accept-loss REASON, which is recorded [lost-events]");
  }
  if (missing.empty() && !options.accept_loss.empty()) warn_of_no_loss();
  std::string also = store.heads_on_record().value_or("");
  if (also.empty() && !readings.empty()) also = readings.front().record.also;
  const record::HeadFiles files(database, record::head_signers(store.commitment()),
                                options.folder.value_or(also));
  if (!missing.empty()) {
    accept(store, missing, options.accept_loss);
    files.update(signer, [&](record::HeadRecord& record) {
      const std::int64_t count = record.count;
      record = record::record_of(store);
      record.count = count;
    });
  }
  if (use == HeadUse::required) warn_if_on_one_disk(files, store, database);
  store.set_head_writer(
      [files, signer](const record::HeadChange& change) { files.update(signer, change); });
  if (use == HeadUse::required) record_heads(store, known, files, signer);
}

void require_head_beside(const fs::path& database) {
  const record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_only);
  const std::vector<record::KnownHead> known = record::known_heads(store, database);
  if (!known.empty() && !known.front().reading) {
    spdlog::warn("{}: its head file is not beside it, and was not compared",
                 one_line(database.string()));
  }
  const std::vector<record::Loss> missing = losses_of(store, readings_of(known));
  if (missing.empty()) return;
  throw VerificationError(
      one_line(database.string()) +
      ": lacks events that its head file records: " + words_on(missing) +
      "; take the database and its -wal from a complete copy, or record the loss at its "
      "station, for instance with `touchtrial note --accept-loss REASON`");
}

void make_head(const record::StudyStore& store, const fs::path& database, const Signer& signer) {
  const fs::path own = record::head_path_for(database);
  std::error_code ignored;
  fs::remove(own, ignored);  // left over from a database that is gone
  record::HeadFile(own).update(
      signer, [&](record::HeadRecord& record) { record = record::record_of(store); });
}

std::string head_words(const record::StudyStore& store) {
  const record::HeadRecord now = record::record_of(store);
  return fmt::format("head {}, {} acknowledged", record::head_digits(now),
                     counted(now.acknowledged, "answer"));
}

}  // namespace touchtrial::app
