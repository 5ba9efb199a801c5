/// \file Makes texts of people and files safe for terminals, tables and pages: no text can move the
///   cursor, colour the screen, or change the order of its display.
#pragma once

#include <string>
#include <string_view>

namespace touchtrial {

/// How ASCII's control characters (below U+0020, and U+007F) are shown.
enum class Controls {
  shown,      ///< line feeds and tabs stay, all others become `\uNNNN`
  as_spaces,  ///< all of them become spaces
};

/// \return `text` as UTF-8 without control characters: those from U+0080, U+2028, U+2029 and
///   Unicode's controls of direction become `\uNNNN`, which JSON reads as the same character; bytes
///   that are not UTF-8 become `\xNN`
[[nodiscard]] std::string printable(std::string_view text, Controls controls = Controls::shown);

}  // namespace touchtrial
