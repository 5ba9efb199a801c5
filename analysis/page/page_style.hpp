/// \file The style sheet of report pages. Private to analysis/page.
#pragma once

namespace touchtrial::analysis {

extern const char* const kPageStyle;

}  // namespace touchtrial::analysis
