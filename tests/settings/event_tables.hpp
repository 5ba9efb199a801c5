/// \file The tables of events in the data dictionary, made from the kinds' descriptions.
#pragma once

#include <string>

namespace touchtrial {

/// A Markdown table with a row for each kind and for each member of its body and secret.
[[nodiscard]] std::string table_of_events(bool on_file_chain);

/// A Markdown table with the kinds of the rows of each file that exports write of events.
[[nodiscard]] std::string table_of_exported_events();

}  // namespace touchtrial
