/// \file config/texts as it was when the program was built.
#pragma once

#include <string_view>

namespace touchtrial::app {

[[nodiscard]] std::string_view english_texts_json() noexcept;
[[nodiscard]] std::string_view german_texts_json() noexcept;

}  // namespace touchtrial::app
