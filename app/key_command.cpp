// key: sheet, restore, copy and protect. "key check" has a file of its own.
#include "analysis/page/recovery_document.hpp"
#include "analysis/text_figures.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/passphrases.hpp"
#include "app/study_inputs.hpp"
#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/key_protection.hpp"
#include "protocols/design/recovery_sheet.hpp"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct KeyArguments {
  fs::path file;  ///< a key, with "restore" a study file, with "protect" also a station's file
  fs::path output;
  fs::path pack;
  std::vector<fs::path> new_passphrase_files;  ///< one at most
  bool passphrase = false;
  bool remove = false;
};

void refuse_existing_secret(const fs::path& output) {
  refuse_link(output);
  if (!is_there(output)) return;
  throw UsageError(one_line(output.string()) + ": exists already; give another name with --out");
}

// The recovery sheet.

std::string sheet_of(const design::StudyKey& key, const fs::path& output) {
  const std::string ending = ending_of(output);
  if (ending == ".html") return analysis::page_html(analysis::recovery_document(key));
  if (ending == ".txt") return analysis::document_text(analysis::recovery_document(key));
  throw UsageError("key sheet: " + one_line(output.string()) +
                   ": sheets are HTML or text; give a name that ends in .html or .txt");
}

int write_key_sheet(const KeyArguments& arguments) {
  refuse_existing_secret(arguments.output);
  const design::StudyKey key = design::load_study_key(arguments.file);
  replace_file(arguments.output, sheet_of(key, arguments.output), FileMode::owner_only);
  print("sheet " + arguments.output.string() +
        " (it opens every session: print it, keep the paper apart from the key, and delete this "
        "file)\n");
  return 0;
}

/// Asks for one line after the other, and again for one that is not what the sheet says.
void ask_lines(design::RecoveryReader& reader) {
  std::fputs("Type the lines of the sheet, each with its number, as in \"1: 7f3a ...\".\n", stderr);
  for (int next = reader.missing(); next > 0; next = reader.missing()) {
    std::fputs(fmt::format("line {}: ", next).c_str(), stderr);
    std::string line;
    if (!std::getline(std::cin, line))
      throw UsageError("key restore: broken off; nothing was made");
    try {
      // The number may be left out, because it was asked for.
      if (!reader.take(line)) static_cast<void>(reader.take(fmt::format("{}: {}", next, line)));
    } catch (const UsageError& mistyped) {
      std::fputs((std::string(mistyped.what()) + "\n").c_str(), stderr);
    }
  }
}

void read_lines(design::RecoveryReader& reader) {
  int number = 0;
  for (std::string line; std::getline(std::cin, line); ++number) {
    static_cast<void>(reader.take(line));
  }
  if (number == 0) throw UsageError("key restore: reads standard input, which is empty");
}

int restore_key(const KeyArguments& arguments) {
  refuse_existing_secret(arguments.output);
  const design::Study study = design::load_study(arguments.file);
  design::RecoveryReader reader;
  if (::isatty(STDIN_FILENO) != 0) {
    ask_lines(reader);
  } else {
    read_lines(reader);
  }
  design::StudyKey key = reader.key_for(study);
  key.pack_folder = pack_place_for(arguments.file, arguments.pack).pack;
  design::save_study_key(arguments.output, key);
  if (!reader.is_sealed_as(key)) {
    spdlog::warn(
        "{}: is not the study for which the sheet was printed: the key opens databases of the "
        "study "
        "as it is now; take the study file as it was for those of before",
        arguments.file.string());
  }
  print(fmt::format("key {} of study {} ({}), with {}\n", arguments.output.string(), study.name,
                    key.study_id,
                    analysis::counted(static_cast<int>(key.stations.size()), "station")));
  return 0;
}

// Copies and passphrases.

bool wants_passphrase(const KeyArguments& arguments) {
  return arguments.passphrase || !arguments.new_passphrase_files.empty();
}

int copy_key(const KeyArguments& arguments) {
  refuse_existing_secret(arguments.output);
  if (!wants_passphrase(arguments) && design::is_protected(arguments.file)) {
    throw UsageError(one_line(arguments.file.string()) +
                     ": is protected by a passphrase, and the copy would not be; give the copy one "
                     "of its own with --passphrase");
  }
  const design::StudyKey key = design::load_study_key(arguments.file);
  if (wants_passphrase(arguments)) {
    design::save_study_key(arguments.output, key,
                           new_passphrase(arguments.output, arguments.new_passphrase_files));
  } else {
    design::save_study_key(arguments.output, key);
  }
  print("key " + arguments.output.string() +
        " (it opens every session, as the first one does; neither can be taken back)\n");
  return 0;
}

int protect_key(const KeyArguments& arguments) {
  if (arguments.remove) {
    design::protect(arguments.file, std::nullopt);
    print(arguments.file.string() + ": is no longer protected by a passphrase\n");
    return 0;
  }
  // The old passphrase first: nobody should think of a new one for a file that does not open.
  static_cast<void>(design::read_secret_text(arguments.file));
  design::protect(arguments.file, new_passphrase(arguments.file, arguments.new_passphrase_files));
  print(arguments.file.string() +
        ": is protected; nobody can open it without the passphrase: keep a recovery sheet\n");
  return 0;
}

CLI::Option* add_new_passphrase_option(CLI::App& command, KeyArguments& arguments) {
  return command
      .add_option("--new-passphrase-file", arguments.new_passphrase_files,
                  "File or descriptor whose first line is the new passphrase (default: asked for)")
      ->type_name("FILE")
      ->expected(1);
}

void add_sheet(CLI::App& keys, Action& action) {
  const auto [command, arguments] = add_command(
      keys, action, "sheet", "Write the recovery sheet of a key, to be printed", write_key_sheet);
  command.add_option("KEY", arguments.file, "The investigator's key")->required();
  command.add_option("-o,--out", arguments.output, "HTML or text file to write")->required();
  add_passphrase_option(command);
}

void add_restore(CLI::App& keys, Action& action) {
  const auto [command, arguments] =
      add_command(keys, action, "restore",
                  "Make a key again from its recovery sheet, which is typed or "
                  "read from standard input",
                  restore_key);
  add_study_argument(command, arguments.file);
  command.add_option("-o,--out", arguments.output, "Key to write")->required();
  add_pack_option(command, arguments.pack);
}

void add_copy(CLI::App& keys, Action& action) {
  const auto [command, arguments] =
      add_command(keys, action, "copy",
                  "Copy a key, for a colleague or another medium, under a "
                  "passphrase of its own",
                  copy_key);
  command.add_option("KEY", arguments.file, "The investigator's key")->required();
  command.add_option("-o,--out", arguments.output, "Key to write")->required();
  command.add_flag("--passphrase", arguments.passphrase, "Protect the copy by a new passphrase");
  add_new_passphrase_option(command, arguments);
  add_passphrase_option(command);
}

void add_protect(CLI::App& keys, Action& action) {
  const auto [command, arguments] =
      add_command(keys, action, "protect",
                  "Give a key or a station's file a passphrase, another one, or none", protect_key);
  command.add_option("FILE", arguments.file, "Key or station's file")->required();
  CLI::Option* given = add_new_passphrase_option(command, arguments);
  command.add_flag("--remove", arguments.remove, "Take the passphrase away")->excludes(given);
  add_passphrase_option(command);
}

}  // namespace

void add_key_command(CLI::App& program, Action& action) {
  CLI::App* keys = program.add_subcommand(
      "key", "Check, copy and protect the investigator's key, and print its recovery sheet");
  keys->require_subcommand(1);
  add_key_check_command(*keys, action);
  add_sheet(*keys, action);
  add_restore(*keys, action);
  add_copy(*keys, action);
  add_protect(*keys, action);
}

}  // namespace touchtrial::app
