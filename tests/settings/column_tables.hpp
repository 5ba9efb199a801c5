/// \file The tables of exported columns in docs/data-dictionary.md.
#pragma once

#include <string>

namespace touchtrial {

/// One row per column of a CSV file, with its meaning, unit and levels.
/// \param file  "trials.csv"
[[nodiscard]] std::string table_of_columns(const std::string& file);

}  // namespace touchtrial
