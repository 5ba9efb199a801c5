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

/// The losses according to the most complete head file, at most one per session and one for the
/// file's chain.
std::vector<record::Loss> losses_of(const record::StudyStore& store,
                                    std::vector<record::HeadReading> readings) {
  std::ranges::stable_sort(
      readings, std::ranges::greater{}, [](const record::HeadReading& reading) {
        return std::pair(reading.record.file.length, reading.record.acknowledged);
      });
  std::vector<record::Loss> new_losses;
  std::set<int> reported_sessions;
  for (const record::HeadReading& reading : readings) {
    if (!reading.damage.empty()) {
      spdlog::warn("{}: {}", one_line(reading.file.string()), reading.damage);
    }
    std::vector<record::Loss> losses = record::losses(reading.record, store);
    std::erase_if(
        losses, [&](const record::Loss& loss) { return reported_sessions.contains(loss.session); });
    for (record::Loss& loss : losses) {
      if (new_losses.empty())
        loss.what = "according to " + one_line(reading.file.string()) + ", " + loss.what;
      reported_sessions.insert(loss.session);
      new_losses.push_back(std::move(loss));
    }
  }
  return new_losses;
}

/// The head files to compare a database with: the recorded ones, and the one in a newly named
/// folder.
std::vector<record::ExpectedHead> heads_of(const record::StudyStore& store,
                                           const fs::path& database, const HeadOptions& options) {
  std::vector<record::ExpectedHead> heads = record::expected_heads(store, database);
  if (!options.folder || options.folder->empty()) return heads;
  const fs::path new_head =
      fs::weakly_canonical(*options.folder) / record::head_path_for(database).filename();
  if (std::ranges::count(heads, new_head, &record::ExpectedHead::file) > 0) return heads;
  auto reading = record::HeadFile(new_head).reading(record::head_signers(store.commitment()));
  if (reading) heads.push_back({new_head, std::move(reading)});
  return heads;
}

std::vector<record::HeadReading> readings_of(const std::vector<record::ExpectedHead>& heads) {
  std::vector<record::HeadReading> readings;
  for (const record::ExpectedHead& head : heads) {
    if (head.reading) readings.push_back(*head.reading);
  }
  return readings;
}

/// Adds missing head files to the losses. The one beside the database is not missing if another one
/// can restore it.
void add_missing_heads(std::vector<record::Loss>& losses,
                       const std::vector<record::ExpectedHead>& heads, const fs::path& main_head,
                       const HeadOptions& options) {
  const bool is_restored = options.folder && !readings_of(heads).empty();
  for (const record::ExpectedHead& head : heads) {
    if (head.reading || (head.file == main_head && is_restored)) continue;
    const std::string name = one_line(head.file.string());
    losses.push_back(
        {.session = 0,
         .what = head.file == main_head
                     ? "its head file " + name +
                           " is missing, so further losses cannot be detected (if there is a "
                           "second head file, name its folder with run --heads)"
                     : "its second head file " + name +
                           " is missing, so it is unknown whether the first is up to date "
                           "(restore it, or connect its disk)"});
  }
}

/// Records the paths of the head files. A head file that is no longer used is updated a last time,
/// so that it reveals an older copy of the database.
void record_heads(record::StudyStore& store, const std::vector<record::ExpectedHead>& previous,
                  const record::HeadFiles& files, const Signer& signer) {
  if (store.heads_on_record() == files.also()) return;
  store.record_heads(files.also(), utc_now());
  const std::vector<fs::path> current_paths = files.paths();
  for (const record::ExpectedHead& head : previous) {
    if (!head.reading || std::ranges::count(current_paths, head.file) > 0) continue;
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

std::string descriptions_of(const std::vector<record::Loss>& losses) {
  return listed(losses, "; ", &record::Loss::what);
}

void record_loss(record::StudyStore& store, const std::vector<record::Loss>& losses,
                 const std::string& reason) {
  std::map<int, std::string> sessions;
  std::int64_t answers = 0;
  for (const record::Loss& loss : losses) {
    if (loss.session > 0 && store.last_event(loss.session)) sessions[loss.session] = loss.what;
    answers = std::max(answers, loss.answers);
  }
  store.accept_loss({.reason = reason, .missing = descriptions_of(losses), .answers = answers},
                    sessions, utc_now());
}

void warn_of_needless_reason() {
  spdlog::warn("--accept-loss: no head file shows a loss, and none was recorded");
}

bool is_on_same_disk(const fs::path& file, const fs::path& database) {
  struct stat folder {};
  struct stat data {};
  return ::stat(file.parent_path().c_str(), &folder) == 0 && ::stat(database.c_str(), &data) == 0 &&
         folder.st_dev == data.st_dev;
}

void warn_if_on_one_disk(const record::HeadFiles& files, const record::StudyStore& store,
                         const fs::path& database) {
  const std::vector<fs::path> paths = files.paths();
  const bool is_on_one_disk =
      paths.size() < 2 || is_on_same_disk(fs::absolute(paths.back()), database);
  if (!is_on_one_disk || store.commitment().simulated) return;
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
      "and its -wal from a complete copy, or start a new one with --accept-loss REASON, which "
      "is recorded",
      one_line(database.string()), one_line(readings.front().file.string()),
      counted(readings.front().record.acknowledged, "answer")));
}

void set_head_writer(record::StudyStore& store, const fs::path& database, const Signer& signer,
                     const HeadOptions& options, HeadUse use) {
  const fs::path main_head = record::head_path_for(database);
  std::vector<record::ExpectedHead> heads = heads_of(store, database, options);
  const std::vector<record::HeadReading> readings = readings_of(heads);
  if (use == HeadUse::if_present && readings.empty()) {
    if (!options.accept_loss.empty()) warn_of_needless_reason();
    if (!store.commitment().simulated && store.stations() == 0) {
      spdlog::warn("{}: has no head file beside it, so losses cannot be detected",
                   one_line(database.string()));
    }
    return;
  }
  if (heads.empty() && !store.sessions().empty()) heads.push_back({main_head, std::nullopt});
  std::vector<record::Loss> losses = losses_of(store, readings);
  add_missing_heads(losses, heads, main_head, options);
  if (!losses.empty() && options.accept_loss.empty()) {
    throw StoreError(one_line(database.string()) +
                     ": lacks events that its head file records: " + descriptions_of(losses) +
                     "; restore the database and its -wal from a complete copy, or continue with "
                     "--accept-loss REASON, which is recorded [lost-events]");
  }
  if (losses.empty() && !options.accept_loss.empty()) warn_of_needless_reason();
  std::string second_folder = store.heads_on_record().value_or("");
  if (second_folder.empty() && !readings.empty()) second_folder = readings.front().record.also;
  const record::HeadFiles files(database, record::head_signers(store.commitment()),
                                options.folder.value_or(second_folder));
  if (!losses.empty()) {
    record_loss(store, losses, options.accept_loss);
    files.update(signer, [&](record::HeadRecord& record) {
      const std::int64_t count = record.count;
      record = record::record_of(store);
      record.count = count;
    });
  }
  if (use == HeadUse::required) warn_if_on_one_disk(files, store, database);
  store.set_head_writer(
      [files, signer](const record::HeadChange& change) { files.update(signer, change); });
  if (use == HeadUse::required) record_heads(store, heads, files, signer);
}

void check_against_heads(const fs::path& database) {
  const record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_only);
  const std::vector<record::ExpectedHead> heads = record::expected_heads(store, database);
  if (!heads.empty() && !heads.front().reading) {
    spdlog::warn("{}: its head file is missing, so the database was not compared with it",
                 one_line(database.string()));
  }
  const std::vector<record::Loss> losses = losses_of(store, readings_of(heads));
  if (losses.empty()) return;
  throw VerificationError(
      one_line(database.string()) +
      ": lacks events that its head file records: " + descriptions_of(losses) +
      "; restore the database and its -wal from a complete copy, or record the loss at its "
      "station, for instance with `touchtrial note --accept-loss REASON`");
}

void make_head(const record::StudyStore& store, const fs::path& database, const Signer& signer) {
  const fs::path main_head = record::head_path_for(database);
  std::error_code ignored;
  fs::remove(main_head, ignored);  // left over from a removed database
  record::HeadFile(main_head).update(
      signer, [&](record::HeadRecord& record) { record = record::record_of(store); });
}

std::string head_words(const record::StudyStore& store) {
  const record::HeadRecord head = record::record_of(store);
  return fmt::format("head {}, {} acknowledged", record::head_digits(head),
                     counted(head.acknowledged, "answer"));
}

}  // namespace touchtrial::app
