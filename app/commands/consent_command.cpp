// consent: records a participant's consent and demographics in the file of personal data.
#include "app/commands/commands.hpp"
#include "app/commands/participant_ids.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/printable.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

constexpr int kMaxAgeYears = 130;
constexpr std::size_t kMaxVersionBytes = 64;

struct ConsentArguments {
  std::filesystem::path database;
  record::PersonalRecord record;
  std::string details;  ///< "-": read them from standard input
  bool yes = false;
};

std::string trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin));
}

void set_detail(record::PersonalRecord& record, std::string_view name, const std::string& value) {
  if (value.empty()) return;
  if (name == "age") {
    record.age = number_in<int>(value);
    if (!record.age || *record.age < 0 || *record.age > kMaxAgeYears) {
      throw UsageError(
          fmt::format("consent: the age must be a whole number of years from 0 to {}; nothing was "
                      "recorded",
                      kMaxAgeYears));
    }
  } else if (name == "gender") {
    record.gender = value;
  } else {
    record.contact = value;
  }
}

constexpr std::array<std::string_view, 3> kDetails = {"age", "gender", "contact"};

/// Asks for each detail; an empty answer skips it.
void ask_details(record::PersonalRecord& record) {
  for (const std::string_view name : kDetails) {
    const std::string prompt = fmt::format("{} (Return: not given): ", name);
    std::fputs(prompt.c_str(), stderr);
    std::string line;
    if (!std::getline(std::cin, line)) {
      throw UsageError("consent: aborted; nothing was recorded");
    }
    set_detail(record, name, trimmed(line));
  }
}

/// Reads lines "NAME: value" to the end of standard input. Messages never repeat a value.
void read_details(record::PersonalRecord& record) {
  std::array<bool, kDetails.size()> is_set{};
  int number = 0;
  for (std::string line; std::getline(std::cin, line);) {
    ++number;
    if (trimmed(line).empty()) continue;
    const std::size_t colon = std::min(line.find(':'), line.size());
    const std::string name = trimmed(std::string_view(line).substr(0, colon));
    const auto* const detail = std::find(kDetails.begin(), kDetails.end(), name);
    if (detail == kDetails.end() || colon == line.size()) {
      throw UsageError(
          fmt::format("consent: standard input, line {}: must be \"age: YEARS\", \"gender: WORDS\" "
                      "or \"contact: WORDS\"; nothing was recorded",
                      number));
    }
    if (std::exchange(is_set.at(static_cast<std::size_t>(detail - kDetails.begin())), true)) {
      throw UsageError(
          fmt::format("consent: standard input, line {}: {} is given twice; nothing was recorded",
                      number, name));
    }
    set_detail(record, name, trimmed(std::string_view(line).substr(colon + 1)));
  }
  if (number == 0) {
    throw UsageError("consent: --details - reads standard input, which is empty");
  }
}

int record_consent(const ConsentArguments& arguments) {
  record::PersonalRecord record = arguments.record;
  if (record.consent_version.empty())
    throw UsageError("consent: --version is empty; name the form");
  if (!record::is_participant_id(record.participant)) {
    throw UsageError("consent: " + in_quotes(record.participant) + " is not a participant id; " +
                     std::string(record::kParticipantIdRule));
  }
  if (record.consent_version.size() > kMaxVersionBytes ||
      printable(record.consent_version) != record.consent_version) {
    throw UsageError(
        fmt::format("consent: --version is the name of a form: one line of at most {} bytes",
                    kMaxVersionBytes));
  }
  confirm_id("consent", arguments.database, record.participant, arguments.yes);
  if (!arguments.details.empty() && ::isatty(STDIN_FILENO) != 0) {
    ask_details(record);
  } else if (!arguments.details.empty()) {
    read_details(record);
  }
  record.consented_utc = utc_text(utc_now());
  const std::filesystem::path path = record::personal_data_path(arguments.database);
  record::PersonalData data(path);
  const auto previous = data.find(record.participant);
  data.put(record);
  print(fmt::format("{}: consent of participant {} to version {} recorded\n", path.string(),
                    record.participant, record.consent_version));
  if (previous) {
    print(fmt::format("the consent to version {} of {} and its details are also kept\n",
                      previous->consent_version, previous->consented_utc));
  }
  return 0;
}

}  // namespace

void add_consent_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "consent",
      "Record a participant's consent and demographics, in DB.personal only", record_consent);
  add_database_argument(command, arguments.database, "Database of the study; it need not exist yet")
      ->check(place_validator());
  command.add_option("--participant", arguments.record.participant, "Id, for instance P07")
      ->required();
  command
      .add_option("--version", arguments.record.consent_version,
                  "Version of the consent form that was signed")
      ->required();
  add_yes_flag(command, arguments.yes);
  command
      .add_option("--details", arguments.details,
                  "With -, ask for age, gender and contact, or read them from standard input as "
                  "lines such as \"age: 34\"")
      ->check(CLI::IsMember({"-"}));
}

}  // namespace touchtrial::app
