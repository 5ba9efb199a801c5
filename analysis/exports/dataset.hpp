/// \file Common parts of the dataset formats: source, options, labels, and the meanings of columns.
#pragma once

#include "analysis/exports/people_tables.hpp"
#include "analysis/outcomes/outcomes.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// A study and, after unblinding, both its outcomes and its key.
struct DatasetSource {
  const record::StudyStore& store;
  const Outcomes* outcomes = nullptr;
  const study::StudyKey* key = nullptr;
};

struct DatasetOptions {
  std::vector<std::string> authors{};
  std::string license{};             ///< for instance "CC0"; empty: not stated
  std::string institution{};         ///< where the data were collected; empty: not stated
  bool traces = false;               ///< includes positions and forces of every trial
  bool stimuli = false;              ///< includes the study's images
  std::filesystem::path database{};  ///< a database to copy into the dataset; empty: none
  Typed typed = Typed::left_out;  ///< free-text answers, notes and reasons, which may name people
  std::vector<record::PersonalRecord> consents{};  ///< of the personal data, if they are known
  std::function<void(int done, int of)> progress{};
};

/// A label for file names that is unique among participants. Letters and digits stay as they are,
/// except that "Z" becomes "ZZ"; "-" becomes "Zd", "_" becomes "Zu" and "+" becomes "Zp". For
/// example, "P-07" becomes "PZd07".
[[nodiscard]] std::string participant_label(const std::string& participant);

/// The letters and digits of a name; "study" if it has none.
[[nodiscard]] std::string plain_label(const std::string& name);

/// The part of the README that all formats share: how the data were collected, and what is still
/// sealed.
[[nodiscard]] std::string about_study(const DatasetSource& study);

/// The report as JSON; before unblinding, the report on quality.
/// \param typed  left_out: without free-text answers
[[nodiscard]] std::string report_in_dataset(const DatasetSource& study, Typed typed);

/// The meaning of an exported column, as in docs/data-dictionary.md, "Exports".
struct ColumnMeaning {
  std::string description;
  std::string unit{};                                         ///< a BIDS unit; empty: none
  std::vector<std::pair<std::string, std::string>> levels{};  ///< values and their meanings
};

/// The prefix of rating columns, followed by the scale's id.
inline constexpr std::string_view kRatingColumn = "rating_";

/// \param column  its name in the CSV files or in BIDS
/// \throws std::out_of_range if no export has such a column
[[nodiscard]] ColumnMeaning meaning_of(const std::string& column);

}  // namespace touchtrial::analysis
