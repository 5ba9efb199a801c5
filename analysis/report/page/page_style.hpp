/// \file The style sheet of report pages. Private to analysis/report/page.
#pragma once

#include <string_view>

namespace touchtrial::analysis {

/// page_style.css
[[nodiscard]] std::string_view page_style() noexcept;

}  // namespace touchtrial::analysis
