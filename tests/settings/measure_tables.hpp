/// \file The tables of results.json in the documentation, made from the measures.
#pragma once

#include <string>

namespace touchtrial {

/// A Markdown table with a row for each object and for each of its members.
/// \param studies  "identification", "ratings" or "thresholds"
/// \throws UsageError for other studies
[[nodiscard]] std::string table_of_measures(const std::string& studies);

}  // namespace touchtrial
