/// \file The JSON Schemas of config/schema and the tables of settings, events and measures in docs,
/// made from the descriptions that readers, writers and reports follow.
///
///     settings_files check ROOT   says which of them are not as the descriptions make them
///     settings_files write ROOT   writes them
///     settings_files judge KIND   reads a settings file from each line, writes the reader's
///     refusal
#include "column_tables.hpp"
#include "core/describe.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/acceptance/certificate.hpp"
#include "device/device_settings.hpp"
#include "device/model/device_model.hpp"
#include "device/settings_schemas.hpp"
#include "event_tables.hpp"
#include "measure_tables.hpp"
#include "protocols/registration/registration.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/subject_schema.hpp"
#include "study/study.hpp"
#include "study/study_schema.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

/// A kind of settings file.
struct Kind {
  std::string_view name;  ///< of its schema
  std::string (*schema)();
  void (*read)(const std::string& text);
  bool is_typed = true;  ///< people type such files, and their editors need the schema
};

constexpr Kind kKinds[] = {
    {"study", study::study_schema,
     [](const std::string& text) { static_cast<void>(study::parse_study(text, "", "file")); }},
    {"subject", simulation::subject_model_schema,
     [](const std::string& text) {
       static_cast<void>(simulation::parse_subject_model(text, "file"));
     }},
    {"devices", device::device_settings_schema,
     [](const std::string& text) {
       static_cast<void>(device::parse_device_settings(text, "/lab", "file"));
     }},
    {"device-model", device::device_model_schema,
     [](const std::string& text) { static_cast<void>(device::parse_device_model(text, "file")); }},
    {"certificate", device::certificate_schema,
     [](const std::string& text) { static_cast<void>(device::parse_certificate(text, "file")); },
     /*is_typed=*/false}};

const Kind& kind_of(std::string_view name) {
  const Kind* const kind = std::ranges::find(kKinds, name, &Kind::name);
  if (kind == std::end(kKinds))
    throw UsageError("no kind of settings is called " + std::string(name));
  return *kind;
}

/// \param what  as in the line before the table
std::string table_of(std::string what) {
  constexpr std::string_view kInner = " with inner keys";
  constexpr std::string_view kMeasures = "measures of ";
  constexpr std::string_view kColumns = "columns of ";
  if (what.starts_with(kMeasures)) return table_of_measures(what.substr(kMeasures.size()));
  if (what.starts_with(kColumns)) return table_of_columns(what.substr(kColumns.size()));
  if (what == "events in exports") return table_of_exported_events();
  if (what.starts_with("events ")) return table_of_events(what.ends_with("file"));
  const bool nested = what.ends_with(kInner);
  if (nested) what.resize(what.size() - kInner.size());
  const std::size_t space = what.find(' ');
  const std::string pointer = space == what.npos ? "" : what.substr(space + 1);
  return table_of_settings(kind_of(what.substr(0, space)).schema(), pointer, nested);
}

/// The page with its tables made anew. A table stands between the lines
/// `<!-- settings: KIND /pointer -->`, `<!-- settings: KIND /pointer with inner keys -->` or
/// `<!-- settings: events of the file -->` (`of a session`, `in exports`) or
/// `<!-- settings: measures of identification -->` (`of ratings`, `of thresholds`) or
/// `<!-- settings: columns of FILE.csv -->` and `<!-- end of settings -->`.
std::string with_tables(const std::string& page) {
  constexpr std::string_view kBegins = "<!-- settings: ";
  constexpr std::string_view kEnds = "<!-- end of settings -->\n";
  std::string text;
  std::size_t at = 0;
  for (std::size_t mark = page.find(kBegins); mark != page.npos; mark = page.find(kBegins, at)) {
    const std::size_t line_ends = page.find('\n', mark) + 1;
    const std::string what =
        page.substr(mark + kBegins.size(), line_ends - mark - kBegins.size() - 5);
    text += page.substr(at, line_ends - at) + "\n" + table_of(what) + "\n";
    at = page.find(kEnds, line_ends);
    if (at == page.npos) throw UsageError("a table of settings has no end: " + what);
  }
  return text + page.substr(at);
}

/// \return whether the file was as it should be
bool settle(const fs::path& file, const std::string& wanted, bool writes) {
  if (path_exists(file) && text_of(read_file(file)) == wanted) return true;
  if (writes) replace_file(file, wanted);
  std::cout << file.string()
            << (writes ? " is written\n" : " is not as the descriptions have it\n");
  return writes;
}

bool settle_all(const fs::path& root, bool writes) {
  bool is_right = true;
  for (const Kind& kind : kKinds) {
    if (!kind.is_typed) continue;
    const std::string name = std::string(kind.name) + ".schema.json";
    is_right &= settle(root / "config" / "schema" / name, plain_schema(kind.schema()), writes);
  }
  for (const auto& page : fs::recursive_directory_iterator(root / "docs")) {
    if (page.path().extension() != ".md") continue;
    is_right &= settle(page.path(), with_tables(text_of(read_file(page.path()))), writes);
  }
  if (!is_right) std::cout << "run `settings_files write ROOT`, tests/settings\n";
  return is_right;
}

void judge(const Kind& kind) {
  for (std::string line; std::getline(std::cin, line);) {
    try {
      kind.read(line);
      std::cout << '\n';
    } catch (const StudyError& error) {
      std::cout << error.what() << '\n';
    }
  }
}

int run(std::string_view task, const std::string& what) {
  registration::register_protocols();
  if (task == "judge") {
    judge(kind_of(what));
    return 0;
  }
  return settle_all(what, task == "write") ? 0 : 1;
}

}  // namespace
}  // namespace touchtrial

int main(int count, char** words) {
  if (count != 3) return 2;
  try {
    return touchtrial::run(words[1], words[2]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
