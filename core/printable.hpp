/// \file Makes text from users and files safe for terminals, tables and pages, so that it cannot
/// move the cursor, colour the screen or change the display order.
#pragma once

#include <string>
#include <string_view>

namespace touchtrial {

/// How ASCII control characters (below U+0020, and U+007F) are shown.
enum class Controls {
  shown,      ///< line feeds and tabs stay, all others become `\uNNNN`
  as_spaces,  ///< all of them become spaces
};

/// \return `text` as UTF-8 without control characters. Controls from U+0080, U+2028, U+2029 and
///   Unicode's bidirectional controls become `\uNNNN`, which JSON reads as the same character;
///   bytes that are not UTF-8 become `\xNN`
[[nodiscard]] std::string printable(std::string_view text, Controls controls = Controls::shown);

}  // namespace touchtrial
