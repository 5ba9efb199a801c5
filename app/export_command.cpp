#include "analysis/exports/export_csv.hpp"
#include "analysis/exports/export_json.hpp"
#include "analysis/outcomes.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/key_of_database.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path database;
  fs::path key;
  fs::path folder;
  std::string format = "csv";
};

int export_study(const ExportArguments& arguments) {
  const StudyStore store = StudyStore::open(arguments.database, StudyStore::Access::read_only);
  std::optional<Outcomes> outcomes;
  if (store.state().unblinded) {
    outcomes = load_outcomes(store, key_of_database(store, arguments.database, arguments.key));
  }
  std::string written;
  if (arguments.format == "json") {
    written = export_json(store, outcomes, arguments.folder).string() + "\n";
  } else {
    for (const fs::path& file : export_csv(store, outcomes, arguments.folder)) {
      written += file.string() + "\n";
    }
  }
  print(written);
  return 0;
}

}  // namespace

void add_export_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = program.add_subcommand("export", "Write a study's data for other programs");
  command->add_option("DB", arguments->database, "Database of the study")->required();
  command->add_option("--format", arguments->format, "What to write")
      ->check(CLI::IsMember({"csv", "json"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->folder, "Folder to write into")->required();
  command->add_option("--key", arguments->key, "Key of the study (default: DB.key)");
  command->callback([=, &action] { action = [=] { return export_study(*arguments); }; });
}

}  // namespace touchtrial
