/// Passphrases of keys and stations' files.
#include "study/key_protection.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/study_examples.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <fstream>
#include <string>

#include <sys/stat.h>

namespace touchtrial {
namespace {

constexpr PassphraseCost kQuick = kMinPassphraseCost;
const std::string kPassphrase = "a long passphrase";

/// Answers with the given passphrases in turn, counts the questions, and forgets everything at the
/// end.
class Answers {
 public:
  explicit Answers(std::vector<std::string> passphrases) {
    study::set_passphrase_prompt([this, passphrases = std::move(passphrases)](
                                     const auto&, int attempt) -> std::optional<std::string> {
      ++asked;
      const auto index = static_cast<std::size_t>(attempt - 1);
      if (index >= passphrases.size()) return std::nullopt;
      return passphrases[index];
    });
  }
  ~Answers() { study::set_passphrase_prompt({}); }
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  int asked = 0;
};

/// A key and its station's file, in clear.
struct KeyFolder {
  TempFolder folder;
  study::StudyKey key;
  std::filesystem::path key_path = folder.path() / "small.key";
  std::filesystem::path station_path = folder.path() / "small.station";

  KeyFolder() {
    SeededEntropy entropy(3);
    key = study::make_study_key(parsed(minimal_study(), folder.path()), entropy, false);
    study::save_study_key(key_path, key);
    study::save_station_key(station_path, study::station_key(key, study::kOnlyStation));
  }
};

void load_either(const std::filesystem::path& path) {
  if (path.extension() == ".key") {
    static_cast<void>(study::load_study_key(path));
  } else {
    static_cast<void>(study::load_station_key(path));
  }
}

/// Without waiting for the disk.
void write_quickly(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
}

std::string with_check(const std::string& lines) {
  return lines + to_hex(sha256(bytes_of(lines))) + "\n";
}

}  // namespace

TEST_CASE("a protected key comes back whole, and shows nothing in clear") {
  const KeyFolder files;
  const std::string plain = text_of(read_file(files.key_path));
  study::protect(files.key_path, kPassphrase, kQuick);
  const std::string text = text_of(read_file(files.key_path));
  CHECK(study::is_protected(files.key_path));
  for (const std::string& part :
       {to_hex(files.key.master), files.key.study_id, std::string("rough"), std::string("main"),
        files.key.stimuli.front().code}) {
    INFO(part);
    CHECK(plain.find(part) != std::string::npos);
    CHECK(text.find(part) == std::string::npos);
  }
  CHECK(text.find(kPassphrase) == std::string::npos);
  struct stat status {};
  REQUIRE(::stat(files.key_path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0600U);
  const Answers answers({kPassphrase});
  CHECK(study::load_study_key(files.key_path).master == files.key.master);
  CHECK(study::read_secret_text(files.key_path) == plain);
}

TEST_CASE("a wrong passphrase is one line, and a right one after it opens the file") {
  const KeyFolder files;
  study::protect(files.key_path, kPassphrase, kQuick);
  {
    const Answers answers({"a wrong passphrase", "another wrong one"});
    const std::string message =
        message_of<FileError>([&] { return study::load_study_key(files.key_path); });
    CHECK_THAT(message, names("small.key"));
    CHECK(message.find('\n') == std::string::npos);
    CHECK(answers.asked == 3);
  }
  const Answers answers({"a wrong passphrase", kPassphrase});
  CHECK(study::load_study_key(files.key_path).study_id == files.key.study_id);
  CHECK(study::load_study_key(files.key_path).study_id == files.key.study_id);
  CHECK(answers.asked == 2);  // once opened, it is not asked for again
}

TEST_CASE("a protected file that nobody can be asked for is refused with the remedy") {
  const KeyFolder files;
  study::protect(files.station_path, kPassphrase, kQuick);
  const Answers answers({});
  CHECK(refuses<FileError>([&] { return study::load_station_key(files.station_path); },
                           "--passphrase-file"));
}

TEST_CASE("a protected file stays protected when it is written again") {
  const KeyFolder files;
  study::protect(files.key_path, kPassphrase, kQuick);
  study::protect(files.station_path, "the station's own", kQuick);
  const Answers answers({kPassphrase, "the station's own"});
  study::StudyKey key = study::load_study_key(files.key_path);
  key.pack_folder = files.folder.path() / "elsewhere.pack";
  study::save_study_key(files.key_path, key);
  study::save_station_key(files.station_path, study::station_key(key, study::kOnlyStation));
  CHECK(study::is_protected(files.key_path));
  CHECK(study::is_protected(files.station_path));
  const Answers again({kPassphrase, "the station's own"});
  CHECK(study::load_study_key(files.key_path).pack_folder.filename() == "elsewhere.pack");
  CHECK(study::load_station_key(files.station_path).pack_folder.filename() == "elsewhere.pack");
}

TEST_CASE("a file that cannot be opened is not written over") {
  const KeyFolder files;
  study::protect(files.station_path, kPassphrase, kQuick);
  const Bytes before = read_file(files.station_path);
  const Answers answers({"a wrong passphrase"});
  const study::StationKey station = study::station_key(files.key, study::kOnlyStation);
  CHECK_THROWS_AS(study::save_station_key(files.station_path, station), FileError);
  CHECK(read_file(files.station_path) == before);
}

TEST_CASE("a passphrase can be changed and taken away, and the plain file is as it was") {
  const KeyFolder files;
  for (const std::filesystem::path& path : {files.key_path, files.station_path}) {
    const Bytes plain = read_file(path);
    study::protect(path, kPassphrase, kQuick);
    const Bytes first = read_file(path);
    {
      const Answers answers({kPassphrase});
      study::protect(path, "another passphrase", kQuick);
    }
    CHECK(read_file(path) != first);
    {
      const Answers answers({kPassphrase});
      CHECK(refuses<FileError>([&] { return study::read_secret_text(path); }));
    }
    const Answers answers({"another passphrase"});
    study::protect(path, std::nullopt);
    CHECK(read_file(path) == plain);
    CHECK_FALSE(study::is_protected(path));
  }
}

TEST_CASE("a short passphrase is refused, and so is a file that is none of ours") {
  const KeyFolder files;
  const Bytes before = read_file(files.key_path);
  CHECK_THROWS_AS(study::protect(files.key_path, "1234567", kQuick), UsageError);
  CHECK(read_file(files.key_path) == before);
  const auto other = files.folder.path() / "other.json";
  replace_file(other, minimal_study().dump(), FileMode::owner_only);
  CHECK_THROWS_AS(study::protect(other, kPassphrase, kQuick), FileError);
  CHECK(text_of(read_file(other)) == minimal_study().dump());
  replace_file(other, read_file(files.key_path));
  CHECK(refuses<FileError>(
      [&] {
        study::protect(other, kPassphrase, kQuick);
        return 0;
      },
      other.string()));
}

TEST_CASE("any altered byte of a plain or protected key or station's file is refused") {
  const KeyFolder files;
  for (const bool is_protected : {false, true}) {
    for (const std::filesystem::path& path : {files.key_path, files.station_path}) {
      if (is_protected) study::protect(path, kPassphrase, kQuick);
      const Answers answers({kPassphrase});
      load_either(path);
      const int asked = answers.asked;
      CHECK(asked == (is_protected ? 1 : 0));
      const std::string whole = text_of(read_file(path));
      for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const unsigned bit : {0x01U, 0x20U, 0x80U}) {
          std::string altered = whole;
          altered[i] = static_cast<char>(static_cast<unsigned char>(altered[i]) ^ bit);
          write_quickly(path, altered);
          INFO(path << ", byte " << i << ", bit " << bit);
          CHECK_THROWS_AS(load_either(path), FileError);
        }
      }
      CHECK(answers.asked == asked);  // damage is found before anybody is asked
      for (const std::size_t size : {std::size_t{0}, std::size_t{20}, whole.size() - 1}) {
        write_quickly(path, whole.substr(0, size));
        CHECK_THROWS_AS(load_either(path), FileError);
      }
      write_quickly(path, whole + "\n");
      CHECK_THROWS_AS(load_either(path), FileError);
      write_quickly(path, whole);
      load_either(path);
    }
  }
}

TEST_CASE("a protected file that somebody altered with a fitting check does not open") {
  const KeyFolder files;
  study::protect(files.key_path, kPassphrase, kQuick);
  const std::string whole = text_of(read_file(files.key_path));
  const std::size_t end = whole.rfind('\n', whole.size() - 2) + 1;  // of what the check covers
  const std::size_t salt = whole.find("argon2id ") + 9;
  const std::size_t box = whole.find('\n', salt) + 1;
  int tried = 0;
  const auto check_at = [&](std::size_t i) {
    std::string altered = whole.substr(0, end);
    altered[i] = altered[i] == '7' ? '9' : '7';
    write_quickly(files.key_path, with_check(altered));
    const Answers answers({kPassphrase});
    INFO("byte " << i);
    CHECK_THROWS_AS(study::load_study_key(files.key_path), FileError);
    ++tried;
  };
  for (std::size_t i = salt; i < salt + 32; ++i) check_at(i);
  check_at(box - 2);  // the memory
  for (std::size_t i = box; i + 1 < end; i += 61) check_at(i);
  CHECK(tried > 60);
}

TEST_CASE("a file that asks for more memory or time than is allowed is refused at once") {
  const KeyFolder files;
  study::protect(files.key_path, kPassphrase, kQuick);
  const std::string whole = text_of(read_file(files.key_path));
  const std::size_t cost = whole.find("argon2id ") + 9 + 32;
  const std::size_t box = whole.find('\n', cost);
  const std::size_t end = whole.rfind('\n', whole.size() - 2) + 1;
  for (const char* wanted : {" 1 99999999999999", " 4294967295 8192", " 1 1", " 0 8192", " 4 8192",
                             " 1 268435457", " 32 4294967296"}) {
    write_quickly(files.key_path,
                  with_check(whole.substr(0, cost) + wanted + whole.substr(box, end - box)));
    const Answers answers({kPassphrase});
    CHECK(refuses<FileError>([&] { return study::load_study_key(files.key_path); }, "Argon2id"));
    CHECK(answers.asked == 0);
  }
}

}  // namespace touchtrial
