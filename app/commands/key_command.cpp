// key: adds "key copy" and "key protect". "key check" has its own file.
#include "app/commands/commands.hpp"
#include "app/terminal/console.hpp"
#include "app/terminal/passphrases.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/key_protection.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct KeyArguments {
  fs::path file;  ///< a key, with "protect" also a station's file
  fs::path output;
  std::vector<fs::path> new_passphrase_files;  ///< at most one
  bool passphrase = false;
  bool remove = false;
};

void refuse_existing_secret(const fs::path& output) {
  refuse_link(output);
  if (!path_exists(output)) return;
  throw UsageError(one_line(output.string()) + ": exists already; give another name with --out");
}

bool has_new_passphrase(const KeyArguments& arguments) {
  return arguments.passphrase || !arguments.new_passphrase_files.empty();
}

int copy_key(const KeyArguments& arguments) {
  refuse_existing_secret(arguments.output);
  if (!has_new_passphrase(arguments) && study::is_protected(arguments.file)) {
    throw UsageError(one_line(arguments.file.string()) +
                     ": is protected by a passphrase, and the copy would not be; protect the copy "
                     "too with --passphrase");
  }
  const study::StudyKey key = study::load_study_key(arguments.file);
  if (has_new_passphrase(arguments)) {
    study::save_study_key(arguments.output, key,
                          new_passphrase(arguments.output, arguments.new_passphrase_files));
  } else {
    study::save_study_key(arguments.output, key);
  }
  print("key " + arguments.output.string() +
        " (like the original, it opens every session and cannot be revoked)\n");
  return 0;
}

int protect_key(const KeyArguments& arguments) {
  if (arguments.remove) {
    study::protect(arguments.file, std::nullopt);
    print(arguments.file.string() + ": is no longer protected by a passphrase\n");
    return 0;
  }
  // Opens the file first, so that a wrong old passphrase is refused before a new one is chosen.
  static_cast<void>(study::read_secret_text(arguments.file));
  study::protect(arguments.file, new_passphrase(arguments.file, arguments.new_passphrase_files));
  print(arguments.file.string() + ": is protected; it cannot be opened without the passphrase\n");
  return 0;
}

CLI::Option* add_new_passphrase_option(CLI::App& command, KeyArguments& arguments) {
  return command
      .add_option("--new-passphrase-file", arguments.new_passphrase_files,
                  "File or descriptor whose first line is the new passphrase (default: prompt)")
      ->type_name("FILE")
      ->expected(1);
}

void add_copy_command(CLI::App& keys, Action& action) {
  const auto [command, arguments] = add_command(
      keys, action, "copy",
      "Copy a key, for a colleague or another medium, with its own passphrase", copy_key);
  command.add_option("KEY", arguments.file, "The investigator's key")->required();
  command.add_option("-o,--out", arguments.output, "Key to write")->required();
  command.add_flag("--passphrase", arguments.passphrase, "Protect the copy with a new passphrase");
  add_new_passphrase_option(command, arguments);
  add_passphrase_option(command);
}

void add_protect_command(CLI::App& keys, Action& action) {
  const auto [command, arguments] =
      add_command(keys, action, "protect",
                  "Set, change or remove the passphrase of a key or a station's file", protect_key);
  command.add_option("FILE", arguments.file, "Key or station's file")->required();
  CLI::Option* new_passphrase = add_new_passphrase_option(command, arguments);
  command.add_flag("--remove", arguments.remove, "Remove the passphrase")->excludes(new_passphrase);
  add_passphrase_option(command);
}

}  // namespace

void add_key_command(CLI::App& program, Action& action) {
  CLI::App* keys = program.add_subcommand("key", "Check, copy and protect the investigator's key");
  keys->require_subcommand(1);
  add_key_check_command(*keys, action);
  add_copy_command(*keys, action);
  add_protect_command(*keys, action);
}

}  // namespace touchtrial::app
