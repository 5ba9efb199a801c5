// consent: records a participant's consent and demographics in the file of personal data, and shows
// what is recorded.
#include "analysis/text_table.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/participant_ids.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/printable.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "protocols/store/personal_data.hpp"
#include "protocols/store/study_store.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace touchtrial::app {
namespace {

constexpr int kOldestYears = 130;
constexpr std::size_t kLongestVersion = 64;  // bytes

struct ConsentArguments {
  std::filesystem::path database;
  store::PersonalRecord record;
  std::string details;  ///< "-": read them from standard input
  bool yes = false;
  bool show = false;
  bool list = false;
  bool json = false;
};

std::string trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin));
}

void set_detail(store::PersonalRecord& record, std::string_view name, const std::string& value) {
  if (value.empty()) return;
  if (name == "age") {
    record.age = number_in<int>(value);
    if (!record.age || *record.age < 0 || *record.age > kOldestYears) {
      throw UsageError(
          fmt::format("consent: the age must be a whole number of years from 0 to {}; nothing was "
                      "recorded",
                      kOldestYears));
    }
  } else if (name == "gender") {
    record.gender = value;
  } else {
    record.contact = value;
  }
}

constexpr std::array<std::string_view, 3> kDetails = {"age", "gender", "contact"};

/// Asks for one after the other; an empty answer leaves a detail out.
void ask_details(store::PersonalRecord& record) {
  for (const std::string_view name : kDetails) {
    const std::string prompt = fmt::format("{} (Return: not given): ", name);
    std::fputs(prompt.c_str(), stderr);
    std::string line;
    if (!std::getline(std::cin, line)) {
      throw UsageError("consent: broken off; nothing was recorded");
    }
    set_detail(record, name, trimmed(line));
  }
}

/// Reads lines "NAME: value" to the end of standard input. No message repeats a value.
void read_details(store::PersonalRecord& record) {
  std::array<bool, kDetails.size()> given{};
  int number = 0;
  for (std::string line; std::getline(std::cin, line);) {
    ++number;
    if (trimmed(line).empty()) continue;
    const std::size_t colon = std::min(line.find(':'), line.size());
    const std::string name = trimmed(std::string_view(line).substr(0, colon));
    const auto* const found = std::find(kDetails.begin(), kDetails.end(), name);
    if (found == kDetails.end() || colon == line.size()) {
      throw UsageError(
          fmt::format("consent: standard input, line {}: must be \"age: YEARS\", \"gender: WORDS\" "
                      "or \"contact: WORDS\"; nothing was recorded",
                      number));
    }
    if (std::exchange(given.at(static_cast<std::size_t>(found - kDetails.begin())), true)) {
      throw UsageError(
          fmt::format("consent: standard input, line {}: {} is there twice; nothing was recorded",
                      number, name));
    }
    set_detail(record, name, trimmed(std::string_view(line).substr(colon + 1)));
  }
  if (number == 0) {
    throw UsageError("consent: --details - reads standard input, which is empty");
  }
}

int record_consent(const ConsentArguments& arguments) {
  store::PersonalRecord record = arguments.record;
  if (record.participant.empty() || record.consent_version.empty()) {
    throw UsageError(
        "consent: give --participant and --version, neither of them empty; --list and --show tell "
        "what is recorded");
  }
  if (!store::is_participant_id(record.participant)) {
    throw UsageError("consent: " + in_quotes(record.participant) + " is no participant id; " +
                     std::string(store::kParticipantIdRule));
  }
  if (record.consent_version.size() > kLongestVersion ||
      printable(record.consent_version) != record.consent_version) {
    throw UsageError(fmt::format(
        "consent: --version is the name of a form: one line of at most {} bytes", kLongestVersion));
  }
  confirm_id("consent", arguments.database, record.participant, arguments.yes);
  if (!arguments.details.empty() && ::isatty(STDIN_FILENO) != 0) {
    ask_details(record);
  } else if (!arguments.details.empty()) {
    read_details(record);
  }
  record.consented_utc = utc_text(utc_now());
  const std::filesystem::path path = store::personal_data_path(arguments.database);
  store::PersonalData data(path);
  const auto before = data.find(record.participant);
  data.put(record);
  print(fmt::format("{}: consent of participant {} to version {} recorded\n", path.string(),
                    record.participant, record.consent_version));
  if (before) {
    print(fmt::format("the consent to version {} of {}, and what was said then, are kept\n",
                      before->consent_version, before->consented_utc));
  }
  return 0;
}

nlohmann::ordered_json consent_json(const store::PersonalRecord& one) {
  nlohmann::ordered_json object{{"version", one.consent_version},
                                {"consented_utc", one.consented_utc}};
  object["age"] = nullptr;
  if (one.age) object["age"] = *one.age;
  object["gender"] = one.gender;
  object["contact"] = one.contact;
  return object;
}

/// Every consent of one participant, with what was said then.
int show_consents(const ConsentArguments& arguments) {
  const std::string& id = arguments.record.participant;
  nlohmann::ordered_json consents = nlohmann::ordered_json::array();
  std::string text;
  const auto said = [](const std::string& words) { return words.empty() ? "-" : one_line(words); };
  for (const store::PersonalRecord& one : consents_beside(arguments.database)) {
    if (one.participant != id) continue;
    consents.push_back(consent_json(one));
    text += fmt::format("{}  version {}; age: {}; gender: {}; contact: {}\n", one.consented_utc,
                        one_line(one.consent_version), one.age ? std::to_string(*one.age) : "-",
                        said(one.gender), said(one.contact));
  }
  if (consents.empty()) {
    throw StoreError(one_line(arguments.database.string() + ": no consent of participant " + id +
                              " is recorded; `touchtrial consent DB --list` names those who have "
                              "one"));
  }
  print(arguments.json ? json_text(nlohmann::ordered_json{{"participant", id},
                                                          {"consents", std::move(consents)}})
                       : text);
  return 0;
}

/// Who consented to what and when, and who has a session and no consent. Nothing else about them.
int list_consents(const ConsentArguments& arguments) {
  if (!is_there(arguments.database) && !is_there(store::personal_data_path(arguments.database))) {
    throw StoreError(one_line(arguments.database.string()) +
                     ": there is neither such a database nor a consent beside it; check the name");
  }
  std::map<std::string, std::vector<store::PersonalRecord>> people;
  for (const std::string& id : participants_of(arguments.database)) people[id];
  for (store::PersonalRecord& one : consents_beside(arguments.database)) {
    people[one.participant].push_back(std::move(one));
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  analysis::TextTable table({"participant", "consents", "last version", "when"}, {0, 2, 3});
  for (const auto& [id, consents] : people) {
    const store::PersonalRecord last = consents.empty() ? store::PersonalRecord{} : consents.back();
    list.push_back({{"participant", id},
                    {"consents", consents.size()},
                    {"version", last.consent_version},
                    {"consented_utc", last.consented_utc}});
    table.add({id, consents.empty() ? "none" : std::to_string(consents.size()),
               consents.empty() ? "-" : last.consent_version,
               consents.empty() ? "-" : last.consented_utc});
  }
  print(arguments.json ? json_text(nlohmann::ordered_json{{"participants", std::move(list)}})
                       : (people.empty() ? "no participant is known\n" : table.text()));
  return 0;
}

}  // namespace

void add_consent_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ConsentArguments>();
  CLI::App* command = program.add_subcommand("consent",
                                             "Record a participant's consent and demographics, in "
                                             "DB.personal only, or show what is there");
  add_database_argument(*command, arguments->database,
                        "Database of the study; it need not exist yet")
      ->check(place_validator());
  CLI::Option* participant =
      command->add_option("--participant", arguments->record.participant, "Id, for instance P07");
  CLI::Option* version = command->add_option("--version", arguments->record.consent_version,
                                             "Version that was signed");
  CLI::Option* show = command->add_flag(
      "--show", arguments->show, "Show every consent of the participant, and what was said then");
  show->needs(participant)->excludes(version);
  CLI::Option* list =
      command->add_flag("--list", arguments->list, "List who consented to which version and when");
  list->excludes(participant)->excludes(version)->excludes(show);
  add_json_flag(*command, arguments->json);
  add_yes_flag(*command, arguments->yes);
  command
      ->add_option("--details", arguments->details,
                   "-: ask for age, gender and contact, or read them from standard input in lines "
                   "\"age: 34\"")
      ->check(CLI::IsMember({"-"}));
  command->callback([=, &action] {
    action = [=] {
      if (arguments->list) return list_consents(*arguments);
      return arguments->show ? show_consents(*arguments) : record_consent(*arguments);
    };
  });
}

}  // namespace touchtrial::app
