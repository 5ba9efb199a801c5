// Attacks by whoever can write into a folder in which the program writes: links in the places of
// its files, and forged keys that would cost it hours.
#include "app/touchtrial_process.hpp"
#include "attacks/forger.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"
#include "support/catch.hpp"

#include <fstream>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;

namespace {

/// A key under a passphrase, as somebody forges it who wants it to cost so much.
std::string forged_key(const std::string& cost) {
  const std::string text = "touchtrial-protected 1\nsigns " + std::string(64, '1') + "\nargon2id " +
                           std::string(32, '2') + " " + cost + "\n" + std::string(512, '3') + "\n";
  return text + to_hex(sha256(bytes_of(text))) + "\n";
}

}  // namespace

TEST_CASE("a forged key never costs more than the program's own, and is refused before any work") {
  const AttackedStudy study;
  const fs::path passphrase = study.folder() / "passphrase";
  replace_file(passphrase, "a long passphrase\n", FileMode::owner_only);
  for (const std::string ending : {".key", ".station"}) {
    const fs::path forged = study.folder() / ("forged" + ending);
    for (const std::string cost : {"32 4294967296", "4 268435456", "3 268435457"}) {
      replace_file(forged, forged_key(cost), FileMode::owner_only);
      const std::vector<std::string> words = {"key",      "protect",           forged.string(),
                                              "--remove", "--passphrase-file", passphrase.string()};
      check_refused(run_touchtrial(study.folder(), words), 1, {"forged", "Argon2id"});
      note("a key that costs too much", Outcome::refused);
    }
  }
}

TEST_CASE("a link in the place of a file that lies beside a database is not written through") {
  AttackedStudy study;
  study.close();
  const fs::path target = study.folder() / "somebody's file";
  for (const char* const beside : {".head", ".lock", ".personal"}) {
    const fs::path file = study.database().string() + beside;
    const fs::path aside = study.folder() / "aside";
    std::error_code was_none;
    fs::rename(file, aside, was_none);
    for (const bool is_dangling : {true, false}) {
      if (!is_dangling) std::ofstream(target) << "mine";
      fs::create_symlink(target, file);
      const std::string day = study.database().string();
      static_cast<void>(run_touchtrial(
          study.folder(), {"note", day, "--station-file", study.station_file().string(),
                           "--participant", "P01", "came late"}));
      static_cast<void>(run_touchtrial(study.folder(),
                                       {"consent", day, "--participant", "P01", "--version", "1"}));
      INFO(beside);
      CHECK(fs::is_symlink(file));
      if (is_dangling) {
        CHECK_FALSE(path_exists(target));
      } else {
        CHECK(text_of(read_file(target)) == "mine");
      }
      note("a link in the place of a file", Outcome::refused);
      fs::remove(file);
      fs::remove(target);
    }
    if (!was_none) fs::rename(aside, file);
  }
}
