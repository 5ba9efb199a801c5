// Attacks by whoever can write the database's folder: older copies laid in its place, and a
// write-ahead log that is damaged or gone.
#include "analysis/text_matching.hpp"
#include "analysis/verification/study_files.hpp"
#include "app/commands/heads.hpp"
#include "app/touchtrial_process.hpp"
#include "attacks/forger.hpp"
#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;

namespace {

/// A study, and its files as they were before its last session.
struct RolledBack : AttackedStudy {
  RolledBack() {
    close();
    for (const fs::path& file : {database(), head(), second_head()}) {
      fs::copy_file(file, old_of(file));
    }
    open();
    add({.participant = "P05", .enrolment = 5, .answers = always_right()});
    on_paper = store().file_head().hash;
    close();
  }
  [[nodiscard]] fs::path old_of(const fs::path& file) const {
    const std::string place = file.parent_path() == folder() ? "" : "second ";
    return folder() / ("old " + place + file.filename().string());
  }
  void roll_back(const fs::path& file) const {
    fs::copy_file(old_of(file), file, fs::copy_options::overwrite_existing);
  }
  /// What the program says when something is to be recorded here; empty if it records it.
  [[nodiscard]] std::string refusal() const {
    const ProgramResult noted =
        run_touchtrial(folder(), {"note", database().string(), "--station-file",
                                  station_file().string(), "--participant", "P01", "came late"});
    return noted.exit_code == 0 ? "" : noted.errors;
  }

  Digest on_paper{};
};

/// The database with its log and its head, as an attacker finds them while a session goes on.
class CopyWithLog {
 public:
  explicit CopyWithLog(const AttackedStudy& study) : folder_(study.folder() / "copy") {
    for (const char* name : {"study.db", "study.db-wal", "study.db.head"}) {
      files_.emplace_back(folder_ / name, read_file(study.folder() / name));
    }
    restore();
  }
  void restore() const {
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    for (const auto& [path, bytes] : files_) {
      std::ofstream(path, std::ios::binary) << text_of(bytes);
    }
  }
  [[nodiscard]] fs::path database() const { return folder_ / "study.db"; }
  [[nodiscard]] fs::path log() const { return folder_ / "study.db-wal"; }
  [[nodiscard]] std::uintmax_t log_size() const { return files_[1].second.size(); }

 private:
  fs::path folder_;
  std::vector<std::pair<fs::path, Bytes>> files_;
};

}  // namespace

TEST_CASE("an older database is named by its head files and refused, and verify exits with 3") {
  const RolledBack study;
  CHECK(study.found().empty());
  study.roll_back(study.database());
  CHECK(contains(study.found(), "heads: "));
  CHECK(names(study.refusal(), "[lost-events]"));
  const ProgramResult verified = run_touchtrial(
      study.folder(), {"verify", study.database().string(), "--key", study.key_file().string()});
  CHECK(verified.exit_code == 3);
  CHECK(names(verified.output, "heads"));
  note("an older database", Outcome::named);
}

TEST_CASE("an older database with its head file is given away by the second head file") {
  const RolledBack study;
  study.roll_back(study.database());
  study.roll_back(study.head());
  CHECK(contains(study.found_without_key(), study.second_head().string() + ": "));
  CHECK(contains(study.found(), study.second_head().string() + ": "));
  CHECK(names(study.refusal(), "[lost-events]"));
  note("an older database with its head file", Outcome::named);

  fs::remove(study.second_head());
  CHECK_FALSE(study.refusal().empty());
  note("the same, and the second head file removed", Outcome::refused);
}

TEST_CASE("a head file that is gone is named, whatever the database lacks") {
  const AttackedStudy untouched;
  for (const fs::path& file : {untouched.head(), untouched.second_head()}) {
    const Bytes whole = read_file(file);
    fs::remove(file);
    CHECK(contains(untouched.found(), file.string()));
    CHECK(contains(untouched.found_without_key(), file.string()));
    replace_file(file, ByteView(whole));
    CHECK(untouched.found().empty());
  }
  note("a head file removed", Outcome::named, 2);
}

TEST_CASE("another folder for the second head file hides nothing that the one on record knows") {
  RolledBack study;
  const fs::path other = study.folder() / "other";
  fs::create_directory(other);
  const auto told = [&](const std::string& reason) {
    record::StudyStore store =
        record::StudyStore::open(study.database(), record::StudyStore::Access::read_write);
    const Signer signer = study.station().signer();
    store.sign_with(signer);
    return message_of<StoreError>([&] {
      app::set_head_writer(store, study.database(), signer,
                           {.folder = other, .accept_loss = reason}, app::HeadUse::required);
    });
  };
  study.roll_back(study.database());
  study.roll_back(study.head());

  SECTION("it is there") {
    fs::copy_file(study.old_of(study.second_head()), other / "study.db.head");
    CHECK(contains(told(""), study.second_head().string()));
    note("an older database and another folder for the second head file", Outcome::refused);
  }
  SECTION("it is gone") {
    fs::copy_file(study.old_of(study.second_head()), other / "study.db.head");
    fs::remove(study.second_head());
    CHECK(contains(told(""), study.second_head().string()));
    note("the same, and the second head file removed", Outcome::refused);
  }
  CHECK(told("the disk died").empty());
  CHECK(told("").empty());
  const analysis::Verification verification =
      analysis::verify_files({.database = study.database(), .key = {}, .pack = {}}, {});
  CHECK(verification.holds());
  CHECK(std::ranges::any_of(
      verification.notes, [](const std::string& one) { return contains(one, "(the disk died)"); }));
}

TEST_CASE("a head file that was left for another folder gives a rolled back move away") {
  RolledBack study;
  for (const fs::path& file : {study.database(), study.head()}) {
    fs::copy_file(file, study.old_of(file), fs::copy_options::overwrite_existing);
  }
  const fs::path other = study.folder() / "other";
  fs::create_directory(other);
  {
    record::StudyStore store =
        record::StudyStore::open(study.database(), record::StudyStore::Access::read_write);
    const Signer signer = study.station().signer();
    store.sign_with(signer);
    app::set_head_writer(store, study.database(), signer, {.folder = other},
                         app::HeadUse::required);
    CHECK(store.heads_on_record() == other.string());
  }
  CHECK(study.found().empty());
  study.roll_back(study.database());
  study.roll_back(study.head());
  CHECK(contains(study.found_without_key(), study.second_head().string() + ": "));
  note("an older database from before the second head file was moved", Outcome::named);
}

TEST_CASE("an older database with all its head files is found by a head on paper alone") {
  const RolledBack study;
  for (const fs::path& file : {study.database(), study.head(), study.second_head()}) {
    study.roll_back(file);
  }
  CHECK(study.found().empty());
  note("an older database with all its head files", Outcome::possible);
  CHECK(names(study.found_by_head(study.on_paper), "[unknown-head]"));
  note("the same, held against a head on paper", Outcome::named);
}

TEST_CASE("a log that is gone is named with the answers that were in it") {
  const AttackedStudy study;
  const CopyWithLog copy(study);
  CHECK(study.found(copy.database()).empty());
  copy.restore();
  fs::remove(copy.log());
  CHECK_FALSE(study.found(copy.database()).empty());
  note("a log removed", Outcome::named);
}

TEST_CASE("a flipped bit anywhere in the log is named, or changes no row") {
  constexpr std::uintmax_t kHeader = 32;
  constexpr std::uintmax_t kFrame = 24 + 8192;
  const AttackedStudy study;
  const CopyWithLog copy(study);
  REQUIRE(copy.log_size() > kHeader + kFrame);
  const std::string whole = rows_of(copy.database());
  RandomStream random = places_of("log");
  std::vector<std::uintmax_t> attacked;
  for (std::uintmax_t at = 0; at < kHeader; ++at) attacked.push_back(at);
  for (std::uintmax_t frame = kHeader; frame < copy.log_size(); frame += kFrame) {
    attacked.push_back(frame + random.below(24));
    attacked.push_back(frame + 24 + random.below(8192));
  }
  for (int i = 0; i < places(120) / 5; ++i) attacked.push_back(random.below(copy.log_size()));
  int unchanged = 0;
  for (const std::uintmax_t at : attacked) {
    INFO(at);
    copy.restore();
    flip(copy.log(), at, static_cast<unsigned>(random.below(8)));
    if (rows_of(copy.database()) == whole) {
      ++unchanged;
    } else {
      CHECK_FALSE(study.found(copy.database()).empty());
    }
  }
  const int all = static_cast<int>(attacked.size());
  CHECK(unchanged < all / 2);
  note("a flipped bit in the log", Outcome::unchanged, unchanged);
  note("a flipped bit in the log", Outcome::named, all - unchanged);
}
