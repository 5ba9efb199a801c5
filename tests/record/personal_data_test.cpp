#include "record/personal_data.hpp"

#include "core/files.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <sys/stat.h>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

PersonalRecord somebody() {
  return {.participant = "P07",
          .consent_version = "2",
          .consented_utc = "2026-11-22T09:00:00Z",
          .age = 31,
          .gender = "f",
          .contact = "seven@example.org"};
}

unsigned mode_of(const std::filesystem::path& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status.st_mode & 0777U;
}

}  // namespace

TEST_CASE("every consent is kept, and removed without a trace in the file") {
  const TempFolder folder;
  const auto path = personal_data_path(folder.path() / "study.db");
  PersonalRecord again = somebody();
  again.consent_version = "3";
  again.consented_utc = "2026-12-01T09:00:00Z";
  again.age.reset();
  again.gender.clear();
  again.contact.clear();
  PersonalRecord other = somebody();
  other.participant = "P06";
  {
    PersonalData data(path);
    data.put(somebody());
    REQUIRE(data.find("P07") == somebody());
    data.put(again);
    data.put(other);
    // The second one says nothing of age, gender and contact, and erases nothing.
    PersonalRecord last = somebody();
    last.consent_version = "3";
    last.consented_utc = "2026-12-01T09:00:00Z";
    REQUIRE(data.find("P07") == last);
    REQUIRE(data.all() == std::vector<PersonalRecord>{other, somebody(), again});
    other.contact = "six@example.org";
    data.put(other);
    REQUIRE(data.find("P06")->contact == "six@example.org");
  }
  REQUIRE(contains(text_of(read_file(path)), "seven@example.org"));
  {
    PersonalData data(path);
    REQUIRE(data.remove("P07"));
    REQUIRE_FALSE(data.remove("P07"));
    REQUIRE_FALSE(data.find("P07"));
    REQUIRE(data.all().size() == 2);
    REQUIRE(data.remove("P06"));
  }
  REQUIRE_FALSE(contains(text_of(read_file(path)), "seven@example.org"));
  REQUIRE_FALSE(contains(text_of(read_file(path)), "six@example.org"));
}

TEST_CASE("only their owner can read personal data whatever the umask, else they are refused") {
  const TempFolder folder;
  const auto path = personal_data_path(folder.path() / "study.db");
  const mode_t before = ::umask(0);
  { PersonalData(path).put(somebody()); }
  ::umask(before);
  REQUIRE(mode_of(path) == 0600U);
  REQUIRE(::chmod(path.c_str(), 0640) == 0);
  REQUIRE_THROWS_WITH(PersonalData(path), holds_text("chmod 600 "));
}

TEST_CASE("another file is not taken for personal data") {
  const TempFolder folder;
  const auto path = personal_data_path(folder.path() / "study.db");
  { PersonalData(path).put(somebody()); }
  SQLite::Database(path.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 1");
  REQUIRE(refuses([&] { const PersonalData data(path); }, "1 2"));
  SQLite::Database(path.string(), SQLite::OPEN_READWRITE).exec("PRAGMA application_id = 5");
  REQUIRE(refuses([&] { const PersonalData data(path); }));
}
