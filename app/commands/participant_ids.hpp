/// \file Ids of participants as people type them: which one comes next, and which one may be a slip
/// of the finger.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The id after the largest of those that begin like the last one: P08 after P06 and P07.
/// \param known  in the order in which they came
/// \return "P01" if none is known; nothing if the last one does not end in a number
[[nodiscard]] std::optional<std::string> next_id(const std::vector<std::string>& known);

/// A known id that an unknown one may be meant for: in other capitals, with other zeros, or with
/// one character added, left out, replaced or swapped. Another digit in the same place is another
/// participant.
/// \return nothing if the id is known, is next_id, or is like no other
[[nodiscard]] std::optional<std::string> perhaps_meant(const std::string& id,
                                                       const std::vector<std::string>& known);

/// The ids of a study's sessions, in their order, and of those who take somebody's place; then
/// those who have consented and have no session. A database or file of personal data that is
/// missing or cannot be read adds nobody.
[[nodiscard]] std::vector<std::string> known_ids(const std::filesystem::path& database);

/// Asks at the terminal about an id that nobody has and that perhaps_meant takes for another's.
/// \param command  that the id was given to, for the message
/// \param yes  as for `confirm`
/// \throws as confirm
void confirm_id(const std::string& command, const std::filesystem::path& database,
                const std::string& id, bool yes);

}  // namespace touchtrial::app
