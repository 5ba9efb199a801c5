/// \file Common parts of the dataset formats: source, options and labels.
#pragma once

#include "analysis/exports/people_tables.hpp"
#include "analysis/outcomes/outcomes.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
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
  std::string institution{};         ///< the institution that collected the data; empty: not stated
  bool traces = false;               ///< includes positions and forces of every trial
  bool stimuli = false;              ///< includes the study's images
  std::filesystem::path database{};  ///< a database to copy into the dataset; empty: none
  /// Free-text answers, notes and reasons, which may name people.
  FreeText free_text = FreeText::left_out;
  std::vector<record::PersonalRecord> consents{};  ///< from the personal data, if available
  std::function<void(int finished, int total)> progress{};
};

/// A label for file names that is unique among participants. Letters and digits stay as they are,
/// except that "Z" becomes "ZZ"; "-" becomes "Zd", "_" becomes "Zu" and "+" becomes "Zp". For
/// example, "P-07" becomes "PZd07".
[[nodiscard]] std::string participant_label(const std::string& participant);

/// The letters and digits of a name; "study" if it has none.
[[nodiscard]] std::string plain_label(const std::string& name);

/// The README text common to all formats: how the data were collected, and what is still sealed.
[[nodiscard]] std::string study_readme(const DatasetSource& study);

/// The report as JSON; before unblinding, the report on quality.
/// \param free_text  left_out: without free-text answers
[[nodiscard]] std::string report_in_dataset(const DatasetSource& study, FreeText free_text);

}  // namespace touchtrial::analysis
