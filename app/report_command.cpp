#include "analysis/outcomes.hpp"
#include "analysis/page/report_folder.hpp"
#include "analysis/page/study_document.hpp"
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
  fs::path folder;
  bool json = false;
};

void write_report(const ReportArguments& arguments, const Document& document,
                  const std::string& results) {
  write_report_folder(arguments.folder, report_files(document, results));
  print((arguments.folder / "report.html").string() + "\n");
}

int report_quality(const StudyStore& store, const ReportArguments& arguments) {
  const QualityReport quality = make_quality(store);
  if (arguments.folder.empty()) {
    print(arguments.json ? quality_json(quality) : quality_text(quality));
    return 0;
  }
  const Provenance provenance = provenance_of(store, arguments.database.filename().string());
  write_report(arguments, quality_document(quality, load_collection(store), provenance),
               quality_json(quality));
  return 0;
}

int report(const ReportArguments& arguments) {
  const StudyStore store = StudyStore::open(arguments.database, StudyStore::Access::read_only);
  if (!arguments.folder.empty()) refuse_other_study(arguments.folder, store.commitment().study);
  if (!store.state().unblinded) return report_quality(store, arguments);
  const StudyKey key = key_of_database(store, arguments.database, arguments.key);
  const StudyReport outcomes = make_report(load_outcomes(store, key));
  if (arguments.folder.empty()) {
    print(arguments.json ? report_json(outcomes) : report_text(outcomes));
    return 0;
  }
  const Provenance provenance = provenance_of(store, arguments.database.filename().string());
  write_report(arguments, study_document(outcomes, provenance), report_json(outcomes));
  return 0;
}

}  // namespace

void add_report_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = program.add_subcommand(
      "report", "Accuracy tables; before unblinding, the quality of the data alone");
  command->add_option("DB", arguments->database, "Database of the study")->required();
  command->add_option("--key", arguments->key, "Key of the study (default: DB.key)");
  auto* json = command->add_flag("--json", arguments->json, "One JSON object in place of tables");
  command
      ->add_option("-o,--out", arguments->folder,
                   "Folder for a page with all tables, the tables as Markdown and LaTeX, and "
                   "results.json")
      ->excludes(json);
  command->callback([=, &action] { action = [=] { return report(*arguments); }; });
}

}  // namespace touchtrial
