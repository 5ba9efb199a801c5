/// \file The subject model that `simulate` uses unless told otherwise: config/subjects/default.json
/// as it was when the program was built, so that the program does not depend on where it is
/// started.
#pragma once

#include <string_view>

namespace touchtrial::app {

[[nodiscard]] std::string_view default_subject_json() noexcept;

}  // namespace touchtrial::app
