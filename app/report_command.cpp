#include "analysis/outcomes.hpp"
#include "analysis/report/quality.hpp"
#include "analysis/report/report.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/key_of_database.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  fs::path database;
  fs::path key;
  bool json = false;
};

int report(const ReportArguments& arguments) {
  const StudyStore store = StudyStore::open(arguments.database, StudyStore::Access::read_only);
  if (!store.state().unblinded) {
    const QualityReport quality = make_quality(store);
    print(arguments.json ? quality_json(quality) : quality_text(quality));
    return 0;
  }
  const StudyKey key = key_of_database(store, arguments.database, arguments.key);
  const StudyReport outcomes = make_report(load_outcomes(store, key));
  print(arguments.json ? report_json(outcomes) : report_text(outcomes));
  return 0;
}

}  // namespace

void add_report_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = program.add_subcommand(
      "report", "Accuracy tables; before unblinding, the quality of the data alone");
  command->add_option("DB", arguments->database, "Database of the study")->required();
  command->add_option("--key", arguments->key, "Key of the study (default: DB.key)");
  command->add_flag("--json", arguments->json, "One JSON object in place of tables");
  command->callback([=, &action] { action = [=] { return report(*arguments); }; });
}

}  // namespace touchtrial
