#include "column_tables.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "analysis/exports/study_tables.hpp"
#include "analysis/exports/trial_tables.hpp"

#include <cstddef>
#include <vector>

namespace touchtrial {
namespace {

/// A column with more is that of events' kinds, which have a table of their own.
constexpr std::size_t kMaxLevels = 8;

std::vector<std::string> listed_columns(const std::string& file) {
  const std::vector<std::string> at_the_end{"visit", "group"};
  std::vector<std::string> columns;
  if (file == "trials.csv") {
    for (const analysis::TrialColumn& column : analysis::trial_columns()) {
      columns.push_back(column.name);
    }
    columns.insert(columns.end(), {"gain_db", "track", "standard", "level_db", "rating_ID"});
  } else if (file == "participants.csv") {
    columns = analysis::participant_columns(true);
  } else {
    return analysis::columns_of(file);
  }
  columns.insert(columns.end(), at_the_end.begin(), at_the_end.end());
  return columns;
}

std::string cell_of(const analysis::ColumnMeaning& meaning) {
  std::string text = meaning.description;
  // 0 and 1 explain themselves.
  const bool is_flag = !meaning.levels.empty() && meaning.levels.front().first == "0";
  if (is_flag) text += ": 1 or 0";
  if (!meaning.unit.empty()) text += ", " + meaning.unit;
  if (meaning.levels.size() > kMaxLevels) return text + ", one of the kinds below";
  for (std::size_t i = 0; i < meaning.levels.size() && !is_flag; ++i) {
    text += (i == 0 ? ": `" : "; `") + meaning.levels[i].first + "` " + meaning.levels[i].second;
  }
  return text;
}

}  // namespace

std::string table_of_columns(const std::string& file) {
  std::string text = "| column of `" + file + "` | meaning |\n| --- | --- |\n";
  for (const std::string& column : listed_columns(file)) {
    text += "| `" + column + "` | " + cell_of(analysis::meaning_of(column, file)) + " |\n";
  }
  return text;
}

}  // namespace touchtrial
