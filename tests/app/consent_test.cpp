// Consent is recorded apart from the study, for its owner's eyes alone.
#include "app/touchtrial_process.hpp"
#include "protocols/store/personal_data.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>

using namespace touchtrial;
using namespace touchtrial::store;

namespace {

namespace fs = std::filesystem;

TEST_CASE("consent is recorded in a file of its own that only its owner may read") {
  const TempFolder folder;
  const fs::path database = folder.path() / "study.db";
  const ProgramResult done =
      run_touchtrial(folder.path(), {"consent", database.string(), "--participant", "P07",
                                     "--version", "2026-03", "--age", "34"});
  INFO(done.errors);
  REQUIRE(done.exit_code == 0);
  const fs::path file = personal_data_path(database);
  CHECK((fs::status(file).permissions() & fs::perms(0777)) == fs::perms(0600));
  const auto record = PersonalData(file).find("P07");
  REQUIRE(record);
  CHECK(record->consent_version == "2026-03");
  CHECK(record->age == 34);
  CHECK(record->contact.empty());
  CHECK_FALSE(fs::exists(database));
}

TEST_CASE("consent without a line for the contact that was announced records nothing") {
  const TempFolder folder;
  const fs::path database = folder.path() / "study.db";
  const ProgramResult done = run_touchtrial(
      folder.path(),
      {"consent", database.string(), "--participant", "P07", "--version", "1", "--contact"});
  CHECK(done.exit_code == 2);
  CHECK_FALSE(fs::exists(personal_data_path(database)));
}

}  // namespace
