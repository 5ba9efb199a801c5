// One byte altered in each kind of evidence: `verify` names it and ends with 3.
#include "app/study_folder.hpp"
#include "core/bytes.hpp"
#include "core/hash.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <functional>
#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

using namespace touchtrial;

namespace {

/// A study that is prepared for people, with two simulated sessions.
struct PreparedStudy : StudyFolder {
  PreparedStudy() {
    done("prepare @cloths.json");
    for (const std::string participant : {"P01", "P02"}) succeeded(session(participant));
  }
  [[nodiscard]] ProgramResult verify(const std::vector<std::string>& more = {}) const {
    return type("verify @study.db --key @cloths.key", more);
  }
};

void flip(const fs::path& file, std::size_t at) {
  Bytes bytes = read_file(file);
  REQUIRE(at < bytes.size());
  bytes[at] ^= 1U;
  replace_file(file, ByteView(bytes));
}

/// Alters the middle byte of a column of one row, as somebody with an SQLite shell could, without a
/// change of the schema.
void flip_in(const StudyFolder& study, const std::string& table, const std::string& column,
             const std::string& where) {
  SQLite::Database database(study.in("study.db"), SQLite::OPEN_READWRITE);
  fixture::without_triggers(database, [&] {
    std::string value;
    bool is_text = false;
    {
      SQLite::Statement query(
          database, "SELECT " + column + " FROM " + table + " WHERE " + where + " LIMIT 1");
      REQUIRE(query.executeStep());
      is_text = query.getColumn(0).isText();
      value = query.getColumn(0).getString();
    }
    REQUIRE_FALSE(value.empty());
    value[value.size() / 2] = static_cast<char>(value[value.size() / 2] ^ 1);
    SQLite::Statement update(database,
                             "UPDATE " + table + " SET " + column + " = ? WHERE " + where);
    if (is_text) {
      update.bind(1, value);
    } else {
      update.bind(1, value.data(), static_cast<int>(value.size()));
    }
    REQUIRE(update.exec() == 1);
  });
}

struct Tampering {
  std::string what;
  std::function<void(const StudyFolder&)> alter;
  std::vector<std::string> words;  ///< that the failed check's line must contain
};

fs::path first_field(const StudyFolder& study) {
  std::vector<fs::path> fields;
  for (const auto& entry : fs::directory_iterator(study.path() / "cloths.pack")) {
    if (entry.path().extension() == ".field") fields.push_back(entry.path());
  }
  REQUIRE(fields.size() == kLabels.size());
  return *std::min_element(fields.begin(), fields.end());
}

const std::vector<Tampering> kTamperings = {
    {"an event's body",
     [](const StudyFolder& study) {
       flip_in(study, "events", "body", "session = 2 AND sequence = 4");
     },
     {"chain", "failed", "2 4"}},
    {"an event's sealed part",
     [](const StudyFolder& study) {
       flip_in(study, "events", "sealed", "session = 2 AND sequence = 0");
     },
     {"chain", "failed", "session 2, event 0"}},
    {"an event's hash",
     [](const StudyFolder& study) {
       flip_in(study, "events", "hash", "session = 2 AND sequence = 5");
     },
     {"chain", "failed", " 2"}},
    {"an event of the file's chain",
     [](const StudyFolder& study) {
       flip_in(study, "events", "body", "session = 0 AND sequence = 1");
     },
     {"chain", "failed", "1"}},
    {"a trace",
     [](const StudyFolder& study) { flip_in(study, "traces", "box", "session = 2 AND trial = 3"); },
     {"chain", "failed", "2 3"}},
    {"a wrapped key",
     [](const StudyFolder& study) { flip_in(study, "participant_keys", "wrapped", "session = 2"); },
     {"chain", "failed", "key"}},
    {"the pack's list",
     [](const StudyFolder& study) {
       const fs::path list = study.path() / "cloths.pack" / "pack.json";
       flip(list, content(list).size() / 2);
     },
     {"pack", "failed"}},
    {"the study of the pack's list",
     [](const StudyFolder& study) {
       const fs::path list = study.path() / "cloths.pack" / "pack.json";
       const json pack = json::parse(content(list));
       const std::string id =
           json::parse(content(study.path() / "cloths.pack" / "pack.json")).at("study_id");
       // One digit changes, so that the value still has the form of an identity.
       flip(list, content(list).find(id) + id.find_first_of("0123456789"));
     },
     {"pack", "failed"}},
    {"a field",
     [](const StudyFolder& study) {
       const fs::path field = first_field(study);
       flip(field, fs::file_size(field) / 2);
     },
     {"pack", "failed", ".pack", "field"}},
    {"the key",
     [](const StudyFolder& study) {
       const fs::path key = study.path() / "cloths.key";
       flip(key, fs::file_size(key) / 2);
     },
     {"key", "failed", "cloths.key"}},
};

/// The lines of failed checks.
std::string failed_lines(const std::string& output) {
  std::string failed;
  std::size_t at = 0;
  while (at < output.size()) {
    const std::size_t end = output.find('\n', at);
    const std::string line = output.substr(at, end - at + 1);
    if (line.find("  failed  ") != std::string::npos) failed += line;
    at = end == std::string::npos ? output.size() : end + 1;
  }
  return failed;
}

}  // namespace

TEST_CASE("verify names one altered byte anywhere, with exit 3") {
  const PreparedStudy study;
  succeeded(study.verify());
  const fs::path kept = study.path() / "kept";
  fs::create_directory(kept);
  const std::vector<std::string> evidence = {"study.db", "cloths.pack", "cloths.key"};
  for (const std::string& name : evidence) {
    fs::copy(study.path() / name, kept / name, fs::copy_options::recursive);
  }
  for (const Tampering& tampering : kTamperings) {
    INFO(tampering.what);
    tampering.alter(study);
    const ProgramResult found = study.verify();
    INFO(found.output << found.errors);
    CHECK(found.exit_code == 3);
    const std::string failed = failed_lines(found.output);
    for (const std::string& word : tampering.words) {
      INFO(word);
      CHECK(names(failed, word));
    }
    for (const std::string& label : kLabels) CHECK(found.output.find(label) == std::string::npos);
    for (const std::string& name : evidence) {
      fs::remove_all(study.path() / name);
      fs::copy(kept / name, study.path() / name, fs::copy_options::recursive);
    }
  }
  succeeded(study.verify());
}

TEST_CASE("alterations before the first session are refused, and repaired by prepare") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  const fs::path list = study.path() / "cloths.pack/pack.json";
  const json whole = json::parse(content(list));
  const auto refused = [&](const std::string& part) {
    check_refused(study.session("P01"), 1, {part});
    const ProgramResult checked = study.type("key check @cloths.json");
    CHECK(checked.exit_code == 3);
    CHECK_THAT(checked.output, holds_text(part));
    CHECK_FALSE(fs::exists(study.path() / "study.db"));
  };
  const auto prepared = [&] {
    const ProgramResult again = study.done("prepare @cloths.json");
    study.done("key check @cloths.json");
    return again.output + again.errors;
  };
  SECTION("gains") {
    json altered = whole;
    for (json& field : altered["fields"]) field["gains"]["tangential_n"] = 0.0;
    replace_file(list, altered.dump(2) + "\n");
    refused("cloths.pack");
    CHECK_THAT(prepared(), holds_text("built 3, reused 0"));
    CHECK(json::parse(content(list)) == whole);
  }
  SECTION("pictures") {
    fs::rename(study.path() / "linen-photo.png", study.path() / "kept.png");
    fs::copy(study.path() / "granite-photo.png", study.path() / "linen-photo.png");
    refused("linen-photo.png");
    fs::rename(study.path() / "kept.png", study.path() / "linen-photo.png");
    CHECK_THAT(prepared(), holds_text("built 0, reused 3"));
  }
  SECTION("the station's file of another investigator") {
    fs::create_directory(study.path() / "forger");
    study.done("prepare @cloths.json --pack @forger/cloths.pack");
    json forged = json::parse(content(study.path() / "cloths.station"));
    const json theirs = json::parse(content(study.path() / "forger/cloths.station"));
    forged["investigator_box"] = theirs["investigator_box"];
    forged.erase("check");
    forged["check"] = to_hex(sha256(bytes_of(forged.dump())));
    replace_file(study.path() / "cloths.station", forged.dump(2) + "\n", FileMode::owner_only);
    check_refused(study.session("P01"), 1, {});
    CHECK(study.type("key check @cloths.json").exit_code == 3);
    CHECK_THAT(prepared(), holds_text("built 0, reused 3"));
  }
}

TEST_CASE("a shown picture that was altered since is named by verify") {
  const PreparedStudy study;
  CHECK_THAT(succeeded(study.verify()).output, holds_text("3 of 3 "));
  Bytes picture = read_file(study.path() / "linen-photo.png");
  picture.push_back(0);
  replace_file(study.path() / "linen-photo.png", ByteView(picture));
  const ProgramResult found = study.verify();
  CHECK(found.exit_code == 3);
  CHECK_THAT(failed_lines(found.output), holds_text("linen-photo.png"));
  fs::remove(study.path() / "linen-photo.png");
  CHECK_THAT(succeeded(study.verify()).output, holds_text("2 of 3 "));
}

TEST_CASE("verify prints UTF-8 even for a damaged list of the pack, as lines and as JSON") {
  const PreparedStudy study;
  const fs::path list = study.path() / "cloths.pack" / "pack.json";
  const Bytes whole = read_file(list);
  for (std::size_t at = 0; at < whole.size(); at += whole.size() / 10) {
    INFO(at);
    Bytes altered = whole;
    altered[at] = 0xff;
    replace_file(list, ByteView(altered));
    const ProgramResult lines = study.verify();
    CHECK(lines.exit_code == 3);
    CHECK_NOTHROW(json(lines.output).dump());
    CHECK(lines.output.find("pack") != std::string::npos);
    const ProgramResult object = study.verify({"--json"});
    INFO(object.errors);
    CHECK(object.exit_code == 3);
    CHECK(json::accept(object.output));
  }
}
