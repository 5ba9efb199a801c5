/// \file Typed participant ids: the next one, and likely typing errors.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The id after the largest of those with the prefix of the last one: P08 after P06 and P07.
/// \param known  in the order of their sessions
/// \return "P01" if none is known; nothing if the last one does not end in a number
[[nodiscard]] std::optional<std::string> next_id(const std::vector<std::string>& known);

/// A known id of which an unknown one may be a misspelling: with other capitals or zeros, or one
/// character added, omitted, replaced or swapped. Another digit in the same place means another
/// participant.
/// \return nothing if the id is known, is next_id, or is like no other
[[nodiscard]] std::optional<std::string> likely_id(const std::string& id,
                                                   const std::vector<std::string>& known);

/// The ids of a study's sessions, in order, and of replacements; then of people with a consent but
/// no session. A missing or unreadable database or file of personal data adds none.
[[nodiscard]] std::vector<std::string> known_ids(const std::filesystem::path& database);

/// Asks at the terminal about an unknown id for which likely_id finds a known one.
/// \param command  for the message
/// \param yes  as for `confirm`
/// \throws as confirm
void confirm_id(const std::string& command, const std::filesystem::path& database,
                const std::string& id, bool yes);

}  // namespace touchtrial::app
