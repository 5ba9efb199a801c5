/// \file Participant ids: the next one, and likely typing errors.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The id after the largest one with the prefix of the last id: P08 after P06 and P07.
/// \param ids  known participants, in the order of their sessions
/// \return "P01" if there are none; nothing if the last one does not end in a number
[[nodiscard]] std::optional<std::string> next_id(const std::vector<std::string>& ids);

/// The known id of which an unknown one may be a misspelling: other capitals or zeros, or one
/// character added, omitted, replaced or swapped. One replaced digit means another participant.
/// \return nothing if the id is known, is next_id, or resembles no known one
[[nodiscard]] std::optional<std::string> likely_id(const std::string& id,
                                                   const std::vector<std::string>& ids);

/// The ids of a study's sessions, in order, and of replacements; then of people with a consent but
/// no session. A missing or unreadable database or file of personal data adds none.
[[nodiscard]] std::vector<std::string> known_ids(const std::filesystem::path& database);

/// Asks for confirmation of an unknown id if likely_id finds a known one.
/// \param command  name of the command, for the message
/// \param yes  as for `confirm`
/// \throws as confirm
void confirm_id(const std::string& command, const std::filesystem::path& database,
                const std::string& id, bool yes);

}  // namespace touchtrial::app
