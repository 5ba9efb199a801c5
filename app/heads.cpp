#include "app/heads.hpp"

#include "app/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "protocols/store/head_file.hpp"

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

/// What is missing: each session once, and the file's chain, by the head file that knows most.
std::vector<store::Loss> losses_of(const store::StudyStore& store,
                                   std::vector<store::HeadReading> readings) {
  std::ranges::stable_sort(readings, std::ranges::greater{}, [](const store::HeadReading& reading) {
    return std::pair(reading.record.file.length, reading.record.acknowledged);
  });
  std::vector<store::Loss> found;
  std::set<int> named;
  for (const store::HeadReading& reading : readings) {
    if (!reading.damage.empty()) {
      spdlog::warn("{}: {}", one_line(reading.file.string()), reading.damage);
    }
    std::vector<store::Loss> losses = store::losses(reading.record, store);
    std::erase_if(losses, [&](const store::Loss& loss) { return named.contains(loss.session); });
    for (store::Loss& loss : losses) {
      if (found.empty())
        loss.what = "as " + one_line(reading.file.string()) + " knows it, " + loss.what;
      named.insert(loss.session);
      found.push_back(std::move(loss));
    }
  }
  return found;
}

/// The second head file if the first names its folder and it is not there; empty: nothing is gone.
fs::path second_that_is_gone(const store::HeadFiles& files,
                             const std::vector<store::HeadReading>& readings) {
  const std::vector<fs::path> paths = files.paths();
  if (paths.size() < 2 || readings.empty() || is_there(paths.back())) return {};
  const fs::path known = readings.front().record.also;
  return known / paths.back().filename() == paths.back() ? paths.back() : fs::path();
}

std::string words_on(const std::vector<store::Loss>& losses) {
  return listed(losses, "; ", &store::Loss::what);
}

void accept(store::StudyStore& store, const std::vector<store::Loss>& losses,
            const std::string& reason) {
  std::map<int, std::string> sessions;
  std::int64_t answers = 0;
  for (const store::Loss& loss : losses) {
    if (loss.session > 0 && store.last_event(loss.session)) sessions[loss.session] = loss.what;
    answers = std::max(answers, loss.answers);
  }
  store.accept_loss({.reason = reason, .missing = words_on(losses), .answers = answers}, sessions,
                    utc_now());
}

void warn_of_no_loss() {
  spdlog::warn("--accept-loss: no head file knows of a loss, and none was recorded");
}

bool is_on_disk_of(const fs::path& file, const fs::path& database) {
  struct stat one {};
  struct stat other {};
  return ::stat(file.parent_path().c_str(), &one) == 0 && ::stat(database.c_str(), &other) == 0 &&
         one.st_dev == other.st_dev;
}

void warn_if_on_one_disk(const store::HeadFiles& files, const store::StudyStore& store,
                         const fs::path& database) {
  const std::vector<fs::path> paths = files.paths();
  const bool is_alone = paths.size() < 2 || is_on_disk_of(fs::absolute(paths.back()), database);
  if (!is_alone || store.commitment().simulated) return;
  spdlog::warn(
      "{}: the head of the study is kept on the database's own disk alone, and would be lost with "
      "it; name a folder on another disk with --heads",
      one_line(database.string()));
}

}  // namespace

void refuse_lost_database(const std::filesystem::path& database,
                          const store::StudyCommitment& commitment, const HeadOptions& options) {
  if (!options.accept_loss.empty()) return;
  const store::HeadFiles files(database, store::head_signers(commitment), options.folder);
  const std::vector<store::HeadReading> readings = files.read();
  if (readings.empty()) return;
  throw StoreError(fmt::format(
      "{}: is not there, but its head file {} knows it, with {} acknowledged; restore the database "
      "and its -wal from where they are whole, or begin a new one with --accept-loss REASON, which "
      "is recorded",
      one_line(database.string()), one_line(readings.front().file.string()),
      counted(readings.front().record.acknowledged, "answer")));
}

void keep_heads(store::StudyStore& store, const fs::path& database, const Signer& signer,
                const HeadOptions& options, HeadUse use) {
  const fs::path own = store::head_path_for(database);
  if (use == HeadUse::if_there && !is_there(own)) {
    if (!options.accept_loss.empty()) warn_of_no_loss();
    if (!store.commitment().simulated && store.stations() == 0) {
      spdlog::warn(
          "{}: has no head file beside it, so that nobody can tell whether it lacks something",
          one_line(database.string()));
    }
    return;
  }
  const store::HeadFiles files(database, store::head_signers(store.commitment()), options.folder);
  const std::vector<store::HeadReading> readings = files.read();
  std::vector<store::Loss> missing = losses_of(store, readings);
  if (readings.empty() && !store.sessions().empty()) {
    missing.push_back(
        {.session = 0,
         .what =
             "its head file " + one_line(own.string()) +
             " is gone, so that nobody can tell what else is missing (if there is a second head "
             "file, name its folder with run --heads)"});
  }
  if (const fs::path second = second_that_is_gone(files, readings); !second.empty()) {
    missing.push_back(
        {.session = 0,
         .what = "its second head file " + one_line(second.string()) +
                 " is gone, so that nobody can tell whether the first is the newest"});
  }
  if (!missing.empty() && options.accept_loss.empty()) {
    throw StoreError(one_line(database.string()) + ": is not as it was left: " + words_on(missing) +
                     "; restore the database and its -wal from where they are whole, or go on "
                     "without with --accept-loss REASON, which is recorded");
  }
  if (missing.empty() && !options.accept_loss.empty()) warn_of_no_loss();
  if (!missing.empty()) {
    accept(store, missing, options.accept_loss);
    files.update(signer, [&](store::HeadRecord& record) {
      const std::int64_t count = record.count;
      record = store::record_of(store);
      record.count = count;
    });
  }
  if (use == HeadUse::required) warn_if_on_one_disk(files, store, database);
  store.keep_heads(
      [files, signer](const store::HeadChange& change) { files.update(signer, change); });
}

void require_head_beside(const fs::path& database) {
  const store::HeadFile file(store::head_path_for(database));
  if (!is_there(file.path())) return;
  const store::StudyStore store =
      store::StudyStore::open(database, store::StudyStore::Access::read_only);
  std::vector<store::HeadReading> readings;
  if (auto reading = file.reading(store::head_signers(store.commitment()))) {
    readings.push_back(std::move(*reading));
  }
  const std::vector<store::Loss> missing = losses_of(store, std::move(readings));
  if (missing.empty()) return;
  throw VerificationError(
      one_line(database.string()) + ": is not as it was left: " + words_on(missing) +
      "; take the database and its -wal from where they are whole, or record the loss at its "
      "station, for instance with `touchtrial note --accept-loss REASON`");
}

void make_head(const store::StudyStore& store, const fs::path& database, const Signer& signer) {
  const fs::path own = store::head_path_for(database);
  std::error_code ignored;
  fs::remove(own, ignored);  // of a database that is gone
  store::HeadFile(own).update(signer,
                              [&](store::HeadRecord& record) { record = store::record_of(store); });
}

std::string head_words(const store::StudyStore& store) {
  const store::HeadRecord now = store::record_of(store);
  return fmt::format("head {}, {} acknowledged", store::spoken_head(now),
                     counted(now.acknowledged, "answer"));
}

}  // namespace touchtrial::app
