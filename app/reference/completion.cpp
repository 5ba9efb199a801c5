#include "app/reference/completion.hpp"

#include "app/reference/pages.hpp"
#include "app/shipped_files.hpp"
#include "device/registry.hpp"
#include "engine/extraction_options.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

/// The subject files that come with the program.
std::vector<std::string> shipped_subjects() {
  std::vector<std::string> files;
  try {
    for (const auto& file :
         std::filesystem::directory_iterator(shipped_folder() / "config/subjects")) {
      files.push_back(file.path().string());
    }
  } catch (const std::exception&) {
    return {};  // a program that was copied alone
  }
  std::ranges::sort(files);
  return files;
}

/// The values that an option takes, or some of them where it takes files and other text as well.
std::vector<std::string> values_of(const CLI::Option& option) {
  if (std::vector<std::string> choices = choices_of(option); !choices.empty()) return choices;
  const std::string name = option.get_name();
  if (name == "--on") return device::modelled_names();
  if (name == "--methods") return engine::method_names();
  if (name == "--subject") return shipped_subjects();
  return {};
}

/// The program's name is in every line already.
std::string place_of(const CLI::App& command) {
  const std::string words = words_of(command);
  const std::size_t space = words.find(' ');
  return space == std::string::npos ? "" : words.substr(space + 1);
}

}  // namespace

std::string completion_table(const CLI::App& program) {
  std::string table;
  for (const CLI::App* command : every_command(program)) {
    const std::string place = place_of(*command);
    for (const CLI::App* below : command->get_subcommands({})) {
      if (below->get_group().empty()) continue;
      table += fmt::format("{}|{}|-|{}\n", place, below->get_name(), below->get_description());
    }
    for (const CLI::Option* option : options_of(*command)) {
      const std::string values = option->get_items_expected_max() == 0
                                     ? "-"
                                     : fmt::format("{}", fmt::join(values_of(*option), " "));
      for (const std::string& name : names_of(*option)) {
        table += fmt::format("{}|{}|{}|{}\n", place, option->nonpositional() ? name : "", values,
                             option->get_description());
      }
    }
  }
  return table;
}

}  // namespace touchtrial::app
