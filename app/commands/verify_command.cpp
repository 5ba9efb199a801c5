// verify: checks that a study's files are consistent.
#include "analysis/verification/study_files.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/hash.hpp"

#include <cctype>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShortHeadDigits = 16;
constexpr std::size_t kHashDigits = 64;

struct VerifyArguments {
  fs::path database;
  fs::path key;
  fs::path pack;
  std::string head;
  std::vector<fs::path> heads;
  bool json = false;
};

/// The digits of a head, in lower case and without the blanks between groups.
std::string head_of(const VerifyArguments& arguments) {
  std::string head;
  for (const char digit : arguments.head) {
    if (digit != ' ') head += static_cast<char>(std::tolower(static_cast<unsigned char>(digit)));
  }
  const bool is_hex = head.find_first_not_of("0123456789abcdef") == std::string::npos;
  const bool is_long_enough = head.size() >= kShortHeadDigits && head.size() <= kHashDigits;
  if (head.empty() || (is_hex && is_long_enough)) return head;
  throw UsageError(
      "--head: is not a head; give the 16 digits of a day sheet, or the 64 that verify printed");
}

int verify(const VerifyArguments& arguments) {
  const std::string head = head_of(arguments);
  const analysis::StudyFiles files{.database = arguments.database,
                                   .key = key_in_use(arguments.database, arguments.key),
                                   .key_named = !arguments.key.empty(),
                                   .heads = arguments.heads,
                                   .pack = arguments.pack};
  const analysis::Verification verification = analysis::verify_files(files, head);
  print(arguments.json ? analysis::verification_json(verification)
                       : analysis::verification_text(verification));
  return verification.holds() ? 0 : kNotVerified;
}

}  // namespace

void add_verify_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "verify",
      "Check that a study's files are consistent: chain, seal, schedule, payloads and pack",
      verify);
  add_database_argument(command, arguments.database);
  add_key_option(command, arguments.key, "Key of the study (default: DB.key, if it exists)");
  command.add_option("--pack", arguments.pack,
                     "Pack of the study (default: the one that the key names, or one of the same "
                     "name beside the database or here)");
  command.add_option("--head", arguments.head,
                     "An earlier head of the file's chain, for instance from a day sheet, which "
                     "the chain must still contain");
  command.add_option(
      "--head-file", arguments.heads,
      "Another head file to compare the database with; for a merged database, a station's");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
