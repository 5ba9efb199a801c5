// consent: who signed which version, kept apart from everything that is analysed.
#include "app/commands.hpp"
#include "app/console.hpp"
#include "core/errors.hpp"
#include "protocols/store/personal_data.hpp"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/chrono.h>

namespace touchtrial::app {
namespace {

struct ConsentArguments {
  std::filesystem::path database;
  store::PersonalRecord record;
  int age = -1;  ///< not given
  bool reads_contact = false;
};

std::string contact_from_input() {
  std::string line;
  if (!std::getline(std::cin, line)) {
    throw UsageError("consent: --contact reads a line from standard input, which has none");
  }
  return line;
}

int record_consent(const ConsentArguments& arguments) {
  store::PersonalRecord record = arguments.record;
  if (record.participant.empty() || record.consent_version.empty()) {
    throw UsageError("consent: --participant and --version must not be empty");
  }
  if (arguments.age >= 0) record.age = arguments.age;
  if (arguments.reads_contact) record.contact = contact_from_input();
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  record.consented_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
  const std::filesystem::path path = store::personal_data_path(arguments.database);
  store::PersonalData(path).put(record);
  print(fmt::format("{}: consent of participant {} to version {} recorded\n", path.string(),
                    record.participant, record.consent_version));
  return 0;
}

}  // namespace

void add_consent_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ConsentArguments>();
  CLI::App* command = program.add_subcommand(
      "consent",
      "Record a participant's consent and demographics, in DB.personal and nowhere else");
  command->add_option("DB", arguments->database, "Database of the study; need not be there yet")
      ->check(place_validator())
      ->required();
  command->add_option("--participant", arguments->record.participant, "Id, for instance P07")
      ->required();
  command->add_option("--version", arguments->record.consent_version, "Version that was signed")
      ->required();
  command->add_option("--age", arguments->age, "Years")->check(CLI::Range(0, 130));
  command->add_option("--gender", arguments->record.gender, "In their own words");
  command->add_flag("--contact", arguments->reads_contact,
                    "Read how to reach them, a line, from standard input");
  command->callback([=, &action] { action = [=] { return record_consent(*arguments); }; });
}

}  // namespace touchtrial::app
